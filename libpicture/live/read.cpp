// read.cpp: Reads a frame into planes: guides, illumination without the surface's colour, and where
// each surface was in the frame before.
#include "libpicture/live/stages.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libpicture/live/read.cpp"
#include <hwy/foreach_target.h>

#include "libpicture/live/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace picture::live {
namespace HWY_NAMESPACE {

constexpr float darkest = 0.03f, lightest = 1e3f; // limits of what illumination is divided by
constexpr float brightest = 1e8f;      // illumination is at most that, so that squares are finite
constexpr float environmentFar = 1e6f; // nearness of the environment in parallel views

// A place in a picture (0 to 1) and the depth along the view.
struct Place {
  Lanes x, y, depth;
};

inline LaneVec toView(const Projection& p, const LaneVec& v) {
  const auto& m = p.rotation;
  return {v.x * lanesOf(m[0][0]) + v.y * lanesOf(m[0][1]) + v.z * lanesOf(m[0][2]),
          v.x * lanesOf(m[1][0]) + v.y * lanesOf(m[1][1]) + v.z * lanesOf(m[1][2]),
          v.x * lanesOf(m[2][0]) + v.y * lanesOf(m[2][1]) + v.z * lanesOf(m[2][2])};
}

inline Place project(const Projection& p, const LaneVec& direction) {
  const Lanes depth = hn::Neg(direction.z), half = lanesOf(0.5f);
  const Lanes per = p.parallel ? lanesOf(1) : lanesOf(1) / depth;
  return {half + direction.x * per * lanesOf(p.scale[0]),
          half + direction.y * per * lanesOf(p.scale[1]), depth};
}

inline Place placeOf(const Projection& p, const LaneVec& point) {
  const LaneVec eye{lanesOf(p.eye[0]), lanesOf(p.eye[1]), lanesOf(p.eye[2])},
      rest{lanesOf(p.eyeRest[0]), lanesOf(p.eyeRest[1]), lanesOf(p.eyeRest[2])};
  return project(p, toView(p, point - eye - rest));
}

// Returns the place where the environment that is seen at (x, y) was seen by another camera.
inline Place environmentAt(const Projection& now, const Projection& before, Lanes x, Lanes y) {
  const Lanes half = lanesOf(0.5f);
  if (now.parallel || before.parallel) return {x, y, lanesOf(1)};
  const LaneVec view{(x - half) * lanesOf(1 / now.scale[0]), (y - half) * lanesOf(1 / now.scale[1]),
                     lanesOf(-1)};
  const auto& m = now.rotation;
  return project(
      before,
      toView(before,
             {view.x * lanesOf(m[0][0]) + view.y * lanesOf(m[1][0]) + view.z * lanesOf(m[2][0]),
              view.x * lanesOf(m[0][1]) + view.y * lanesOf(m[1][1]) + view.z * lanesOf(m[2][1]),
              view.x * lanesOf(m[0][2]) + view.y * lanesOf(m[1][2]) + view.z * lanesOf(m[2][2])}));
}

inline Lanes nearnessOf(const Projection& p, Lanes depth) {
  return p.parallel ? depth * lanesOf(p.perHeight) : lanesOf(1) / depth;
}

inline Mask isPlace(const Projection& p, const Place& place) {
  const Mask finite = hn::And(isFinite(place.x), isFinite(place.y));
  if (p.parallel) return hn::And(finite, isFinite(place.depth));
  return hn::And(finite, hn::And(place.depth > lanesOf(1e-30f), place.depth < lanesOf(1e30f)));
}

// Returns a plane's numbers where they are finite and positive, otherwise 0.
inline Lanes amount(Lanes v) { return hn::IfThenElseZero(hn::And(isFinite(v), v > lanesOf(0)), v); }
inline LaneVec amounts(const LaneVec& v) { return {amount(v.x), amount(v.y), amount(v.z)}; }

inline LaneVec unitNormal(const LaneVec& v) {
  const Lanes length2 = dot(v, v), zero = lanesOf(0);
  const Mask known = hn::And(isFinite(length2), length2 > lanesOf(1e-12f));
  const LaneVec unit = v * (lanesOf(1) / hn::Sqrt(select(known, length2, lanesOf(1))));
  return select(known, unit, LaneVec{zero, zero, lanesOf(1)});
}

// Returns the pixel of the shown picture that a place within a pixel of a frame lies in, along one
// axis. frame, shown: their pixels.
inline Lanes shownPixel(Lanes pixel, Lanes within, int frame, int shown) {
  const Lanes ratio = lanesOf(float(double(shown) / frame)), one = lanesOf(1);
  const Lanes inside = clamp(within, lanesOf(0), one);
  return min(hn::Floor((pixel + inside) * ratio), hn::Ceil((pixel + one) * ratio) - one);
}

// Returns the standard deviations of colours from the variances of their samples.
inline LaneVec deviationOf(const LaneVec& variance, Lanes samples, Mask some) {
  const LaneVec v = amounts(variance);
  const Lanes per = lanesOf(1) / max(samples, lanesOf(1));
  return {hn::IfThenElseZero(some, hn::Sqrt(v.x * per)),
          hn::IfThenElseZero(some, hn::Sqrt(v.y * per)),
          hn::IfThenElseZero(some, hn::Sqrt(v.z * per))};
}

// Stores the variance of the luma, which one sample does not tell. The colours of a sample vary
// together.
inline void storeVariance(const LaneVec& deviation, Lanes samples, Plane& plane, size_t i) {
  const Lanes luma = min(lumaOf(deviation).x, lanesOf(brightest));
  store(select(samples == lanesOf(1), lanesOf(Reading::unknown), luma * luma), plane.data() + i);
}

void readRow(const ReadPass& pass, int y, Moment& now, Reading& reading) {
  const FramePlanes& frame = pass.frame;
  const Moment& before = pass.before;
  const int w = now.layout.width, h = now.layout.height;
  const size_t first = size_t(y) * size_t(w), row = now.layout.row(y);
  const Projection &p = now.projection, &q = before.projection;
  const bool projects = p.usable && q.usable;
  const Resampling alongX(w, std::max(1, before.layout.width)),
      alongY(h, std::max(1, before.layout.height));
  const float stayY = alongY(float(y));
  const Lanes nan = lanesOf(std::numeric_limits<float>::quiet_NaN()), zero = lanesOf(0),
              one = lanesOf(1);
  Guides& guides = now.guides;
  for (int x = 0; x < w; x += width()) {
    const size_t i = row + size_t(x);
    Lanes alpha;
    const LaneVec radiance = amounts(loadQuadruples(frame.rgba + 4 * first, x, w, alpha));
    const LaneVec point = loadTriples(frame.position + 3 * first, x, w),
                  motion = pass.isFirst ? LaneVec{nan, nan, nan}
                                        : loadTriples(frame.motion + 3 * first, x, w),
                  colour = loadTriples(frame.albedo + 3 * first, x, w);
    const Lanes depth = loadSome(frame.depth + first, x, w),
                given = loadSome(frame.name + first, x, w),
                samples = loadSome(frame.samples + first, x, w);
    const LaneVec known = amounts(colour);
    // Without light, a pixel that shows the environment shows it in a mirror or through glass.
    const Mask coloured = known.x + known.y + known.z > zero,
               sparse = pass.sparse ? hn::Or(coloured, isFinite(depth)) : samples > zero;
    const Mask some = hn::Or(samples > zero, sparse), hit = hn::And(some, isFinite(depth));

    const Lanes centerX = countFrom(x), centerY = lanesOf(float(y));
    const Lanes filmX = (centerX + lanesOf(0.5f)) * lanesOf(1.0f / float(w)),
                filmY = lanesOf((float(y) + 0.5f) / float(h));
    const Place place = placeOf(p, point);
    const Lanes offsetX = place.x * lanesOf(float(w)) - (centerX + lanesOf(0.5f)),
                offsetY = place.y * lanesOf(float(h)) - (centerY + lanesOf(0.5f));
    // The camera is known to be what was said if the sample projects into its own pixel.
    const Mask own =
        hn::And(hn::And(hit, isPlace(p, place)), hn::And(abs(offsetX) <= one, abs(offsetY) <= one));
    const Place past = placeOf(q, point - motion);
    // A picture behind the world moves with the screen, but not what mirrors and glass show.
    Place far = environmentAt(p, q, filmX, filmY);
    if (p.camera.fixedBackground)
      far = {select(coloured, far.x, filmX), select(coloured, far.y, filmY),
             select(coloured, far.depth, one)};
    const Mask moved = hn::And(own, isPlace(q, past)),
               environment = hn::AndNot(hit, hn::And(some, isPlace(q, far)));
    const Mask still = hn::And(hn::And(motion.x == zero, motion.y == zero), motion.z == zero);
    const Lanes wide = lanesOf(float(before.layout.width)),
                high = lanesOf(float(before.layout.height));
    const Lanes stayX = centerX * lanesOf(alongX.ratio) + lanesOf(alongX.shift);
    Lanes moveX = nan, moveY = nan;
    if (projects) {
      moveX = select(moved, past.x - place.x, select(environment, far.x - filmX, nan));
      moveY = select(moved, past.y - place.y, select(environment, far.y - filmY, nan));
    }
    const Mask stays = pass.rests ? hn::Or(still, hn::Not(some)) : hn::Not(some);
    moveX = select(stays, zero, moveX);
    moveY = select(stays, zero, moveY);
    store(moveX, reading.moveX.data() + i);
    store(moveY, reading.moveY.data() + i);
    store(stayX + moveX * wide, reading.pastX.data() + i);
    store(lanesOf(stayY) + moveY * high, reading.pastY.data() + i);

    Lanes withinY;
    const Lanes withinX = loadPairs(frame.place + 2 * first, x, w, withinY);
    const Mask lies = hn::And(some, hn::And(isFinite(withinX), isFinite(withinY)));
    store(select(lies, shownPixel(centerX, withinX, w, pass.shown.width), lanesOf(-1)),
          reading.hitX.data() + i);
    store(select(lies, shownPixel(centerY, withinY, h, pass.shown.height), lanesOf(-1)),
          reading.hitY.data() + i);

    // Without a projection that can be inverted, the depth of the frame itself must do.
    const Lanes none = lanesOf(p.parallel ? environmentFar : 0);
    const Lanes nearness =
        select(hit, amount(nearnessOf(p, select(own, place.depth, depth))), none);
    const Mask follows = hn::And(moved, hn::Not(hn::And(stays, hit)));
    store(select(follows, amount(nearnessOf(q, past.depth)), nearness),
          reading.pastNearness.data() + i);
    store(nearness, guides.nearness.data() + i);
    store(hn::IfThenElseZero(own, offsetX), guides.offsetX.data() + i);
    store(hn::IfThenElseZero(own, offsetY), guides.offsetY.data() + i);
    store(hn::IfThenElseZero(hn::AndNot(still, hit), lanesOf(1)), guides.moves.data() + i);
    store(unitNormal(loadTriples(frame.normal + 3 * first, x, w)), guides.normal, i);
    const Lanes name = select(some, amount(given), lanesOf(emptyName));
    store(select(presentFrom(x, w), name, lanesOf(outsideName)), guides.name.data() + i);

    const Lanes least = lanesOf(darkest), greatest = lanesOf(lightest);
    const LaneVec surface{clamp(known.x, least, greatest), clamp(known.y, least, greatest),
                          clamp(known.z, least, greatest)};
    // The environment has an albedo only in mirrors and behind glass.
    const LaneVec albedo = select(hn::Or(hit, coloured), surface, LaneVec{one, one, one});
    const Lanes most = lanesOf(brightest);
    const LaneVec given3 = amounts(loadTriples(frame.reflection + 3 * first, x, w));
    const LaneVec reflected{min(given3.x, min(radiance.x, most)),
                            min(given3.y, min(radiance.y, most)),
                            min(given3.z, min(radiance.z, most))};
    const LaneVec rest = radiance - reflected;
    const LaneVec light{min(rest.x / albedo.x, most), min(rest.y / albedo.y, most),
                        min(rest.z / albedo.z, most)};
    if (frame.variance) {
      const LaneVec deviation =
          deviationOf(loadTriples(frame.variance + 3 * first, x, w), samples, some);
      storeVariance(deviation, samples, reading.reflectionVariance, i);
      storeVariance({deviation.x / albedo.x, deviation.y / albedo.y, deviation.z / albedo.z},
                    samples, reading.variance, i);
    }
    const LaneVec nothing{zero, zero, zero};
    store(albedo, reading.albedo, i);
    store(lumaOf(select(some, light, nothing)), reading.light, i);
    store(lumaOf(select(some, reflected, nothing)), reading.reflection, i);
  }
}

} // namespace HWY_NAMESPACE
} // namespace picture::live
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace picture::live {
HWY_EXPORT(readRow);
void readRow(const ReadPass& pass, int y, Moment& now, Reading& reading) {
  HWY_DYNAMIC_DISPATCH(readRow)(pass, y, now, reading);
}
} // namespace picture::live
#endif

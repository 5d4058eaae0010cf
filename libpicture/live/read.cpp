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

inline Lanes3 toView(const Projection& p, const Lanes3& v) {
  const auto& m = p.rotation;
  return {v.x * all(m[0][0]) + v.y * all(m[0][1]) + v.z * all(m[0][2]),
          v.x * all(m[1][0]) + v.y * all(m[1][1]) + v.z * all(m[1][2]),
          v.x * all(m[2][0]) + v.y * all(m[2][1]) + v.z * all(m[2][2])};
}

inline Place project(const Projection& p, const Lanes3& direction) {
  const Lanes depth = hn::Neg(direction.z), half = all(0.5f);
  const Lanes per = p.parallel ? all(1) : all(1) / depth;
  return {half + direction.x * per * all(p.scale[0]), half + direction.y * per * all(p.scale[1]),
          depth};
}

inline Place placeOf(const Projection& p, const Lanes3& point) {
  const Lanes3 eye{all(p.eye[0]), all(p.eye[1]), all(p.eye[2])},
      rest{all(p.eyeRest[0]), all(p.eyeRest[1]), all(p.eyeRest[2])};
  return project(p, toView(p, point - eye - rest));
}

// Returns the place where the environment that is seen at (x, y) was seen by another camera.
inline Place environmentAt(const Projection& now, const Projection& before, Lanes x, Lanes y) {
  const Lanes half = all(0.5f);
  if (now.parallel || before.parallel) return {x, y, all(1)};
  const Lanes3 view{(x - half) * all(1 / now.scale[0]), (y - half) * all(1 / now.scale[1]),
                    all(-1)};
  const auto& m = now.rotation;
  return project(
      before,
      toView(before, {view.x * all(m[0][0]) + view.y * all(m[1][0]) + view.z * all(m[2][0]),
                      view.x * all(m[0][1]) + view.y * all(m[1][1]) + view.z * all(m[2][1]),
                      view.x * all(m[0][2]) + view.y * all(m[1][2]) + view.z * all(m[2][2])}));
}

inline Lanes nearnessOf(const Projection& p, Lanes depth) {
  return p.parallel ? depth * all(p.perHeight) : all(1) / depth;
}

inline Mask isPlace(const Projection& p, const Place& place) {
  const Mask finite = both(isFinite(place.x), isFinite(place.y));
  if (p.parallel) return both(finite, isFinite(place.depth));
  return both(finite, both(place.depth > all(1e-30f), place.depth < all(1e30f)));
}

// Returns a plane's numbers where they are finite and positive, otherwise 0.
inline Lanes amount(Lanes v) { return where(both(isFinite(v), v > all(0)), v); }
inline Lanes3 amounts(const Lanes3& v) { return {amount(v.x), amount(v.y), amount(v.z)}; }

inline Lanes3 unitNormal(const Lanes3& v) {
  const Lanes length2 = dot(v, v), zero = all(0);
  const Mask known = both(isFinite(length2), length2 > all(1e-12f));
  const Lanes3 unit = v * (all(1) / hn::Sqrt(select(known, length2, all(1))));
  return select(known, unit, Lanes3{zero, zero, all(1)});
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
  const Lanes nan = all(std::numeric_limits<float>::quiet_NaN()), zero = all(0), one = all(1);
  Guides& guides = now.guides;
  for (int x = 0; x < w; x += width()) {
    const size_t i = row + size_t(x);
    Lanes alpha;
    const Lanes3 radiance = amounts(loadQuadruples(frame.rgba + 4 * first, x, w, alpha));
    const Lanes3 point = loadTriples(frame.position + 3 * first, x, w),
                 motion = loadTriples(frame.motion + 3 * first, x, w),
                 colour = loadTriples(frame.albedo + 3 * first, x, w);
    const Lanes depth = loadSome(frame.depth + first, x, w),
                given = loadSome(frame.name + first, x, w),
                samples = loadSome(frame.samples + first, x, w);
    const Lanes3 known = amounts(colour);
    // Without light, a pixel that shows the environment shows it in a mirror or through glass.
    const Mask coloured = known.x + known.y + known.z > zero,
               sparse = pass.sparse ? either(coloured, isFinite(depth)) : samples > zero;
    const Mask some = either(samples > zero, sparse), hit = both(some, isFinite(depth));

    const Lanes centerX = countFrom(x), centerY = all(float(y));
    const Lanes filmX = (centerX + all(0.5f)) * all(1.0f / float(w)),
                filmY = all((float(y) + 0.5f) / float(h));
    const Place place = placeOf(p, point);
    const Lanes offsetX = place.x * all(float(w)) - (centerX + all(0.5f)),
                offsetY = place.y * all(float(h)) - (centerY + all(0.5f));
    // The camera is known to be what was said if the sample projects into its own pixel.
    const Mask own = both(both(hit, isPlace(p, place)),
                          both(absolute(offsetX) <= one, absolute(offsetY) <= one));
    const Place past = placeOf(q, point - motion);
    // A picture behind the world moves with the screen, but not what mirrors and glass show.
    Place far = environmentAt(p, q, filmX, filmY);
    if (p.camera.fixedBackground)
      far = {select(coloured, far.x, filmX), select(coloured, far.y, filmY),
             select(coloured, far.depth, one)};
    const Mask moved = both(own, isPlace(q, past)),
               environment = hn::AndNot(hit, both(some, isPlace(q, far)));
    const Mask still = both(both(motion.x == zero, motion.y == zero), motion.z == zero);
    const Lanes wide = all(float(before.layout.width)), high = all(float(before.layout.height));
    const Lanes stayX = centerX * all(alongX.ratio) + all(alongX.shift);
    Lanes pastX = nan, pastY = nan;
    if (projects) {
      pastX = select(moved, stayX + (past.x - place.x) * wide,
                     select(environment, stayX + (far.x - filmX) * wide, nan));
      pastY = select(moved, all(stayY) + (past.y - place.y) * high,
                     select(environment, all(stayY) + (far.y - filmY) * high, nan));
    }
    const Mask stays = pass.rests ? either(still, hn::Not(some)) : hn::Not(some);
    store(select(stays, stayX, pastX), reading.pastX.data() + i);
    store(select(stays, all(stayY), pastY), reading.pastY.data() + i);

    // Without a projection that can be inverted, the depth of the frame itself must do.
    const Lanes none = all(p.parallel ? environmentFar : 0);
    const Lanes nearness =
        select(hit, amount(nearnessOf(p, select(own, place.depth, depth))), none);
    const Mask follows = both(moved, hn::Not(both(stays, hit)));
    store(select(follows, amount(nearnessOf(q, past.depth)), nearness),
          reading.pastNearness.data() + i);
    store(nearness, guides.nearness.data() + i);
    store(where(own, offsetX), guides.offsetX.data() + i);
    store(where(own, offsetY), guides.offsetY.data() + i);
    store(where(hn::AndNot(still, hit), all(1)), guides.moves.data() + i);
    store(unitNormal(loadTriples(frame.normal + 3 * first, x, w)), guides.normal, i);
    const Lanes name = select(some, amount(given), all(emptyName));
    store(select(present(x, w), name, all(outsideName)), guides.name.data() + i);

    const Lanes least = all(darkest), greatest = all(lightest);
    const Lanes3 surface{clamped(known.x, least, greatest), clamped(known.y, least, greatest),
                         clamped(known.z, least, greatest)};
    // The environment has an albedo only in mirrors and behind glass.
    const Lanes3 albedo = select(either(hit, coloured), surface, Lanes3{one, one, one});
    const Lanes most = all(brightest);
    const Lanes3 given3 = amounts(loadTriples(frame.reflection + 3 * first, x, w));
    const Lanes3 reflected{smaller(given3.x, smaller(radiance.x, most)),
                           smaller(given3.y, smaller(radiance.y, most)),
                           smaller(given3.z, smaller(radiance.z, most))};
    const Lanes3 rest = radiance - reflected;
    const Lanes3 light{smaller(rest.x / albedo.x, most), smaller(rest.y / albedo.y, most),
                       smaller(rest.z / albedo.z, most)};
    const Lanes3 nothing{zero, zero, zero};
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

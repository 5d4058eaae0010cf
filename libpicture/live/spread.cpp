// spread.cpp: Gives each pixel illumination from the cells around it that show its surface. So
// edges and textures are as sharp as the pixels. Where illumination has no noise, the pixel's own
// sample is the truth: it is shown, and followed with its surface until the pixel has the next one,
// so that shadows become as sharp, too.
#include "libpicture/live/stages.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libpicture/live/spread.cpp"
#include <hwy/foreach_target.h>

#include "libpicture/live/past-inl.h"
#include "libpicture/live/shown-inl.h"

HWY_BEFORE_NAMESPACE();
namespace picture::live {
namespace HWY_NAMESPACE {

constexpr float normalFall = 64;     // about the power of the cosine between normals
constexpr float leastWeight = 1e-3f; // a sum of weights below that shows nothing
constexpr float almostNoNoise = 0.05f;
constexpr float noiseFall = 4; // from a quarter of noise on, a pixel's own sample does not count
// Illumination is radiance divided by albedo. Where a surface also reflects like varnish that is no
// illumination of another albedo, so cells of a like albedo count more, as long as there are some.
constexpr float albedoFall = 9, mostAlbedoFall = 3, alikeAlbedo = 1;

// The cells of neighbouring pixels: the first one, and the others counted from it.
using Table = decltype(hn::IndicesFromVec(LanesTag(), hn::Zero(IndicesTag())));

// Where pixels from x on lie among the cells of one axis.
struct Columns {
  Columns(int x, int block)
      : first(x / block), table(hn::IndicesFromVec(LanesTag(), cells(x, block))) {
    float places[Layout::widest];
    for (int k = 0; k < width(); k++)
      places[k] = (float(x + k) + 0.5f) / float(block) - 0.5f - float((x + k) / block);
    part = load(places);
  }
  static Indices cells(int x, int block) {
    int32_t numbers[Layout::widest];
    for (int k = 0; k < width(); k++) numbers[k] = (x + k) / block - x / block;
    return hn::LoadU(IndicesTag(), numbers);
  }
  // Returns the numbers of the pixels' cells, `at` being where the first cell's number lies.
  Lanes of(const float* at) const { return hn::TableLookupLanes(load(at), table); }
  LaneVec of(const Plane3& planes, size_t at) const {
    return {of(planes.x.data() + at), of(planes.y.data() + at), of(planes.z.data() + at)};
  }

  int first;
  Table table;
  Lanes part; // how far the pixel's centre is from the centre of its cell, in cells
};

// Weights of three cells for a place `part` from the middle one: the quadratic B-spline.
template <class Number> inline void splineWeights3(Number part, Number half, Number weight[3]) {
  weight[0] = half * (half - part) * (half - part);
  weight[1] = half + half * half - part * part;
  weight[2] = half * (half + part) * (half + part);
}

inline Lanes meanOf(const LaneVec& colour) {
  return (colour.x + colour.y + colour.z) * lanesOf(1.0f / 3);
}

// Holds what the cells around a pixel tell.
struct Around {
  LaneVec light, least, most;
  Lanes weights, noise, slope, changed;
  // Holds the largest noise of the cells with the pixel's name, however they lie; -1: there are
  // none.
  Lanes nameNoise;

  // Written out, because GCC compiles a constructor of its own making for the oldest instruction
  // set, where vectors are returned in another way.
  Around()
      : light{lanesOf(0), lanesOf(0), lanesOf(0)}, least{lanesOf(1e30f), lanesOf(1e30f),
                                                         lanesOf(1e30f)},
        most{lanesOf(-1e30f), lanesOf(-1e30f), lanesOf(-1e30f)}, weights(lanesOf(0)),
        noise(lanesOf(0)), slope(lanesOf(0)), changed(lanesOf(0)), nameNoise(lanesOf(-1)) {}

  // same: the names are equal. alike: the cell's albedo is like the pixel's, so that its light is a
  // bound for the pixel's.
  void add(const LaneVec& other, Lanes weight, Mask same, Mask alike, Lanes otherNoise,
           Lanes otherSlope) {
    const Mask counts = hn::And(alike, weight > lanesOf(0.1f * leastWeight));
    weights = weights + weight;
    light = light + other * weight;
    noise = noise + otherNoise * weight;
    nameNoise = select(same, max(nameNoise, otherNoise), nameNoise);
    slope = slope + otherSlope * weight;
    least =
        select(counts, LaneVec{min(least.x, other.x), min(least.y, other.y), min(least.z, other.z)},
               least);
    most = select(counts, LaneVec{max(most.x, other.x), max(most.y, other.y), max(most.z, other.z)},
                  most);
  }
  Mask found() const { return weights > lanesOf(leastWeight); }
};

// The surfaces of some pixels.
struct Surface {
  Lanes name, nearness, albedo; // mean of the colours
  LaneVec colour;               // the albedo
  Lanes x, y;                   // the sample from the centre of the pixel's cell, in cells
  LaneVec normal;
};

// Returns the illumination of cells; what coats reflect becomes one of the pixels' own albedo.
inline LaneVec lightOf(const ColourPass& pass, const Columns& columns, size_t at,
                       const Surface& surface) {
  const LaneVec light = columns.of(pass.light, at);
  if (!pass.reflection) return light;
  return light + asIllumination(columns.of(*pass.reflection, at), surface.colour);
}

inline Around cellsAround(const ColourPass& pass, const Columns& columns, const Surface& surface,
                          int y) {
  const Moment& cells = pass.cells;
  const Guides& guides = cells.guides;
  const auto block = float(cells.block);
  const int cellY = y / cells.block;
  float down[3];
  splineWeights3((float(y) + 0.5f) / block - 0.5f - float(cellY), 0.5f, down);
  Lanes across[3];
  splineWeights3(columns.part, lanesOf(0.5f), across);
  const Lanes scale = cells.projection.parallel ? lanesOf(1) : abs(surface.nearness);
  Around around;
  for (int dy = -1; dy <= 1; dy++)
    for (int dx = -1; dx <= 1; dx++) {
      const size_t at = size_t(ptrdiff_t(cells.layout.row(cellY + dy)) + columns.first + dx);
      const auto of = [&](const Plane& plane) { return columns.of(plane.data() + at); };
      const Lanes slopeX = of(guides.slopeX), slopeY = of(guides.slopeY),
                  slope = abs(slopeX) + abs(slopeY);
      const Lanes expected = of(guides.nearness) +
                             slopeX * (surface.x - lanesOf(float(dx)) - of(guides.offsetX)) +
                             slopeY * (surface.y - lanesOf(float(dy)) - of(guides.offsetY));
      const Lanes away = abs(surface.nearness - expected) /
                             (slope * lanesOf(0.5f) + scale * lanesOf(0.003f) + lanesOf(1e-20f)) +
                         abs(lanesOf(1) - dot(columns.of(guides.normal, at), surface.normal)) *
                             lanesOf(normalFall);
      const Lanes albedo = meanOf(columns.of(pass.cellAlbedo, at));
      const Lanes unlike = min(abs(albedo - surface.albedo) * lanesOf(albedoFall) /
                                   (albedo + surface.albedo + lanesOf(1e-6f)),
                               lanesOf(mostAlbedoFall));
      const Mask same = of(guides.name) == surface.name;
      const Lanes weight =
          hn::IfThenElseZero(same, fallOff(away + unlike) * across[dx + 1] * lanesOf(down[dy + 1]));
      around.add(lightOf(pass, columns, at, surface), weight, same, unlike < lanesOf(alikeAlbedo),
                 of(cells.accumulated.noise), slope);
      const Mask exists = of(guides.name) >= lanesOf(0);
      around.changed =
          max(around.changed,
              hn::IfThenElseZero(hn::AndNot(of(pass.verdict) == lanesOf(0), exists), lanesOf(1)));
    }
  const Lanes per = lanesOf(1) / max(around.weights, lanesOf(1e-20f));
  around.light = around.light * per;
  around.noise = around.noise * per;
  around.slope = around.slope * per;
  return around;
}

// Returns the illumination of cells farther away: those with the pixel's name count, however they
// lie, and the others only if there are none. The light of a surface with a lower albedo is lowered
// with it, because some of that light may be reflected as by varnish.
inline LaneVec lightFarAround(const ColourPass& pass, const Columns& columns,
                              const Surface& surface, int y) {
  constexpr int reach = 2;
  constexpr float otherWeight = 1e-4f;
  const Moment& cells = pass.cells;
  const int cellY = y / cells.block;
  Lanes weights = lanesOf(1e-20f);
  LaneVec sum{lanesOf(0), lanesOf(0), lanesOf(0)};
  for (int dy = -reach; dy <= reach; dy++)
    for (int dx = -reach; dx <= reach; dx++) {
      const size_t at = size_t(ptrdiff_t(cells.layout.row(cellY + dy)) + columns.first + dx);
      const Lanes other = columns.of(cells.guides.name.data() + at);
      const float nearby = 1 / float(1 + dx * dx + dy * dy);
      const Lanes weight =
          hn::IfThenElseZero(other >= lanesOf(0), select(other == surface.name, lanesOf(nearby),
                                                         lanesOf(nearby * otherWeight)));
      const Lanes albedo = meanOf(columns.of(pass.cellAlbedo, at));
      const Lanes lower = min(albedo / max(surface.albedo, lanesOf(1e-6f)), lanesOf(1));
      weights = weights + weight;
      sum = sum + columns.of(pass.light, at) * (weight * lower);
      if (pass.reflection)
        sum = sum + asIllumination(columns.of(*pass.reflection, at), surface.colour) * weight;
    }
  return sum * (lanesOf(1) / weights);
}

inline LaneVec bounded(const LaneVec& v, const LaneVec& least, const LaneVec& most) {
  return {clamp(v.x, least.x, most.x), clamp(v.y, least.y, most.y), clamp(v.z, least.z, most.z)};
}

// Holds what was shown of pixels, and the pixels of the frame before that showed their surfaces.
struct RecalledSurfaces : Recalled {
  Taps taps;
};

// Tells where the surfaces of pixels were shown. slope: change of nearness from pixel to pixel.
inline RecalledSurfaces recalledSurfaces(const ColourPass& pass, const Beside& beside, Lanes slope,
                                         const Pixels& at) {
  const Expected expected = expectedAt(pass.pixels, pass.before, pass.reading, slope, at.i);
  const Lanes pastX = load(pass.reading.pastX.data() + at.i),
              pastY = load(pass.reading.pastY.data() + at.i);
  Taps taps = tapsAround(pass.before, expected, pastX, pastY);
  searchAround(pass.before, expected, pastX, pastY, taps);
  return {recalledAt(pass, beside, taps.found, at.x, at.y, at.i), taps};
}

// Returns the illumination that was shown of the pixels' own surfaces. A spline across the edges of
// something thin would swing below and above the light of what is beside it, and more with each
// frame.
inline LaneVec lightOfSurfaces(const ColourPass& pass, const Taps& taps) {
  const float* light = pass.shownLight.light.data();
  LaneVec sum{lanesOf(0), lanesOf(0), lanesOf(0)};
  for (int k = 0; k < 4; k++) {
    const Indices at = hn::ShiftLeft<2>(taps.index[k]);
    const LaneVec tap{gather(light, at), gather(light + 1, at), gather(light + 2, at)};
    sum = sum + tap * taps.weight[k];
  }
  return sum;
}

// Pixels that have a sample of light, and those of them that see the environment directly.
struct Lit {
  Mask all, environment;
};

inline Lit litPixels(const ColourPass& pass, const Pixels& at) {
  const int w = pass.pixels.layout.width;
  const size_t first = size_t(at.y) * size_t(w);
  const Mask lit = loadSome(pass.frame.samples + first, at.x, w) > lanesOf(0);
  // The environment has an albedo only in mirrors and behind glass.
  const LaneVec albedo = loadTriples(pass.frame.albedo + 3 * first, at.x, w);
  const Mask untinted = abs(albedo.x) + abs(albedo.y) + abs(albedo.z) <= lanesOf(0);
  const Mask far = hn::AndNot(isFinite(loadSome(pass.frame.depth + first, at.x, w)), lit);
  return {lit, hn::And(far, untinted)};
}

// Returns the illumination of pixels of which `around` may be noise or have no light.
inline LaneVec ownLight(const ColourPass& pass, const Around& around,
                        const RecalledSurfaces& recalled, Mask lit, const Pixels& at) {
  Lanes unused;
  LaneVec shown = shownNumbers(pass.shownLight.layout, pass.shownLight.light, recalled, unused);
  // Where nothing has changed at rest, a surface keeps what it has shown, also what is too fine
  // for the cells.
  const Mask same = pass.shownLight.layout == pass.pixels.layout ? lanesOf(0) < lanesOf(1)
                                                                 : lanesOf(1) < lanesOf(0);
  const Mask rests =
      hn::And(hn::And(recalled.known, same),
              hn::And(recalled.past.x == countFrom(at.x), recalled.past.y == lanesOf(float(at.y))));
  const Mask calm = hn::And(rests, around.changed <= lanesOf(0)), alone = hn::Not(around.found());
  const Mask keeps = hn::Or(calm, alone);
  const Mask follows =
      hn::And(hn::And(hn::AndNot(calm, alone), recalled.known), recalled.taps.found);
  if (!hn::AllFalse(LanesTag(), follows))
    shown = select(follows, lightOfSurfaces(pass, recalled.taps), shown);
  // A colour that was shown may belong to another albedo: the sample lies anywhere in the pixel.
  const Mask isBound = hn::Not(around.least.x > around.most.x);
  const LaneVec bound = select(isBound, bounded(shown, around.least, around.most), around.light);
  const LaneVec old = select(keeps, shown, bound);
  const LaneVec sample =
      load(pass.reading.light, at.i) +
      asIllumination(load(pass.reading.reflection, at.i), load(pass.reading.albedo, at.i));
  return select(lit, sample, select(recalled.known, old, around.light));
}

// Forgets colours that were shown while others lent their light: until the pixel's first sample of
// its own, also where there is no noise, and once noise is found to have been none.
inline void forgetLent(Mask unsampled, Mask lit, Mask found, Lanes noise, size_t i, Fresh& fresh) {
  const Lanes frames = load(fresh.oldFrames.data() + i);
  const Mask lent = hn::And(unsampled, hn::Not(hn::Or(found, lit)));
  const Mask quiet = hn::Or(hn::Not(found), noise < lanesOf(1 / noiseFall));
  const Mask first = hn::And(hn::And(lit, unsampled), hn::Or(quiet, frames <= lanesOf(1)));
  const Mask settles = hn::And(noise > lanesOf(0), noise <= lanesOf(almostNoNoise));
  const Mask forgets = hn::Or(lent, hn::Or(first, settles));
  store(hn::IfThenElseZero(hn::Not(forgets), frames), fresh.oldFrames.data() + i);
  const Lanes trust = load(fresh.trust.data() + i);
  store(select(forgets, lanesOf(Fresh::forgotten), trust), fresh.trust.data() + i);
}

inline LaneVec spreadLight(const ColourPass& pass, const Columns& columns, const Surface& surface,
                           const Around& around, const RecalledSurfaces& recalled, const Pixels& at,
                           Fresh& fresh) {
  const Lit lit = litPixels(pass, at);
  const Lanes one = lanesOf(1);
  const Mask some =
      hn::And(surface.name >= lanesOf(0), presentFrom(at.x, pass.pixels.layout.width));
  const Mask found = hn::AndNot(lit.environment, around.found());
  const Lanes last =
      lastNumbers(pass.shownLight.layout, pass.shownLight.light, recalled, ShownLight::noSample);
  // Nobody knows about the noise of something thin that no cell shows: its samples are kept.
  const Lanes nameNoise = select(around.nameNoise >= lanesOf(0), around.nameNoise,
                                 hn::IfThenElseZero(last < lanesOf(0), one));
  const Lanes noise =
      hn::IfThenElseZero(hn::Not(lit.environment), select(found, around.noise, nameNoise));
  store(noise, fresh.noise.data() + at.i);
  const LaneVec own = load(pass.reading.light, at.i);
  store(select(lit.all, own.x, last), fresh.sample.data() + at.i);

  const Lanes trust =
      hn::IfThenElseZero(found, min(noise * lanesOf(noiseFall), one)); // 0: free of noise
  forgetLent(last < lanesOf(0), lit.all, found, noise, at.i, fresh);
  LaneVec light = around.light;
  if (!hn::AllTrue(LanesTag(), trust >= one)) {
    const LaneVec sharp = ownLight(pass, around, recalled, lit.all, at);
    light = select(trust >= one, light, sharp + (light - sharp) * trust);
  }
  const Mask missing = hn::AndNot(hn::Or(found, hn::Or(lit.all, recalled.known)), some);
  if (!hn::AllFalse(LanesTag(), missing))
    light = select(missing, lightFarAround(pass, columns, surface, at.y), light);
  return light;
}

void spreadRow(const ColourPass& pass, int y, Fresh& fresh) {
  const Layout& layout = pass.pixels.layout;
  const Guides& guides = pass.pixels.guides;
  const auto block = float(pass.cells.block);
  const size_t row = layout.row(y);
  const float partY = (float(y) + 0.5f) / block - 0.5f - float(y / pass.cells.block);
  for (int x = 0; x < layout.width; x += width()) {
    const size_t i = row + size_t(x);
    const Columns columns(x, pass.cells.block);
    const Surface surface{load(guides.name.data() + i),
                          load(guides.nearness.data() + i),
                          meanOf(load(pass.reading.albedo, i)),
                          load(pass.reading.albedo, i),
                          columns.part + load(guides.offsetX.data() + i) * lanesOf(1 / block),
                          lanesOf(partY) + load(guides.offsetY.data() + i) * lanesOf(1 / block),
                          load(guides.normal, i)};
    const Around around = cellsAround(pass, columns, surface, y);
    const Pixels at{x, y, i};
    const Beside beside = besideOf(pass.pixels, i);
    const Lanes slope = around.slope * lanesOf(1 / block);
    const RecalledSurfaces recalled = recalledSurfaces(pass, beside, slope, at);
    keepShown(pass, recalled, beside, recalled.taps.found, slope, at, fresh);
    storeColour(spreadLight(pass, columns, surface, around, recalled, at, fresh), pass.reading, i,
                fresh);
  }
  continueBorder(layout, y, fresh.colour);
}

} // namespace HWY_NAMESPACE
} // namespace picture::live
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace picture::live {
HWY_EXPORT(spreadRow);
void spreadRow(const ColourPass& pass, int y, Fresh& fresh) {
  HWY_DYNAMIC_DISPATCH(spreadRow)(pass, y, fresh);
}
} // namespace picture::live
#endif

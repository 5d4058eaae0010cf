// shown-inl.h: Finds what was shown of this frame's surfaces in the frame before.

#if defined(PICTURE_LIVE_SHOWN_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PICTURE_LIVE_SHOWN_INL_H
#undef PICTURE_LIVE_SHOWN_INL_H
#else
#define PICTURE_LIVE_SHOWN_INL_H
#endif

#include <algorithm>
#include <cmath>

#include "libpicture/live/lanes-inl.h"
#include "libpicture/live/stages.h"

HWY_BEFORE_NAMESPACE();
namespace picture::live {
namespace HWY_NAMESPACE {

// A neighbour that is nearer by this fraction is another surface.
constexpr float nearer = 0.05f;

// Where pixels were in the frame before, in its pixels.
struct Past {
  Lanes x, y;
};

// At the edge of something in front, its motion counts for the pixels beside it, too: the colours
// of an edge move with what is in front.
inline Past pastOf(const Moment& before, const Moment& now, const Reading& reading, size_t i) {
  const Guides& guides = now.guides;
  const auto stride = ptrdiff_t(now.layout.stride);
  const float ratioX = float(before.layout.width) / float(now.layout.width),
              ratioY = float(before.layout.height) / float(now.layout.height);
  const Lanes own = load(guides.nearness.data() + i);
  const Mask some = load(guides.name.data() + i) >= lanesOf(0);
  Lanes nearest = own + lanesOf(nearer) * (now.projection.parallel ? lanesOf(1) : own);
  Past past{load(reading.pastX.data() + i), load(reading.pastY.data() + i)};
  for (ptrdiff_t dy = -1; dy <= 1; dy++)
    for (ptrdiff_t dx = -1; dx <= 1; dx++) {
      const size_t j = i + size_t(dy * stride + dx);
      const Lanes other = load(guides.nearness.data() + j);
      const Mask front =
          hn::And(hn::And(some, load(guides.name.data() + j) >= lanesOf(0)), other > nearest);
      nearest = select(front, other, nearest);
      past.x = select(front, load(reading.pastX.data() + j) - lanesOf(float(dx) * ratioX), past.x);
      past.y = select(front, load(reading.pastY.data() + j) - lanesOf(float(dy) * ratioY), past.y);
    }
  return past;
}

// Weights of four pixels in a row for a place `part` behind the second (E. Catmull, R. Rom, "A
// Class of Local Interpolating Splines", 1974): sharper than a linear weight.
inline void splineWeights(float part, float weight[4]) {
  const float p2 = part * part, p3 = p2 * part;
  weight[0] = 0.5f * (-p3 + 2 * p2 - part);
  weight[1] = 0.5f * (3 * p3 - 5 * p2 + 2);
  weight[2] = 0.5f * (-3 * p3 + 4 * p2 + part);
  weight[3] = 0.5f * (p3 - p2);
}

// Writes the four numbers of what was shown at a place between pixels; the last one is that of the
// nearest pixel. Outside of the picture its border continues.
inline void shownAt(const Layout& layout, const float* shown, float x, float y, float out[4]) {
  const int left = int(std::floor(x)), top = int(std::floor(y));
  const float partX = x - float(left), partY = y - float(top);
  const auto column = [&](int at) { return size_t(std::clamp(at, 0, layout.width - 1)); };
  const auto row = [&](int at) {
    return shown + 4 * layout.row(std::clamp(at, 0, layout.height - 1));
  };
  if (partX == 0 && partY == 0) {
    std::copy_n(row(top) + 4 * column(left), 4, out);
    return;
  }
  float alongX[4], alongY[4];
  splineWeights(partX, alongX);
  splineWeights(partY, alongY);
  const size_t columns[4] = {column(left - 1), column(left), column(left + 1), column(left + 2)};
  const hn::CappedTag<float, 4> tag;
  for (size_t k = 0; k < 4; k += hn::Lanes(tag)) {
    auto sum = hn::Zero(tag);
    for (int r = 0; r < 4; r++) {
      const float* line = row(top + r - 1) + k;
      auto across = hn::Zero(tag);
      for (int c = 0; c < 4; c++)
        across = hn::Add(across,
                         hn::Mul(hn::LoadU(tag, line + 4 * columns[c]), hn::Set(tag, alongX[c])));
      sum = hn::Add(sum, hn::Mul(across, hn::Set(tag, alongY[r])));
    }
    hn::StoreU(sum, tag, out + k);
  }
  out[3] = row(top + (partY >= 0.5f))[4 * columns[partX >= 0.5f ? 2 : 1] + 3];
}

// Holds what was shown of some pixels.
struct Recalled {
  Past past;
  Mask known; // the surface was to be seen
};

// Tells where pixels were. seen: their surfaces were found in the frame before.
inline Recalled recalledAt(const ColourPass& pass, Mask seen, int x, size_t i) {
  const Layout &layout = pass.pixels.layout, &old = pass.shown.layout;
  const Mask some = load(pass.pixels.guides.name.data() + i) >= lanesOf(0);
  const Past past = pastOf(pass.before, pass.pixels, pass.reading, i);
  const Mask inside =
      hn::And(hn::And(past.x > lanesOf(-0.5f), past.x < lanesOf(float(old.width) - 0.5f)),
              hn::And(past.y > lanesOf(-0.5f), past.y < lanesOf(float(old.height) - 0.5f)));
  // A surface that is seen for the first time has no colours yet. A pixel without a sample takes
  // what was there.
  return {past,
          hn::And(hn::And(inside, presentFrom(x, layout.width)), hn::Or(hn::Not(some), seen))};
}

// Returns numbers that were shown; 0 where nothing is known. `last` receives the fourth ones.
inline LaneVec shownNumbers(const Layout& layout, const std::vector<float>& shown,
                            const Recalled& recalled, Lanes& last) {
  float x[Layout::widest], y[Layout::widest], known[Layout::widest],
      numbers[4 * Layout::widest] = {};
  store(recalled.past.x, x);
  store(recalled.past.y, y);
  store(hn::IfThenElseZero(recalled.known, lanesOf(1)), known);
  for (int k = 0; k < width(); k++)
    if (known[k] > 0) shownAt(layout, shown.data(), x[k], y[k], numbers + 4 * k);
  LaneVec v;
  hn::LoadInterleaved4(LanesTag(), numbers, v.x, v.y, v.z, last);
  return v;
}

// Returns the fourth numbers alone: those of the nearest pixels.
inline Lanes lastNumbers(const Layout& layout, const std::vector<float>& shown,
                         const Recalled& recalled, float unknown) {
  float x[Layout::widest], y[Layout::widest], known[Layout::widest], numbers[Layout::widest];
  store(recalled.past.x, x);
  store(recalled.past.y, y);
  store(hn::IfThenElseZero(recalled.known, lanesOf(1)), known);
  for (int k = 0; k < width(); k++) {
    numbers[k] = unknown;
    if (!(known[k] > 0)) continue;
    const int column = std::clamp(int(std::floor(x[k] + 0.5f)), 0, layout.width - 1),
              line = std::clamp(int(std::floor(y[k] + 0.5f)), 0, layout.height - 1);
    numbers[k] = shown[4 * (layout.row(line) + size_t(column)) + 3];
  }
  return load(numbers);
}

// Returns where a pixel that rests was covered, or its neighbours were, by something in front that
// has moved away since, or by something that is gone: what was shown there is not its own colour.
inline Mask wasUncovered(const ColourPass& pass, const Recalled& recalled, int x, int y, size_t i) {
  const Mask none = lanesOf(1) < lanesOf(0);
  if (!(pass.before.layout == pass.pixels.layout)) return none;
  const Mask rests = hn::And(recalled.known, hn::And(recalled.past.x == countFrom(x),
                                                     recalled.past.y == lanesOf(float(y))));
  const Guides& old = pass.before.guides;
  const auto stride = ptrdiff_t(pass.before.layout.stride);
  const Lanes own = load(pass.pixels.guides.nearness.data() + i);
  const Lanes front = own + lanesOf(nearer) * (pass.pixels.projection.parallel ? lanesOf(1) : own);
  Mask covered = none;
  for (ptrdiff_t dy = -1; dy <= 1; dy++)
    for (ptrdiff_t dx = -1; dx <= 1; dx++) {
      const size_t j = i + size_t(dy * stride + dx);
      const Mask ahead =
          hn::And(load(old.name.data() + j) >= lanesOf(0), load(old.nearness.data() + j) > front);
      const Lanes moves = load(old.moves.data() + j);
      covered =
          hn::Or(covered, hn::Or(hn::And(ahead, moves > lanesOf(0)), moves >= lanesOf(isGone)));
    }
  return hn::And(rests, covered);
}

// Continues a row of colours by the widest range of showRow on both sides, the first and the last
// one upwards and downwards, too: beyond the border of the picture is nothing else to be seen.
inline void continueBorder(const Layout& layout, int y, Plane& colours) {
  constexpr ptrdiff_t reach = 2;
  const auto stride = ptrdiff_t(layout.stride), width = ptrdiff_t(layout.width);
  float* const row = colours.data() + layout.row(y);
  std::fill_n(row - reach, reach, row[0]);
  std::fill_n(row + width, reach, row[width - 1]);
  for (ptrdiff_t k = 1; k <= reach; k++) {
    if (y == 0) std::copy_n(row - reach, width + 2 * reach, row - reach - k * stride);
    if (y == layout.height - 1)
      std::copy_n(row - reach, width + 2 * reach, row - reach + k * stride);
  }
}
inline void continueBorder(const Layout& layout, int y, Plane3& colours) {
  for (Plane* plane : {&colours.x, &colours.y, &colours.z}) continueBorder(layout, y, *plane);
}

// Keeps for showRow what was shown.
inline void keepShown(const ColourPass& pass, Recalled recalled, int x, int y, size_t i,
                      Fresh& fresh) {
  const Lanes nowhere = lanesOf(std::numeric_limits<float>::quiet_NaN());
  recalled.known = hn::AndNot(wasUncovered(pass, recalled, x, y, i), recalled.known);
  Lanes frames;
  store(shownNumbers(pass.shown.layout, pass.shown.colour, recalled, frames), fresh.oldColour, i);
  store(frames, fresh.oldFrames.data() + i);
  store(select(recalled.known, recalled.past.x, nowhere), fresh.pastX.data() + i);
  store(select(recalled.known, recalled.past.y, nowhere), fresh.pastY.data() + i);
}

// Returns the illumination that would bring as much light as coats reflect.
inline LaneVec asIllumination(const LaneVec& reflection, const LaneVec& albedo) {
  const LaneVec radiance = colourOf(reflection);
  return lumaOf({radiance.x / albedo.x, radiance.y / albedo.y, radiance.z / albedo.z});
}

// Multiplies illumination by albedo again.
inline void storeColour(const LaneVec& light, const Reading& reading, size_t i, Fresh& fresh) {
  const LaneVec rgb = colourOf(light) * load(reading.albedo, i);
  const Lanes zero = lanesOf(0);
  store(LaneVec{max(rgb.x, zero), max(rgb.y, zero), max(rgb.z, zero)}, fresh.colour, i);
  store(light, fresh.light, i);
}

} // namespace HWY_NAMESPACE
} // namespace picture::live
HWY_AFTER_NAMESPACE();

#endif

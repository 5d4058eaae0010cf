// shown-inl.h: Finds what the frame before has shown of the surfaces of a frame's pixels.

#if defined(PICTURE_LIVE_SHOWN_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PICTURE_LIVE_SHOWN_INL_H
#undef PICTURE_LIVE_SHOWN_INL_H
#else
#define PICTURE_LIVE_SHOWN_INL_H
#endif

#include <algorithm>
#include <cmath>

#include "libpicture/live/past-inl.h"
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

// Surfaces of other depths among the 3 x 3 pixels around a pixel: where the nearest one in front of
// it lies in planes, counted from the pixel, and the farthest one behind it; 0: there is none.
struct Beside {
  Lanes front, behind;
};

inline Beside besideOf(const Moment& now, size_t i) {
  const Guides& guides = now.guides;
  const auto stride = ptrdiff_t(now.layout.stride);
  const Lanes own = load(guides.nearness.data() + i), zero = lanesOf(0);
  const Mask some = load(guides.name.data() + i) >= zero;
  const Lanes apart = lanesOf(nearer) * (now.projection.parallel ? lanesOf(1) : own);
  Lanes nearest = own + apart, farthest = own - apart;
  Beside beside{zero, zero};
  for (ptrdiff_t dy = -1; dy <= 1; dy++)
    for (ptrdiff_t dx = -1; dx <= 1; dx++) {
      const ptrdiff_t away = dy * stride + dx;
      const size_t j = i + size_t(away);
      const Lanes other = load(guides.nearness.data() + j);
      const Mask exists = hn::And(some, load(guides.name.data() + j) >= zero);
      const Mask before = hn::And(exists, other > nearest),
                 after = hn::And(exists, other < farthest);
      nearest = select(before, other, nearest);
      farthest = select(after, other, farthest);
      beside.front = select(before, lanesOf(float(away)), beside.front);
      beside.behind = select(after, lanesOf(float(away)), beside.behind);
    }
  return beside;
}

inline Indices indicesFrom(size_t i) { return hn::Iota(IndicesTag(), int32_t(i)); }
inline Indices indicesFrom(size_t i, Lanes away) {
  return indicesFrom(i) + hn::ConvertTo(IndicesTag(), away);
}

// At the edge of something in front, its motion counts for the pixels beside it, too: the colours
// of an edge move with what is in front.
inline Past pastOf(const Moment& before, const Moment& now, const Reading& reading,
                   const Beside& beside, int x, int y, size_t i) {
  const Layout &layout = now.layout, &old = before.layout;
  const Resampling alongX(layout.width, std::max(1, old.width)),
      alongY(layout.height, std::max(1, old.height));
  const Indices at = indicesFrom(i, beside.front);
  return {countFrom(x) * lanesOf(alongX.ratio) + lanesOf(alongX.shift) +
              gather(reading.moveX.data(), at) * lanesOf(float(old.width)),
          lanesOf(alongY(float(y))) +
              gather(reading.moveY.data(), at) * lanesOf(float(old.height))};
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

// Pixels of a row from x on, i being the place of the first one in planes.
struct Pixels {
  int x, y;
  size_t i;
};

// Holds where some pixels were.
struct Recalled {
  Past past;
  Mask known; // the surface was to be seen
};

// Tells which places lie in a picture.
inline Mask isInside(const Layout& layout, const Past& past) {
  return hn::And(hn::And(past.x > lanesOf(-0.5f), past.x < lanesOf(float(layout.width) - 0.5f)),
                 hn::And(past.y > lanesOf(-0.5f), past.y < lanesOf(float(layout.height) - 0.5f)));
}

// Tells where pixels were. seen: their surfaces were found in the frame before.
inline Recalled recalledAt(const ColourPass& pass, const Beside& beside, Mask seen, int x, int y,
                           size_t i) {
  const Mask some = load(pass.pixels.guides.name.data() + i) >= lanesOf(0);
  const Past past = pastOf(pass.before, pass.pixels, pass.reading, beside, x, y, i);
  // A surface that is seen for the first time has no colours yet. A pixel without a sample takes
  // what was there.
  return {past, hn::And(hn::And(isInside(pass.shownLight.layout, past),
                                presentFrom(x, pass.pixels.layout.width)),
                        hn::Or(hn::Not(some), seen))};
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

// Keeps for the stages at full size whether surfaces were seen, and what was shown where their
// samples lie. found: they were found themselves, and not those around them. slope: change of
// nearness from pixel to pixel.
inline void keepShown(const ColourPass& pass, const Recalled& recalled, const Beside& beside,
                      Mask found, Lanes slope, const Pixels& at, Fresh& fresh) {
  const Layout &now = pass.showing, &old = pass.shown.layout;
  const Lanes zero = lanesOf(0), one = lanesOf(1);
  const size_t i = at.i;
  store(beside.front, fresh.front.data() + i);
  store(beside.behind, fresh.behind.data() + i);
  store(expectedAt(pass.pixels, pass.before, pass.reading, slope, i).tolerance,
        fresh.tolerance.data() + i);
  const Mask some = load(pass.pixels.guides.name.data() + i) >= zero;
  const Lanes how = select(hn::And(some, found), lanesOf(Fresh::seen), lanesOf(Fresh::seenAround));
  store(select(recalled.known, how, lanesOf(Fresh::unseen)), fresh.trust.data() + i);

  const Resampling alongX(now.width, old.width), alongY(now.height, old.height);
  const Lanes hitX = load(pass.reading.hitX.data() + i), hitY = load(pass.reading.hitY.data() + i);
  const Indices mover = indicesFrom(i, beside.front);
  const Past past{hitX * lanesOf(alongX.ratio) + lanesOf(alongX.shift) +
                      gather(pass.reading.moveX.data(), mover) * lanesOf(float(old.width)),
                  hitY * lanesOf(alongY.ratio) + lanesOf(alongY.shift) +
                      gather(pass.reading.moveY.data(), mover) * lanesOf(float(old.height))};
  const Mask known = hn::And(hn::And(recalled.known, hitX >= zero), isInside(old, past));
  Lanes frames;
  store(shownNumbers(old, pass.shown.colour, {past, known}, frames), fresh.oldColour, i);
  store(frames, fresh.oldFrames.data() + i);
  const Mask same = old == now ? zero < one : one < zero;
  const Mask stays = hn::And(hn::And(known, same), hn::And(past.x == hitX, past.y == hitY));
  store(hn::IfThenElseZero(stays, one), fresh.rests.data() + i);
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

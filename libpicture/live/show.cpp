// show.cpp: Turns illumination into colours again, and finds which colours the pixels around allow
// what was shown to have, so that it cannot show what is gone.
#include "libpicture/live/stages.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libpicture/live/show.cpp"
#include <hwy/foreach_target.h>

#include "libpicture/live/shown-inl.h"

HWY_BEFORE_NAMESPACE();
namespace picture::live {
namespace HWY_NAMESPACE {

// Returns where the surface was seen in the frame before, or those of most pixels around it: thin
// things are met by few samples, and what was hidden appears in larger parts.
inline Mask wasSeen(const Plane& frames, size_t i, ptrdiff_t stride) {
  Lanes seen = lanesOf(0);
  for (ptrdiff_t dy = -1; dy <= 1; dy++)
    for (ptrdiff_t dx = -1; dx <= 1; dx++)
      seen =
          seen + hn::IfThenElseZero(load(frames.data() + i + size_t(dy * stride + dx)) > lanesOf(1),
                                    lanesOf(1));
  return hn::Or(load(frames.data() + i) > lanesOf(1), seen >= lanesOf(5));
}

void colourRow(const ColourPass& pass, int y, Fresh& fresh) {
  const Layout& layout = pass.pixels.layout;
  const Guides& guides = pass.pixels.guides;
  const size_t row = layout.row(y);
  for (int x = 0; x < layout.width; x += width()) {
    const size_t i = row + size_t(x);
    LaneVec light = load(pass.light, i);
    if (pass.reflection)
      light = light + asIllumination(load(*pass.reflection, i), load(pass.reading.albedo, i));
    storeColour(light, pass.reading, i, fresh);
    const Plane& frames = pass.cells.accumulated.frames;
    const Mask seen = wasSeen(frames, i, ptrdiff_t(layout.stride)),
               found = load(frames.data() + i) > lanesOf(1);
    store(load(pass.cells.accumulated.noise.data() + i), fresh.noise.data() + i);
    store(lanesOf(ShownLight::noSample), fresh.sample.data() + i);
    const Beside beside = besideOf(pass.pixels, i);
    const Lanes slope = abs(load(guides.slopeX.data() + i)) + abs(load(guides.slopeY.data() + i));
    keepShown(pass, recalledAt(pass, beside, seen, x, y, i), beside, found, slope, {x, y, i},
              fresh);
  }
  continueBorder(layout, y, fresh.colour);
}

// The colours that the pixels around allow.
struct Range {
  Lanes low, high;
};

// In motion, 3 x 3 pixels bound the colours, the closer the more they are alike.
inline Range rangeInMotion(const float* middle, ptrdiff_t stride) {
  Lanes least = load(middle), most = least, sum = lanesOf(0), squares = lanesOf(0);
  for (ptrdiff_t dy = -1; dy <= 1; dy++)
    for (ptrdiff_t dx = -1; dx <= 1; dx++) {
      const Lanes v = load(middle + dy * stride + dx);
      least = min(least, v);
      most = max(most, v);
      sum = sum + v;
      squares = squares + v * v;
    }
  const Lanes mean = sum * lanesOf(1.0f / 9);
  const Lanes spread = hn::Sqrt(max(squares * lanesOf(1.0f / 9) - mean * mean, lanesOf(0)));
  return {max(least, mean - spread), min(most, mean + spread)};
}

// At rest, a pixel may keep what it showed in other frames, though its neighbours happen not to
// show it now: 5 x 5 pixels, and half of their range more.
inline Range rangeAtRest(const float* middle, ptrdiff_t stride) {
  Lanes least = load(middle), most = least;
  for (ptrdiff_t dy = -2; dy <= 2; dy++)
    for (ptrdiff_t dx = -2; dx <= 2; dx++) {
      const Lanes v = load(middle + dy * stride + dx);
      least = min(least, v);
      most = max(most, v);
    }
  const Lanes more = lanesOf(0.5f) * (most - least);
  return {least - more, most + more};
}

inline Range rangeAround(const Plane& colour, size_t i, ptrdiff_t stride, Mask rests) {
  const float* middle = colour.data() + i;
  if (hn::AllTrue(LanesTag(), rests)) return rangeAtRest(middle, stride);
  const Range moving = rangeInMotion(middle, stride);
  if (hn::AllFalse(LanesTag(), rests)) return moving;
  const Range resting = rangeAtRest(middle, stride);
  return {select(rests, resting.low, moving.low), select(rests, resting.high, moving.high)};
}

// At rest the samples of an edge or a texture differ from what was shown in both directions. Where
// they agree, as behind a shadow or in a texture that changes, what was shown is out of date.
// Returns the part of its samples that still counts: with independent differences d around a pixel,
// the square of their sum is as large as the sum of their squares, and `agreeing` times it one time
// in seventy.
inline Lanes stillValid(const Fresh& fresh, size_t i, ptrdiff_t stride) {
  constexpr float agreeing = 6;
  LaneVec sum{lanesOf(0), lanesOf(0), lanesOf(0)};
  Lanes squares = lanesOf(0);
  for (ptrdiff_t dy = -2; dy <= 2; dy++)
    for (ptrdiff_t dx = -2; dx <= 2; dx++) {
      const size_t j = i + size_t(dy * stride + dx);
      const Mask known = load(fresh.oldFrames.data() + j) > lanesOf(0);
      const LaneVec difference = load(fresh.colour, j) - load(fresh.oldColour, j);
      const LaneVec d{hn::IfThenElseZero(known, difference.x),
                      hn::IfThenElseZero(known, difference.y),
                      hn::IfThenElseZero(known, difference.z)};
      sum = sum + d;
      squares = squares + dot(d, d);
    }
  const Lanes whole = dot(sum, sum), most = lanesOf(agreeing) * squares;
  const Lanes part = most / max(whole, lanesOf(1e-30f));
  return select(whole > most, part * part, lanesOf(1));
}

void boundColourRow(const Layout& layout, int y, const Fresh& fresh, Bounds& bounds,
                    ShownLight& shown) {
  const size_t row = layout.row(y);
  const auto stride = ptrdiff_t(layout.stride);
  const Lanes zero = lanesOf(0), one = lanesOf(1);
  for (int x = 0; x < layout.width; x += width()) {
    const size_t i = row + size_t(x);
    // Where light is sampled, what was shown is filtered light, and may lag behind it.
    const Mask quiet =
        hn::And(load(fresh.rests.data() + i) > zero, load(fresh.noise.data() + i) <= zero);
    Lanes valid = one;
    if (!hn::AllFalse(LanesTag(), quiet)) valid = select(quiet, stillValid(fresh, i, stride), one);
    const Mask forgotten = load(fresh.trust.data() + i) >= lanesOf(Fresh::forgotten);
    store(hn::IfThenElseZero(hn::Not(forgotten), valid), bounds.valid.data() + i);
    const Range red = rangeAround(fresh.colour.x, i, stride, quiet),
                green = rangeAround(fresh.colour.y, i, stride, quiet),
                blue = rangeAround(fresh.colour.z, i, stride, quiet);
    store(LaneVec{red.low, green.low, blue.low}, bounds.low, i);
    store(LaneVec{red.high, green.high, blue.high}, bounds.high, i);

    const LaneVec light = load(fresh.light, i);
    hn::StoreInterleaved4(light.x, light.y, light.z, load(fresh.sample.data() + i), LanesTag(),
                          shown.light.data() + 4 * i);
  }
}

} // namespace HWY_NAMESPACE
} // namespace picture::live
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace picture::live {
HWY_EXPORT(colourRow);
HWY_EXPORT(boundColourRow);
void colourRow(const ColourPass& pass, int y, Fresh& fresh) {
  HWY_DYNAMIC_DISPATCH(colourRow)(pass, y, fresh);
}
void boundColourRow(const Layout& layout, int y, const Fresh& fresh, Bounds& bounds,
                    ShownLight& shown) {
  HWY_DYNAMIC_DISPATCH(boundColourRow)(layout, y, fresh, bounds, shown);
}
} // namespace picture::live
#endif

// show.cpp: Turns illumination into colours again and accumulates the colours over time. Samples
// lie at random places in their pixels, so the mean over the frames smooths edges and textures, as
// more samples in one frame would. The accumulated colour is bounded by the colours around the
// pixel now, so that it cannot show what is gone.
#include "libpicture/live/stages.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libpicture/live/show.cpp"
#include <hwy/foreach_target.h>

#include "libpicture/live/shown-inl.h"

HWY_BEFORE_NAMESPACE();
namespace picture::live {
namespace HWY_NAMESPACE {

// Frames that are accumulated: where nothing moves; where nothing moves but light is sampled, which
// may change; and elsewhere, where each frame blurs a little what was accumulated.
constexpr float framesAtRest = 256, framesSampled = 16, framesMoving = 4;

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
  const size_t row = layout.row(y);
  for (int x = 0; x < layout.width; x += width()) {
    const size_t i = row + size_t(x);
    LaneVec light = load(pass.light, i);
    if (pass.reflection)
      light = light + asIllumination(load(*pass.reflection, i), load(pass.reading.albedo, i));
    storeColour(light, pass.reading, i, fresh);
    const Mask seen = wasSeen(pass.cells.accumulated.frames, i, ptrdiff_t(layout.stride));
    store(load(pass.cells.accumulated.noise.data() + i), fresh.noise.data() + i);
    store(lanesOf(Shown::noSample), fresh.sample.data() + i);
    keepShown(pass, recalledAt(pass, seen, x, i), x, y, i, fresh);
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
// Returns the part of its frames that still counts: with independent differences d around a pixel,
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

inline Lanes mixed(Lanes old, Lanes fresh, const Range& range, Lanes part) {
  const Lanes kept = clamp(old, range.low, range.high);
  return max(select(part < lanesOf(1), kept + (fresh - kept) * part, fresh), lanesOf(0));
}

void showRow(const FramePlanes& frame, int y, const Layout& before, const Moment& now,
             const Fresh& fresh, Shown& shown, float* rgba) {
  const Layout& layout = now.layout;
  const size_t row = layout.row(y), first = size_t(y) * size_t(layout.width);
  const auto stride = ptrdiff_t(layout.stride);
  const Lanes half = lanesOf(0.5f), one = lanesOf(1), zero = lanesOf(0);
  const Mask same = before == layout ? half < one : one < half;
  for (int x = 0; x < layout.width; x += width()) {
    const size_t i = row + size_t(x);
    const Mask some = load(now.guides.name.data() + i) >= zero;
    const LaneVec old = load(fresh.oldColour, i);
    Lanes oldFrames = load(fresh.oldFrames.data() + i);
    const Mask rests = hn::And(same, hn::And(load(fresh.pastX.data() + i) == countFrom(x),
                                             load(fresh.pastY.data() + i) == lanesOf(float(y))));
    // Where light is sampled, what was shown is filtered light, and may lag behind it.
    const Mask quiet = hn::And(rests, load(fresh.noise.data() + i) <= zero);
    if (!hn::AllFalse(LanesTag(), quiet))
      oldFrames = oldFrames * select(quiet, stillValid(fresh, i, stride), one);
    const Lanes most = select(quiet, lanesOf(framesAtRest),
                              select(rests, lanesOf(framesSampled), lanesOf(framesMoving)));
    const Lanes frames = min(oldFrames + one, most);
    const Lanes part = one / frames;
    const LaneVec own = load(fresh.colour, i), light = load(fresh.light, i);
    const Plane3& colours = fresh.colour;
    const LaneVec bounded{mixed(old.x, own.x, rangeAround(colours.x, i, stride, quiet), part),
                          mixed(old.y, own.y, rangeAround(colours.y, i, stride, quiet), part),
                          mixed(old.z, own.z, rangeAround(colours.z, i, stride, quiet), part)};
    const LaneVec kept{max(old.x, zero), max(old.y, zero), max(old.z, zero)};
    const LaneVec colour = select(some, bounded, kept);
    hn::StoreInterleaved4(colour.x, colour.y, colour.z, select(some, frames, min(oldFrames, one)),
                          LanesTag(), shown.colour.data() + 4 * i);
    hn::StoreInterleaved4(light.x, light.y, light.z, load(fresh.sample.data() + i), LanesTag(),
                          shown.light.data() + 4 * i);

    // Pixels without light of their own have no alpha of their own.
    const Mask lit = loadSome(frame.samples + first, x, layout.width) > zero;
    Lanes alpha;
    loadQuadruples(frame.rgba + 4 * first, x, layout.width, alpha);
    float out[4 * Layout::widest];
    hn::StoreInterleaved4(colour.x, colour.y, colour.z,
                          select(hn::And(lit, isFinite(alpha)), clamp(alpha, zero, one), one),
                          LanesTag(), out);
    std::copy_n(out, 4 * std::min(width(), layout.width - x), rgba + 4 * x);
  }
}

} // namespace HWY_NAMESPACE
} // namespace picture::live
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace picture::live {
HWY_EXPORT(colourRow);
HWY_EXPORT(showRow);
void colourRow(const ColourPass& pass, int y, Fresh& fresh) {
  HWY_DYNAMIC_DISPATCH(colourRow)(pass, y, fresh);
}
void showRow(const FramePlanes& frame, int y, const Layout& before, const Moment& now,
             const Fresh& fresh, Shown& shown, float* rgba) {
  HWY_DYNAMIC_DISPATCH(showRow)(frame, y, before, now, fresh, shown, rgba);
}
} // namespace picture::live
#endif

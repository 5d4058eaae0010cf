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
  Lanes seen = all(0);
  for (ptrdiff_t dy = -1; dy <= 1; dy++)
    for (ptrdiff_t dx = -1; dx <= 1; dx++)
      seen = seen + where(load(frames.data() + i + size_t(dy * stride + dx)) > all(1), all(1));
  return either(load(frames.data() + i) > all(1), seen >= all(5));
}

void colourRow(const ColourPass& pass, int y, Fresh& fresh) {
  const Layout& layout = pass.pixels.layout;
  const size_t row = layout.row(y);
  for (int x = 0; x < layout.width; x += width()) {
    const size_t i = row + size_t(x);
    Lanes3 light = load(pass.light, i);
    if (pass.reflection)
      light = light + asIllumination(load(*pass.reflection, i), load(pass.reading.albedo, i));
    storeColour(light, pass.reading, i, fresh);
    const Mask seen = wasSeen(pass.cells.accumulated.frames, i, ptrdiff_t(layout.stride));
    store(load(pass.cells.accumulated.noise.data() + i), fresh.noise.data() + i);
    store(all(Shown::noSample), fresh.sample.data() + i);
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
  Lanes least = load(middle), most = least, sum = all(0), squares = all(0);
  for (ptrdiff_t dy = -1; dy <= 1; dy++)
    for (ptrdiff_t dx = -1; dx <= 1; dx++) {
      const Lanes v = load(middle + dy * stride + dx);
      least = smaller(least, v);
      most = larger(most, v);
      sum = sum + v;
      squares = squares + v * v;
    }
  const Lanes mean = sum * all(1.0f / 9);
  const Lanes spread = hn::Sqrt(larger(squares * all(1.0f / 9) - mean * mean, all(0)));
  return {larger(least, mean - spread), smaller(most, mean + spread)};
}

// At rest, a pixel may keep what it showed in other frames, though its neighbours happen not to
// show it now: 5 x 5 pixels, and half of their range more.
inline Range rangeAtRest(const float* middle, ptrdiff_t stride) {
  Lanes least = load(middle), most = least;
  for (ptrdiff_t dy = -2; dy <= 2; dy++)
    for (ptrdiff_t dx = -2; dx <= 2; dx++) {
      const Lanes v = load(middle + dy * stride + dx);
      least = smaller(least, v);
      most = larger(most, v);
    }
  const Lanes more = all(0.5f) * (most - least);
  return {least - more, most + more};
}

inline Range rangeAround(const Plane& colour, size_t i, ptrdiff_t stride, Mask rests) {
  const float* middle = colour.data() + i;
  if (hn::AllTrue(Tag(), rests)) return rangeAtRest(middle, stride);
  const Range moving = rangeInMotion(middle, stride);
  if (hn::AllFalse(Tag(), rests)) return moving;
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
  Lanes3 sum{all(0), all(0), all(0)};
  Lanes squares = all(0);
  for (ptrdiff_t dy = -2; dy <= 2; dy++)
    for (ptrdiff_t dx = -2; dx <= 2; dx++) {
      const size_t j = i + size_t(dy * stride + dx);
      const Mask known = load(fresh.oldFrames.data() + j) > all(0);
      const Lanes3 difference = load(fresh.colour, j) - load(fresh.oldColour, j);
      const Lanes3 d{where(known, difference.x), where(known, difference.y),
                     where(known, difference.z)};
      sum = sum + d;
      squares = squares + dot(d, d);
    }
  const Lanes whole = dot(sum, sum), most = all(agreeing) * squares;
  const Lanes part = most / larger(whole, all(1e-30f));
  return select(whole > most, part * part, all(1));
}

inline Lanes mixed(Lanes old, Lanes fresh, const Range& range, Lanes part) {
  const Lanes kept = clamped(old, range.low, range.high);
  return larger(select(part < all(1), kept + (fresh - kept) * part, fresh), all(0));
}

void showRow(const FramePlanes& frame, int y, const Layout& before, const Moment& now,
             const Fresh& fresh, Shown& shown, float* rgba) {
  const Layout& layout = now.layout;
  const size_t row = layout.row(y), first = size_t(y) * size_t(layout.width);
  const auto stride = ptrdiff_t(layout.stride);
  const Lanes half = all(0.5f), one = all(1), zero = all(0);
  const Mask same = before == layout ? half < one : one < half;
  for (int x = 0; x < layout.width; x += width()) {
    const size_t i = row + size_t(x);
    const Mask some = load(now.guides.name.data() + i) >= zero;
    const Lanes3 old = load(fresh.oldColour, i);
    Lanes oldFrames = load(fresh.oldFrames.data() + i);
    const Mask rests = both(same, both(load(fresh.pastX.data() + i) == countFrom(x),
                                       load(fresh.pastY.data() + i) == all(float(y))));
    // Where light is sampled, what was shown is filtered light, and may lag behind it.
    const Mask quiet = both(rests, load(fresh.noise.data() + i) <= zero);
    if (!hn::AllFalse(Tag(), quiet))
      oldFrames = oldFrames * select(quiet, stillValid(fresh, i, stride), one);
    const Lanes most =
        select(quiet, all(framesAtRest), select(rests, all(framesSampled), all(framesMoving)));
    const Lanes frames = smaller(oldFrames + one, most);
    const Lanes part = one / frames;
    const Lanes3 own = load(fresh.colour, i), light = load(fresh.light, i);
    const Plane3& colours = fresh.colour;
    const Lanes3 bounded{mixed(old.x, own.x, rangeAround(colours.x, i, stride, quiet), part),
                         mixed(old.y, own.y, rangeAround(colours.y, i, stride, quiet), part),
                         mixed(old.z, own.z, rangeAround(colours.z, i, stride, quiet), part)};
    const Lanes3 kept{larger(old.x, zero), larger(old.y, zero), larger(old.z, zero)};
    const Lanes3 colour = select(some, bounded, kept);
    hn::StoreInterleaved4(colour.x, colour.y, colour.z,
                          select(some, frames, smaller(oldFrames, one)), Tag(),
                          shown.colour.data() + 4 * i);
    hn::StoreInterleaved4(light.x, light.y, light.z, load(fresh.sample.data() + i), Tag(),
                          shown.light.data() + 4 * i);

    // Pixels without light of their own have no alpha of their own.
    const Mask lit = loadSome(frame.samples + first, x, layout.width) > zero;
    Lanes alpha;
    loadQuadruples(frame.rgba + 4 * first, x, layout.width, alpha);
    float out[4 * Layout::widest];
    hn::StoreInterleaved4(colour.x, colour.y, colour.z,
                          select(both(lit, isFinite(alpha)), clamped(alpha, zero, one), one), Tag(),
                          out);
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

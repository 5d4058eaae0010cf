// show.cpp: Turns illumination into colours again and accumulates the colours over time. Samples
// lie at random places in their pixels, so the mean over the frames smooths edges and textures, as
// more samples in one frame would. What was accumulated is bounded by the colours around the pixel
// now, so that it cannot show what is gone.
#include <algorithm>
#include <cmath>

#include "libpicture/live/stages.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libpicture/live/show.cpp"
#include <hwy/foreach_target.h>

#include "libpicture/live/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace picture::live {
namespace HWY_NAMESPACE {

// Frames that are accumulated: where nothing moves; where nothing moves but light is sampled, which
// may change; and elsewhere, where each frame blurs a little what was accumulated.
constexpr float framesAtRest = 256, framesSampled = 16, framesMoving = 4;
// A neighbour that is nearer by this fraction is another surface.
constexpr float nearer = 0.05f;

void colourRow(const Plane3& light, int y, const Moment& now, Work& work) {
  const size_t row = now.layout.row(y);
  const Lanes zero = all(0);
  for (int x = 0; x < now.layout.width; x += width()) {
    const size_t i = row + size_t(x);
    const Lanes3 rgb = colourOf(load(light, i)) * load(work.albedo, i);
    store(Lanes3{larger(rgb.x, zero), larger(rgb.y, zero), larger(rgb.z, zero)}, work.colour, i);
  }
}

// Where pixels were in the frame before, in its pixels.
struct Past {
  Lanes x, y;
};

// At the edge of something in front, its motion counts for the pixels beside it, too: the colours
// of an edge move with what is in front.
inline Past pastOf(const Moment& before, const Moment& now, const Work& work, size_t i) {
  const Guides& guides = now.guides;
  const auto stride = ptrdiff_t(now.layout.stride);
  const float ratioX = float(before.layout.width) / float(now.layout.width),
              ratioY = float(before.layout.height) / float(now.layout.height);
  const Lanes own = load(guides.nearness.data() + i);
  const Mask some = load(guides.name.data() + i) >= all(0);
  Lanes nearest = own + all(nearer) * (now.projection.parallel ? all(1) : own);
  Past past{load(work.pastX.data() + i), load(work.pastY.data() + i)};
  for (ptrdiff_t dy = -1; dy <= 1; dy++)
    for (ptrdiff_t dx = -1; dx <= 1; dx++) {
      const size_t j = i + size_t(dy * stride + dx);
      const Lanes other = load(guides.nearness.data() + j);
      const Mask front = both(both(some, load(guides.name.data() + j) >= all(0)), other > nearest);
      nearest = select(front, other, nearest);
      past.x = select(front, load(work.pastX.data() + j) - all(float(dx) * ratioX), past.x);
      past.y = select(front, load(work.pastY.data() + j) - all(float(dy) * ratioY), past.y);
    }
  return past;
}

// Returns where the surface was seen in the frame before, or those of most pixels around it: thin
// things are met by few samples, and what was hidden appears in larger parts.
inline Mask wasSeen(const Plane& frames, size_t i, ptrdiff_t stride) {
  Lanes seen = all(0);
  for (ptrdiff_t dy = -1; dy <= 1; dy++)
    for (ptrdiff_t dx = -1; dx <= 1; dx++)
      seen = seen + where(load(frames.data() + i + size_t(dy * stride + dx)) > all(1), all(1));
  return either(load(frames.data() + i) > all(1), seen >= all(5));
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

// Weights of four pixels in a row for a place `part` behind the second (E. Catmull, R. Rom, "A
// Class of Local Interpolating Splines", 1974): sharper than a linear weight.
inline void splineWeights(float part, float weight[4]) {
  const float p2 = part * part, p3 = p2 * part;
  weight[0] = 0.5f * (-p3 + 2 * p2 - part);
  weight[1] = 0.5f * (3 * p3 - 5 * p2 + 2);
  weight[2] = 0.5f * (-3 * p3 + 4 * p2 + part);
  weight[3] = 0.5f * (p3 - p2);
}

// Writes the shown colour at a place between pixels, and its number of frames. Outside of the
// picture its border continues.
inline void shownAt(const Moment& before, float x, float y, float out[4]) {
  const Layout& layout = before.layout;
  const float* shown = before.accumulated.shown.data();
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
  float sum[4] = {};
  for (int r = 0; r < 4; r++) {
    const float* line = row(top + r - 1);
    float across[4] = {};
    for (int c = 0; c < 4; c++)
      for (int k = 0; k < 4; k++) across[k] += line[4 * columns[c] + size_t(k)] * alongX[c];
    for (int k = 0; k < 4; k++) sum[k] += across[k] * alongY[r];
  }
  std::copy_n(sum, 3, out);
  out[3] = row(top + (partY >= 0.5f))[4 * columns[partX >= 0.5f ? 2 : 1] + 3];
}

// The shown colours of the frame before, and their numbers of frames.
struct Shown {
  Lanes3 colour;
  Lanes frames;
};

inline Shown recallShown(const Moment& before, const Past& past, Mask known) {
  float x[Layout::widest], y[Layout::widest], valid[Layout::widest],
      colour[4 * Layout::widest] = {};
  store(past.x, x);
  store(past.y, y);
  store(where(known, all(1)), valid);
  for (int k = 0; k < width(); k++)
    if (valid[k] > 0) shownAt(before, x[k], y[k], colour + 4 * k);
  Shown old;
  hn::LoadInterleaved4(Tag(), colour, old.colour.x, old.colour.y, old.colour.z, old.frames);
  return old;
}

inline Lanes mixed(Lanes old, Lanes fresh, const Range& range, Lanes part) {
  const Lanes kept = clamped(old, range.low, range.high);
  return larger(select(part < all(1), kept + (fresh - kept) * part, fresh), all(0));
}

void showRow(const FramePlanes& frame, int y, const Moment& before, Moment& now, const Work& work,
             float* rgba) {
  const Layout &layout = now.layout, &old = before.layout;
  const size_t row = layout.row(y), first = size_t(y) * size_t(layout.width);
  const auto stride = ptrdiff_t(layout.stride);
  const Lanes half = all(0.5f), one = all(1);
  const Mask same = old == layout ? half < one : one < half;
  for (int x = 0; x < layout.width; x += width()) {
    const size_t i = row + size_t(x);
    const Mask some = load(now.guides.name.data() + i) >= all(0);
    const Past past = pastOf(before, now, work, i);
    const Mask inside = both(both(past.x > all(-0.5f), past.x < all(float(old.width) - 0.5f)),
                             both(past.y > all(-0.5f), past.y < all(float(old.height) - 0.5f)));
    // A pixel without a sample takes what was there.
    const Mask known = both(both(inside, present(x, layout.width)),
                            either(hn::Not(some), wasSeen(now.accumulated.frames, i, stride)));
    const Shown shown = recallShown(before, past, known);

    const Mask rests =
        both(both(known, same), both(past.x == countFrom(x), past.y == all(float(y))));
    // Where light is sampled, what was shown is filtered light, and may lag behind it.
    const Mask quiet = both(rests, load(now.accumulated.noise.data() + i) <= all(0));
    const Lanes most =
        select(quiet, all(framesAtRest), select(rests, all(framesSampled), all(framesMoving)));
    const Lanes frames = smaller(shown.frames + one, most);
    const Lanes part = one / frames;
    const Lanes3 fresh = load(work.colour, i);
    const Lanes3 bounded{
        mixed(shown.colour.x, fresh.x, rangeAround(work.colour.x, i, stride, quiet), part),
        mixed(shown.colour.y, fresh.y, rangeAround(work.colour.y, i, stride, quiet), part),
        mixed(shown.colour.z, fresh.z, rangeAround(work.colour.z, i, stride, quiet), part)};
    const Lanes zero = all(0);
    const Lanes3 kept{larger(shown.colour.x, zero), larger(shown.colour.y, zero),
                      larger(shown.colour.z, zero)};
    const Lanes3 colour = select(some, bounded, kept);
    hn::StoreInterleaved4(colour.x, colour.y, colour.z,
                          select(some, frames, smaller(shown.frames, one)), Tag(),
                          now.accumulated.shown.data() + 4 * i);

    Lanes alpha;
    loadQuadruples(frame.rgba + 4 * first, x, layout.width, alpha);
    float out[4 * Layout::widest];
    hn::StoreInterleaved4(colour.x, colour.y, colour.z,
                          select(both(some, isFinite(alpha)), clamped(alpha, zero, one), one),
                          Tag(), out);
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
void colourRow(const Plane3& light, int y, const Moment& now, Work& work) {
  HWY_DYNAMIC_DISPATCH(colourRow)(light, y, now, work);
}
void showRow(const FramePlanes& frame, int y, const Moment& before, Moment& now, const Work& work,
             float* rgba) {
  HWY_DYNAMIC_DISPATCH(showRow)(frame, y, before, now, work, rgba);
}
} // namespace picture::live
#endif

// past-inl.h: Finds the surfaces of this frame among the pixels or cells of the frame before.

#if defined(PICTURE_LIVE_PAST_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PICTURE_LIVE_PAST_INL_H
#undef PICTURE_LIVE_PAST_INL_H
#else
#define PICTURE_LIVE_PAST_INL_H
#endif

#include <algorithm>

#include "libpicture/live/lanes-inl.h"
#include "libpicture/live/stages.h"

HWY_BEFORE_NAMESPACE();
namespace picture::live {
namespace HWY_NAMESPACE {

// Up to four pixels of the frame before, and their weights, which sum up to 1 or are all 0.
struct Taps {
  Index index[4];
  Lanes weight[4];
  Mask found;

  Lanes of(const Plane& plane) const {
    Lanes sum = gather(plane.data(), index[0]) * weight[0];
    for (int k = 1; k < 4; k++) sum = sum + gather(plane.data(), index[k]) * weight[k];
    return sum;
  }
  Lanes3 of(const Plane3& planes) const { return {of(planes.x), of(planes.y), of(planes.z)}; }
};

// The surface of pixels of this frame, as it is expected in the frame before.
struct Expected {
  Lanes name, nearness, tolerance;
  Lanes3 normal;

  Mask matches(const Guides& guides, Index at) const {
    const Mask near = absolute(gather(guides.nearness.data(), at) - nearness) <= tolerance;
    const Mask same = gather(guides.name.data(), at) == name;
    return both(both(near, same), dot(gather(guides.normal, at), normal) > all(0.6f));
  }
};

// slope: change of nearness from pixel to pixel.
inline Expected expectedAt(const Moment& now, const Moment& before, const Reading& reading,
                           Lanes slope, size_t i) {
  const Guides& guides = now.guides;
  const Lanes nearness = load(reading.pastNearness.data() + i);
  const Lanes scale = before.projection.parallel ? all(1) : nearness;
  const float enlarged = float(now.layout.width) / float(std::max(1, before.layout.width));
  return {load(guides.name.data() + i), nearness,
          slope * all(1.5f * std::max(1.0f, enlarged)) + scale * all(0.01f),
          load(guides.normal, i)};
}

// Weights of the four pixels around (x, y), those of other surfaces left out.
inline Taps tapsAround(const Moment& before, const Expected& expected, Lanes x, Lanes y) {
  const Layout& layout = before.layout;
  const Mask inside = both(both(x > all(-1), x < all(float(layout.width))),
                           both(y > all(-1), y < all(float(layout.height))));
  const Lanes atX = where(inside, x), atY = where(inside, y);
  const Lanes left = hn::Floor(atX), top = hn::Floor(atY);
  const Lanes partX = atX - left, partY = atY - top;
  const IndexTag tag;
  const auto stride = int32_t(layout.stride);
  const Index corner =
      (hn::ConvertTo(tag, top) + hn::Set(tag, Layout::border)) * hn::Set(tag, stride) +
      hn::ConvertTo(tag, left) + hn::Set(tag, Layout::border);
  const Lanes acrossX[2] = {all(1) - partX, partX}, acrossY[2] = {all(1) - partY, partY};
  Taps taps;
  Lanes sum = all(0);
  for (int k = 0; k < 4; k++) {
    taps.index[k] = corner + hn::Set(tag, (k / 2) * stride + k % 2);
    const Mask valid = both(inside, expected.matches(before.guides, taps.index[k]));
    taps.weight[k] = where(valid, acrossX[k % 2] * acrossY[k / 2]);
    sum = sum + taps.weight[k];
  }
  taps.found = sum > all(0.01f);
  const Lanes per = where(taps.found, all(1) / sum);
  for (Lanes& weight : taps.weight) weight = weight * per;
  return taps;
}

// Gives pixels whose surface is in none of the four taps the nearest one that shows it, among the
// nine around (x, y): at edges the random place of the sample decides which surface a pixel shows.
inline void searchAround(const Moment& before, const Expected& expected, Lanes x, Lanes y,
                         Taps& taps) {
  const Layout& layout = before.layout;
  const Lanes half = all(0.5f);
  const Mask inside = both(both(x > all(-1), x < all(float(layout.width))),
                           both(y > all(-1), y < all(float(layout.height))));
  const Mask missing = hn::AndNot(taps.found, inside);
  if (hn::AllFalse(Tag(), missing)) return;
  const Lanes middleX = hn::Floor(where(missing, x) + half),
              middleY = hn::Floor(where(missing, y) + half);
  const IndexTag tag;
  const auto stride = int32_t(layout.stride);
  const Index middle =
      (hn::ConvertTo(tag, middleY) + hn::Set(tag, Layout::border)) * hn::Set(tag, stride) +
      hn::ConvertTo(tag, middleX) + hn::Set(tag, Layout::border);
  Lanes least = all(1e30f);
  Index best = middle;
  for (int dy = -1; dy <= 1; dy++)
    for (int dx = -1; dx <= 1; dx++) {
      const Index at = middle + hn::Set(tag, dy * stride + dx);
      const Lanes awayX = middleX + all(float(dx)) - x, awayY = middleY + all(float(dy)) - y;
      const Lanes distance = awayX * awayX + awayY * awayY;
      const Mask better =
          both(both(missing, expected.matches(before.guides, at)), distance < least);
      least = select(better, distance, least);
      best = hn::IfThenElse(hn::RebindMask(tag, better), at, best);
    }
  const Mask met = least < all(1e30f);
  taps.index[0] = hn::IfThenElse(hn::RebindMask(tag, met), best, taps.index[0]);
  taps.weight[0] = select(met, all(1), taps.weight[0]);
  taps.found = either(taps.found, met);
}

} // namespace HWY_NAMESPACE
} // namespace picture::live
HWY_AFTER_NAMESPACE();

#endif

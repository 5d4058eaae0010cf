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
  Indices index[4];
  Lanes weight[4];
  Mask found;

  Lanes of(const Plane& plane) const {
    Lanes sum = gather(plane.data(), index[0]) * weight[0];
    for (int k = 1; k < 4; k++) sum = sum + gather(plane.data(), index[k]) * weight[k];
    return sum;
  }
  LaneVec of(const Plane3& planes) const { return {of(planes.x), of(planes.y), of(planes.z)}; }
};

// The surface of pixels of this frame, as it is expected in the frame before.
struct Expected {
  Lanes name, nearness, tolerance;
  LaneVec normal;

  Mask matches(const Surfaces& guides, Indices at) const {
    const Mask near = abs(gather(guides.nearness.data(), at) - nearness) <= tolerance;
    const Mask same = gather(guides.name.data(), at) == name;
    return hn::And(hn::And(near, same), dot(gather(guides.normal, at), normal) > lanesOf(0.6f));
  }
};

// slope: change of nearness from pixel to pixel.
inline Expected expectedAt(const Moment& now, const Moment& before, const Reading& reading,
                           Lanes slope, size_t i) {
  const Guides& guides = now.guides;
  const Lanes nearness = load(reading.pastNearness.data() + i);
  const Lanes scale = before.projection.parallel ? lanesOf(1) : nearness;
  const float enlarged = float(now.layout.width) / float(std::max(1, before.layout.width));
  return {load(guides.name.data() + i), nearness,
          slope * lanesOf(1.5f * std::max(1.0f, enlarged)) + scale * lanesOf(0.01f),
          load(guides.normal, i)};
}

// Weights of the four pixels around (x, y), those of other surfaces left out.
inline Taps tapsAround(const Moment& before, const Expected& expected, Lanes x, Lanes y) {
  const Layout& layout = before.layout;
  const Mask inside = hn::And(hn::And(x > lanesOf(-1), x < lanesOf(float(layout.width))),
                              hn::And(y > lanesOf(-1), y < lanesOf(float(layout.height))));
  const Lanes atX = hn::IfThenElseZero(inside, x), atY = hn::IfThenElseZero(inside, y);
  const Lanes left = hn::Floor(atX), top = hn::Floor(atY);
  const Lanes partX = atX - left, partY = atY - top;
  const IndicesTag tag;
  const auto stride = int32_t(layout.stride);
  const Indices corner =
      (hn::ConvertTo(tag, top) + hn::Set(tag, Layout::border)) * hn::Set(tag, stride) +
      hn::ConvertTo(tag, left) + hn::Set(tag, Layout::border);
  const Lanes acrossX[2] = {lanesOf(1) - partX, partX}, acrossY[2] = {lanesOf(1) - partY, partY};
  Taps taps;
  Lanes sum = lanesOf(0);
  for (int k = 0; k < 4; k++) {
    taps.index[k] = corner + hn::Set(tag, (k / 2) * stride + k % 2);
    const Mask valid = hn::And(inside, expected.matches(before.guides, taps.index[k]));
    taps.weight[k] = hn::IfThenElseZero(valid, acrossX[k % 2] * acrossY[k / 2]);
    sum = sum + taps.weight[k];
  }
  taps.found = sum > lanesOf(0.01f);
  const Lanes per = hn::IfThenElseZero(taps.found, lanesOf(1) / sum);
  for (Lanes& weight : taps.weight) weight = weight * per;
  return taps;
}

// Gives pixels whose surface is in none of the four taps the nearest one that shows it, among the
// nine around (x, y): at edges the random place of the sample decides which surface a pixel shows.
inline void searchAround(const Moment& before, const Expected& expected, Lanes x, Lanes y,
                         Taps& taps) {
  const Layout& layout = before.layout;
  const Lanes half = lanesOf(0.5f);
  const Mask inside = hn::And(hn::And(x > lanesOf(-1), x < lanesOf(float(layout.width))),
                              hn::And(y > lanesOf(-1), y < lanesOf(float(layout.height))));
  const Mask missing = hn::AndNot(taps.found, inside);
  if (hn::AllFalse(LanesTag(), missing)) return;
  const Lanes middleX = hn::Floor(hn::IfThenElseZero(missing, x) + half),
              middleY = hn::Floor(hn::IfThenElseZero(missing, y) + half);
  const IndicesTag tag;
  const auto stride = int32_t(layout.stride);
  const Indices middle =
      (hn::ConvertTo(tag, middleY) + hn::Set(tag, Layout::border)) * hn::Set(tag, stride) +
      hn::ConvertTo(tag, middleX) + hn::Set(tag, Layout::border);
  Lanes least = lanesOf(1e30f);
  Indices best = middle;
  for (int dy = -1; dy <= 1; dy++)
    for (int dx = -1; dx <= 1; dx++) {
      const Indices at = middle + hn::Set(tag, dy * stride + dx);
      const Lanes awayX = middleX + lanesOf(float(dx)) - x,
                  awayY = middleY + lanesOf(float(dy)) - y;
      const Lanes distance = awayX * awayX + awayY * awayY;
      const Mask better =
          hn::And(hn::And(missing, expected.matches(before.guides, at)), distance < least);
      least = select(better, distance, least);
      best = hn::IfThenElse(hn::RebindMask(tag, better), at, best);
    }
  const Mask met = least < lanesOf(1e30f);
  taps.index[0] = hn::IfThenElse(hn::RebindMask(tag, met), best, taps.index[0]);
  taps.weight[0] = select(met, lanesOf(1), taps.weight[0]);
  taps.found = hn::Or(taps.found, met);
}

} // namespace HWY_NAMESPACE
} // namespace picture::live
HWY_AFTER_NAMESPACE();

#endif

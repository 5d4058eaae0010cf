// show.cpp: Accumulates the rebuilt colours over time. Samples lie at random places in their pixels,
// so the mean over the frames smooths edges and textures, as more samples in one frame would. What
// was accumulated is bounded by the colours around the pixel now, so that it cannot show what is
// gone.
#include <algorithm>
#include <cmath>

#include "libpicture/live/stages.h"

namespace picture::live {

namespace {

constexpr float framesAtRest = 256, framesMoving = 10;

struct Colour {
  float v[4] = {};
};

// The colours of 3 x 3 pixels.
struct Range {
  float least[3], most[3], mean[3], spread[3];
};

Range rangeAround(const Plane3& colour, size_t i, size_t stride) {
  Range range;
  const Plane* planes[3] = {&colour.x, &colour.y, &colour.z};
  for (int c = 0; c < 3; c++) {
    const float* middle = planes[c]->data() + i;
    float least = *middle, most = *middle, sum = 0, squares = 0;
    for (ptrdiff_t dy = -1; dy <= 1; dy++)
      for (ptrdiff_t dx = -1; dx <= 1; dx++) {
        const float v = middle[dy * ptrdiff_t(stride) + dx];
        least = std::min(least, v);
        most = std::max(most, v);
        sum += v;
        squares += v * v;
      }
    range.least[c] = least;
    range.most[c] = most;
    range.mean[c] = sum / 9;
    range.spread[c] = std::sqrt(std::max(0.0f, squares / 9 - range.mean[c] * range.mean[c]));
  }
  return range;
}

// Weights of four pixels in a row for a place `part` behind the second (E. Catmull, R. Rom, "A Class
// of Local Interpolating Splines", 1974): sharper than a linear weight, which would blur the picture
// a little more with each frame.
void splineWeights(float part, float weight[4]) {
  const float p2 = part * part, p3 = p2 * part;
  weight[0] = 0.5f * (-p3 + 2 * p2 - part);
  weight[1] = 0.5f * (3 * p3 - 5 * p2 + 2);
  weight[2] = 0.5f * (-3 * p3 + 4 * p2 + part);
  weight[3] = 0.5f * (p3 - p2);
}

// Returns the shown colour at a place between pixels. Outside of the picture its border continues.
Colour shownAt(const Moment& before, float x, float y) {
  const Layout& layout = before.layout;
  const float* shown = before.accumulated.shown.data();
  const int left = int(std::floor(x)), top = int(std::floor(y));
  const float partX = x - float(left), partY = y - float(top);
  const auto pixel = [&](int px, int py) {
    px = std::clamp(px, 0, layout.width - 1);
    py = std::clamp(py, 0, layout.height - 1);
    return shown + 4 * (layout.row(py) + size_t(px));
  };
  Colour result;
  if (partX == 0 && partY == 0) {
    std::copy_n(pixel(left, top), 4, result.v);
    return result;
  }
  float alongX[4], alongY[4];
  splineWeights(partX, alongX);
  splineWeights(partY, alongY);
  for (int r = 0; r < 4; r++)
    for (int c = 0; c < 4; c++) {
      const float* from = pixel(left + c - 1, top + r - 1);
      const float weight = alongX[c] * alongY[r];
      for (int k = 0; k < 4; k++) result.v[k] += from[k] * weight;
    }
  result.v[3] = pixel(left + (partX >= 0.5f), top + (partY >= 0.5f))[3];
  return result;
}

// Returns the nearest of 3 x 3 pixels: at the edge of something that moves, its motion counts.
size_t nearestAround(const Guides& guides, size_t i, size_t stride) {
  size_t nearest = i;
  for (ptrdiff_t dy = -1; dy <= 1; dy++)
    for (ptrdiff_t dx = -1; dx <= 1; dx++) {
      const size_t j = i + size_t(dy * ptrdiff_t(stride) + dx);
      if (guides.name[j] >= 0 && guides.nearness[j] > guides.nearness[nearest]) nearest = j;
    }
  return nearest;
}

} // namespace

void showRow(const FramePlanes& frame, int y, const Moment& before, Moment& now, Work& work,
             float* rgba) {
  const Layout& layout = now.layout;
  const size_t row = layout.row(y), first = size_t(y) * size_t(layout.width);
  for (int x = 0; x < layout.width; x++) {
    const size_t i = row + size_t(x);
    const bool some = now.guides.name[i] != emptyName;
    const size_t guide = some ? nearestAround(now.guides, i, layout.stride) : i;
    const auto guideX = float(int(guide - i + layout.stride + 1) % int(layout.stride) - 1);
    const float guideY = guide + 1 < i ? -1.0f : guide > i + 1 ? 1.0f : 0.0f;
    const float ratioX = float(before.layout.width) / float(layout.width),
                ratioY = float(before.layout.height) / float(layout.height);
    const float pastX = work.pastX[guide] - guideX * ratioX, pastY = work.pastY[guide] - guideY * ratioY;
    const bool known = pastX > -0.5f && pastX < float(before.layout.width) - 0.5f &&
                       pastY > -0.5f && pastY < float(before.layout.height) - 0.5f &&
                       (!some || now.accumulated.frames[i] > 1);
    float* shown = now.accumulated.shown.data() + 4 * i;
    const float fresh[3] = {work.colour.x[i], work.colour.y[i], work.colour.z[i]};
    Colour old;
    if (known) old = shownAt(before, pastX, pastY);
    if (!some) {
      for (int k = 0; k < 4; k++) shown[k] = std::max(0.0f, old.v[k]);
      shown[3] = std::min(shown[3], 1.0f);
    } else {
      const bool rests = known && pastX == float(x) && pastY == float(y) && before.layout == layout;
      const float frames = std::min(old.v[3] + 1, rests ? framesAtRest : framesMoving);
      const float part = 1 / frames;
      const Range range = rangeAround(work.colour, i, layout.stride);
      for (int k = 0; k < 3; k++) {
        float low, high;
        if (rests) {
          const float more = 0.5f * (range.most[k] - range.least[k]);
          low = range.least[k] - more;
          high = range.most[k] + more;
        } else {
          low = std::max(range.least[k], range.mean[k] - 1.5f * range.spread[k]);
          high = std::min(range.most[k], range.mean[k] + 1.5f * range.spread[k]);
        }
        const float bounded = std::clamp(old.v[k], low, high);
        shown[k] = std::max(0.0f, frames > 1 ? bounded + (fresh[k] - bounded) * part : fresh[k]);
      }
      shown[3] = frames;
    }
    float* out = rgba + 4 * (first + size_t(x)) - 4 * first;
    for (int k = 0; k < 3; k++) out[k] = shown[k];
    const float alpha = frame.rgba[4 * (first + size_t(x)) + 3];
    out[3] = some && std::isfinite(alpha) ? alpha : 1;
  }
}

} // namespace picture::live

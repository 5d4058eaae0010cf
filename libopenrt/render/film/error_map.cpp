#include "render/film/error_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/film/error.h"

namespace openrt {

// Returns the expected error of a constant pixel beside an edge, divided by the bound of that
// error. Most such pixels are exact. For an edge across pixels with 64 samples, the measured error
// is a tenth of the bound. The corner that no sample hits has an area of 1 / n, and a fraction
// sqrt(1 / n) of all edges cuts off so small a corner.
double expectedOfBound(double samples) { return std::min(1.0, .8 / std::sqrt(samples)); }

// Returns the range that contains 95 % of the values. Reorders the values.
static float middleRange(std::vector<float>& values) {
  const auto out = std::ptrdiff_t(double(values.size() - 1) * .025);
  const auto low = values.begin() + out, high = values.end() - 1 - out;
  std::nth_element(values.begin(), low, values.end());
  const float lowest = *low;
  std::nth_element(values.begin(), high, values.end());
  return *high - lowest;
}

float relativeError(double sum, const float colors[3]) {
  double all = darkest;
  for (int k = 0; k < 3; k++) all += std::fabs(colors[k]);
  const double relative = sum / all;
  return relative < 1 ? float(relative) : 1.0f;
}

ErrorMap::ErrorMap(uint32_t width, uint32_t height, Kind kind) : width_(width), height_(height) {
  const size_t pixels = size_t(width) * height;
  if (kind == Kind::none) return;
  relative_.assign(pixels, std::numeric_limits<float>::quiet_NaN());
  doubted_ = relative_;
  if (kind != Kind::doubts) noise_.resize(pixels);
  if (kind != Kind::summary) seen_.resize(pixels);
}

void ErrorMap::store(size_t pixel, const PixelError& e) {
  if (empty()) return;
  relative_[pixel] = e.trusted ? e.relative : -e.relative;
  if (!noise_.empty()) noise_[pixel] = e.noise;
  if (!seen_.empty()) seen_[pixel] = {{e.mean[0], e.mean[1], e.mean[2]}, e.samples, e.constant};
}

// Returns whether one of the eight neighbours differs.
bool ErrorMap::beside(uint32_t x, uint32_t y) const {
  const Seen& here = seen_[size_t(y) * width_ + x];
  for (uint32_t j = y - std::min(y, 1u); j <= std::min(y + 1, height_ - 1); j++)
    for (uint32_t i = x - std::min(x, 1u); i <= std::min(x + 1, width_ - 1); i++) {
      const Seen& there = seen_[size_t(j) * width_ + i];
      if (there.samples == 0) continue;
      if (!there.constant) return true;
      for (int k = 0; k < 3; k++)
        if (there.mean[k] != here.mean[k]) return true;
    }
  return false;
}

// Writes the range of the colours within two pixels, because the far side of an edge that cuts a
// corner of the pixel lies there.
void ErrorMap::range(uint32_t x, uint32_t y, float out[3]) const {
  float low[3], high[3];
  for (int k = 0; k < 3; k++) low[k] = high[k] = seen_[size_t(y) * width_ + x].mean[k];
  for (uint32_t j = y - std::min(y, 2u); j <= std::min(y + 2, height_ - 1); j++)
    for (uint32_t i = x - std::min(x, 2u); i <= std::min(x + 2, width_ - 1); i++) {
      const Seen& there = seen_[size_t(j) * width_ + i];
      if (there.samples == 0) continue;
      for (int k = 0; k < 3; k++) {
        low[k] = std::min(low[k], there.mean[k]);
        high[k] = std::max(high[k], there.mean[k]);
      }
    }
  for (int k = 0; k < 3; k++) out[k] = high[k] - low[k];
}

// Returns whether the colours that range() compares can be trusted.
bool ErrorMap::coloursKnown(uint32_t x, uint32_t y) const {
  for (uint32_t j = y - std::min(y, 2u); j <= std::min(y + 2, height_ - 1); j++)
    for (uint32_t i = x - std::min(x, 2u); i <= std::min(x + 2, width_ - 1); i++) {
      const size_t at = size_t(j) * width_ + i;
      if (seen_[at].samples > 0 && !seen_[at].constant && std::signbit(relative_[at])) return false;
    }
  return true;
}

void ErrorMap::doubtConstants(
    const std::function<void(size_t pixel, const float halfWidth[3], bool known)>& changed) {
  if (seen_.empty()) return;
  // At the border of the picture the far side of an edge may lie outside. It is then assumed to
  // have any colour in the range of 95 % of the pixels. The range excludes outliers: a pixel hit by
  // a bright path or a lamp says nothing about that side.
  bool uniform = true;
  std::vector<float> values;
  values.reserve(seen_.size());
  for (int k = 0; k < 3; k++) {
    values.clear();
    for (const Seen& s : seen_)
      if (s.samples > 0 && std::isfinite(s.mean[k])) values.push_back(s.mean[k]);
    if (values.empty()) continue;
    range_[k] = middleRange(values);
    uniform &= *std::min_element(values.begin(), values.end()) ==
               *std::max_element(values.begin(), values.end());
  }
  for (uint32_t y = 0; y < height_; y++)
    for (uint32_t x = 0; x < width_; x++) {
      const size_t pixel = size_t(y) * width_ + x;
      const Seen& here = seen_[pixel];
      if (!here.constant || !((border(x, y) && !uniform) || beside(x, y))) continue;
      float half[3];
      range(x, y, half);
      const double part = std::min(1.0, ruleOfThree / here.samples);
      double sum = 0, behind = 0;
      for (int k = 0; k < 3; k++) {
        behind += part * double(half[k]);
        half[k] = float(part * double(border(x, y) ? std::max(range_[k], half[k]) : half[k]));
        sum += double(half[k]);
      }
      const float edge = relativeError(behind, here.mean);
      doubted_[pixel] = relativeError(expectedOfBound(here.samples) * behind, here.mean);
      if (!noise_.empty())
        noise_[pixel].own = edge; // the pixel's error if it has an edge; used by picture_error.cpp
      const bool known = coloursKnown(x, y);
      relative_[pixel] =
          std::copysign(relativeError(sum, here.mean), known ? relative_[pixel] : -1.0f);
      changed(pixel, half, known);
    }
}

void ErrorMap::addMissing(const Tile& tile, double bound, double expected,
                          const std::function<void(size_t pixel)>& distrusted) {
  if (noise_.empty()) return;
  for (uint32_t y = tile.y0; y < tile.y1; y++)
    for (uint32_t x = tile.x0; x < tile.x1; x++) {
      const size_t pixel = size_t(y) * width_ + x;
      const PixelNoise& noise = noise_[pixel];
      if (!noise.finished) continue;
      if (expected > 0) missing_ += std::min(1.0, expected / double(noise.scale));
      if (!noise.random || !(bound > double(relative_[pixel]) * double(noise.scale))) continue;
      relative_[pixel] = -std::fabs(relative_[pixel]);
      distrusted(pixel);
    }
}

RTerrorStats ErrorMap::summary() const {
  RTerrorStats s{};
  std::vector<float> halves;
  halves.reserve(relative_.size());
  for (size_t i = 0; i < relative_.size(); i++) {
    if (std::isnan(relative_[i])) continue;
    const double h = std::fabs(relative_[i]);
    s.pixels++;
    s.trusted += std::signbit(relative_[i]) ? 0 : 1;
    s.halfWidth += h;
    halves.push_back(float(h));
  }
  if (s.pixels == 0) return s;
  const double n = double(s.pixels);
  s.halfWidth /= n;
  const PictureError whole = pictureError(width_, noise_, doubted_);
  s.mean = whole.mean;
  // The error lies between 0 and 1.
  s.meanInterval = std::min(std::hypot(whole.interval, missing_ / n), std::max(s.mean, 1 - s.mean));
  const auto at = halves.begin() + std::ptrdiff_t(double(halves.size() - 1) * 0.99);
  std::nth_element(halves.begin(), at, halves.end());
  s.p99 = *at;
  return s;
}

} // namespace openrt

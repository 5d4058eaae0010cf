#include "libpicture/live/fade.h"

#include <algorithm>
#include <cmath>

namespace picture::live {

namespace {

constexpr int blockEdge = 32; // pixels
// The noise is measured again when there are so many times the samples.
constexpr double moreSamples = 1.5;
// Noise with this standard deviation, in bytes, cannot be told on a screen.
constexpr double invisible = 2;

} // namespace

void Fade::begin(int width, int height) {
  *this = {};
  width_ = width;
  height_ = height;
  columns_ = size_t((width + blockEdge - 1) / blockEdge);
  rows_ = size_t((height + blockEdge - 1) / blockEdge);
  blocks_.resize(columns_ * rows_);
  acrossBlocks_ = neighbours(int(columns_), width);
  downBlocks_ = neighbours(int(rows_), height);
}

void Fade::learn(const std::vector<uint8_t>& below, const std::vector<uint8_t>& rgb, double samples,
                 double weight) {
  const bool begins = !isKnown_;
  const bool measures = earlierSamples_ > 0 && samples >= moreSamples * earlierSamples_;
  isKnown_ |= measures;
  for (size_t row = 0; row < rows_ && isKnown_; row++)
    for (size_t column = 0; column < columns_; column++) {
      const size_t left = column * blockEdge, top = row * blockEdge,
                   right = std::min(left + blockEdge, size_t(width_)),
                   bottom = std::min(top + blockEdge, size_t(height_));
      double change = 0, apart = 0;
      for (size_t y = top; y < bottom; y++)
        for (size_t i = 3 * (y * size_t(width_) + left), end = i + 3 * (right - left); i < end;
             i++) {
          const int d = int(rgb[i]) - int(below[i]), e = measures ? rgb[i] - earlier_[i] : 0;
          apart += d * d;
          change += e * e;
        }
      const double per = 1 / double(3 * (right - left) * (bottom - top));
      Block& block = blocks_[blockOf(column, row)];
      if (begins) block.limit = lastWeight_;
      if (measures) block.variance = change * per / (1 / earlierSamples_ - 1 / samples);
      const double noise = block.variance / samples, wrong = std::max(0.0, apart * per - noise);
      const double visible = std::max(0.0, noise - invisible * invisible);
      block.limit = std::max(block.limit, visible > 0 ? wrong / (wrong + visible) : 1);
    }
  lastWeight_ = weight;
  if (earlierSamples_ > 0 && !measures) return;
  earlier_ = rgb;
  earlierSamples_ = samples;
}

double Fade::limitAt(size_t column, size_t row) const {
  return isKnown_ ? blocks_[blockOf(column, row)].limit : 1;
}

Fade::Row::Row(const Fade& fade, int y) : fade_(fade), rows_(fade.downBlocks_[size_t(y)]) {}

double Fade::Row::operator()(int x) const {
  const Neighbours& columns = fade_.acrossBlocks_[size_t(x)];
  const auto across = [&](size_t row) {
    return fade_.limitAt(columns.first, row) * (1 - columns.weight) +
           fade_.limitAt(columns.second, row) * columns.weight;
  };
  return across(rows_.first) * (1 - rows_.weight) + across(rows_.second) * rows_.weight;
}

} // namespace picture::live

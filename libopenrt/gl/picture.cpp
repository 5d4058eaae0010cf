// picture.cpp: Adds samples, and encodes colours.
#include "gl/picture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gl/overlay.h"

namespace rtgl {

float encoded(float c) {
  return c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f;
}

float decoded(float c) {
  return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}

void Film::restart(int newWidth, int newHeight, bool isLinear,
                   std::shared_ptr<const Overlay> cover) {
  width = newWidth;
  height = newHeight;
  linear = isLinear;
  samples = 0;
  cover_ = std::move(cover);
  sum_.assign(size_t(4) * static_cast<size_t>(width) * static_cast<size_t>(height), 0.0);
}

void Film::add(const std::vector<float>& rgba, int count) {
  for (size_t i = 0; i < sum_.size(); i++) sum_[i] += static_cast<double>(rgba[i]) * count;
  samples += count;
}

float Film::shown(int x, int y, int c) const {
  const size_t at =
      4 * (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)) +
      static_cast<size_t>(c);
  const auto mean = static_cast<float>(sum_[at] / samples);
  const float seen = std::clamp(linear && c < 3 ? encoded(std::max(mean, 0.0f)) : mean, 0.0f, 1.0f);
  if (!cover_) return seen;
  const Color& over = cover_->at(x, y);
  return std::min(over[static_cast<size_t>(c)] + (1 - over[3]) * seen, 1.0f);
}

const unsigned char* Film::bytes() const {
  if (samples == 0) return nullptr;
  bytes_.clear();
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++)
      for (int c = 0; c < 3; c++)
        bytes_.push_back(static_cast<unsigned char>(255 * shown(x, y, c) + 0.5f));
  return bytes_.data();
}

} // namespace rtgl

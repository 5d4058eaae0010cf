// light_image.cpp: see light_image.h.
#include "render/light_image.h"

#include <algorithm>
#include <chrono>

namespace openrt {

bool LightImage::add(uint32_t number, const std::vector<float>& part, const std::atomic<bool>& cancelled) {
  std::unique_lock lock(mutex_);
  while (next_ != number) {
    if (cancelled) return false;
    turn_.wait_for(lock, std::chrono::milliseconds(20)); // who cancels does not know of those who wait
  }
  for (size_t i = 0; i < pixels_.size(); i++) // B. P. Welford, Technometrics 4(3), 1962
    for (int k = 0; k < 3; k++) {
      Pixel& p = pixels_[i];
      const double x = part[3 * i + size_t(k)], d = x - p.mean[k];
      p.mean[k] += d / (number + 1);
      p.squares[k] += d * (x - p.mean[k]);
    }
  next_++;
  lock.unlock();
  turn_.notify_all();
  return true;
}

double LightImage::variance(const Pixel& pixel, int k) const {
  return next_ > 1 ? pixel.squares[k] / (next_ * (next_ - 1.0)) : std::numeric_limits<double>::infinity();
}

LightImage::Around LightImage::around(size_t pixel) const {
  constexpr uint32_t reach = 2;
  const uint32_t x = uint32_t(pixel % width_), y = uint32_t(pixel / width_);
  Around out;
  for (int k = 0; k < 3; k++) {
    double mean = 0, variance = 0, count = 0;
    for (uint32_t j = y - std::min(y, reach); j <= std::min(y + reach, height_ - 1); j++)
      for (uint32_t i = x - std::min(x, reach); i <= std::min(x + reach, width_ - 1); i++) {
        const Pixel& p = pixels_[size_t(j) * width_ + i];
        mean += p.mean[k], variance += this->variance(p, k), count++;
      }
    out.variance[k] = std::max(variance / count, this->variance(pixels_[pixel], k));
    if (variance > 0) out.hits = std::min(out.hits, mean * mean / variance);
  }
  return out;
}

} // namespace openrt

// light_image.cpp: see light_image.h.
#include "render/light_image.h"

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

} // namespace openrt

#include "render/film/light_image.h"

#include <algorithm>

#include "render/path/light_stride.h"

namespace openrt {

uint32_t LightImage::partsOf(const edit::FrameSettingsT& frame) {
  constexpr uint32_t ofPreviews = 4;
  return lightStrideOf(frame) > 1 ? ofPreviews : parts;
}

LightImage::LightImage(uint32_t width, uint32_t height, uint32_t all, bool variance)
    : width_(width), height_(height), all_(all), waiting_(all) {
  const size_t pixels = size_t(width) * height;
  if (variance)
    pixels_.resize(pixels);
  else
    means_.resize(pixels);
}

void LightImage::add(uint32_t number, std::vector<float>&& part) {
  std::unique_lock turn(turn_);
  waiting_[number] = std::move(part);
  if (adding_) return; // another thread is adding parts and will find this one
  adding_ = true;
  for (uint32_t next; (next = added_) < all_ && !waiting_[next].empty();) {
    const std::vector<float> now = std::move(waiting_[next]);
    waiting_[next].clear();
    turn.unlock();
    addNow(now, next);
    turn.lock();
  }
  adding_ = false;
}

void LightImage::addNow(const std::vector<float>& part, double number) {
  std::unique_lock lock(sums_);
  for (size_t i = 0; i < means_.size(); i++)
    for (size_t k = 0; k < 3; k++) means_[i][k] += (part[3 * i + k] - means_[i][k]) / (number + 1);
  for (size_t i = 0; i < pixels_.size(); i++) // B. P. Welford, Technometrics 4(3), 1962
    for (int k = 0; k < 3; k++) {
      Pixel& p = pixels_[i];
      const double x = part[3 * i + size_t(k)], d = x - p.mean[k];
      p.mean[k] += d / (number + 1);
      p.squares[k] += d * (x - p.mean[k]);
    }
  added_.fetch_add(1, std::memory_order_release);
}

double LightImage::variance(const Pixel& pixel, int k) const {
  const double n = added_;
  return n > 1 ? pixel.squares[k] / (n * (n - 1)) : std::numeric_limits<double>::infinity();
}

// Returns the sums of a pixel. A pixel with few light paths has an unreliable variance (error.cpp):
// it uses the mean variance of the surrounding 5x5 pixels if that is larger. hits: effective number
// of equal paths in the window, for the colour with the fewest.
LightSums LightImage::at(uint32_t x, uint32_t y) const {
  constexpr uint32_t reach = 2;
  const Pixel& pixel = pixels_[size_t(y) * width_ + x];
  LightSums out;
  out.hits = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; k++) {
    double mean = 0, variance = 0, count = 0;
    for (uint32_t j = y - std::min(y, reach); j <= std::min(y + reach, height_ - 1); j++)
      for (uint32_t i = x - std::min(x, reach); i <= std::min(x + reach, width_ - 1); i++) {
        const Pixel& p = pixels_[size_t(j) * width_ + i];
        mean += p.mean[k];
        variance += this->variance(p, k);
        count++;
      }
    out.mean[k] = pixel.mean[k];
    out.variance[k] = std::max(variance / count, this->variance(pixel, k));
    if (variance > 0) out.hits = std::min(out.hits, mean * mean / variance);
  }
  return out;
}

void LightImage::read(const Tile& tile, std::vector<LightSums>& out) const {
  std::shared_lock lock(sums_);
  out.clear();
  for (uint32_t y = tile.y0; y < tile.y1; y++)
    for (uint32_t x = tile.x0; x < tile.x1; x++) {
      if (means_.empty()) {
        out.push_back(at(x, y));
        continue;
      }
      LightSums mean;
      std::copy_n(means_[size_t(y) * width_ + x].data(), 3, mean.mean);
      out.push_back(mean);
    }
}

} // namespace openrt

// light_image.h: the part of a picture that paths from lamps make. They may fall on any pixel, so
// the picture is made in a fixed number of parts, each a whole picture by one thread; their mean
// and its variance are kept. Parts are added in their order, those that come too early wait: the
// sums do not depend on threads. [any]
#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <mutex>
#include <shared_mutex>
#include <vector>

#include "render/film/film.h"

namespace openrt {

class LightImage {
 public:
  static constexpr uint32_t parts = 16; // of a frame
  LightImage(uint32_t width, uint32_t height, uint32_t all = parts)
      : width_(width), height_(height), all_(all), pixels_(size_t(width) * height), waiting_(all) {}
  // part: rgb by pixel; each number once.
  void add(uint32_t number, std::vector<float>&& part);
  uint32_t added() const { return added_.load(std::memory_order_acquire); }
  bool complete() const { return added() == all_; }
  // Of a tile, row by row, from the parts that are in; their variance is infinite if these are
  // fewer than two.
  void look(const Tile& tile, std::vector<LightSums>& out) const;

 private:
  struct Pixel {
    double mean[3] = {}, squares[3] = {}; // squares: sum of squared differences from the mean
  };
  void addNow(const std::vector<float>& part, double number);
  double variance(const Pixel& pixel, int k) const;
  LightSums at(uint32_t x, uint32_t y) const;

  uint32_t width_, height_, all_;
  mutable std::shared_mutex sums_; // pixels_, and added_ for those who look
  std::vector<Pixel> pixels_;
  std::atomic<uint32_t> added_{0};
  std::mutex turn_; // waiting_, adding_
  std::vector<std::vector<float>> waiting_;
  bool adding_ = false;
};

} // namespace openrt

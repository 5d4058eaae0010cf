// light_image.h: the part of a picture that paths from lamps make. They may fall on any pixel, so the picture is made in a fixed
// number of parts, each a whole picture by one thread; their mean and its variance are kept. Parts are added in their order: the
// sums do not depend on threads.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <limits>
#include <mutex>
#include <vector>

namespace openrt {

class LightImage {
 public:
  static constexpr uint32_t parts = 16;
  LightImage(uint32_t width, uint32_t height) : width_(width), height_(height), pixels_(size_t(width) * height) {}
  // part: rgb by pixel; waits until the parts before it are in. False if cancelled before. [render]
  bool add(uint32_t number, const std::vector<float>& part, const std::atomic<bool>& cancelled);

  // While no part is being added. Of the parts that are in.
  struct Pixel {
    double mean[3] = {}, squares[3] = {}; // squares: sum of squared differences from the mean
  };
  const Pixel& at(size_t pixel) const { return pixels_[pixel]; }
  // Of a pixel's mean and of what the 5x5 pixels around know: one that few paths have met knows too little of itself (error.cpp).
  struct Around {
    double variance[3] = {};                               // of the pixel's mean: its own, at least the mean of those around
    double hits = std::numeric_limits<double>::infinity(); // as many equal paths have met them, in the colour with the fewest
  };
  Around around(size_t pixel) const;
  // Of a pixel's mean; infinite if fewer than two parts are in.
  double variance(const Pixel& pixel, int k) const;

 private:
  uint32_t width_, height_;
  std::vector<Pixel> pixels_;
  std::mutex mutex_;
  std::condition_variable turn_;
  uint32_t next_ = 0;
};

} // namespace openrt

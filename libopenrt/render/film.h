// film.h: the picture being made: channels as floats, rows from the top. Whoever writes takes a tile of its own. Statistics of a
// pixel are gathered in double (sums.h) and rounded once.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "openrt/openrt.h"
#include "render/error_map.h"
#include "render/sums.h"
#include "render/tiles.h"
#include "scene/channels.h"

namespace openrt {

// What paths from lamps add to a pixel: an estimate of its own (light_image.h).
struct LightSums {
  double mean[3] = {}, variance[3] = {};
  double hits = 0; // paths that have met the pixel and those around
};

class Film {
 public:
  Film() = default;
  Film(uint32_t width, uint32_t height, uint32_t channels, ErrorMap::Kind errors = ErrorMap::Kind::none);
  uint32_t width() const { return width_; }
  uint32_t height() const { return height_; }
  bool has(uint32_t channel) const { return channels_ & channel; }
  // [render] each pixel by one thread; light, error: null where there is none, where nothing is known of it
  void store(uint32_t x, uint32_t y, const PixelSums& sums, const LightSums* light = nullptr, const PixelError* error = nullptr);
  // After the last store(): looks at the neighbours of constant pixels. One thread.
  void finishErrors();
  // Then, of each tile: what its pixels may lack that no sample tells of (ErrorMap).
  void miss(const Tile& tile, double bound, double expected);
  const ErrorMap& errors() const { return errors_; }
  bool read(uint32_t channel, std::span<float> out) const;
  // Of a picture that is still being made: nothing everywhere, then tile by tile those that are finished. false: no such
  // channel, or no room for it.
  bool clear(uint32_t channel, std::span<float> out) const;
  void copy(uint32_t channel, const Tile& tile, std::span<float> out) const;

 private:
  std::vector<float>& plane(uint32_t channel);
  uint32_t width_ = 0, height_ = 0, channels_ = 0;
  std::vector<float> planes_[channelBits];
  ErrorMap errors_;
};

} // namespace openrt

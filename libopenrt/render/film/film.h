// film.h: the film: the channels of the picture as floats, rows from the top. Threads write to
// different tiles. Statistics of a pixel are accumulated in double (sums.h) and rounded once.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/film/error_map.h"
#include "render/film/sums.h"
#include "render/wave/tiles.h"
#include "scene/channels.h"

namespace openrt {

// Minimum number of light paths that tell a variance.
inline constexpr double fewestPaths = 16;

// Contribution of light paths to a pixel, estimated separately from the camera samples
// (light_image.h).
struct LightSums {
  double mean[3] = {}, variance[3] = {};
  // Effective number of light paths that contributed to a window around the pixel, and the number
  // of the window's pixels.
  double hits = 0, window = 1;
  // This is the largest mean of all cells of sensors, and 0 in pictures.
  double brightest = 0;
  uint32_t parts = 16; // number of independent pictures that the variance was estimated from
};

class Film {
 public:
  Film() = default;
  Film(uint32_t width, uint32_t height, uint32_t channels,
       ErrorMap::Kind errors = ErrorMap::Kind::none);
  uint32_t width() const { return width_; }
  uint32_t height() const { return height_; }
  bool has(uint32_t channel) const { return channels_ & channel; }
  // Stores a pixel. [render] each pixel by one thread. light: null if there is no light tracing;
  // error: null if the error is unknown.
  void store(uint32_t x, uint32_t y, const PixelSums& sums, const LightSums* light = nullptr,
             const PixelError* error = nullptr);
  // Stores how many of the samples of a tile's pixels have hit which names. sums: of these pixels.
  void storeHits(const Tile& tile, const HitCounts& hits, std::span<const PixelSums> sums);
  // Revises the errors of constant pixels beside edges. Call after the last store(), from one
  // thread.
  void finishErrors();
  // Records the radiance that the tile's pixels may lack because no sample has found it
  // (ErrorMap::addMissing). Call after finishErrors().
  void addMissing(const Tile& tile, double bound, double expected);
  const ErrorMap& errors() const { return errors_; }
  bool read(uint32_t channel, std::span<float> out) const;
  // Snapshots of an unfinished picture: clear() empties the output, then copy() adds the finished
  // tiles. clear() returns false if the channel does not exist or `out` is too small.
  bool clear(uint32_t channel, std::span<float> out) const;
  void copy(uint32_t channel, const Tile& tile, std::span<float> out) const;

 private:
  std::vector<float>& plane(uint32_t channel);
  uint32_t width_ = 0, height_ = 0, channels_ = 0;
  std::vector<float> planes_[channelBits];
  ErrorMap errors_;
};

} // namespace openrt

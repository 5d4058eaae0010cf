// film.h: the picture being made: channels as floats, rows from the top. Render threads write disjoint tiles. Statistics of a
// pixel are gathered in double while its tile renders (PixelSums) and rounded once.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "openrt/openrt.h"
#include "render/error_map.h"
#include "scene/channels.h"

namespace openrt {

struct PixelSums { // of one pixel, samples added in their order
  double rgba[4] = {};
  float depth = 0, position[3] = {}, name = 0;
  uint32_t samples = 0;
  double first[3] = {}, delta[3] = {}, delta2[3] = {}; // sums of (x - first) and its square: no cancellation
  double normal[3] = {}, albedo[3] = {};
  // Over the complete replicates: sums of their delta, of its square, cube and fourth power.
  double closed[3] = {}, closed2[3] = {}, closed3[3] = {}, closed4[3] = {};
  double grey[3] = {};                         // sums of (red + green + blue - first)^2, ^3 and ^4; see addTails()
  double light[3] = {}, lightVariance[3] = {}; // what paths from lamps add to the mean, and its variance (light_image.h)
  double lightHits = 0;                        // paths from lamps that have met the pixel and those around (light_image.h)
  float largest[3] = {};
  uint32_t replicates = 0; // complete ones
  bool random = false;     // a path has taken a random decision

  void add(const float radiance[3], float alpha);
  // After add(), where somebody asks for the error.
  void addTails(const float radiance[3]);
  void closeReplicate();
};

struct Tile {
  uint32_t x0, y0, x1, y1; // pixels, end exclusive
};

class Film {
 public:
  Film() = default;
  Film(uint32_t width, uint32_t height, uint32_t channels, ErrorMap::Kind errors = ErrorMap::Kind::none);
  uint32_t width() const { return width_; }
  uint32_t height() const { return height_; }
  bool has(uint32_t channel) const { return channels_ & channel; }
  // [render] each pixel by one thread; error: null where nothing is known of it
  void store(uint32_t x, uint32_t y, const PixelSums& sums, const PixelError* error = nullptr);
  // After the last store(): looks at the neighbours of constant pixels. One thread.
  void finishErrors();
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

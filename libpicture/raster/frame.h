// frame.h: The pixels of a picture that is being drawn: what is nearest in each, and the colours.
// [any thread, one for each row]
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "xvrml/types.h"

namespace picture::raster {

struct Frame {
  // The triangle that is visible in a pixel. Its colour is computed when all of its batch are
  // drawn.
  struct Visible {
    uint32_t mesh = none, triangle = 0;
    static constexpr uint32_t none = ~0u;
  };

  Frame(int w, int h)
      : width(w), height(h), depth(size_t(w) * size_t(h), -std::numeric_limits<float>::infinity()),
        visible(depth.size()), color(depth.size()), covered(depth.size()) {}
  size_t place(int x, int y) const { return size_t(y) * size_t(width) + size_t(x); }

  int width, height;
  std::vector<float> depth; // see Corner::d
  std::vector<Visible> visible;
  std::vector<xvrml::Color> color;
  std::vector<uint8_t> covered; // 1: `color` is that of a shape
};

} // namespace picture::raster

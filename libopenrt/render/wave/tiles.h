// tiles.h: the tiles of a picture: squares, cut off at the right and lower border, numbered row by
// row. With a scissor (rtScissor) only those that it needs are there, each as a whole: so its
// pixels are those of the whole picture, also where a tile shares something. [any]
#pragma once

#include <cstddef>
#include <cstdint>

#include "scene/scene.h"

namespace openrt {

struct Tile {
  uint32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0; // pixels, end exclusive
  bool operator==(const Tile&) const = default;
  uint32_t width() const { return x1 - x0; }
  size_t pixels() const { return size_t(x1 - x0) * (y1 - y0); }
};

// The division into tiles. It is the same on every machine that renders the frame.
class TileGrid {
 public:
  explicit TileGrid(const edit::FrameSettingsT& frame);
  uint32_t count() const { return columns_ * rows_; }
  uint64_t pixels() const { return pixels_; } // the pixels of all tiles
  uint32_t edge() const { return edge_; }
  uint32_t columns() const { return columns_; }
  Tile at(uint32_t number) const;

 private:
  uint32_t width_, height_, edge_;
  // the first column and the first row of tiles of the picture that are there, and their numbers
  uint32_t firstColumn_ = 0, firstRow_ = 0, columns_, rows_;
  uint64_t pixels_ = 0;
};

} // namespace openrt

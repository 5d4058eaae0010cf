#include "render/frame/tiles.h"

#include <algorithm>

namespace openrt {
namespace {

// Returns the edge length of the tiles: large enough for a few thousand paths in flight, and small
// enough that small pictures have tiles for many threads.
uint32_t edgeOf(const edit::FrameSettingsT& frame) {
  constexpr uint32_t least = 16, enough = 64; // pixels; tiles
  if (frame.tile) return frame.tile;
  uint32_t edge = frame.samples >= 16 ? least : frame.samples >= 4 ? 32 : 64;
  while (edge > least && uint64_t(frame.width) * frame.height < uint64_t(enough) * edge * edge)
    edge /= 2;
  return edge;
}

} // namespace

TileGrid::TileGrid(const edit::FrameSettingsT& frame)
    : width_(frame.width), height_(frame.height), edge_(edgeOf(frame)),
      columns_((width_ + edge_ - 1) / edge_), rows_((height_ + edge_ - 1) / edge_) {}

Tile TileGrid::at(uint32_t number) const {
  const uint32_t x = number % columns_ * edge_, y = number / columns_ * edge_;
  return {x, y, std::min(x + edge_, width_), std::min(y + edge_, height_)};
}

} // namespace openrt

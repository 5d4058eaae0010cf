#include "render/wave/tiles.h"

#include <algorithm>

#include "scene/quality.h"

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

// Keeps the tiles of one direction that the pixels from `begin` on touch, with `margin` around.
void limit(uint32_t begin, uint32_t length, uint32_t margin, uint32_t size, uint32_t edge,
           uint32_t& first, uint32_t& tiles) {
  if (begin >= size) {
    tiles = 0;
    return;
  }
  const uint32_t from = begin - std::min(begin, margin),
                 to = uint32_t(std::min<uint64_t>(uint64_t(begin) + length + margin, size));
  first = from / edge;
  tiles = (to + edge - 1) / edge - first;
}

} // namespace

TileGrid::TileGrid(const edit::FrameSettingsT& frame)
    : width_(frame.width), height_(frame.height), edge_(edgeOf(frame)),
      columns_((width_ + edge_ - 1) / edge_), rows_((height_ + edge_ - 1) / edge_) {
  if (frame.scissorWidth > 0) {
    // Errors look at the pixels within two pixels (ErrorMap::doubtConstants).
    const uint32_t margin = wantsError(frame) ? 2 : 0;
    limit(frame.scissorX, frame.scissorWidth, margin, width_, edge_, firstColumn_, columns_);
    limit(frame.scissorY, frame.scissorHeight, margin, height_, edge_, firstRow_, rows_);
  }
  if (count() == 0) return;
  const Tile first = at(0), last = at(count() - 1);
  pixels_ = uint64_t(last.x1 - first.x0) * (last.y1 - first.y0);
}

Tile TileGrid::at(uint32_t number) const {
  const uint32_t x = (firstColumn_ + number % columns_) * edge_,
                 y = (firstRow_ + number / columns_) * edge_;
  return {x, y, std::min(x + edge_, width_), std::min(y + edge_, height_)};
}

} // namespace openrt

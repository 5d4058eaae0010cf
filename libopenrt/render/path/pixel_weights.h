// pixel_weights.h: weighs the squared errors of a trial by the brightness of the picture nearby, as
// far as some blocks of pixels tell it, so that dark parts count as much as bright ones. [render]
#pragma once

#include <algorithm>
#include <vector>

#include "render/wave/tiles.h"

namespace openrt {

class PixelWeights {
 public:
  // Adds a block of pixels with its mean radiance, summed over the colours.
  void add(const Tile& tile, double radiance) {
    blocks_.push_back({(tile.x0 + tile.x1) / 2.0, (tile.y0 + tile.y1) / 2.0, radiance});
  }
  // Turns brightnesses into weights, after the last block: 1 / brightness^2, where no block is
  // darker than a tenth of the median.
  void finish() {
    std::vector<double> all;
    for (const Block& block : blocks_) all.push_back(block.value);
    const auto middle = all.begin() + ptrdiff_t(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end());
    const double least = *middle > 0 ? *middle / 10 : 1;
    for (Block& block : blocks_) {
      const double bright = std::max(block.value, least);
      block.value = 1 / (bright * bright);
    }
  }
  bool empty() const { return blocks_.empty(); }
  double ofBlock(size_t number) const { return blocks_[number].value; }
  // Returns the weight of a place in the picture: that of the nearest block.
  double at(double x, double y) const {
    const auto square = [&](const Block& b) {
      return (b.x - x) * (b.x - x) + (b.y - y) * (b.y - y);
    };
    return std::min_element(blocks_.begin(), blocks_.end(),
                            [&](const Block& a, const Block& b) { return square(a) < square(b); })
        ->value;
  }

 private:
  struct Block {
    double x, y, value; // its middle; its brightness, and after finish() its weight
  };
  std::vector<Block> blocks_;
};

} // namespace openrt

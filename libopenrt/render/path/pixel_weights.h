// pixel_weights.h: weighs the squared errors of a trial by the brightness of the picture there, so
// that dark parts count as much as bright ones: that which camera paths show in some blocks of
// pixels, and that which light paths bring. [render]
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "render/path/light_path_picture.h"
#include "render/wave/tiles.h"

namespace openrt {

class PixelWeights {
 public:
  // Adds a block of pixels with the mean radiance of its camera paths, summed over the colours.
  void add(const Tile& tile, double radiance) {
    blocks_.push_back({(tile.x0 + tile.x1) / 2.0, (tile.y0 + tile.y1) / 2.0, radiance});
  }
  bool empty() const { return blocks_.empty(); }
  // Sets the light of light paths, after the last block. No place counts as darker than a tenth of
  // the median of the blocks.
  void setLight(LightPathPicture light) {
    light_ = std::move(light);
    std::vector<double> all;
    for (const Block& block : blocks_) all.push_back(block.radiance + light_.at(block.x, block.y));
    const auto middle = all.begin() + ptrdiff_t(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end());
    least_ = *middle > 0 ? *middle / 10 : 1;
  }
  // Return the weight of a block, and that of a place, whose camera paths are those of the nearest
  // block.
  double ofBlock(size_t number) const {
    const Block& block = blocks_[number];
    return weightOf(block.radiance + light_.at(block.x, block.y));
  }
  double at(double x, double y) const {
    const auto square = [&](const Block& b) {
      return (b.x - x) * (b.x - x) + (b.y - y) * (b.y - y);
    };
    const auto nearest =
        std::min_element(blocks_.begin(), blocks_.end(),
                         [&](const Block& a, const Block& b) { return square(a) < square(b); });
    return weightOf(nearest->radiance + light_.at(x, y));
  }

 private:
  struct Block {
    double x, y, radiance; // x, y: its middle
  };
  double weightOf(double radiance) const {
    const double bright = std::max(radiance, least_);
    return 1 / (bright * bright);
  }
  std::vector<Block> blocks_;
  LightPathPicture light_;
  double least_ = 1;
};

} // namespace openrt

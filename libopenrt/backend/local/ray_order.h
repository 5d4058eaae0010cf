// ray_order.h: the order in which the rays of a query are traced. Rays that come row by row, as
// those of a camera, of a lidar or of a grid, are traced in patches of a few rows and columns, so
// that the rays of a packet stay close together. Made for each query. [any thread]
#pragma once

#include <cstdint>
#include <span>

#include "openrt/query.h"

namespace openrt {

class RayOrder {
 public:
  static constexpr uint32_t most = 4096; // rays of a block
  // sceneSize: the largest extent of the scene.
  RayOrder(std::span<const RTray> rays, float sceneSize);

  size_t blocks() const { return bands_ * bandBlocks_ + after_; }
  // A block of rays: numbers first + offset[0], first + offset[1], ...
  struct Block {
    size_t first;
    uint32_t count;
    uint32_t offset[most];
  };
  void get(size_t block, Block& to) const;

 private:
  bool findRows(std::span<const RTray> rays);
  size_t findPeriod(std::span<const RTray> rays) const;
  double squareBetween(const RTray& a, const RTray& b) const;

  double originWeight_ = 0;
  size_t count_;
  // Before ray `end_` there are bands of `down_` rows of `width_` rays, which are cut into patches
  // `across_` rays wide. The rays from there on are traced in their order.
  size_t end_ = 0, width_ = 1;
  uint32_t across_ = 16, down_ = 1, columns_ = most; // columns_: of a block
  size_t bands_ = 0, bandBlocks_ = 0, after_ = 0;    // numbers of blocks
};

} // namespace openrt

// array_blocks.h: keeps many small arrays in few blocks of memory. An array of its own takes 64
// bytes behind its end, its alignment and two allocations, which is more than the corners of a
// small part. [one thread at a time]
#pragma once

#include "scene/commit.h"

namespace openrt {

class ArrayBlocks {
 public:
  // Larger arrays are not worth a copy.
  static constexpr size_t largestBytes = 2048;
  // Returns a copy of an array, which shares its block with others: the block lives as long as one
  // of them. It is aligned to 16 bytes.
  ArrayPtr copy(const Array& array);

 private:
  struct Block {
    std::unique_ptr<std::byte[]> memory;
  };
  std::shared_ptr<Block> block_;
  size_t used_ = 0, size_ = 0; // bytes of the block
};

} // namespace openrt

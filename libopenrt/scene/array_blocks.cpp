// array_blocks.cpp: a block holds each array's Array and then its bytes. Blocks double in size up
// to a limit, so that few arrays do not take a large block.
#include "scene/array_blocks.h"

#include <algorithm>
#include <cstring>
#include <new>

namespace openrt {
namespace {

constexpr size_t alignment = 16, firstBlock = 8192, largestBlock = 65536;
constexpr size_t padding = 64; // readable bytes behind the last array

size_t rounded(size_t bytes) { return (bytes + alignment - 1) / alignment * alignment; }

} // namespace

ArrayPtr ArrayBlocks::copy(const Array& array) {
  static_assert(__STDCPP_DEFAULT_NEW_ALIGNMENT__ >= alignment);
  const size_t header = rounded(sizeof(Array)), room = header + rounded(array.size());
  if (!block_ || used_ + room + padding > size_) {
    const size_t size = std::max(std::clamp(2 * size_, firstBlock, largestBlock), room + padding);
    auto fresh = std::make_shared<Block>();
    fresh->memory = std::make_unique<std::byte[]>(size);
    block_ = std::move(fresh);
    used_ = 0;
    size_ = size;
  }
  std::byte* const at = block_->memory.get() + used_;
  used_ += room;
  std::memcpy(at + header, array.data(), array.size());
  // The block frees its memory without calling the destructor, which would free the array's.
  const Array* const made = new (at) Array(at + header, array.size());
  return ArrayPtr(block_, made);
}

} // namespace openrt

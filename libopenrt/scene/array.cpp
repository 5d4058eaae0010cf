// array.cpp: storage of bulk arrays: aligned for vector loads, with readable bytes past the end for
// the ray kernels. Made on the application's thread, freed by the last owner.
#include "scene/commit.h"

#include <cstdlib>
#include <cstring>
#include <limits>
#include <new>

namespace openrt {
namespace {
constexpr size_t alignment = 64, padding = 64;
}

Array::Array(size_t bytes) : data_(nullptr), size_(bytes) {
  if (bytes > std::numeric_limits<size_t>::max() / 2) throw std::bad_alloc();
  const size_t capacity = (bytes + alignment - 1) / alignment * alignment + padding;
  data_ = static_cast<std::byte*>(std::aligned_alloc(alignment, capacity));
  if (!data_) throw std::bad_alloc();
  // Clears only the padding; the caller fills the rest.
  std::memset(data_ + bytes, 0, capacity - bytes);
}

Array::~Array() { std::free(data_); }

bool sameBytes(const ArrayPtr& a, const ArrayPtr& b) {
  if (a == b) return true;
  return a && b && a->size() == b->size() && std::memcmp(a->data(), b->data(), a->size()) == 0;
}

} // namespace openrt

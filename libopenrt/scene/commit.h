// commit.h: the data that the API's front end sends to a backend: a list of edits (edits.fbs) and
// the bulk arrays they refer to. Made on the application's thread, immutable afterwards, read by
// backends on any thread. api/scene_state.h defines the order of the edits and the references they
// may hold; backend/record/validator.h checks both.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "edits_generated.h"

namespace openrt {

// The bytes of one bulk array, aligned and followed by 64 readable bytes (ray kernels read past the
// end). Immutable once shared.
class Array {
 public:
  explicit Array(size_t bytes); // aligned to 64 bytes
  ~Array();
  Array(const Array&) = delete;
  Array& operator=(const Array&) = delete;
  std::byte* data() { return data_; }
  const std::byte* data() const { return data_; }
  size_t size() const { return size_; }
  template <class T> const T* as() const { return reinterpret_cast<const T*>(data_); }
  template <class T> size_t count() const { return size_ / sizeof(T); }

 private:
  friend class ArrayBlocks;
  Array(std::byte* data, size_t size) : data_(data), size_(size) {} // in a block, which owns it

  std::byte* data_;
  size_t size_;
};

using ArrayPtr = std::shared_ptr<const Array>;
// Returns whether two arrays have the same bytes; also if both are null.
bool sameBytes(const ArrayPtr& a, const ArrayPtr& b);
// 0: none. The front end numbers arrays; a number is never reused within a context.
using ArrayId = uint64_t;

struct Commit {
  edit::EditsT edits;
  std::unordered_map<ArrayId, ArrayPtr> arrays; // arrays that this commit uses for the first time
};

} // namespace openrt

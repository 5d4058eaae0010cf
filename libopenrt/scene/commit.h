// commit.h: what travels from the API's front end to a backend: a list of edits (edits.fbs) and the
// bulk arrays they name. Made on the application's thread, immutable afterwards, read by backends
// on any thread. The order of the edits and what they may name: api/scene_state.h;
// backend/record/validator.h checks both.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "edits_generated.h"

namespace openrt {

// Bytes of one bulk array, 64-byte aligned, followed by 64 readable bytes (ray kernels read past
// the end). Immutable once shared.
class Array {
 public:
  explicit Array(size_t bytes);
  ~Array();
  Array(const Array&) = delete;
  Array& operator=(const Array&) = delete;
  std::byte* data() { return data_; }
  const std::byte* data() const { return data_; }
  size_t size() const { return size_; }
  template <class T> const T* as() const { return reinterpret_cast<const T*>(data_); }
  template <class T> size_t count() const { return size_ / sizeof(T); }

 private:
  std::byte* data_;
  size_t size_;
};

using ArrayPtr = std::shared_ptr<const Array>;
using ArrayId = uint64_t; // 0: none; numbered by the front end, never reused within a context

struct Commit {
  edit::EditsT edits;
  std::unordered_map<ArrayId, ArrayPtr> arrays; // those that this commit names for the first time
};

} // namespace openrt

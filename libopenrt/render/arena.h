// arena.h: arena allocator of one render thread for structure-of-arrays storage: aligned blocks cut
// from large chunks, released in reverse order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>
#include <numeric>
#include <vector>

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/asan_interface.h>
#endif

namespace openrt {

inline constexpr uint32_t lanes = 16;
inline uint32_t padded(uint32_t n) { return (n + lanes - 1) / lanes * lanes; }

// Tell the address sanitizer which bytes of a chunk are in use, so that it reports access to
// released blocks and beyond the ends of blocks. Blocks are filled with the bytes of NaN, so that
// results show where elements are read that were never written.
#ifdef __SANITIZE_ADDRESS__
inline constexpr size_t gapBytes = 64; // between blocks
inline void beginUse(void* at, size_t bytes) {
  ASAN_UNPOISON_MEMORY_REGION(at, bytes);
  std::memset(at, 0xff, bytes);
}
inline void endUse(void* at, size_t bytes) { ASAN_POISON_MEMORY_REGION(at, bytes); }
#else
inline constexpr size_t gapBytes = 0;
inline void beginUse(void*, size_t) {}
inline void endUse(void*, size_t) {}
#endif

// Bump allocator in chunks. Blocks do not move until release() to an earlier mark().
class Arena {
 public:
  Arena() = default;
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;
  ~Arena() {
    for (auto& c : chunks_) std::free(c.data);
  }

  template <class T> T* take(size_t count) {
    const size_t inUse = count * sizeof(T), bytes = (inUse + 63) / 64 * 64 + gapBytes;
    while (current_ < chunks_.size() && chunks_[current_].used + bytes > chunks_[current_].size) {
      current_++;
      if (current_ < chunks_.size()) chunks_[current_].used = 0;
    }
    if (current_ == chunks_.size()) grow(bytes);
    Chunk& chunk = chunks_[current_];
    T* result = reinterpret_cast<T*>(chunk.data + chunk.used);
    chunk.used += bytes;
    beginUse(result, inUse);
    return result;
  }
  template <class T> T* takeZero(size_t count) {
    T* result = take<T>(count);
    std::memset(result, 0, count * sizeof(T));
    return result;
  }

  // Returns an array with 0, 1, 2, ..., count - 1.
  uint32_t* takeNumbers(uint32_t count) {
    auto* result = take<uint32_t>(count);
    std::iota(result, result + count, 0u);
    return result;
  }

  struct Mark {
    size_t chunk, used;
  };
  Mark mark() const { return {current_, current_ < chunks_.size() ? chunks_[current_].used : 0}; }
  void release(Mark mark) {
    for (size_t k = mark.chunk; k < chunks_.size() && k <= current_; k++) {
      const size_t kept = k == mark.chunk ? mark.used : 0;
      endUse(chunks_[k].data + kept, chunks_[k].used - kept);
    }
    current_ = mark.chunk;
    if (current_ < chunks_.size()) chunks_[current_].used = mark.used;
  }

 private:
  static constexpr size_t chunkBytes = 1 << 20;
  struct Chunk {
    std::byte* data;
    size_t size, used;
  };
  void grow(size_t bytes) {
    const size_t size = bytes > chunkBytes ? bytes : chunkBytes;
    void* data = std::aligned_alloc(64, size);
    if (!data) throw std::bad_alloc();
    endUse(data, size);
    chunks_.push_back({static_cast<std::byte*>(data), size, 0});
  }
  std::vector<Chunk> chunks_;
  size_t current_ = 0;
};

// Releases, at the end of a scope, the memory that was allocated within it.
class ArenaScope {
 public:
  explicit ArenaScope(Arena& arena) : arena_(arena), mark_(arena.mark()) {}
  ~ArenaScope() { arena_.release(mark_); }
  ArenaScope(const ArenaScope&) = delete;
  ArenaScope& operator=(const ArenaScope&) = delete;

 private:
  Arena& arena_;
  Arena::Mark mark_;
};

} // namespace openrt

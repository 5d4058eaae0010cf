// array_cache.h: Keeps a worker's arrays by content hash, and arrays that arrive piece by piece.
// Arrays used by the scene are never dropped; of the others, the least recently used are dropped
// first. One thread.
#pragma once

#include <list>
#include <map>
#include <memory>

#include "backend/cluster/messages/messages.h"
#include "backend/cluster/worker/array_folder.h"

namespace openrt::cluster {

class ArrayCache {
 public:
  explicit ArrayCache(size_t limit) : limit_(limit) {}
  // Returns null if it is not cached or has another size.
  ArrayPtr find(const Hash& hash, uint64_t bytes);
  void put(const Hash& hash, ArrayPtr array);
  void trim(); // drops unused arrays down to the limit
  size_t bytes() const { return bytes_; }
  size_t count() const { return entries_.size(); }

 private:
  struct Entry {
    ArrayPtr array;
    std::list<Hash>::iterator age;
  };
  std::map<Hash, Entry> entries_;
  std::list<Hash> ages_; // least recently used first
  size_t limit_, bytes_ = 0;
};

// An array that is being received; pieces are unpacked in the order in which they arrive.
class ArrayStream {
 public:
  // folder: keeps the array when it has arrived; may be null.
  ArrayStream(const Hash& hash, uint64_t bytes, ArrayFolder* folder = nullptr);
  ~ArrayStream();
  ArrayStream(ArrayStream&&) noexcept;
  // Adds a piece. Returns an empty string, or what is wrong with the piece.
  std::string put(const message::Piece& piece);
  uint64_t bytes() const;
  bool begun() const; // its memory has been allocated
  bool complete() const;
  // Call once complete. Returns null if the content does not match the hash; otherwise the array is
  // kept in the folder, too.
  ArrayPtr take();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace openrt::cluster

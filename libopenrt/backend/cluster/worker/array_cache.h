// array_cache.h: a worker's arrays by what they hold, and how they come piece by piece. One that
// the scene uses is never thrown away; of the others, those that were of no use for longest go
// first. One thread's.
#pragma once

#include <list>
#include <map>
#include <memory>

#include "backend/cluster/net/messages.h"

namespace openrt::cluster {

class ArrayCache {
 public:
  explicit ArrayCache(size_t limit) : limit_(limit) {}
  // Null: it is not there, or is of another size.
  ArrayPtr find(const Hash& hash, uint64_t bytes);
  void put(const Hash& hash, ArrayPtr array);
  void trim(); // to the limit, if what is in use leaves it
  size_t bytes() const { return bytes_; }
  size_t count() const { return entries_.size(); }

 private:
  struct Entry {
    ArrayPtr array;
    std::list<Hash>::iterator age;
  };
  std::map<Hash, Entry> entries_;
  std::list<Hash> ages_; // the one last asked for at the end
  size_t limit_, bytes_ = 0;
};

// An array that comes: unpacked as its pieces arrive, in their order.
class ArrayStream {
 public:
  ArrayStream(const Hash& hash, uint64_t bytes);
  ~ArrayStream();
  ArrayStream(ArrayStream&&) noexcept;
  // Empty, or what is wrong with the piece.
  std::string put(const message::Piece& piece);
  bool begun() const; // memory has been taken for it
  bool complete() const;
  ArrayPtr take(); // once complete; null: not what its name says

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace openrt::cluster

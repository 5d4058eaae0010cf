// node_map.h: a hash map from nodes to small values. It keeps everything in one array, because
// worlds have millions of nodes: an entry takes about 24 bytes and one cache miss. The nodes are
// only compared, never read. [any thread, one at a time]
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace xvrml {

class Node;

template <class V> class NodeMap {
 public:
  // Inserts the value if the node has none. Returns the value of the node, and whether it is new.
  // The pointer is valid until the next insert or erase. node: not null.
  std::pair<V*, bool> insert(const Node* node, V value) {
    if (4 * (size_ + 1) > 3 * entries_.size()) grow();
    Entry& entry = entries_[place(node)];
    if (entry.node) return {&entry.value, false};
    entry = {node, value};
    ++size_;
    return {&entry.value, true};
  }
  const V* find(const Node* node) const {
    if (size_ == 0 || !node) return nullptr;
    const Entry& entry = entries_[place(node)];
    return entry.node ? &entry.value : nullptr;
  }
  bool contains(const Node* node) const { return find(node) != nullptr; }
  size_t size() const { return size_; }
  // Makes room for this many nodes at once.
  void reserve(size_t nodes) {
    size_t entries = std::max(entries_.size(), least);
    while (3 * entries < 4 * nodes) entries *= 2;
    if (entries > entries_.size()) resize(entries);
  }

  void erase(const Node* node) {
    if (!contains(node)) return;
    const size_t mask = entries_.size() - 1;
    size_t gap = place(node);
    // The entries after the gap move up, unless that would put them before their first place.
    for (size_t i = (gap + 1) & mask; entries_[i].node; i = (i + 1) & mask) {
      if (((i - first(entries_[i].node)) & mask) < ((i - gap) & mask)) continue;
      entries_[gap] = entries_[i];
      gap = i;
    }
    entries_[gap] = {};
    --size_;
  }

 private:
  static constexpr size_t least = 16; // entries
  struct Entry {
    const Node* node = nullptr; // null: the entry is free
    [[no_unique_address]] V value{};
  };
  // Returns where the search for a node begins.
  size_t first(const Node* node) const {
    return size_t(uint64_t(reinterpret_cast<uintptr_t>(node)) * 0x9e3779b97f4a7c15u >> shift_);
  }
  // Returns the entry of a node, or the free entry where it belongs.
  size_t place(const Node* node) const {
    size_t i = first(node);
    while (entries_[i].node && entries_[i].node != node) i = (i + 1) & (entries_.size() - 1);
    return i;
  }
  void grow() { resize(std::max(2 * entries_.size(), least)); }
  void resize(size_t entries) {
    std::vector<Entry> before(entries);
    before.swap(entries_);
    shift_ = 64;
    for (size_t n = entries_.size(); n > 1; n /= 2) --shift_;
    for (const Entry& entry : before)
      if (entry.node) entries_[place(entry.node)] = entry;
  }

  std::vector<Entry> entries_; // a power of two, at most three quarters in use
  size_t size_ = 0;
  unsigned shift_ = 64; // 64 minus log2 of the number of entries
};

} // namespace xvrml

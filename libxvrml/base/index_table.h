// index_table.h: a hash table of the numbers of entries in a list. The list holds what is compared,
// so that an entry takes about 16 bytes here and one cache miss. Hashes must be uniform, as those
// of xxHash are. [any thread, one at a time]
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace xvrml {

class IndexTable {
 public:
  static constexpr uint32_t none = ~uint32_t(0); // not a number

  // Returns the first number with this hash for which is(number) is true; none if there is none.
  template <class Is> uint32_t find(uint64_t hash, const Is& is) const {
    if (size_ == 0) return none;
    for (size_t i = first(shortened(hash)); slots_[i].number != none; i = after(i))
      if (slots_[i].hash == shortened(hash) && is(slots_[i].number)) return slots_[i].number;
    return none;
  }
  void insert(uint64_t hash, uint32_t number) {
    reserve(size_ + 1);
    place({shortened(hash), number});
    ++size_;
  }
  // Removes a number that was inserted with this hash, if it is there.
  void erase(uint64_t hash, uint32_t number) {
    if (size_ == 0) return;
    size_t gap = first(shortened(hash));
    while (slots_[gap].number != number) {
      if (slots_[gap].number == none) return;
      gap = after(gap);
    }
    // The slots after the gap move up, unless that would put them before their first place.
    for (size_t i = after(gap); slots_[i].number != none; i = after(i)) {
      if (((i - first(slots_[i].hash)) & mask()) < ((i - gap) & mask())) continue;
      slots_[gap] = slots_[i];
      gap = i;
    }
    slots_[gap] = {};
    --size_;
  }
  size_t size() const { return size_; }
  // Makes room for this many numbers at once.
  void reserve(size_t numbers) {
    size_t slots = std::max(slots_.size(), size_t(16));
    while (3 * slots < 4 * numbers) slots *= 2;
    if (slots == slots_.size()) return;
    std::vector<Slot> before(slots);
    before.swap(slots_);
    for (const Slot& slot : before)
      if (slot.number != none) place(slot);
  }

 private:
  struct Slot {
    uint32_t hash = 0, number = none; // none: the slot is free
  };
  static uint32_t shortened(uint64_t hash) { return uint32_t(hash >> 32); }
  size_t mask() const { return slots_.size() - 1; }
  size_t first(uint32_t hash) const { return hash & mask(); }
  size_t after(size_t slot) const { return (slot + 1) & mask(); }
  void place(const Slot& slot) {
    size_t i = first(slot.hash);
    while (slots_[i].number != none) i = after(i);
    slots_[i] = slot;
  }

  std::vector<Slot> slots_; // a power of two, at most three quarters in use
  size_t size_ = 0;
};

} // namespace xvrml

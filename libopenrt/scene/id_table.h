// id_table.h: a table by id that is iterated in ascending order of the ids. Ids are handed out in
// ascending order, and scenes have millions of them. So a table keeps its entries in chunks,
// without memory of their own, and finds an entry by its id without a search. Used by the front end
// (api/scene_state.h) and by backends (scene/scene.h), each on its own thread.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

namespace openrt {

template <class T> class IdTable {
 public:
  using Entry = std::pair<uint32_t, T>; // id and value

  template <class E> class Iterator {
   public:
    Iterator(const IdTable* table, uint64_t id) : table_(table), id_(id) {}
    E& operator*() const { return table_->entry(table_->numberOf(id_)); }
    E* operator->() const { return &**this; }
    Iterator& operator++() {
      id_ = table_->next(id_ + 1);
      return *this;
    }
    bool operator==(const Iterator&) const = default;

   private:
    const IdTable* table_;
    uint64_t id_;
  };
  using iterator = Iterator<Entry>;
  using const_iterator = Iterator<const Entry>;

  iterator begin() { return {this, next(0)}; }
  iterator end() { return {this, afterLast()}; }
  const_iterator begin() const { return {this, next(0)}; }
  const_iterator end() const { return {this, afterLast()}; }
  iterator find(uint32_t id) { return {this, contains(id) ? id : afterLast()}; }
  const_iterator find(uint32_t id) const { return {this, contains(id) ? id : afterLast()}; }
  bool contains(uint32_t id) const { return numberOf(id) != 0; }
  size_t size() const { return size_; }
  const T& at(uint32_t id) const {
    const uint32_t number = numberOf(id);
    if (number == 0) throw std::out_of_range("no entry has this id");
    return entry(number).second;
  }

  // Adds the value if the id has none. If it throws, nothing is changed.
  std::pair<iterator, bool> try_emplace(uint32_t id, const T& value = T()) {
    if (contains(id)) return {find(id), false};
    if (pages_.size() <= id / pageSize) pages_.resize(id / pageSize + 1);
    std::unique_ptr<Page>& page = pages_[id / pageSize];
    if (!page) page = std::make_unique<Page>();
    if (free_ == 0) addChunk();
    const uint32_t number = free_;
    Entry& added = entry(number);
    added.second = value;
    free_ = std::exchange(added.first, id);
    page->numbers[id % pageSize] = number;
    ++page->used;
    ++size_;
    return {{this, id}, true};
  }
  T& operator[](uint32_t id) { return try_emplace(id).first->second; }

  void erase(uint32_t id) {
    const uint32_t number = numberOf(id);
    if (number == 0) return;
    std::unique_ptr<Page>& page = pages_[id / pageSize];
    page->numbers[id % pageSize] = 0;
    if (--page->used == 0) page.reset();
    entry(number) = {free_, T()};
    free_ = number;
    --size_;
  }

 private:
  static constexpr uint32_t pageSize = 4096, chunkSize = 32;
  struct Page { // the numbers of the entries of consecutive ids; 0: none
    uint32_t used = 0;
    std::array<uint32_t, pageSize> numbers{};
  };
  uint64_t afterLast() const { return uint64_t(pages_.size()) * pageSize; }
  uint32_t numberOf(uint64_t id) const {
    const size_t page = id / pageSize;
    return page < pages_.size() && pages_[page] ? pages_[page]->numbers[id % pageSize] : 0;
  }
  // Returns the first id in use from this one on.
  uint64_t next(uint64_t id) const {
    while (id < afterLast() && numberOf(id) == 0)
      id = pages_[id / pageSize] ? id + 1 : (id / pageSize + 1) * pageSize;
    return id;
  }
  Entry& entry(uint32_t number) const {
    return chunks_[(number - 1) / chunkSize][(number - 1) % chunkSize];
  }
  // Adds free entries. They form a list: the id of each is the number of the next one.
  void addChunk() {
    const uint32_t first = uint32_t(chunks_.size()) * chunkSize + 1;
    chunks_.push_back(std::make_unique<Entry[]>(chunkSize));
    for (uint32_t i = 0; i + 1 < chunkSize; ++i) chunks_.back()[i].first = first + i + 1;
    free_ = first;
  }

  std::vector<std::unique_ptr<Page>> pages_;
  std::vector<std::unique_ptr<Entry[]>> chunks_;
  uint32_t free_ = 0; // number of the first free entry; 0: none
  size_t size_ = 0;
};

} // namespace openrt

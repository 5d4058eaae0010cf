// recent_viewers.h: Keeps something for each of the viewers who were served last. When there are
// more, the one unused for longest is forgotten. [one thread]
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>

namespace picture::live {

constexpr size_t mostRecentViewers = 8;

template <class Kept> class RecentViewers {
 public:
  // Returns what is kept for a viewer, and makes it if there is nothing.
  Kept& of(uint32_t viewer) {
    if (!entries_.contains(viewer) && entries_.size() >= mostRecentViewers) {
      const auto older = [](const auto& a, const auto& b) { return a.second.used < b.second.used; };
      entries_.erase(std::min_element(entries_.begin(), entries_.end(), older));
    }
    Entry& found = entries_[viewer];
    found.used = ++uses_;
    return found.kept;
  }
  void forget(uint32_t viewer) { entries_.erase(viewer); }
  size_t size() const { return entries_.size(); }

 private:
  struct Entry {
    Kept kept{};
    uint64_t used = 0; // number of the last use
  };
  std::map<uint32_t, Entry> entries_;
  uint64_t uses_ = 0;
};

} // namespace picture::live

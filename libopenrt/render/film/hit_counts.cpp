#include "render/film/hit_counts.h"

#include <algorithm>
#include <utility>

namespace openrt {
namespace {

bool before(const HitCount& a, const HitCount& b) {
  return a.pixel != b.pixel ? a.pixel < b.pixel : a.name < b.name;
}

} // namespace

void HitCounts::add(uint32_t pixel, uint32_t name) {
  if (name == 0) return;
  // Most samples of a pixel hit what the one before has hit.
  if (!counts_.empty() && counts_.back().pixel == pixel && counts_.back().name == name)
    counts_.back().times++;
  else
    counts_.push_back({pixel, name, 1});
}

void HitCounts::finish() {
  std::sort(counts_.begin(), counts_.end(), before);
  combine();
}

void HitCounts::merge(const HitCounts& more) {
  const auto middle = std::ptrdiff_t(counts_.size());
  counts_.insert(counts_.end(), more.counts_.begin(), more.counts_.end());
  std::inplace_merge(counts_.begin(), counts_.begin() + middle, counts_.end(), before);
  combine();
}

// Adds up the counts of the same pixel and name, which are neighbours, and drops those of more
// names than are counted.
void HitCounts::combine() {
  size_t kept = 0, firstOfPixel = 0;
  for (const HitCount& count : counts_) {
    HitCount* const last = kept > 0 ? &counts_[kept - 1] : nullptr;
    if (!last || last->pixel != count.pixel) firstOfPixel = kept;
    if (last && last->pixel == count.pixel && last->name == count.name)
      last->times += count.times;
    else if (kept - firstOfPixel < mostNames)
      counts_[kept++] = count;
  }
  counts_.resize(kept);
}

bool HitCounts::assign(std::vector<HitCount> counts, uint32_t pixels) {
  uint32_t names = 0;
  for (size_t i = 0; i < counts.size(); i++) {
    const HitCount& count = counts[i];
    if (count.pixel >= pixels || count.name == 0 || count.times == 0) return false;
    if (i > 0 && !before(counts[i - 1], count)) return false;
    names = i > 0 && counts[i - 1].pixel == count.pixel ? names + 1 : 1;
    if (names > mostNames) return false;
  }
  counts_ = std::move(counts);
  return true;
}

} // namespace openrt

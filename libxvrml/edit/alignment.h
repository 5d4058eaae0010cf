// alignment.h: which elements of a list stay where they are when it becomes another one. Elements
// are equal if their keys are. [any thread]
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace xvrml {

using Keys = std::span<const uint64_t>;
// Has for each element of the new list the old one that stays for it, or `fresh`. Those that stay
// keep their order.
using Alignment = std::vector<size_t>;
inline constexpr size_t fresh = ~size_t(0);

// Returns an alignment in which as many elements stay as possible, if no element is repeated.
Alignment longestInOrder(Keys olds, Keys news);
// Returns an alignment in which few elements are replaced, inserted or removed. As many stay as
// possible, unless elements that are replaced in their places are fewer changes, or as few. Lists
// that differ in thousands of elements are compared less closely.
Alignment fewestChanges(Keys olds, Keys news);

enum class AlignmentStep : uint8_t { keep, replace, insert, remove };

// Calls visit(step, old, now) for all elements in their order. Between two that stay, old elements
// are replaced one by one; then new ones are inserted before the old one `old`, or old ones
// removed.
template <class Visit>
void forEachStep(const Alignment& alignment, size_t olds, const Visit& visit) {
  using Step = AlignmentStep;
  size_t old = 0, now = 0;
  const auto between = [&](size_t oldEnd, size_t newEnd) {
    for (; old < oldEnd && now < newEnd; ++old, ++now) visit(Step::replace, old, now);
    for (; now < newEnd; ++now) visit(Step::insert, old, now);
    for (; old < oldEnd; ++old) visit(Step::remove, old, now);
  };
  for (size_t i = 0; i < alignment.size(); ++i) {
    if (alignment[i] == fresh) continue;
    between(alignment[i], i);
    visit(Step::keep, old++, now++);
  }
  between(olds, alignment.size());
}

} // namespace xvrml

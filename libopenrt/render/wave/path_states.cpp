#include "render/wave/path_states.h"

#include <algorithm>
#include <cstring>

namespace openrt {

void RayQueue::reserve(size_t count) {
  const size_t needed = size_ + count + lanes;
  if (needed <= capacity_) return;
  const size_t capacity = std::max<size_t>((needed + lanes - 1) / lanes * lanes, 2 * capacity_);
  size_t bytes = 0;
  const auto countBytes = [&](auto* array) { bytes += capacity * sizeof *array; };
  const auto forAll = [&](const auto& f) {
    for (auto* group : {origin_, direction_})
      for (int k = 0; k < 3; k++) f(group[k]);
    states_.forEachArray(f);
  };
  forAll(countBytes);
  std::unique_ptr<std::byte[]> memory(new std::byte[bytes + 64]);
  const auto address = reinterpret_cast<uintptr_t>(memory.get());
  std::byte* at = memory.get() + (64 - address % 64) % 64;
  forAll([&](auto*& array) {
    using Element = std::remove_reference_t<decltype(*array)>;
    if (size_) std::memcpy(at, array, size_ * sizeof(Element));
    array = reinterpret_cast<Element*>(at);
    at += capacity * sizeof(Element);
  });
  memory_ = std::move(memory);
  capacity_ = capacity;
}

void RayQueue::cut(uint32_t level, uint32_t most, double& lost) {
  if (level <= most) return;
  size_t kept = 0;
  for (size_t i = 0; i < size_; i++) {
    const RayState state = states_[i];
    if (!isWithinDepth(state.flags, level, most)) {
      for (size_t k = 0; k < 3; k++) lost += double(state.throughput[k]);
      continue;
    }
    if (kept < i) {
      store(load(origin_, i), origin_, kept);
      store(load(direction_, i), direction_, kept);
      states_.set(kept, state);
    }
    kept++;
  }
  size_ = kept;
}

PathStates RayQueue::statesFrom(size_t begin) const {
  PathStates from = states_;
  from.forEachArray([&](auto*& array) { array += begin; });
  return from;
}

} // namespace openrt

#include "render/wave/random_numbers.h"

#include <algorithm>

namespace openrt {
namespace {

// Returns an array of n numbers to be written, whose padding is 0.
float* takePadded(Arena& arena, uint32_t n) {
  auto* numbers = arena.take<float>(padded(n));
  std::fill(numbers + n, numbers + padded(n), 0.0f);
  return numbers;
}

} // namespace

void RandomNumbers::drawPair(uint32_t offset, Arena& arena, float* square[2]) const {
  for (int k = 0; k < 2; k++) square[k] = takePadded(arena, count);
  samplePairs(count, key, pair, offset, index, square[0], square[1]);
}

float* RandomNumbers::drawSecond(Decision what, Arena& arena) const {
  float* second = takePadded(arena, count);
  samplePairs(count, key, pair, uint32_t(what), index, nullptr, second);
  return second;
}

RandomNumbers randomNumbersAt(const PathSamples& samples, const PathStates& states,
                              const uint32_t* order, uint32_t n, uint32_t pair, Arena& arena) {
  auto *key = arena.take<uint32_t>(n), *index = arena.take<uint32_t>(n),
       *pairs = arena.take<uint32_t>(n);
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t path = states.path[order[i]];
    key[i] = samples.key[path];
    index[i] = samples.index[path];
    pairs[i] = pair + states.branch[order[i]];
  }
  return {n, key, index, pairs};
}

RandomNumbers randomNumbersAtStart(const PathSamples& samples, uint32_t n, Arena& arena) {
  return {n, samples.key, samples.index, arena.takeZero<uint32_t>(n)};
}

} // namespace openrt

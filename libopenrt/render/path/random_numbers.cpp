#include "render/path/random_numbers.h"

namespace openrt {

void RandomNumbers::drawPair(uint32_t offset, Arena& arena, float* square[2]) const {
  for (int k = 0; k < 2; k++) square[k] = arena.takeZero<float>(padded(count));
  samplePairs(count, key, pair, offset, index, square[0], square[1]);
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

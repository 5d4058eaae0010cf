// openrt_sums.cpp: reads arbitrary bytes as kept sums, adds what was read to itself under another
// seed, and makes its picture. The checksum is made right first, so that the fuzzer reaches the
// code behind it. libFuzzer target.
#include <cstdint>
#include <cstring>
#include <vector>

#include <xxhash.h>

#include "render/frame/frame_sums.h"

using namespace openrt;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  constexpr size_t head = 16; // the magic, and the checksum of what follows
  constexpr uint64_t mostPixels = 1 << 14;
  if (size < head) return 0;
  std::vector<std::byte> bytes(size);
  std::memcpy(bytes.data(), data, size);
  const uint64_t check = XXH3_64bits(bytes.data() + head, size - head);
  std::memcpy(bytes.data() + head / 2, &check, sizeof check);
  try {
    const FrameSumsPtr sums = readSums(bytes);
    if (uint64_t(sums->frame.width) * sums->frame.height > mostPixels) return 0;
    // What was read is written as it was.
    if (writeSums(*readSums(writeSums(*sums))) != writeSums(*sums)) __builtin_trap();
    const FrameSumsPtr small = condense(*sums);
    const FrameWork picture(*small);
    if (small->seeds.back().first > 1u << 30) return 0;
    FrameSums other = *small;
    for (SeedSums& seeds : other.seeds) seeds.first += 1u << 20;
    const FrameWork both(*mergeSums(*small, other));
  } catch (const SumsError&) {} // damaged, or not finished
  return 0;
}

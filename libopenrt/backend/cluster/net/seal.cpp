// seal.cpp: adds and checks seals. A seal covers the header, and only the sizes of the bulk frames.
// The content of bulk frames has its own checksum in the header, which is verified where there is
// time. [any]
#include "backend/cluster/net/seal.h"

#include <array>
#include <cstring>

#include <xxhash.h>

namespace openrt::cluster {
namespace {

constexpr size_t sealBytes = 16;

uint64_t littleEndian(uint64_t value) {
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
  return __builtin_bswap64(value);
#else
  return value;
#endif
}

std::array<uint64_t, 2> sealOf(std::span<const std::vector<std::byte>> frames, uint64_t number) {
  uint64_t sum = XXH3_64bits_withSeed(frames[0].data(), frames[0].size(), number);
  for (const auto& frame : frames.subspan(1)) {
    const uint64_t size = littleEndian(frame.size());
    sum = XXH3_64bits_withSeed(&size, sizeof size, sum);
  }
  return {littleEndian(number), littleEndian(sum)};
}

} // namespace

void seal(Frames& frames, uint64_t number) {
  const std::array<uint64_t, 2> value = sealOf(frames, number);
  std::memcpy(frames.emplace_back(sealBytes).data(), value.data(), sealBytes);
}

bool unseal(Frames& frames, uint64_t number) {
  if (frames.size() < 2 || frames.back().size() != sealBytes) return false;
  std::array<uint64_t, 2> value{};
  std::memcpy(value.data(), frames.back().data(), sealBytes);
  frames.pop_back();
  return value == sealOf(frames, number);
}

} // namespace openrt::cluster

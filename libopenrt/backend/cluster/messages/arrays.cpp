// arrays.cpp: Computes content hashes of arrays and compresses them (messages.h). [any]
#include <cstdio>

#include <xxhash.h>
#include <zstd.h>

#include "backend/cluster/messages/messages.h"

namespace openrt::cluster {

Hash hashOf(std::span<const std::byte> bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return {hash.low64, hash.high64};
}

std::string hex(const Hash& hash) {
  char text[40];
  std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(hash.high),
                static_cast<unsigned long long>(hash.low));
  return text;
}

bool plausible(uint64_t bytes, uint64_t stored) {
  // zstd compresses a block of 128 KiB to 4 bytes at best.
  constexpr uint64_t bestRatio = 1 << 16;
  return stored > 0 && stored <= ZSTD_compressBound(bytes) && bytes <= bestRatio * stored;
}

std::vector<std::byte> packArray(std::span<const std::byte> array) {
  constexpr int fastest = 1;
  std::vector<std::byte> packed(ZSTD_compressBound(array.size()));
  const size_t stored =
      ZSTD_compress(packed.data(), packed.size(), array.data(), array.size(), fastest);
  // The buffer is large enough, so only memory can be missing.
  if (ZSTD_isError(stored)) throw std::bad_alloc();
  packed.resize(stored);
  packed.shrink_to_fit();
  return packed;
}

ArrayPtr unpackArray(std::span<const std::byte> packed, uint64_t bytes, const Hash& hash) {
  if (bytes > limits::arrayBytes || !plausible(bytes, packed.size())) return nullptr;
  auto array = std::make_shared<Array>(bytes);
  const size_t size = ZSTD_decompress(array->data(), bytes, packed.data(), packed.size());
  if (ZSTD_isError(size) || size != bytes || hashOf({array->data(), bytes}) != hash) return nullptr;
  return array;
}

message::Piece pieceOf(const Hash& hash, uint64_t bytes, std::span<const std::byte> packed,
                       uint64_t offset) {
  const auto part = packed.subspan(offset, std::min<size_t>(pieceBytes, packed.size() - offset));
  message::Piece piece;
  piece.hash = hash;
  piece.bytes = bytes;
  piece.stored = packed.size();
  piece.offset = offset;
  piece.data.assign(part.begin(), part.end());
  return piece;
}

} // namespace openrt::cluster

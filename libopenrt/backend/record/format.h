// format.h: the format of recordings: the commits that rtSwapBuffers passed to the backend. Written
// by record.cpp, read by reader.cpp.
//
//   file    ::= magic version reserved commit*           magic 8 bytes, version and reserved 32-bit
//   commit  ::= array* edits
//   array   ::= ChunkHeader(kind Array, id) zstd-frame    the bytes of one array
//   edits   ::= ChunkHeader(kind Edits) flatbuffer        root openrt.edit.Edits;
//                                                         its `render` marks a frame
// All numbers are little-endian. `hash` is XXH3 (64 bits) of the bytes before compression.
#pragma once

#include <bit>
#include <cstdint>

namespace openrt::recording {

inline constexpr char magic[8] = {'O', 'p', 'e', 'n', 'R', 'T', 'r', 'c'};
inline constexpr uint32_t version = 1;

enum class ChunkKind : uint32_t { Array = 1, Edits = 2 };

struct FileHeader {
  char magic[8];
  uint32_t version;
  uint32_t reserved; // must be 0
};

struct ChunkHeader {
  ChunkKind kind;
  uint32_t reserved; // must be 0
  uint64_t id;       // array number; 0 for edits
  uint64_t bytes;    // size before compression
  uint64_t stored;   // size of the payload that follows
  uint64_t hash;
};

static_assert(sizeof(FileHeader) == 16 && sizeof(ChunkHeader) == 40);
static_assert(std::endian::native == std::endian::little,
              "the structures are written as they lie in memory");

} // namespace openrt::recording

// openrt_recording.cpp: reads arbitrary bytes as a recording. If the first byte is 0, the rest is
// the file. Otherwise the rest is the edits of a commit, wrapped with a correct checksum, so that
// the fuzzer reaches the code behind it. libFuzzer target.
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <vector>

#include <xxhash.h>

#include "backend/record/format.h"
#include "backend/record/reader.h"

namespace {

using namespace openrt;

std::vector<uint8_t> asRecording(const uint8_t* data, size_t size) {
  recording::FileHeader file{};
  std::memcpy(file.magic, recording::magic, sizeof(file.magic));
  file.version = recording::version;
  const recording::ChunkHeader chunk{recording::ChunkKind::Edits, 0, 0, size, size,
                                     XXH3_64bits(data, size)};
  std::vector<uint8_t> bytes(sizeof(file) + sizeof(chunk) + size);
  std::memcpy(bytes.data(), &file, sizeof(file));
  std::memcpy(bytes.data() + sizeof(file), &chunk, sizeof(chunk));
  if (size) std::memcpy(bytes.data() + sizeof(file) + sizeof(chunk), data, size);
  return bytes;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size < 2) return 0;
  std::vector<uint8_t> bytes =
      data[0] ? asRecording(data + 1, size - 1) : std::vector<uint8_t>(data + 1, data + size);
  std::FILE* file = fmemopen(bytes.data(), bytes.size(), "rb");
  if (!file) return 0;
  try {
    RecordingReader reader(
        file, "fuzz", nullptr,
        {.arrayBytes = 1 << 20, .totalBytes = 1 << 22, .editBytes = 1 << 20, .commits = 16});
    while (reader.next()) {}
  } catch (const BadRecording&) {}
  return 0;
}

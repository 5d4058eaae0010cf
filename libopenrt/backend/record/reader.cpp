// reader.cpp: reads, decompresses and verifies the chunks of a recording. Called by openrt-replay,
// tests and the fuzz target; one thread.
#include "backend/record/reader.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <xxhash.h>
#include <zstd.h>

#include "backend/record/edits_bytes.h"
#include "backend/record/format.h"

namespace openrt {

using namespace recording;

RecordingReader::RecordingReader(std::FILE* file, std::string name, const ShaderRegistry* shaders,
                                 const RecordingLimits& limits)
    : file_(file), name_(std::move(name)), limits_(limits), validator_(shaders) {
  FileHeader header;
  read(&header, sizeof(header), false);
  if (std::memcmp(header.magic, magic, sizeof(magic)) != 0) fail("not a recording");
  if (header.version != version)
    fail("the recording has version " + std::to_string(header.version) +
         "; this program reads version " + std::to_string(version));
  if (header.reserved != 0) fail("a reserved field is not 0");
}

void RecordingReader::fail(const std::string& what) const {
  throw BadRecording(name_ + ": byte " + std::to_string(offset_) + ": " + what);
}

// Returns false only at the end of the file, and only if `mayEnd`.
bool RecordingReader::read(void* out, size_t bytes, bool mayEnd) {
  const size_t got = std::fread(out, 1, bytes, file_.get());
  if (got == 0 && mayEnd && std::feof(file_.get())) return false;
  if (got != bytes)
    fail(std::ferror(file_.get()) ? std::strerror(errno) : "the file ends in the middle");
  offset_ += bytes;
  return true;
}

void RecordingReader::countBytes(uint64_t bytes) {
  total_ += bytes;
  if (total_ > limits_.totalBytes)
    fail("more than " + std::to_string(limits_.totalBytes) + " bytes of data");
}

// Reads in pieces, so that a size beyond the end of the file fails before memory is allocated for
// it.
std::vector<uint8_t> RecordingReader::readPayload(uint64_t bytes) {
  constexpr uint64_t piece = 1 << 20;
  std::vector<uint8_t> payload;
  while (payload.size() < bytes) {
    const size_t before = payload.size();
    payload.resize(before + static_cast<size_t>(std::min(piece, bytes - before)));
    read(payload.data() + before, payload.size() - before, false);
  }
  return payload;
}

void RecordingReader::readArray(uint64_t id, uint64_t bytes, uint64_t stored, uint64_t hash,
                                Commit& commit) {
  // zstd compresses a block of 128 KiB to 4 bytes at best.
  constexpr uint64_t bestRatio = 1 << 16;
  if (id == 0 || commit.arrays.contains(id))
    fail("array " + std::to_string(id) + " appears twice or has no number");
  if (bytes > limits_.arrayBytes || stored > ZSTD_compressBound(bytes) ||
      bytes > bestRatio * stored)
    fail("an array of " + std::to_string(bytes) + " bytes in " + std::to_string(stored));
  countBytes(bytes);
  const std::vector<uint8_t> packed = readPayload(stored);
  auto array = std::make_shared<Array>(bytes);
  const size_t size = ZSTD_decompress(array->data(), bytes, packed.data(), packed.size());
  if (ZSTD_isError(size)) fail(std::string("zstd: ") + ZSTD_getErrorName(size));
  if (size != bytes) fail("an array is shorter than it claims");
  if (XXH3_64bits(array->data(), bytes) != hash) fail("an array has a wrong checksum");
  commit.arrays.emplace(id, std::move(array));
}

void RecordingReader::readEdits(uint64_t bytes, uint64_t stored, uint64_t hash, Commit& commit) {
  if (bytes != stored || bytes > limits_.editBytes)
    fail("edits of " + std::to_string(bytes) + " bytes");
  countBytes(bytes);
  const std::vector<uint8_t> buffer = readPayload(bytes);
  if (XXH3_64bits(buffer.data(), buffer.size()) != hash) fail("the edits have a wrong checksum");
  try {
    unpackEdits(std::as_bytes(std::span(buffer)), commit.edits);
  } catch (const std::runtime_error& e) { fail(e.what()); }
}

std::shared_ptr<const Commit> RecordingReader::next() {
  auto commit = std::make_shared<Commit>();
  ChunkHeader header;
  bool begun = false;
  while (read(&header, sizeof(header), !begun)) {
    begun = true;
    if (header.reserved != 0) fail("a reserved field is not 0");
    if (header.kind == ChunkKind::Array) {
      readArray(header.id, header.bytes, header.stored, header.hash, *commit);
      continue;
    }
    if (header.kind != ChunkKind::Edits || header.id != 0) fail("an unknown kind of chunk");
    if (++commits_ > limits_.commits)
      fail("more than " + std::to_string(limits_.commits) + " commits");
    readEdits(header.bytes, header.stored, header.hash, *commit);
    try {
      validator_.check(*commit);
    } catch (const std::runtime_error& e) { fail(e.what()); }
    return commit;
  }
  return nullptr;
}

std::unique_ptr<RecordingReader> openRecording(const std::string& path,
                                               const ShaderRegistry* shaders) {
  std::FILE* file = std::fopen(path.c_str(), "rbe");
  if (!file) throw BadRecording(path + ": " + std::strerror(errno));
  return std::make_unique<RecordingReader>(file, path, shaders);
}

} // namespace openrt

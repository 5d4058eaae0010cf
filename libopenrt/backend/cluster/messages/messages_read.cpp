// messages_read.cpp: decodes frames into messages. The sender is not trusted: the flatbuffer is
// verified first, then sizes and counts are checked (checks.cpp), and only then data is copied.
// [any]
#include <algorithm>

#include <lz4.h>
#include <xxhash.h>

#include "backend/cluster/messages/messages.h"
#include "backend/cluster/messages/statistics.h"

namespace openrt::cluster {
namespace {

size_t bulkBytes(const Frames& frames) {
  size_t sum = 0;
  for (size_t i = 1; i < frames.size(); i++) sum += frames[i].size();
  return sum;
}

std::vector<std::byte> joined(Frames& frames) {
  if (frames.size() == 2) return std::move(frames[1]);
  std::vector<std::byte> bytes;
  bytes.reserve(bulkBytes(frames));
  for (size_t i = 1; i < frames.size(); i++)
    bytes.insert(bytes.end(), frames[i].begin(), frames[i].end());
  return bytes;
}

// Copies a message that has been checked.
template <class Table, class Message> void read(const Table& t, Frames&, Message& m) {
  t.UnPackTo(&m);
}

void read(const wire::Ready& t, Frames&, message::Ready& m) {
  m.epoch = t.epoch();
  m.facts.camera = t.camera();
  m.facts.lamps = t.lamps();
  m.transport = t.transport();
  m.stats = readStatistics(t.stats());
}

void read(const wire::Result& t, Frames& frames, message::Result& m) {
  m.epoch = t.epoch();
  m.lease = t.lease();
  m.seconds = t.seconds();
  m.camera = t.cameraRays();
  m.shadow = t.shadowRays();
  m.secondary = t.secondaryRays();
  if (t.faults())
    for (const wire::Fault* fault : *t.faults()) fault->UnPackTo(&m.faults.emplace_back());
  m.packed.bytes = t.bytes();
  m.packed.hash = t.hash();
  m.packed.lz4 = t.packed();
  m.packed.frames.swap(frames); // last, because the header being read lies in the frames
}

void read(const wire::Scene& t, Frames& frames, message::Scene& m) {
  m.epoch = t.epoch();
  m.whole = t.whole();
  m.prepare = t.prepare();
  if (t.arrays()) {
    m.arrays.reserve(t.arrays()->size());
    for (const wire::ArrayName* name : *t.arrays()) m.arrays.push_back(flatbuffers::UnPack(*name));
  }
  if (t.libraries())
    for (const wire::Library* library : *t.libraries())
      library->UnPackTo(&m.libraries.emplace_back());
  m.edits = joined(frames);
  demand(XXH3_64bits(m.edits.data(), m.edits.size()) == t.hash(),
         "the edits have a wrong checksum");
}

void read(const wire::Piece& t, Frames& frames, message::Piece& m) {
  t.UnPackTo(&m);
  m.data = std::move(frames[1]);
}

void read(const wire::Log& t, Frames&, message::Log& m) {
  t.UnPackTo(&m);
  m.level = std::clamp(m.level, 0, 3);
}

// Decompresses a result from its chunks. The chunk sizes follow from the total size.
std::vector<std::byte> unpackResult(const Frames& frames, uint64_t bytes) {
  constexpr uint64_t bestRatio = 255; // best compression ratio of LZ4
  const auto chunkOf = [&](size_t i) {
    return size_t(std::min<uint64_t>(limits::chunkBytes, bytes - i * limits::chunkBytes));
  };
  demand((bytes + limits::chunkBytes - 1) / limits::chunkBytes == frames.size() - 1,
         "the result has a wrong number of frames");
  for (size_t i = 0; i + 1 < frames.size(); i++)
    demand(chunkOf(i) <= bestRatio * frames[i + 1].size(),
           "the result is larger than its bytes can be");
  std::vector<std::byte> result(bytes);
  for (size_t i = 0; i + 1 < frames.size(); i++) {
    const auto& packed = frames[i + 1];
    const int size =
        LZ4_decompress_safe(reinterpret_cast<const char*>(packed.data()),
                            reinterpret_cast<char*>(result.data() + i * limits::chunkBytes),
                            int(packed.size()), int(chunkOf(i)));
    demand(size >= 0 && size_t(size) == chunkOf(i), "the result cannot be unpacked");
  }
  return result;
}

void unpackBytes(message::Result& m) {
  Frames frames = std::move(m.packed.frames);
  if (m.packed.lz4) {
    m.bytes = unpackResult(frames, m.packed.bytes);
  } else {
    demand(bulkBytes(frames) == m.packed.bytes, "the result has another size than it claims");
    m.bytes = joined(frames);
  }
  demand(XXH3_64bits(m.bytes.data(), m.bytes.size()) == m.packed.hash,
         "the result has a wrong checksum");
}

void readBody(const wire::Header& header, Frames& frames, message::Body& body) {
  const wire::Any any = header.any_type();
  demand(any != wire::Any::NONE, "an empty message");
  body.emplace<message::Unknown>();
  checkBody(header, frames);
  forEachKind([&](auto kind) {
    using Kind = decltype(kind);
    if (any != kind.any) return;
    read(*header.any_as<typename Kind::Table>(), frames, body.emplace<typename Kind::Message>());
  });
}

// Returns the size class of a kind of this version.
BulkFrames bulkFramesOf(wire::Any any) {
  BulkFrames frames = noBulk;
  forEachKind([&](auto kind) {
    if (any == kind.any) frames = kind.bulk;
  });
  return frames;
}

} // namespace

std::string verifyHeader(std::span<const std::byte> frame, uint8_t& kind) {
  // The header, its body, and the libraries.
  constexpr flatbuffers::uoffset_t depth = 4, tables = 2 + 2 * limits::libraries;
  if (frame.size() > limits::headerBytes)
    return "the header has " + std::to_string(frame.size()) + " bytes";
  const auto* bytes = reinterpret_cast<const uint8_t*>(frame.data());
  flatbuffers::Verifier verifier(bytes, frame.size(), depth, tables);
  if (!wire::VerifyHeaderBuffer(verifier)) return "the header is not valid";
  kind = uint8_t(wire::GetHeader(bytes)->any_type());
  return {};
}

std::string unpack(message::Result& result) {
  try {
    unpackBytes(result);
  } catch (const BadMessage& bad) { return "Result: " + bad.why; } catch (const std::bad_alloc&) {
    return "Result: no memory for it";
  }
  return {};
}

std::string decode(Frames&& frames, Message& out, uint64_t largestResult) {
  if (std::string why = decodePacked(std::move(frames), out, largestResult); !why.empty())
    return why;
  auto* result = std::get_if<message::Result>(&out.body);
  return result ? unpack(*result) : std::string();
}

std::string decodePacked(Frames&& frames, Message& out, uint64_t largestResult) {
  if (frames.empty() || frames.size() > limits::frames)
    return "a message of " + std::to_string(frames.size()) + " frames";
  uint8_t kind = 0;
  if (std::string why = verifyHeader(frames[0], kind); !why.empty()) return why;
  const wire::Header& header = *wire::GetHeader(frames[0].data());
  const BulkFrames expected = bulkFramesOf(header.any_type());
  const bool known = header.any_type() <= wire::Any::MAX;
  if (known && (frames.size() - 1 < expected.least || frames.size() - 1 > expected.most))
    return std::string("a ") + wire::EnumNameAny(header.any_type()) + " of " +
           std::to_string(frames.size()) + " frames";
  if (const wire::Result* result = header.any_as_Result();
      result && result->bytes() > largestResult)
    return "a result of " + std::to_string(result->bytes()) + " bytes, which no job makes";
  out.session = header.session();
  try {
    readBody(header, frames, out.body);
  } catch (const BadMessage& bad) {
    return std::string(wire::EnumNameAny(header.any_type())) + ": " + bad.why;
  } catch (const std::bad_alloc&) {
    return std::string(wire::EnumNameAny(header.any_type())) + ": no memory for it";
  }
  return {};
}

} // namespace openrt::cluster

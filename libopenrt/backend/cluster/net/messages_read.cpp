// messages_read.cpp: decodes frames into messages. The sender is not trusted: the flatbuffer is
// verified first, then sizes and counts are checked, and only then data is copied. [any]
#include <algorithm>
#include <cmath>
#include <cstring>

#include <lz4.h>
#include <xxhash.h>

#include "backend/cluster/net/messages.h"
#include "messages_generated.h"
#include "scene/transports.h"

namespace openrt::cluster {
namespace {

// Reason why a message is invalid; thrown and caught in this file.
struct Bad {
  std::string why;
};
[[noreturn]] void refuse(std::string why) { throw Bad{std::move(why)}; }
void demand(bool good, const char* why) {
  if (!good) refuse(why);
}

Hash from(const wire::Hash* hash) {
  demand(hash != nullptr, "a hash is missing");
  return {hash->low(), hash->high()};
}

// Returns the length of the UTF-8 character at the beginning (RFC 3629); 0 if it is invalid.
size_t characterAt(std::string_view text) {
  const auto byte = [&](size_t i) {
    return i < text.size() ? static_cast<uint8_t>(text[i]) : uint8_t(0);
  };
  const uint8_t first = byte(0), second = byte(1);
  const size_t length = first < 0x80   ? 1
                        : first < 0xc2 ? 0
                        : first < 0xe0 ? 2
                        : first < 0xf0 ? 3
                        : first < 0xf5 ? 4
                                       : 0;
  for (size_t i = 1; i < length; i++)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  // Overlong forms, surrogate halves, beyond Unicode.
  const bool outside = (first == 0xe0 && second < 0xa0) || (first == 0xed && second >= 0xa0) ||
                       (first == 0xf0 && second < 0x90) || (first == 0xf4 && second >= 0x90);
  return outside ? 0 : length;
}

// Replaces everything in a text that must not reach a user's terminal: control characters that move
// the cursor (C0, DEL, C1) and invalid UTF-8.
void clean(std::span<char> text) {
  for (size_t i = 0; i < text.size();) {
    const size_t length = characterAt({text.data() + i, text.size() - i});
    const auto first = static_cast<uint8_t>(text[i]),
               second = length == 2 ? static_cast<uint8_t>(text[i + 1]) : uint8_t(0);
    if (first < ' ' || first == 0x7f || (first == 0xc2 && length == 2 && second < 0xa0))
      std::fill_n(&text[i], length, ' ');
    else if (length == 0)
      text[i] = '?';
    i += std::max<size_t>(length, 1);
  }
}

std::string text(const flatbuffers::String* string) {
  if (!string) return {};
  demand(string->size() <= limits::textBytes, "a text that is too long");
  std::string result = string->str();
  clean(result);
  return result;
}

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

void read(const wire::Hello& t, Frames&, message::Hello& m) {
  m.protocol = t.protocol();
  m.library = text(t.library());
  m.api = t.api();
  m.shaderAbi = t.shaderAbi();
  m.isa = text(t.isa());
  m.kernel = text(t.kernel());
  m.platform = text(t.platform());
  m.threads = t.threads();
  m.host = text(t.host());
  m.process = t.process();
  demand(m.threads >= 1 && m.threads <= 65536, "an impossible number of threads");
}

void read(const wire::Need& t, Frames&, message::Need& m) {
  m.epoch = t.epoch();
  if (!t.arrays()) return;
  m.arrays.reserve(t.arrays()->size());
  for (const wire::Hash* hash : *t.arrays()) m.arrays.push_back(from(hash));
}

template <size_t n> void terminate(char (&text)[n]) {
  text[n - 1] = 0;
  clean({text, std::strlen(text)});
}

void read(const wire::Ready& t, Frames&, message::Ready& m) {
  m.epoch = t.epoch();
  m.facts.camera = t.camera();
  m.facts.lamps = t.lamps();
  m.transport = t.transport();
  demand(isTransport(m.transport), "an unknown transport");
  if (t.stats())
    std::memcpy(&m.stats, t.stats()->data(), std::min<size_t>(t.stats()->size(), sizeof m.stats));
  m.stats.size = sizeof m.stats;
  terminate(m.stats.isa);
  terminate(m.stats.kernel);
  terminate(m.stats.errorMethod);
  terminate(m.stats.transportReason);
}

void read(const wire::Failed& t, Frames&, message::Failed& m) {
  m.epoch = t.epoch();
  m.why = text(t.why());
}

// Decompresses a result from its chunks. The chunk sizes follow from the total size.
std::vector<std::byte> unpackResult(const Frames& frames, uint64_t bytes) {
  constexpr uint64_t bestRatio = 255; // best compression ratio of LZ4
  const auto chunkOf = [&](size_t i) {
    return size_t(std::min<uint64_t>(limits::chunkBytes, bytes - i * limits::chunkBytes));
  };
  demand((bytes + limits::chunkBytes - 1) / limits::chunkBytes == frames.size() - 1,
         "a result in a wrong number of frames");
  for (size_t i = 0; i + 1 < frames.size(); i++)
    demand(chunkOf(i) <= bestRatio * frames[i + 1].size(),
           "a result that is larger than its bytes can be");
  std::vector<std::byte> result(bytes);
  for (size_t i = 0; i + 1 < frames.size(); i++) {
    const auto& packed = frames[i + 1];
    const int size =
        LZ4_decompress_safe(reinterpret_cast<const char*>(packed.data()),
                            reinterpret_cast<char*>(result.data() + i * limits::chunkBytes),
                            int(packed.size()), int(chunkOf(i)));
    demand(size >= 0 && size_t(size) == chunkOf(i), "a result that is not packed as it should be");
  }
  return result;
}

void read(const wire::Result& t, Frames& frames, message::Result& m) {
  m.epoch = t.epoch();
  m.lease = t.lease();
  m.seconds = t.seconds();
  m.camera = t.cameraRays();
  m.shadow = t.shadowRays();
  m.secondary = t.secondaryRays();
  demand(m.seconds >= 0 && std::isfinite(m.seconds), "a result after an impossible time");
  demand(t.bytes() <= limits::resultBytes, "a result that is too large");
  if (t.faults()) {
    demand(t.faults()->size() <= limits::libraries, "too many faults");
    for (const wire::Fault* fault : *t.faults())
      m.faults.push_back(
          {text(fault->name()), text(fault->library()), fault->kind(), fault->hits()});
  }
  m.packed.bytes = t.bytes();
  m.packed.hash = t.hash();
  m.packed.lz4 = t.packed();
  m.packed.frames.swap(frames); // last, because the header being read lies in the frames
}

void unpackBytes(message::Result& m) {
  Frames frames = std::move(m.packed.frames);
  if (m.packed.lz4) {
    m.bytes = unpackResult(frames, m.packed.bytes);
  } else {
    demand(bulkBytes(frames) == m.packed.bytes, "a result of another size than it says");
    m.bytes = joined(frames);
  }
  demand(XXH3_64bits(m.bytes.data(), m.bytes.size()) == m.packed.hash,
         "a result with a wrong checksum");
}

void read(const wire::Log& t, Frames&, message::Log& m) {
  m.level = std::clamp(t.level(), 0, 3);
  m.text = text(t.text());
}

void read(const wire::Welcome& t, Frames&, message::Welcome& m) {
  m.protocol = t.protocol();
  m.session = t.session();
  m.heartbeat = t.heartbeat();
  m.silence = t.silence();
  demand(m.heartbeat >= 0.01f && m.heartbeat <= 60 && m.silence >= 0.02f && m.silence <= 600 &&
             m.heartbeat < m.silence,
         "impossible heartbeats");
}

void read(const wire::Scene& t, Frames& frames, message::Scene& m) {
  m.epoch = t.epoch();
  m.whole = t.whole();
  m.prepare = t.prepare();
  demand(m.epoch != 0 && m.epoch <= limits::epochs,
         "a scene without a number, or with too large a one");
  demand(bulkBytes(frames) <= limits::editBytes, "too many edits");
  uint64_t sum = 0;
  if (t.arrays()) {
    m.arrays.reserve(t.arrays()->size());
    for (const wire::ArrayName* name : *t.arrays()) {
      demand(name->id() != 0 && name->bytes() <= limits::arrayBytes,
             "an array without a number, or too large");
      sum += name->bytes();
      demand(sum <= limits::sceneBytes, "arrays that are too large together");
      m.arrays.push_back({name->id(), name->bytes(), {name->hash().low(), name->hash().high()}});
    }
  }
  if (t.libraries()) {
    demand(t.libraries()->size() <= limits::libraries, "too many libraries");
    for (const wire::Library* library : *t.libraries())
      m.libraries.push_back({text(library->name()), from(library->hash())});
  }
  m.edits = joined(frames);
  demand(XXH3_64bits(m.edits.data(), m.edits.size()) == t.hash(), "edits with a wrong checksum");
}

void read(const wire::Piece& t, Frames& frames, message::Piece& m) {
  m.hash = from(t.hash());
  m.bytes = t.bytes();
  m.stored = t.stored();
  m.offset = t.offset();
  const size_t here = frames[1].size();
  demand(m.bytes <= limits::arrayBytes && plausible(m.bytes, m.stored),
         "an array of an impossible size");
  demand(m.offset < m.stored && m.offset % pieceBytes == 0 &&
             here == std::min<uint64_t>(pieceBytes, m.stored - m.offset),
         "a piece that does not fit");
  m.data = std::move(frames[1]);
}

void read(const wire::Prepare& t, Frames&, message::Prepare& m) { m.epoch = t.epoch(); }

void read(const wire::Jobs& t, Frames&, message::Jobs& m) {
  m.epoch = t.epoch();
  if (!t.jobs()) return;
  demand(t.jobs()->size() <= limits::jobs, "too many jobs");
  for (const wire::Job* j : *t.jobs()) {
    using Kind = openrt::Job::Kind;
    demand(j->kind() <= uint8_t(Kind::light), "an unknown kind of job");
    demand(j->count() >= 1 && j->shift() <= 31 &&
               uint64_t(j->first()) + j->count() <= uint64_t(1) << 32,
           "an impossible job");
    LeasedJob& job = m.jobs.emplace_back();
    job.lease = j->lease();
    job.job = {Kind(j->kind()), j->centred(), j->number(),
               j->first(),      j->count(),   {j->seed(), j->shift()}};
  }
}

void read(const wire::Drop& t, Frames&, message::Drop& m) { m.epoch = t.epoch(); }
void read(const wire::Beat& t, Frames&, message::Beat& m) {
  m.sent = t.sent();
  m.answer = t.answer();
}
void read(const wire::Bye& t, Frames&, message::Bye& m) { m.why = text(t.why()); }

// Limits on the number of bulk frames of a message kind.
struct Kind {
  size_t least, most;
};
Kind framesOf(wire::Any any) {
  switch (any) {
  case wire::Any::Result:
  case wire::Any::Scene: return {1, limits::frames - 1};
  case wire::Any::Piece: return {1, 1};
  default: return {0, 0};
  }
}

void readBody(const wire::Header& header, Frames& frames, message::Body& body) {
  const auto as = [&](const auto* table, auto&& fresh) {
    demand(table != nullptr, "a message without its content");
    using Fresh = std::remove_reference_t<decltype(fresh)>;
    read(*table, frames, body.emplace<Fresh>());
  };
  using wire::Any;
  switch (header.any_type()) {
  case Any::Hello: return as(header.any_as_Hello(), message::Hello());
  case Any::Need: return as(header.any_as_Need(), message::Need());
  case Any::Ready: return as(header.any_as_Ready(), message::Ready());
  case Any::Failed: return as(header.any_as_Failed(), message::Failed());
  case Any::Result: return as(header.any_as_Result(), message::Result());
  case Any::Log: return as(header.any_as_Log(), message::Log());
  case Any::Welcome: return as(header.any_as_Welcome(), message::Welcome());
  case Any::Scene: return as(header.any_as_Scene(), message::Scene());
  case Any::Piece: return as(header.any_as_Piece(), message::Piece());
  case Any::Prepare: return as(header.any_as_Prepare(), message::Prepare());
  case Any::Jobs: return as(header.any_as_Jobs(), message::Jobs());
  case Any::Drop: return as(header.any_as_Drop(), message::Drop());
  case Any::Beat: return as(header.any_as_Beat(), message::Beat());
  case Any::Bye: return as(header.any_as_Bye(), message::Bye());
  case Any::NONE: refuse("an empty message");
  }
  body.emplace<message::Unknown>();
}

} // namespace

std::string verifyHeader(std::span<const std::byte> frame, uint8_t& kind) {
  // The header, its body, and the libraries.
  constexpr flatbuffers::uoffset_t depth = 4, tables = 2 + 2 * limits::libraries;
  if (frame.size() > limits::headerBytes)
    return "a header of " + std::to_string(frame.size()) + " bytes";
  const auto* bytes = reinterpret_cast<const uint8_t*>(frame.data());
  flatbuffers::Verifier verifier(bytes, frame.size(), depth, tables);
  if (!wire::VerifyHeaderBuffer(verifier)) return "no valid header";
  kind = uint8_t(wire::GetHeader(bytes)->any_type());
  return {};
}

std::string unpack(message::Result& result) {
  try {
    unpackBytes(result);
  } catch (const Bad& bad) { return "Result: " + bad.why; } catch (const std::bad_alloc&) {
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
  const Kind expected = framesOf(header.any_type());
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
  } catch (const Bad& bad) {
    return std::string(wire::EnumNameAny(header.any_type())) + ": " + bad.why;
  } catch (const std::bad_alloc&) {
    return std::string(wire::EnumNameAny(header.any_type())) + ": no memory for it";
  }
  return {};
}

} // namespace openrt::cluster

// messages.cpp: encodes messages into frames. Decoding: messages_read.cpp. [any]
#include "backend/cluster/net/messages.h"

#include <algorithm>
#include <cstring>

#include <lz4.h>
#include <xxhash.h>

#include "messages_generated.h"
#include "shading/registry.h"
#include "shading/running.h"

namespace openrt::cluster {
namespace {

wire::Hash to(const Hash& hash) { return {hash.low, hash.high}; }

std::string cut(std::string text) {
  if (text.size() > limits::textBytes) text.resize(limits::textBytes);
  return text;
}

// Splits bytes into frames of at most `most` bytes.
void append(Frames& frames, std::vector<std::byte>&& bytes, size_t most) {
  if (bytes.size() <= most) {
    frames.push_back(std::move(bytes));
    return;
  }
  for (size_t at = 0; at < bytes.size(); at += most) {
    const size_t end = std::min(bytes.size(), at + most);
    frames.emplace_back(bytes.begin() + ptrdiff_t(at), bytes.begin() + ptrdiff_t(end));
  }
}

// Compresses the bytes with LZ4. Returns an empty vector if that saves less than a tenth.
std::vector<std::byte> compressLz4(std::span<const std::byte> bytes) {
  const size_t most = bytes.size() - bytes.size() / 10;
  std::vector<std::byte> packed(most);
  const int size =
      LZ4_compress_default(reinterpret_cast<const char*>(bytes.data()),
                           reinterpret_cast<char*>(packed.data()), int(bytes.size()), int(most));
  packed.resize(size > 0 ? size_t(size) : 0);
  return packed;
}

// One function per message kind: fills its table and its bulk frames.
struct Encoder {
  Frames& bulk;

  wire::AnyUnion any;

  template <class T> T& make() {
    any.Set(T());
    return *static_cast<T*>(any.value);
  }

  void operator()(message::Unknown&&) {}
  void operator()(message::Hello&& m) {
    auto& t = make<wire::HelloT>();
    t.protocol = m.protocol;
    t.library = cut(m.library);
    t.api = m.api;
    t.shaderAbi = m.shaderAbi;
    t.isa = cut(m.isa);
    t.kernel = cut(m.kernel);
    t.platform = cut(m.platform);
    t.threads = m.threads;
    t.host = cut(m.host);
    t.process = m.process;
  }
  void operator()(message::Need&& m) {
    auto& t = make<wire::NeedT>();
    t.epoch = m.epoch;
    for (const Hash& hash : m.arrays) t.arrays.push_back(to(hash));
  }
  void operator()(message::Ready&& m) {
    auto& t = make<wire::ReadyT>();
    t.epoch = m.epoch;
    t.camera = m.facts.camera;
    t.lamps = m.facts.lamps;
    t.transport = m.transport;
    t.stats.resize(sizeof m.stats);
    std::memcpy(t.stats.data(), &m.stats, sizeof m.stats);
  }
  void operator()(message::Failed&& m) {
    auto& t = make<wire::FailedT>();
    t.epoch = m.epoch;
    t.why = cut(std::move(m.why));
  }
  void operator()(message::Result&& m) {
    auto& t = make<wire::ResultT>();
    t.epoch = m.epoch;
    t.lease = m.lease;
    t.seconds = m.seconds;
    t.cameraRays = m.camera;
    t.shadowRays = m.shadow;
    t.secondaryRays = m.secondary;
    for (message::Fault& fault : m.faults) {
      auto& f = *t.faults.emplace_back(std::make_unique<wire::FaultT>());
      f.name = cut(std::move(fault.name));
      f.library = cut(std::move(fault.library));
      f.kind = fault.kind;
      f.hits = fault.hits;
    }
    t.bytes = m.bytes.size();
    t.hash = XXH3_64bits(m.bytes.data(), m.bytes.size());
    Frames packed;
    for (size_t at = 0; at < m.bytes.size(); at += limits::chunkBytes) {
      packed.push_back(compressLz4(
          std::span(m.bytes).subspan(at, std::min(limits::chunkBytes, m.bytes.size() - at))));
      if (packed.back().empty()) break; // all chunks are compressed, or none
    }
    t.packed = !packed.empty() && !packed.back().empty();
    if (t.packed)
      bulk = std::move(packed);
    else
      append(bulk, std::move(m.bytes), limits::chunkBytes);
  }
  void operator()(message::Log&& m) {
    auto& t = make<wire::LogT>();
    t.level = m.level;
    t.text = cut(std::move(m.text));
  }
  void operator()(message::Welcome&& m) {
    auto& t = make<wire::WelcomeT>();
    t.protocol = m.protocol;
    t.session = m.session;
    t.heartbeat = m.heartbeat;
    t.silence = m.silence;
  }
  void operator()(message::Scene&& m) {
    auto& t = make<wire::SceneT>();
    t.epoch = m.epoch;
    t.whole = m.whole;
    t.prepare = m.prepare;
    for (const message::ArrayName& name : m.arrays)
      t.arrays.emplace_back(name.id, name.bytes, to(name.hash));
    for (message::Library& library : m.libraries) {
      auto& l = *t.libraries.emplace_back(std::make_unique<wire::LibraryT>());
      l.name = cut(std::move(library.name));
      l.hash = std::make_unique<wire::Hash>(to(library.hash));
    }
    t.hash = XXH3_64bits(m.edits.data(), m.edits.size());
    append(bulk, std::move(m.edits), largestMessage);
  }
  void operator()(message::Piece&& m) {
    auto& t = make<wire::PieceT>();
    t.hash = std::make_unique<wire::Hash>(to(m.hash));
    t.bytes = m.bytes;
    t.stored = m.stored;
    t.offset = m.offset;
    bulk.push_back(std::move(m.data));
  }
  void operator()(message::Prepare&& m) { make<wire::PrepareT>().epoch = m.epoch; }
  void operator()(message::Jobs&& m) {
    auto& t = make<wire::JobsT>();
    t.epoch = m.epoch;
    for (const LeasedJob& l : m.jobs) {
      const openrt::Job& j = l.job;
      t.jobs.emplace_back(l.lease, j.replicates.seed, j.number, j.first, j.count, uint8_t(j.kind),
                          j.centred, uint8_t(j.replicates.shift));
    }
  }
  void operator()(message::Drop&& m) { make<wire::DropT>().epoch = m.epoch; }
  void operator()(message::Beat&& m) {
    auto& t = make<wire::BeatT>();
    t.sent = m.sent;
    t.answer = m.answer;
  }
  void operator()(message::Bye&& m) { make<wire::ByeT>().why = cut(std::move(m.why)); }
};

} // namespace

Frames encode(uint64_t session, message::Body&& body) {
  Frames bulk;
  Encoder encoder{bulk, {}};
  std::visit([&](auto&& m) { encoder(std::move(m)); }, std::move(body));
  wire::HeaderT header;
  header.session = session;
  header.any = std::move(encoder.any);
  flatbuffers::FlatBufferBuilder builder;
  wire::FinishHeaderBuffer(builder, wire::Header::Pack(builder, &header));
  const auto* begin = reinterpret_cast<const std::byte*>(builder.GetBufferPointer());
  Frames frames;
  frames.reserve(1 + bulk.size());
  frames.emplace_back(begin, begin + builder.GetSize());
  for (auto& frame : bulk) frames.push_back(std::move(frame));
  return frames;
}

std::vector<message::Fault> faultsOf(const ShaderFaults& faults) {
  std::vector<message::Fault> result;
  for (const auto& entry : faults.entries()) {
    const std::string label = labelOf(*entry.shaderClass); // has the form "CLASS of LIBRARY"
    const size_t at = label.rfind(" of ");
    result.push_back({entry.shaderClass->name, at == label.npos ? "" : label.substr(at + 4),
                      uint8_t(entry.fault), entry.hits});
  }
  return result;
}

ShaderFaults faultsFrom(std::span<const message::Fault> faults, const ShaderRegistry& shaders) {
  ShaderFaults result;
  for (const message::Fault& fault : faults) {
    const RtsClass* shaderClass = shaders.loaded(fault.name, fault.library);
    if (shaderClass && fault.kind <= uint8_t(Fault::undeclaredScattering))
      result.add(*shaderClass, Fault(fault.kind), fault.hits);
  }
  return result;
}

} // namespace openrt::cluster

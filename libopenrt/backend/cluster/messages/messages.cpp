// messages.cpp: encodes messages into frames. Decoding: messages_read.cpp. [any]
#include "backend/cluster/messages/messages.h"

#include <algorithm>

#include <lz4.h>
#include <xxhash.h>

#include "backend/cluster/messages/statistics.h"
#include "shading/registry.h"
#include "shading/running.h"

namespace openrt::cluster {
namespace {

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

using Builder = flatbuffers::FlatBufferBuilder;

// Writes a message as the object API does, without bulk frames.
template <class Message> auto write(Builder& builder, Message&& m, Frames&) {
  return Message::TableType::Pack(builder, &m);
}

template <class T> auto writeAll(Builder& builder, const std::vector<T>& elements) {
  std::vector<flatbuffers::Offset<typename T::TableType>> offsets;
  for (const T& element : elements) offsets.push_back(T::TableType::Pack(builder, &element));
  return offsets.empty() ? 0 : builder.CreateVector(offsets);
}

auto write(Builder& builder, message::Ready&& m, Frames&) {
  const auto stats = writeStatistics(builder, m.stats);
  return wire::CreateReady(builder, m.epoch, m.facts.camera, m.facts.lamps, m.transport, stats);
}

auto write(Builder& builder, message::Result&& m, Frames& bulk) {
  const size_t bytes = m.bytes.size();
  const uint64_t hash = XXH3_64bits(m.bytes.data(), bytes);
  Frames packed;
  for (size_t at = 0; at < bytes; at += limits::chunkBytes) {
    packed.push_back(
        compressLz4(std::span(m.bytes).subspan(at, std::min(limits::chunkBytes, bytes - at))));
    if (packed.back().empty()) break; // all chunks are compressed, or none
  }
  const bool lz4 = !packed.empty() && !packed.back().empty();
  if (lz4)
    bulk = std::move(packed);
  else
    append(bulk, std::move(m.bytes), limits::chunkBytes);
  const auto faults = writeAll(builder, m.faults);
  return wire::CreateResult(builder, m.epoch, m.lease, m.seconds, bytes, lz4, hash, m.camera,
                            m.shadow, m.secondary, faults);
}

auto write(Builder& builder, message::Scene&& m, Frames& bulk) {
  flatbuffers::Offset<flatbuffers::Vector<const wire::ArrayName*>> arrays;
  if (!m.arrays.empty()) arrays = builder.CreateVectorOfNativeStructs<wire::ArrayName>(m.arrays);
  const auto libraries = writeAll(builder, m.libraries);
  const uint64_t hash = XXH3_64bits(m.edits.data(), m.edits.size());
  append(bulk, std::move(m.edits), largestMessage);
  return wire::CreateScene(builder, m.epoch, m.whole, m.prepare, arrays, libraries, hash);
}

auto write(Builder& builder, message::Piece&& m, Frames& bulk) {
  bulk.push_back(std::move(m.data));
  return wire::Piece::Pack(builder, &m);
}

} // namespace

Frames encode(uint64_t session, message::Body&& body) {
  Frames frames(1); // room for the header, which is finished last
  Frames bulk;
  Builder builder;
  flatbuffers::Offset<void> table;
  forEachKind([&](auto kind) {
    if (auto* m = std::get_if<typename decltype(kind)::Message>(&body))
      table = write(builder, std::move(*m), bulk).Union();
  });
  wire::FinishHeaderBuffer(builder,
                           wire::CreateHeader(builder, session, wire::Any(body.index()), table));
  const auto* begin = reinterpret_cast<const std::byte*>(builder.GetBufferPointer());
  frames[0].assign(begin, begin + builder.GetSize());
  for (auto& frame : bulk) frames.push_back(std::move(frame));
  return frames;
}

std::vector<message::Fault> faultsOf(const ShaderFaults& faults) {
  std::vector<message::Fault> result;
  for (const auto& entry : faults.entries()) {
    const std::string label = labelOf(*entry.shaderClass); // has the form "CLASS of LIBRARY"
    const size_t at = label.rfind(" of ");
    result.push_back({.name = entry.shaderClass->name,
                      .library = at == label.npos ? "" : label.substr(at + 4),
                      .kind = uint8_t(entry.fault),
                      .hits = entry.hits});
  }
  return result;
}

ShaderFaults faultsFrom(std::span<const message::Fault> faults, const ShaderRegistry& shaders) {
  ShaderFaults result;
  for (const message::Fault& fault : faults) {
    const RtsClass* shaderClass = shaders.loaded(fault.name, fault.library);
    if (shaderClass && fault.kind <= uint8_t(Fault::neverEntered))
      result.add(*shaderClass, Fault(fault.kind), fault.hits);
  }
  return result;
}

} // namespace openrt::cluster

#include "backend/record/edits_bytes.h"

#include <cstring>
#include <stdexcept>

namespace openrt {
namespace {

// Returns the least number of bytes that the edits take once unpacked. Several references in a
// flatbuffer may point to the same table, so a small file could otherwise unpack to any size. For
// buffers made by packEdits, this count never exceeds the buffer size.
uint64_t unpackedBytes(const edit::Edits& edits) {
  constexpr uint64_t perTable = 8;
  uint64_t bytes = 0;
  if (!edits.edits()) return 0;
  for (const edit::Edit* entry : *edits.edits()) {
    bytes += perTable;
    if (!entry->any()) continue;
    if (const auto* parameter = entry->any_as_Parameter()) {
      if (parameter->floats()) bytes += sizeof(float) * uint64_t(parameter->floats()->size());
      if (parameter->text()) bytes += parameter->text()->size();
    } else if (const auto* shaderClass = entry->any_as_ShaderClass()) {
      if (shaderClass->name()) bytes += shaderClass->name()->size();
      if (shaderClass->library()) bytes += shaderClass->library()->size();
    } else if (const auto* object = entry->any_as_Object()) {
      if (!object->geometries()) continue;
      bytes += sizeof(edit::Matrix) * uint64_t(object->geometries()->size());
      for (const edit::Geometry* geometry : *object->geometries())
        if (geometry && geometry->parameters())
          bytes += perTable * uint64_t(geometry->parameters()->size());
    }
  }
  return bytes;
}

} // namespace

std::vector<std::byte> packEdits(const edit::EditsT& edits) {
  flatbuffers::FlatBufferBuilder builder;
  edit::FinishEditsBuffer(builder, edit::Edits::Pack(builder, &edits));
  std::vector<std::byte> bytes(builder.GetSize());
  std::memcpy(bytes.data(), builder.GetBufferPointer(), bytes.size());
  return bytes;
}

void unpackEdits(std::span<const std::byte> bytes, edit::EditsT& edits) {
  constexpr flatbuffers::uoffset_t depth = 8, bytesPerTable = 8;
  const auto* buffer = reinterpret_cast<const uint8_t*>(bytes.data());
  flatbuffers::Verifier verifier(
      buffer, bytes.size(), depth,
      static_cast<flatbuffers::uoffset_t>(bytes.size() / bytesPerTable + 1));
  if (!edit::VerifyEditsBuffer(verifier))
    throw std::runtime_error("the edits are not a valid flatbuffer");
  const edit::Edits& packed = *edit::GetEdits(buffer);
  if (unpackedBytes(packed) > bytes.size()) throw std::runtime_error("the edits share their parts");
  packed.UnPackTo(&edits);
}

} // namespace openrt

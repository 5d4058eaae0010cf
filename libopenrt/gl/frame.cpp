// frame.cpp: Compares chunks, parts and materials: by hash first, then by bytes.
#include "gl/frame.h"

#include <algorithm>
#include <cstring>
#include <string_view>

namespace rtgl {

size_t hashOf(const void* bytes, size_t count) {
  return std::hash<std::string_view>()({static_cast<const char*>(bytes), count});
}

void Chunk::finish() {
  const auto differs = [&](const Vertex& v) { return v.color != vertices.front().color; };
  const bool inheritsAll = inheritsColor == vertices.size();
  colorsVary =
      !inheritsAll && (inheritsColor > 0 || std::any_of(vertices.begin(), vertices.end(), differs));
  if (!colorsVary && !vertices.empty()) {
    color = vertices.front().color;
    for (Vertex& v : vertices) v.color = {1, 1, 1, 1};
  }
  hash = hashOf(vertices.data(), vertices.size() * sizeof(Vertex)) + mode;
}

std::shared_ptr<const Chunk> Chunk::resolved(const Current& current) const {
  if (resolved_ && resolvedFor_ == current) return resolved_;
  auto copy = std::make_shared<Chunk>(*this);
  for (size_t i = 0; i < inheritsNormal; i++) copy->vertices[i].normal = current.normal;
  for (size_t i = 0; i < inheritsTexCoord; i++) copy->vertices[i].texCoord = current.texCoord;
  if (colorsVary)
    for (size_t i = 0; i < inheritsColor; i++) copy->vertices[i].color = current.color;
  copy->resolved_ = nullptr;
  copy->hash = hashOf(copy->vertices.data(), copy->vertices.size() * sizeof(Vertex)) + mode;
  resolved_ = copy;
  resolvedFor_ = current;
  return copy;
}

bool Chunk::operator==(const Chunk& other) const {
  return this == &other ||
         (hash == other.hash && mode == other.mode && vertices.size() == other.vertices.size() &&
          std::memcmp(vertices.data(), other.vertices.data(), vertices.size() * sizeof(Vertex)) ==
              0);
}

size_t Part::hash() const {
  const size_t flags = flat + 2u * colored + 4u * lit + 8u * textured + 16u * cull;
  return chunk->hash * 31 + flags * 7 + cullFace + 3 * frontFace + 5 * polygonMode[0] +
         11 * polygonMode[1];
}

bool Part::operator==(const Part& o) const {
  return flat == o.flat && colored == o.colored && lit == o.lit && textured == o.textured &&
         cull == o.cull && cullFace == o.cullFace && frontFace == o.frontFace &&
         polygonMode == o.polygonMode && lineWidth == o.lineWidth && pointSize == o.pointSize &&
         *chunk == *o.chunk;
}

bool Material::operator==(const Material& other) const {
  return std::memcmp(this, &other, sizeof(Material)) == 0;
}

size_t Material::hash() const { return hashOf(this, sizeof(Material)); }

} // namespace rtgl

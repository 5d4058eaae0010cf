// vertex_buffer.cpp: Grows the vertex buffer and changes its layout. Every function allocates its
// memory before it changes anything.
#include "api/geometry/vertex_buffer.h"

#include <algorithm>
#include <cstring>
#include <new>

namespace openrt {
namespace {
constexpr size_t maxVertices = size_t(1) << 31; // half of the range of 32-bit indices
}

VertexBuffer::Floats VertexBuffer::grown(const Floats& old, size_t components,
                                         size_t capacity) const {
  Floats fresh = std::make_unique_for_overwrite<float[]>(components * capacity);
  if (old) std::copy_n(old.get(), components * count_, fresh.get());
  return fresh;
}

void VertexBuffer::reserve(size_t capacity) {
  if (capacity > maxVertices) throw std::bad_alloc();
  Floats points = grown(points_, 3, capacity);
  Floats normals = attributes_ & HasNormal ? grown(normals_, 3, capacity) : nullptr;
  Floats texCoords = attributes_ & HasTexCoord ? grown(texCoords_, 2, capacity) : nullptr;
  Floats colors = attributes_ & HasColor ? grown(colors_, 4, capacity) : nullptr;
  Floats fogCoords = attributes_ & HasFogCoord ? grown(fogCoords_, 1, capacity) : nullptr;
  Floats parameters =
      attributes_ & HasParameters ? grown(parameters_, parameterFloats_, capacity) : nullptr;
  parameters_ = std::move(parameters);
  points_ = std::move(points);
  normals_ = std::move(normals);
  texCoords_ = std::move(texCoords);
  colors_ = std::move(colors);
  fogCoords_ = std::move(fogCoords);
  capacity_ = capacity;
}

void VertexBuffer::addAttributes(uint8_t attributes) {
  const uint8_t added = attributes & static_cast<uint8_t>(~attributes_);
  Floats normals =
      added & HasNormal ? std::make_unique_for_overwrite<float[]>(3 * capacity_) : nullptr;
  Floats texCoords =
      added & HasTexCoord ? std::make_unique_for_overwrite<float[]>(2 * capacity_) : nullptr;
  Floats colors =
      added & HasColor ? std::make_unique_for_overwrite<float[]>(4 * capacity_) : nullptr;
  Floats fogCoords =
      added & HasFogCoord ? std::make_unique_for_overwrite<float[]>(capacity_) : nullptr;
  const VertexState unset;
  if (added & HasNormal) {
    std::fill_n(normals.get(), 3 * count_, unset.normal[0]);
    normals_ = std::move(normals);
  }
  if (added & HasTexCoord) {
    std::fill_n(texCoords.get(), 2 * count_, unset.texCoord[0]);
    texCoords_ = std::move(texCoords);
  }
  if (added & HasColor) {
    std::fill_n(colors.get(), 4 * count_, unset.color[0]);
    colors_ = std::move(colors);
  }
  if (added & HasFogCoord) {
    std::fill_n(fogCoords.get(), count_, unset.fogCoord);
    fogCoords_ = std::move(fogCoords);
  }
  attributes_ |= added;
}

void VertexBuffer::addParameters(const float* values, size_t count) {
  const size_t wide = parameterFloats_ + count;
  Floats parameters = std::make_unique_for_overwrite<float[]>(wide * capacity_);
  for (size_t i = 0; i < count_; i++) {
    if (parameterFloats_)
      std::copy_n(parameters_.get() + parameterFloats_ * i, parameterFloats_,
                  parameters.get() + wide * i);
    std::copy_n(values, count, parameters.get() + wide * i + parameterFloats_);
  }
  parameters_ = std::move(parameters);
  parameterFloats_ = wide;
  attributes_ |= HasParameters;
}

void VertexBuffer::restart(uint8_t attributes, size_t parameterFloats) {
  Floats parameters = parameterFloats
                          ? std::make_unique_for_overwrite<float[]>(parameterFloats * capacity_)
                          : nullptr;
  parameters_ = std::move(parameters);
  parameterFloats_ = parameterFloats;
  count_ = 0;
  addAttributes(attributes);
  attributes_ = attributes;
  if (!(attributes & HasNormal)) normals_.reset();
  if (!(attributes & HasTexCoord)) texCoords_.reset();
  if (!(attributes & HasColor)) colors_.reset();
  if (!(attributes & HasFogCoord)) fogCoords_.reset();
}

void VertexBuffer::dropFront(size_t n) {
  const size_t rest = count_ - n;
  const auto shift = [n, rest](const Floats& data, size_t components) {
    if (data)
      std::memmove(data.get(), data.get() + components * n, components * rest * sizeof(float));
  };
  shift(points_, 3);
  shift(normals_, 3);
  shift(texCoords_, 2);
  shift(colors_, 4);
  shift(fogCoords_, 1);
  shift(parameters_, parameterFloats_);
  count_ = rest;
}

ArrayPtr VertexBuffer::copy(const float* data, size_t floats) {
  auto array = std::make_shared<Array>(floats * sizeof(float));
  if (floats) std::memcpy(array->data(), data, floats * sizeof(float));
  return array;
}

} // namespace openrt

// vertex_buffer.h: Holds the vertices between rtBegin and rtEnd. All attributes have the same
// capacity, so appending a vertex takes one comparison and a few stores. Used on the application's
// thread.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>

#include "scene/commit.h"

namespace openrt {

enum Attribute : uint8_t {
  HasNormal = 1,
  HasTexCoord = 2,
  HasColor = 4,
  HasParameters = 8,
  HasFogCoord = 16
};

// The current attributes, which the next vertex gets.
struct VertexState {
  float normal[3] = {0, 0, 0}; // 0 0 0: the geometric normal of the face
  float texCoord[2] = {0, 0};
  float color[4] = {1, 1, 1, 1};
  float fogCoord = 0;
  // Parameter values for the latched shader: VertexBuffer::parameterFloats() floats
  // (HasParameters).
  const float* parameters = nullptr;
  uint8_t present = 0; // Attribute bits that were set since the object's definition began
};

class VertexBuffer {
 public:
  size_t count() const { return count_; }
  uint8_t attributes() const { return attributes_; }
  const float* points() const { return points_.get(); }
  float* points() { return points_.get(); }

  // Appends a vertex; state.present must equal attributes(). If it throws std::bad_alloc, nothing
  // is changed.
  void append(float x, float y, float z, const VertexState& state) {
    if (count_ == capacity_) [[unlikely]]
      reserve(capacity_ ? 2 * capacity_ : 256);
    float* p = points_.get() + 3 * count_;
    p[0] = x;
    p[1] = y;
    p[2] = z;
    if (attributes_) appendAttributes(state);
    count_++;
  }

  // Adds attributes. Existing vertices get their default values.
  void addAttributes(uint8_t attributes);
  // Appends `count` floats to the shader parameters of every vertex. Existing vertices get these
  // values.
  void addParameters(const float* values, size_t count);
  // Removes all vertices and sets attributes and parameter floats; keeps the allocated memory.
  void restart(uint8_t attributes, size_t parameterFloats);
  // Removes the first n vertices.
  void dropFront(size_t n);
  void truncate(size_t n) { count_ = n; }

  // These copy an attribute of the first n vertices; null if the attribute is absent.
  ArrayPtr copyPoints(size_t n) const { return copy(points_.get(), 3 * n); }
  ArrayPtr copyNormals(size_t n) const {
    return attributes_ & HasNormal ? copy(normals_.get(), 3 * n) : nullptr;
  }
  ArrayPtr copyTexCoords(size_t n) const {
    return attributes_ & HasTexCoord ? copy(texCoords_.get(), 2 * n) : nullptr;
  }
  ArrayPtr copyColors(size_t n) const {
    return attributes_ & HasColor ? copy(colors_.get(), 4 * n) : nullptr;
  }
  ArrayPtr copyFogCoords(size_t n) const {
    return attributes_ & HasFogCoord ? copy(fogCoords_.get(), n) : nullptr;
  }
  size_t parameterFloats() const { return parameterFloats_; }
  const float* parameters(size_t vertex) const {
    return parameters_.get() + parameterFloats_ * vertex;
  }

 private:
  using Floats = std::unique_ptr<float[]>;
  void appendAttributes(const VertexState& state) {
    if (attributes_ & HasNormal) {
      float* n = normals_.get() + 3 * count_;
      n[0] = state.normal[0];
      n[1] = state.normal[1];
      n[2] = state.normal[2];
    }
    if (attributes_ & HasTexCoord) {
      float* t = texCoords_.get() + 2 * count_;
      t[0] = state.texCoord[0];
      t[1] = state.texCoord[1];
    }
    if (attributes_ & HasColor) {
      float* c = colors_.get() + 4 * count_;
      c[0] = state.color[0];
      c[1] = state.color[1];
      c[2] = state.color[2];
      c[3] = state.color[3];
    }
    if (attributes_ & HasFogCoord) fogCoords_[count_] = state.fogCoord;
    if (attributes_ & HasParameters)
      std::copy_n(state.parameters, parameterFloats_,
                  parameters_.get() + parameterFloats_ * count_);
  }
  void reserve(size_t capacity);
  Floats grown(const Floats& old, size_t components, size_t capacity) const;
  static ArrayPtr copy(const float* data, size_t floats);

  size_t count_ = 0, capacity_ = 0, parameterFloats_ = 0;
  uint8_t attributes_ = 0;
  Floats points_, normals_, texCoords_, colors_, fogCoords_, parameters_;
};

} // namespace openrt

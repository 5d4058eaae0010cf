// object_builder.h: the geometry of the object being defined, from begin/end, arrays and analytic
// shapes. Consecutive begin/end lists with the same state become one geometry. Application thread.
//
// Vertices given in double that float cannot hold are stored relative to a local origin, which goes
// into the geometry's matrix. The origin is a multiple of the power of two above the extent, so
// coordinates that are short binary fractions stay exact. A later list joins such a geometry only
// while its distance from the origin is at most 64 of its own extents: the rounding of float then
// stays below 2^-18 of the list's size.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "api/geometry/primitives.h"
#include "api/geometry/vertex_buffer.h"
#include "openrt/openrts.h"
#include "scene/matrix.h"

namespace openrt {

// What is latched when a list begins, apart from its vertices.
struct GeometryState {
  uint32_t shader = 0, name = 0;
  Matrix4d matrix;
  bool cull = false, clockwise = false;
  float width = 1;
  bool operator==(const GeometryState& other) const {
    return shader == other.shader && name == other.name && cull == other.cull &&
           clockwise == other.clockwise && width == other.width && matrix.m == other.matrix.m;
  }
};

// Where a draw call finds one attribute.
struct AttributeSource {
  const std::byte* data = nullptr;
  size_t stride = 0; // bytes
  int components = 0;
  RTenum type = RT_FLOAT;
};

// A shader parameter that geometry has values of its own for.
struct OwnParameter {
  uint32_t index = 0; // in the class's table
  size_t floats = 0;
  bool perVertex = false; // else by triangle, segment or point
};

// One that a draw call finds in an array.
struct ParameterSource {
  OwnParameter parameter;
  const RtsParam* declared = nullptr;
  AttributeSource source;
};

struct DrawCall {
  RTenum mode = RT_TRIANGLES;
  size_t count = 0, vertexCount = 0;
  const uint32_t* indices = nullptr; // null: 0, 1, 2 ...
  AttributeSource points, normals, texCoords, colors;
  std::vector<ParameterSource> parameters;
};

struct BuiltParameter {
  uint32_t index = 0;
  bool perVertex = false;
  ArrayPtr values;
};

// A geometry with its arrays, before they have numbers.
struct BuiltGeometry {
  GeometryState state;
  edit::Primitive primitive = edit::Primitive::Triangles;
  ArrayPtr points, indices, normals, texCoords, colors;
  std::vector<BuiltParameter> parameters;
};

class ObjectBuilder {
 public:
  VertexState current;

  void begin(RTenum mode, const GeometryState& state);
  bool inList() const { return inList_; }
  void vertex(float x, float y, float z) {
    if (!inList_ || !((x - x) + (y - y) + (z - z) == 0)) [[unlikely]]
      rejectVertex();
    if (current.present != vertices_.attributes()) [[unlikely]]
      adaptAttributes();
    if (wideList_) [[unlikely]]
      appendWide(x, y, z);
    vertices_.append(x, y, z, current);
  }
  void vertex(double x, double y, double z);
  void end();
  // Within a list: the value of a parameter of the latched shader for the vertices or triangles
  // that follow, also those of later lists with that shader. own: the shader's value, which the
  // list's vertices had until now.
  void parameter(const OwnParameter& which, std::span<const float> value,
                 std::span<const float> own);
  uint32_t listShader() const { return state_.shader; }

  void draw(const DrawCall& call, const GeometryState& state);
  void sphere(float radius, const GeometryState& state);

  uint64_t degenerate() const { return degenerate_; }
  // Closes the object and hands its geometry over.
  std::vector<BuiltGeometry> finish();

 private:
  [[noreturn]] void rejectVertex() const;
  void adaptAttributes();
  void appendWide(double x, double y, double z);
  void widenList();
  void settleOrigin();
  void storeRelative(const Vec3d& origin);
  void flush(size_t vertexCount);
  void addParameters(BuiltGeometry& built, size_t vertexCount) const;

  std::vector<BuiltGeometry> done_;
  // The open geometry: state, vertices and indices of lists that may still grow.
  bool open_ = false, local_ = false;
  GeometryState state_;
  edit::Primitive primitive_ = edit::Primitive::Triangles;
  Vec3d origin_;
  VertexBuffer vertices_;
  std::vector<uint32_t> indices_;
  // Values that were set for parameters of a shader since the object began: of each parameter in a
  // row.
  struct Latched {
    std::vector<OwnParameter> layout;
    std::vector<float> values;
  };
  std::map<uint32_t, Latched> latched_; // by shader
  std::vector<OwnParameter> layout_;    // of the open geometry
  std::vector<uint32_t> completing_; // of the open geometry: vertex that completes each primitive,
                                     // if layout_ is not empty
  // The list between begin and end.
  bool inList_ = false, wideList_ = false;
  RTenum mode_ = RT_POINTS;
  size_t listStart_ = 0;
  std::vector<Vec3d> wide_; // the list's vertices as given, once one came in double
  uint64_t degenerate_ = 0;
};

// Bounds of points in double, and whether float holds all of them exactly.
struct WideBounds {
  Vec3d low, high;
  bool exact = true, any = false;
  void add(const Vec3d& p);
  // The origin for points within these bounds, and the largest distance along an axis of any of
  // them from a place.
  Vec3d origin() const;
  double reach(const Vec3d& from) const;
};

// Largest coordinate accepted in double: differences of two stay within float's range.
inline constexpr double maxCoordinate = 1e38;

// Geometry of one draw call; no value where every primitive is degenerate. (draw.cpp)
std::optional<BuiltGeometry> buildDraw(const DrawCall& call, const GeometryState& state,
                                       const VertexState& current, uint64_t& degenerate);

} // namespace openrt

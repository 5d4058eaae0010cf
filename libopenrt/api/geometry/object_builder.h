// object_builder.h: builds the geometry of the object being defined from rtBegin/rtEnd lists, array
// draw calls and spheres. Consecutive lists with the same state are merged into one geometry. Draw
// calls with the same values, such as those of equal boxes, share their arrays. Used on the
// application's thread.
//
// Vertices in double that float cannot represent are stored relative to a local origin, which
// becomes part of the geometry's matrix. The origin is a multiple of the power of two above the
// extent, so coordinates that are short binary fractions stay exact. A later list is merged into
// such a geometry only if its distance from the origin is at most 64 times its own extent. The
// rounding to float is then below 2^-18 of the list's size.
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
#include "scene/array_blocks.h"
#include "scene/matrix.h"
#include "scene/stipple.h"

namespace openrt {

// The state that a list or draw call takes from the context when it begins.
struct GeometryState {
  uint32_t shader = 0, name = 0;
  Matrix4d matrix;
  bool cull = false, clockwise = false;
  float width = 1;
  edit::TexGen texGen = edit::TexGen::Off;
  Stipple stipple; // dashes, where it is lines
  bool operator==(const GeometryState& other) const {
    return shader == other.shader && name == other.name && cull == other.cull &&
           clockwise == other.clockwise && width == other.width && texGen == other.texGen &&
           stipple == other.stipple && matrix.m == other.matrix.m;
  }
};

// The array of one attribute of a draw call.
struct AttributeSource {
  const std::byte* data = nullptr;
  size_t stride = 0; // bytes from one element to the next
  int components = 0;
  RTenum type = RT_FLOAT;
};

// A shader parameter whose value varies over a geometry.
struct VaryingParameter {
  uint32_t index = 0;     // index in the class's parameter table
  size_t floats = 0;      // number of floats of its type
  bool perVertex = false; // false: per triangle, segment or point
};

// A varying parameter of a draw call, with its array.
struct ParameterSource {
  VaryingParameter parameter;
  const RtsParam* declared = nullptr;
  AttributeSource source;
};

struct DrawCall {
  RTenum mode = RT_TRIANGLES;
  size_t count = 0, vertexCount = 0;
  const uint32_t* indices = nullptr; // vertex indices; null stands for 0, 1, 2 ...
  AttributeSource points, normals, texCoords, colors, fogCoords;
  std::vector<ParameterSource> parameters;
  ArrayPtr formerIndices; // an array that is used if its bytes are those of the indices; or null
};

struct BuiltParameter {
  uint32_t index = 0;
  bool perVertex = false;
  ArrayPtr values;
};

// A finished geometry with its arrays, which get their ids at commit.
struct BuiltGeometry {
  GeometryState state;
  edit::Primitive primitive = edit::Primitive::Triangles;
  ArrayPtr points, indices, normals, texCoords, colors, fogCoords;
  std::vector<BuiltParameter> parameters;
  std::vector<double> surface; // numbers of a quadric or an asphere
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
  // Sets, inside a list, a parameter of the latched shader for the following vertices or triangles,
  // also in later lists with that shader. own: the shader's value, which applies to the vertices
  // before.
  void parameter(const VaryingParameter& which, std::span<const float> value,
                 std::span<const float> own);
  uint32_t listShader() const { return state_.shader; }

  void draw(const DrawCall& call, const GeometryState& state);
  void sphere(float radius, const GeometryState& state);
  // Adds a quadric or an asphere with the numbers of AnalyticSurface.
  void analytic(edit::Primitive kind, std::vector<double> numbers, const GeometryState& state);

  uint64_t degenerate() const { return degenerate_; }
  // Ends the object and returns its geometry.
  std::vector<BuiltGeometry> finish();

 private:
  [[noreturn]] void rejectVertex() const;
  void adaptAttributes();
  void appendWide(double x, double y, double z);
  void widenList();
  void chooseOrigin();
  void storeRelative(const Vec3d& origin);
  void flush(size_t vertexCount);
  void addParameters(BuiltGeometry& built, size_t vertexCount) const;
  void shareArrays(BuiltGeometry& built);

  std::vector<BuiltGeometry> done_;
  // Recent arrays of draw calls, each at its hash modulo the size, which is fixed.
  std::vector<ArrayPtr> recent_;
  ArrayBlocks blocks_; // for the small arrays of objects with many draw calls
  // The open geometry: state, vertices and indices of the lists merged so far.
  bool open_ = false, local_ = false;
  GeometryState state_;
  edit::Primitive primitive_ = edit::Primitive::Triangles;
  Vec3d origin_;
  VertexBuffer vertices_;
  std::vector<uint32_t> indices_;
  // The parameter values set for one shader since the object began, parameter after parameter.
  struct Latched {
    std::vector<VaryingParameter> layout;
    std::vector<float> values;
  };
  std::map<uint32_t, Latched> latched_;  // latched values, by shader
  std::vector<VaryingParameter> layout_; // parameters of the open geometry
  // If layout_ is not empty: the vertex that completes each primitive of the open geometry.
  std::vector<uint32_t> completing_;
  // The list between begin and end.
  bool inList_ = false, wideList_ = false;
  RTenum mode_ = RT_POINTS;
  size_t listStart_ = 0;
  std::vector<Vec3d> wide_; // the list's vertices in double, if any of them was given in double
  uint64_t degenerate_ = 0;
};

// Bounds of points in double, and whether float represents all of them exactly.
struct WideBounds {
  Vec3d low, high;
  bool exact = true, any = false;
  void add(const Vec3d& p);
  // origin() returns the local origin for points in these bounds. reach() returns their largest
  // distance from a point along any axis.
  Vec3d origin() const;
  double reach(const Vec3d& from) const;
};

// Largest coordinate accepted in double: the difference of two stays in the range of float.
inline constexpr double maxCoordinate = 1e38;

// Builds the geometry of one draw call. Returns no value if every primitive is degenerate
// (draw.cpp).
std::optional<BuiltGeometry> buildDraw(const DrawCall& call, const GeometryState& state,
                                       const VertexState& current, uint64_t& degenerate);

} // namespace openrt

// mesh.h: what a geometry node becomes: flat arrays that the OpenRT mapper hands on. Built by pure
// functions, one file a node, on the caller's thread; what is degenerate or out of range is dropped
// with one warning a node.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "xvrml/diagnostics.h"
#include "xvrml/limits.h"
#include "xvrml/types.h"

namespace xvrml {

struct Color4 {
  float r = 1, g = 1, b = 1, a = 1;
};

struct Mesh {
  enum class Kind : uint8_t { empty, triangles, lines, points, sphere };
  Kind kind = Kind::empty;
  // Views into the node's own arrays where they can be used as they are, else into the owned
  // vectors below. One entry per vertex; normals, texCoords and colors are empty or as long as
  // points.
  std::span<const Vec3f> points;
  std::span<const uint32_t> indices; // 3 a triangle, 2 a line segment, 1 a point
  std::span<const Vec3f> normals;    // empty: flat, the face's own normal
  std::span<const Vec2f> texCoords;
  std::span<const Color> colors;
  bool solid = true; // back faces are not drawn
  bool ccw = true;
  float radius = 0; // sphere

  std::vector<Vec3f> ownPoints, ownNormals;
  std::vector<uint32_t> ownIndices;
  std::vector<Vec2f> ownTexCoords;
  std::vector<Color> ownColors;
  void viewOwn(); // points all views at the owned vectors

  Mesh() = default;
  Mesh(Mesh&&) = default; // moving vectors keeps their storage, so views stay valid
  Mesh& operator=(Mesh&&) = default;
  Mesh(const Mesh&) = delete;
};

struct MeshOptions {
  bool needTexCoords =
      false; // the shape has a texture: make the default mapping where the node gives none
  const Limits* limits = nullptr;
  Diagnostics* diagnostics = nullptr;
  std::string_view limitName =
      {}; // what limits->triangles follows from, for messages; empty: the limit 'triangles'
};

// The mesh of any geometry node (Box ... Text); kind empty for a node that is none or has nothing
// to draw. The node must outlive the mesh. coord, color, normal and texCoord children may be
// prototype instances (renderedNode).
Mesh buildMesh(Node& geometry, const MeshOptions& options);

} // namespace xvrml

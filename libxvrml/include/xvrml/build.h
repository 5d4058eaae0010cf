// build.h: for programs that make worlds or take them apart: nodes outside of any world, and the
// drawn content of a world as plain arrays. [the thread that owns the world]
#pragma once

#include <array>

#include <memory>
#include <vector>

#include "xvrml/world.h"

namespace xvrml {

// Returns a node with default fields that belongs to no world; null for types whose nodes a program
// cannot make (Script).
NodeRef makeNode(const NodeType& type);

// A Shape and its place in the world.
struct PlacedShape {
  NodeRef shape;
  NodeRef geometry;  // the geometry node that is rendered
  double matrix[16]; // local to world, column-major
  // Holds what ClipPlanes leave of it: points of the shape's coordinates with a x + b y + c z + d
  // >= 0 for each of these. Empty: all.
  std::vector<std::array<double, 4>> kept = {};
};
// Returns the Shapes with a geometry that are drawn for a viewer, in the order of the file. view:
// camera to world, column-major; null: at the origin. A Shape that is used n times appears n times.
// Throws std::length_error beyond 4 million visits to nodes.
std::vector<PlacedShape> placedShapes(const World& world, const double* view = nullptr);

// The arrays of a geometry node, one entry per vertex. normals, texCoords, colors and
// alphas are either empty or as long as points.
struct GeometryArrays {
  enum class Kind : uint8_t { empty, triangles, lines, points, sphere };
  Kind kind = Kind::empty;
  std::vector<Vec3f> points;
  std::vector<uint32_t> indices; // 3 per triangle, 2 per line segment, 1 per point
  std::vector<Vec3f> normals;    // empty: flat shading
  std::vector<Vec2f> texCoords;
  std::vector<Color> colors;
  std::vector<float> alphas; // opacities of `colors`, 0 to 1; empty: all are opaque
  bool solid = true, ccw = true;
  float radius = 0; // radius of a sphere around the origin
};
// Returns the arrays of a geometry node. sphereSteps: number of parts that a Sphere is cut into
// from pole to pole, with twice as many around; 0 keeps it a sphere.
GeometryArrays geometryArrays(Node& geometry, int sphereSteps, const Limits& limits = {});
// Returns the arrays of what ClipPlanes leave of a shape. A Sphere that they cut has facets.
GeometryArrays geometryArrays(const PlacedShape& shape, int sphereSteps, const Limits& limits = {});

} // namespace xvrml

// build.h: worlds and programs that make them or take them apart: nodes outside of any world, and
// what of a world is drawn as plain arrays. [the thread that has the world]
#pragma once

#include <memory>
#include <vector>

#include "xvrml/world.h"

namespace xvrml {

// A node with default fields, in no world yet; null for types whose nodes a program cannot make
// (Script).
NodeRef makeNode(const NodeType& type);

// A Shape where it stands.
struct PlacedShape {
  NodeRef shape;
  NodeRef geometry;  // what is rendered for its geometry
  double matrix[16]; // its coordinates to the world's, column-major
};
// The Shapes with a geometry that are drawn for a viewer (camera to world, column-major; null: at
// the origin), in the order of the file. A Shape that is used n times is n of them. Throws
// std::length_error beyond 4 million visits to nodes.
std::vector<PlacedShape> placedShapes(const World& world, const double* view = nullptr);

// What a geometry node looks like. One entry per vertex; normals, texCoords and colors are empty or
// as long as points.
struct GeometryArrays {
  enum class Kind : uint8_t { empty, triangles, lines, points, sphere };
  Kind kind = Kind::empty;
  std::vector<Vec3f> points;
  std::vector<uint32_t> indices; // 3 a triangle, 2 a line segment, 1 a point
  std::vector<Vec3f> normals;    // empty: flat
  std::vector<Vec2f> texCoords;
  std::vector<Color> colors;
  bool solid = true, ccw = true;
  float radius = 0; // sphere: about the origin
};
// sphereSteps: a Sphere is cut into so many parts from pole to pole, and twice as many around; 0:
// it stays a sphere.
GeometryArrays geometryArrays(Node& geometry, int sphereSteps, const Limits& limits = {});

} // namespace xvrml

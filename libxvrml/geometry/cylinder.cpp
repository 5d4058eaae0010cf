// cylinder.cpp: builds the mesh of a Cylinder (clause 6.14).
#include "geometry/builders.h"
#include "geometry/round.h"
#include "geometry/vector_math.h"

namespace xvrml {

Mesh buildCylinder(const nodes::Cylinder& node, const MeshOptions& options, Faults& faults) {
  Mesh mesh;
  mesh.solid = node.solid;
  float radius = std::abs(node.radius), half = std::abs(node.height) / 2;
  if (!isFinite(radius) || !isFinite(half)) {
    faults.note("radius and height must be finite; nothing is drawn");
    return mesh;
  }
  if (!(node.radius > 0 && node.height > 0)) faults.note("radius and height must be positive");
  if (node.side) {
    for (int i = 0; i <= roundSegments; i++) {
      float s = float(i) / roundSegments;
      Vec2f at = aroundAxis(i == roundSegments ? 0 : s);
      addVertex(mesh, {at.x * radius, -half, at.y * radius}, {at.x, 0, at.y}, {s, 0});
      addVertex(mesh, {at.x * radius, half, at.y * radius}, {at.x, 0, at.y}, {s, 1});
    }
    for (uint32_t i = 0; i < roundSegments; i++) {
      uint32_t low = 2 * i, high = low + 1, nextLow = low + 2, nextHigh = low + 3;
      addTriangle(mesh, low, nextLow, nextHigh);
      addTriangle(mesh, low, nextHigh, high);
    }
  }
  if (node.top) addDisc(mesh, half, radius, true);
  if (node.bottom) addDisc(mesh, -half, radius, false);
  if (options.exactShapes && hasExactSize(double(radius), 2 * double(half))) {
    if (node.side) addExactSide(mesh, radius, radius, -half, half);
    if (node.top) addExactDisc(mesh, half, radius, true);
    if (node.bottom) addExactDisc(mesh, -half, radius, false);
  }
  return finishRound(std::move(mesh));
}

} // namespace xvrml

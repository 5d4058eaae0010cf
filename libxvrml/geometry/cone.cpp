// cone.cpp: Cone (clause 6.11). Every side triangle has an apex vertex of its own, with the normal
// at the middle of its segment.
#include "geometry/builders.h"
#include "geometry/round.h"
#include "geometry/vector_math.h"

namespace xvrml {

Mesh buildCone(const nodes::Cone& node, const MeshOptions& options, Faults& faults) {
  Mesh mesh;
  mesh.solid = node.solid;
  float radius = std::abs(node.bottomRadius), height = std::abs(node.height);
  if (!isFinite(radius) || !isFinite(height)) {
    faults.note("bottomRadius and height must be finite; nothing is drawn");
    return mesh;
  }
  if (!(node.bottomRadius > 0 && node.height > 0))
    faults.note("bottomRadius and height must be positive");
  if (node.side) {
    // The outward normal is (height around the axis, radius along the axis), normalised.
    V3d slope = unit(V3d(height, radius, 0));
    auto normal = [&](const Vec2f& at) {
      return Vec3f{float(at.x * slope.x), float(slope.y), float(at.y * slope.x)};
    };
    for (int i = 0; i <= roundSegments; i++) {
      float s = float(i) / roundSegments;
      Vec2f at = aroundAxis(i == roundSegments ? 0 : s);
      addVertex(mesh, {at.x * radius, -height / 2, at.y * radius}, normal(at), {s, 0});
    }
    for (uint32_t i = 0; i < roundSegments; i++) {
      float s = (float(i) + 0.5f) / roundSegments;
      addVertex(mesh, {0, height / 2, 0}, normal(aroundAxis(s)), {s, 1});
      addTriangle(mesh, i, i + 1, roundSegments + 1 + i);
    }
  }
  if (node.bottom) addDisc(mesh, -height / 2, radius, false);
  if (options.exactShapes && hasExactSize(double(radius), double(height))) {
    if (node.side) addExactSide(mesh, radius, 0, -height / 2, height / 2);
    if (node.bottom) addExactDisc(mesh, -height / 2, radius, false);
  }
  return finishRound(std::move(mesh));
}

} // namespace xvrml

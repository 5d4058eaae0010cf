// bounds.cpp: bounding boxes over indexed points.
#include "geometry/bounds.h"

#include <algorithm>

#include "geometry/vector_math.h"

namespace xvrml {

static void extend(Box3& box, const Vec3f& p) {
  if (!isFinite(p)) return;
  if (box.empty) {
    box = {p, p, false};
    return;
  }
  box.minimum = {std::min(box.minimum.x, p.x), std::min(box.minimum.y, p.y),
                 std::min(box.minimum.z, p.z)};
  box.maximum = {std::max(box.maximum.x, p.x), std::max(box.maximum.y, p.y),
                 std::max(box.maximum.z, p.z)};
}

Box3 boundsOf(std::span<const Vec3f> points, std::span<const uint32_t> indices) {
  Box3 box;
  for (uint32_t index : indices)
    if (index < points.size()) extend(box, points[index]);
  return box;
}

Box3 boundsOf(const Mesh& mesh) {
  float r = mesh.radius;
  if (mesh.kind == Mesh::Kind::sphere) return {{-r, -r, -r}, {r, r, r}, false};
  return boundsOf(mesh.points, mesh.indices);
}

} // namespace xvrml

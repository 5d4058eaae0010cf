// box.cpp: Box (clause 6.7): six flat rectangles, each with the whole texture. Without a texture
// they share their corners, because worlds have millions of boxes.
#include <array>

#include "geometry/builders.h"
#include "geometry/vector_math.h"

namespace xvrml {
namespace {

// A side: its lower left corner and its edges to the right and up, as seen from outside. The
// texture is upright in this view.
struct Side {
  V3f corner, right, up;
};
const Side sides[] = {
    {{-1, -1, 1}, {2, 0, 0}, {0, 2, 0}},  // front
    {{1, -1, -1}, {-2, 0, 0}, {0, 2, 0}}, // back
    {{1, -1, 1}, {0, 0, -2}, {0, 2, 0}},  // right
    {{-1, -1, -1}, {0, 0, 2}, {0, 2, 0}}, // left
    {{-1, 1, 1}, {2, 0, 0}, {0, 0, -2}},  // top, seen from above with -z up
    {{-1, -1, -1}, {2, 0, 0}, {0, 0, 2}}, // bottom, seen from below with +z up
};

} // namespace

Mesh buildBox(const nodes::Box& node, const MeshOptions& options, Faults& faults) {
  Mesh mesh;
  V3f half(std::abs(node.size.x) / 2, std::abs(node.size.y) / 2, std::abs(node.size.z) / 2);
  if (!isFinite(node.size)) {
    faults.note("size is not finite; nothing is drawn");
    return mesh;
  }
  if (!(node.size.x > 0 && node.size.y > 0 && node.size.z > 0))
    faults.note("size must be positive");
  const bool textured = options.needTexCoords;
  mesh.ownPoints.reserve(textured ? 24 : 8);
  mesh.ownIndices.reserve(36);
  for (int corner = 0; corner < 8 && !textured; corner++)
    mesh.ownPoints.push_back(toVec3f(
        V3f(corner & 1 ? 1.f : -1.f, corner & 2 ? 1.f : -1.f, corner & 4 ? 1.f : -1.f) * half));
  for (const Side& side : sides) {
    std::array<uint32_t, 4> v{};
    for (size_t k = 0; k < 4; k++) {
      const float s = k == 1 || k == 2, t = k >= 2;
      const V3f at = side.corner + side.right * s + side.up * t;
      v[k] =
          textured ? uint32_t(mesh.ownPoints.size()) : (at.x > 0) + 2 * (at.y > 0) + 4 * (at.z > 0);
      if (!textured) continue;
      mesh.ownPoints.push_back(toVec3f(at * half));
      mesh.ownTexCoords.push_back({s, t});
    }
    const auto& p = mesh.ownPoints;
    if (hasArea(p[v[0]], p[v[1]], p[v[2]])) // a box of height zero has only two sides
      mesh.ownIndices.insert(mesh.ownIndices.end(), {v[0], v[1], v[2], v[0], v[2], v[3]});
  }
  if (mesh.ownIndices.empty()) return Mesh();
  mesh.kind = Mesh::Kind::triangles;
  mesh.solid = node.solid;
  mesh.viewOwn();
  return mesh;
}

} // namespace xvrml

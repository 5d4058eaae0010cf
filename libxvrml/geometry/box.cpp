// box.cpp: Box (clause 6.7): six flat rectangles, each with the whole texture.
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

Mesh buildBox(const nodes::Box& node, const MeshOptions&, Faults& faults) {
  Mesh mesh;
  V3f half(std::abs(node.size.x) / 2, std::abs(node.size.y) / 2, std::abs(node.size.z) / 2);
  if (!isFinite(node.size)) {
    faults.note("size is not finite; nothing is drawn");
    return mesh;
  }
  if (!(node.size.x > 0 && node.size.y > 0 && node.size.z > 0))
    faults.note("size must be positive");
  mesh.ownPoints.reserve(24);
  mesh.ownTexCoords.reserve(24);
  mesh.ownIndices.reserve(36);
  for (const Side& side : sides) {
    uint32_t first = uint32_t(mesh.ownPoints.size());
    for (auto [s, t] : {std::pair{0.f, 0.f}, {1.f, 0.f}, {1.f, 1.f}, {0.f, 1.f}}) {
      mesh.ownPoints.push_back(toVec3f((side.corner + side.right * s + side.up * t) * half));
      mesh.ownTexCoords.push_back({s, t});
    }
    const auto& p = mesh.ownPoints;
    if (hasArea(p[first], p[first + 1], p[first + 2])) // a box of height zero has only two sides
      mesh.ownIndices.insert(mesh.ownIndices.end(),
                             {first, first + 1, first + 2, first, first + 2, first + 3});
  }
  if (mesh.ownIndices.empty()) return Mesh();
  mesh.kind = Mesh::Kind::triangles;
  mesh.solid = node.solid;
  mesh.viewOwn();
  return mesh;
}

} // namespace xvrml

// facets.cpp: points on a mesh and within it, by random numbers.
#include "behaviour/particles/facets.h"

#include "geometry/mesh.h"
#include "geometry/sphere_facets.h"

namespace xvrml {
namespace {

constexpr uint32_t sphereRows = 32;
constexpr int tries = 32; // to find a point within a surface

Mesh meshOf(Node& geometry) {
  Limits limits;
  limits.triangles = Facets::most;
  MeshOptions options;
  options.limits = &limits;
  Mesh mesh = buildMesh(geometry, options);
  facetSphere(mesh, sphereRows);
  return mesh;
}

} // namespace

Facets::Facets(Node* geometry) {
  if (!geometry) return;
  const Mesh mesh = meshOf(*geometry);
  if (mesh.kind != Mesh::Kind::triangles || mesh.indices.size() / 3 > most) return;
  twoSided_ = !mesh.solid;
  low_ = high_ = toV3d(mesh.points[mesh.indices[0]]);
  for (size_t i = 0; i + 3 <= mesh.indices.size(); i += 3) {
    std::array<V3d, 3> corners, normals{};
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t index = mesh.indices[i + (mesh.ccw ? k : 2 - k)];
      corners[k] = toV3d(mesh.points[index]);
      if (!mesh.normals.empty()) normals[k] = toV3d(mesh.normals[index]);
    }
    add(corners, normals);
  }
}

// Adds a triangle whose corners run counter-clockwise, seen from its front, if it has an area.
void Facets::add(const std::array<V3d, 3>& corners, const std::array<V3d, 3>& normals) {
  const V3d cross = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double area = cross.length() / 2;
  if (!(area > 0) || !std::isfinite(area)) return;
  Facet facet{corners, {}, cross / (2 * area)};
  for (size_t k = 0; k < 3; ++k) {
    const V3d given = unit(normals[k]);
    facet.normals[k] = given == V3d(0) ? facet.normal : given;
    for (int axis = 0; axis < 3; ++axis) {
      low_[axis] = std::min(low_[axis], corners[k][axis]);
      high_[axis] = std::max(high_[axis], corners[k][axis]);
    }
  }
  all_.push_back(facet);
  areas_.push_back((areas_.empty() ? 0 : areas_.back()) + area);
}

Facets::Point Facets::draw(Draws& draws) const {
  const double area = draws.next() * areas_.back();
  const auto at = size_t(std::upper_bound(areas_.begin(), areas_.end(), area) - areas_.begin());
  const Facet& facet = all_[std::min(at, all_.size() - 1)];
  double u = draws.next(), v = draws.next();
  if (u + v > 1) { // the other half of the parallelogram
    u = 1 - u;
    v = 1 - v;
  }
  const auto mix = [&](const std::array<V3d, 3>& of) {
    return of[0] * (1 - u - v) + of[1] * u + of[2] * v;
  };
  V3d normal = unit(mix(facet.normals));
  if (twoSided_ && draws.next() < 0.5) normal = -normal;
  return {mix(facet.corners), normal};
}

V3d Facets::drawWithin(Draws& draws) const {
  for (int i = 0; i < tries; ++i) {
    V3d point;
    for (int axis = 0; axis < 3; ++axis)
      point[axis] = low_[axis] + (high_[axis] - low_[axis]) * draws.next();
    if (isInside(point)) return point;
  }
  return draw(draws).place;
}

// Returns whether a ray along +x crosses the surface an odd number of times. An edge belongs to the
// triangle above it alone (y), so that a ray through an edge counts it once.
bool Facets::isInside(const V3d& point) const {
  bool inside = false;
  for (const Facet& facet : all_) {
    int winding = 0;
    for (size_t k = 0; k < 3; ++k) {
      const V3d &a = facet.corners[k], &b = facet.corners[(k + 1) % 3];
      if ((a.y > point.y) == (b.y > point.y)) continue;
      const double z = a.z + (point.y - a.y) / (b.y - a.y) * (b.z - a.z);
      if (z > point.z) ++winding;
    }
    if (winding % 2 == 0) continue;
    const double height = facet.normal.dot(facet.corners[0] - point);
    if (height * facet.normal.x > 0) inside = !inside;
  }
  return inside;
}

Facets facetsOfFaces(const NodeRef& coord, const MFInt32& coordIndex) {
  const NodeRef faces(new nodes::IndexedFaceSet());
  auto& set = *nodeCast<nodes::IndexedFaceSet>(faces);
  set.coord = coord;
  set.coordIndex = coordIndex;
  return Facets(faces.get());
}

} // namespace xvrml

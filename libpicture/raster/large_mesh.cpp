#include "libpicture/raster/large_mesh.h"

#include "xvrml/deformed.h"

namespace picture::raster {

using xvrml::GeometryArrays;

namespace {

// Returns whether each face of a list has three corners and its end.
bool areTriangles(const std::vector<int32_t>& faces) {
  if (faces.size() % 4 != 0) return false;
  for (size_t i = 0; i < faces.size(); i += 4)
    if (faces[i] < 0 || faces[i + 1] < 0 || faces[i + 2] < 0 || faces[i + 3] != -1) return false;
  return true;
}

} // namespace

GeometryArrays arraysOf(const xvrml::DrawnShape& shape) {
  const auto* set = xvrml::nodeCast<xvrml::nodes::IndexedFaceSet>(&shape.geometry);
  if (!set || set->coordIndex.size() < largeMesh || set->color || set->normal ||
      !shape.kept().empty() || !areTriangles(set->coordIndex))
    return shape.mesh();
  const xvrml::AppearanceParts& parts = shape.appearance();
  if (parts.shader || xvrml::colorTexture(parts)) return shape.mesh();
  const auto* points =
      xvrml::nodeCast<xvrml::nodes::Coordinate>(xvrml::renderedNode(set->coord.get()));
  if (!points) return shape.mesh();
  GeometryArrays arrays;
  arrays.kind = GeometryArrays::Kind::triangles;
  const std::span<const xvrml::Vec3f> drawn = xvrml::drawnPoints(*points);
  arrays.points.assign(drawn.begin(), drawn.end());
  arrays.indices.reserve(set->coordIndex.size() / 4 * 3);
  for (size_t i = 0; i < set->coordIndex.size(); i += 4)
    for (size_t k = i; k < i + 3; ++k) arrays.indices.push_back(uint32_t(set->coordIndex[k]));
  arrays.solid = set->solid;
  arrays.ccw = set->ccw;
  return arrays;
}

} // namespace picture::raster

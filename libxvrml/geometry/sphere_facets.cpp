#include "geometry/sphere_facets.h"

#include "geometry/round.h"

namespace xvrml {

Mesh sphereFacets(float radius, uint32_t rows) {
  const uint32_t columns = 2 * rows;
  Mesh mesh;
  for (uint32_t row = 0; row <= rows; ++row) {
    const Vec2f height = aroundAxis(0.5 * row / rows); // (-sine, -cosine) from below
    for (uint32_t column = 0; column <= columns; ++column) {
      const Vec2f side = aroundAxis(double(column) / columns);
      const Vec3f n{-height.x * side.x, height.y, -height.x * side.y};
      addVertex(mesh, {radius * n.x, radius * n.y, radius * n.z}, n,
                {float(column) / float(columns), float(row) / float(rows)});
    }
  }
  for (uint32_t row = 0; row < rows; ++row)
    for (uint32_t column = 0; column < columns; ++column) {
      const uint32_t low = row * (columns + 1) + column, high = low + columns + 1;
      if (row > 0) addTriangle(mesh, low, low + 1, high + 1);
      if (row + 1 < rows) addTriangle(mesh, low, high + 1, high);
    }
  mesh.kind = Mesh::Kind::triangles;
  mesh.viewOwn();
  return mesh;
}

void facetSphere(Mesh& mesh, uint32_t rows) {
  if (mesh.kind != Mesh::Kind::sphere) return;
  const bool solid = mesh.solid;
  mesh = sphereFacets(mesh.radius, rows);
  mesh.solid = solid;
}

} // namespace xvrml

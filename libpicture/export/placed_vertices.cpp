#include "libpicture/export/placed_vertices.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace picture {

using xvrml::Vec3f;

namespace {

Vec3f unit(const Vec& v) {
  const double size = length(v);
  if (!(size > 0) || !std::isfinite(size)) return {};
  return {float(v.x / size), float(v.y / size), float(v.z / size)};
}

Vec vecOf(const Vec3f& v) { return {v.x, v.y, v.z}; }

} // namespace

PlacedVertices::PlacedVertices(const xvrml::GeometryArrays& arrays, const double matrix[16],
                               Remarks& remarks)
    : vertices_(arrays) {
  std::copy_n(matrix, 16, matrix_.begin());
  if (vertices_.leftOut() > 0)
    remarks.change("triangles, lines or points with numbers that are not finite are left out");
  const double* m = matrix;
  const Vec x{m[0], m[1], m[2]}, y{m[4], m[5], m[6]}, z{m[8], m[9], m[10]};
  // The inverse transposed matrix, times the determinant.
  normals_[0] = cross(y, z);
  normals_[1] = cross(z, x);
  normals_[2] = cross(x, y);
  mirrors_ = dot(x, normals_[0]) < 0;
  if (mirrors_)
    for (Vec& column : normals_) column = column * -1.0;
}

Vec PlacedVertices::place(size_t i) const {
  const Vec3f p = vertices_.point(i);
  const auto& m = matrix_;
  return {m[0] * p.x + m[4] * p.y + m[8] * p.z + m[12],
          m[1] * p.x + m[5] * p.y + m[9] * p.z + m[13],
          m[2] * p.x + m[6] * p.y + m[10] * p.z + m[14]};
}

Vec3f PlacedVertices::point(size_t i) const {
  const Vec p = place(i);
  return {float(p.x), float(p.y), float(p.z)};
}

Vec3f PlacedVertices::normal(size_t i) const {
  const Vec3f n = vertices_.normal(i);
  return unit(normals_[0] * n.x + normals_[1] * n.y + normals_[2] * n.z);
}

std::array<uint32_t, 3> PlacedVertices::triangle(size_t t) const {
  const auto indices = vertices_.indices();
  std::array<uint32_t, 3> corners = {indices[3 * t], indices[3 * t + 1], indices[3 * t + 2]};
  if (mirrors_) std::swap(corners[1], corners[2]);
  return corners;
}

Vec3f PlacedVertices::faceNormal(size_t t) const {
  const auto corners = triangle(t);
  const Vec a = vecOf(point(corners[0])), b = vecOf(point(corners[1])),
            c = vecOf(point(corners[2]));
  return unit(cross(b + a * -1.0, c + a * -1.0));
}

bool PlacedVertices::isFinite(size_t t) const {
  for (const uint32_t corner : triangle(t)) {
    const Vec3f p = point(corner);
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return false;
  }
  return true;
}

} // namespace picture

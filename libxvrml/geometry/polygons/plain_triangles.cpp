// plain_triangles.cpp: checks that nothing of a node asks for more than its arrays, in passes that
// run on several threads where there is much to do.
#include "geometry/polygons/plain_triangles.h"

#include <algorithm>
#include <atomic>

#include "geometry/builders.h"
#include "geometry/texture_mapping.h"
#include "parallel_for.h"

namespace xvrml {
namespace {

// Returns whether test(i) is true for all numbers below count.
template <class Test> bool holdsForAll(size_t count, const Test& test) {
  std::atomic<bool> holds{true};
  forRanges(count, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end && holds; i++)
      if (!test(i)) holds = false;
  });
  return holds;
}

// Reads the indices of a list of valid triangles only. Returns false if there is anything else.
bool readTriangles(const PlainTriangles& triangles, std::span<const Vec3f> points,
                   std::vector<uint32_t>& out) {
  const std::span<const int32_t> index = triangles.index;
  const size_t n = index.size(), stride = triangles.ended ? 4 : 3;
  if (n == 0 || (n % stride != 0 && n % stride != 3)) return false;
  const uint32_t limit = uint32_t(std::min<size_t>(points.size(), INT32_MAX));
  const size_t count = (n + stride - 3) / stride;
  out.resize(3 * count);
  return holdsForAll(count, [&](size_t t) {
    const uint32_t a = uint32_t(index[stride * t]), b = uint32_t(index[stride * t + 1]),
                   c = uint32_t(index[stride * t + 2]);
    const bool ends = stride == 3 || 4 * t + 3 == n || index[4 * t + 3] == -1;
    if (!ends || a >= limit || b >= limit || c >= limit ||
        !hasArea(points[a], points[b], points[c]))
      return false;
    out[3 * t] = a;
    out[3 * t + 1] = b;
    out[3 * t + 2] = c;
    return true;
  });
}

// Returns whether the triangles of the mesh before are valid ones of these points, too.
bool remain(const MeshTopology* former, std::span<const Vec3f> points) {
  if (!former || former->indices.empty() || former->points != points.size()) return false;
  const auto& index = former->indices;
  return holdsForAll(index.size() / 3, [&](size_t t) {
    return hasArea(points[index[3 * t]], points[index[3 * t + 1]], points[index[3 * t + 2]]);
  });
}

// Returns whether there are no values, or those of the points.
template <class T> bool matchPoints(std::span<const T> values, size_t points) {
  return values.empty() || (values.size() >= points && allFinite(values));
}

bool areUnit(std::span<const Vec3f> normals) {
  return std::all_of(normals.begin(), normals.end(), [](const Vec3f& n) {
    return std::abs(n.x * n.x + n.y * n.y + n.z * n.z - 1) < 1e-4f;
  });
}

} // namespace

bool buildPlain(const PlainTriangles& triangles, const FaceSet& set, const MeshOptions& options,
                Mesh& mesh) {
  constexpr size_t manyIndices = 1 << 14; // fewer are not worth an attempt to smooth them
  const std::span<const Vec3f> points = set.points;
  const std::span<const int32_t> index = triangles.index;
  const bool smooth = set.normals.values.empty() && triangles.creaseAngle > 0;
  if (index.size() / (triangles.ended ? 4 : 3) + 1 > triangleLimit(options) ||
      points.size() / 4 > index.size() || (smooth && index.size() < manyIndices) ||
      !set.alphas.empty() || !set.texPlaces.empty() || !set.fogCoords.empty() ||
      !matchPoints(set.colors.values, points.size()) ||
      !matchPoints(set.texCoords.values, points.size()) ||
      !matchPoints(set.normals.values, points.size()) || !areUnit(set.normals.values) ||
      !allFinite(points))
    return false;
  if (remain(options.former, points))
    mesh.ownIndices = std::move(options.former->indices);
  else if (!readTriangles(triangles, points, mesh.ownIndices))
    return false;
  if (smooth && !smoothNormals(points, mesh.ownIndices, triangles.creaseAngle, triangles.ccw,
                               mesh.ownNormals))
    return false;
  mesh.kind = Mesh::Kind::triangles;
  mesh.plain = true;
  mesh.points = points;
  mesh.indices = mesh.ownIndices;
  mesh.solid = triangles.solid;
  mesh.ccw = triangles.ccw;
  if (smooth)
    mesh.normals = mesh.ownNormals;
  else if (!set.normals.values.empty())
    mesh.normals = set.normals.values.first(points.size());
  if (!set.colors.values.empty()) mesh.colors = set.colors.values.first(points.size());
  if (!set.texCoords.values.empty()) {
    mesh.texCoords = set.texCoords.values.first(points.size());
  } else if (options.needTexCoords) {
    mesh.ownTexCoords = defaultTextureMapping(mesh.points, mesh.indices);
    mesh.texCoords = mesh.ownTexCoords;
  }
  return true;
}

} // namespace xvrml

// bake.cpp: bounds, checks and baking of geometries. Large arrays are processed in parallel; every
// element is independent, so the result does not depend on the number of threads.
#include "backend/local/accel/bake.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>

#include "backend/local/sliver_edges.h"
#include "parallel_for.h"

namespace openrt {
namespace {

// Returns the bounds of points (stride 3).
Box boundsOf(const float* points, size_t count) {
  Box box;
  std::mutex mutex;
  forRanges(count, [&](size_t begin, size_t end) {
    Vec3f low{INFINITY, INFINITY, INFINITY}, high = -low;
    for (size_t i = begin; i < end; i++) {
      low = min(low, vectorOf(points + 3 * i));
      high = max(high, vectorOf(points + 3 * i));
    }
    const std::lock_guard lock(mutex);
    box.add(Vec3d(low));
    box.add(Vec3d(high));
  });
  return box;
}

} // namespace

void Box::add(const Vec3d& p) {
  low = min(low, p);
  high = max(high, p);
}

void Box::add(const Box& box, const Matrix4d& matrix) {
  if (box.empty()) return;
  for (int corner = 0; corner < 8; corner++)
    add(matrix.point({corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                      corner & 4 ? box.high.z : box.low.z}));
}

double halfDiagonal(const Box& box) { return box.empty() ? 0 : length(box.high - box.low) / 2; }

Box boundsOf(const Geometry& geometry) {
  Box local, result;
  if (geometry.primitive == edit::Primitive::Sphere) {
    const double r = geometry.width;
    local.add({-r, -r, -r});
    local.add({r, r, r});
  } else if (geometry.surface) {
    local.add(geometry.surface->low());
    local.add(geometry.surface->high());
  } else if (geometry.points) {
    const size_t n = geometry.points->count<float>() / 3;
    if (n) local = boundsOf(geometry.points->as<float>(), n);
  }
  result.add(local, geometry.matrix);
  return result;
}

bool hasDetailAtOrigin(const Geometry& g) {
  if (g.primitive != edit::Primitive::Triangles || !g.points) return false;
  const float* points = g.points->as<float>();
  const size_t n = g.points->count<float>() / 3;
  if (n == 0) return false;
  const Box box = boundsOf(points, n);
  const float close = float(largest(max(abs(box.low), abs(box.high))) / largestToSmallest);
  std::atomic<size_t> count{0};
  forRanges(n, [&](size_t begin, size_t end) {
    size_t found = 0;
    for (size_t i = begin; i < end; i++) found += largest(abs(vectorOf(points + 3 * i))) < close;
    count += found;
  });
  return count > 1;
}

bool consistent(const Geometry& g) {
  if (g.primitive == edit::Primitive::Sphere) return g.width > 0 && std::isfinite(g.width);
  if (AnalyticSurface::isAnalytic(g.primitive)) return g.surface != nullptr;
  if (!g.points || !g.indices) return false;
  const size_t n = g.points->count<float>() / 3;
  if ((g.normals && g.normals->count<float>() < 3 * n) ||
      (g.texCoords && g.texCoords->count<float>() < 2 * n) ||
      (g.colors && g.colors->count<float>() < 4 * n) ||
      (g.fogCoords && g.fogCoords->count<float>() < n))
    return false;
  const uint32_t* index = g.indices->as<uint32_t>();
  const size_t count = g.indices->count<uint32_t>();
  std::atomic<bool> inRange{true};
  forRanges(count, [&](size_t begin, size_t end) {
    uint32_t largest = 0;
    for (size_t i = begin; i < end; i++) largest = std::max(largest, index[i]);
    if (largest >= n) inRange = false;
  });
  return count > 0 && inRange;
}

std::vector<float> bakePoints(const Geometry& geometry, const Matrix4d& m) {
  const float* p = geometry.points->as<float>();
  const size_t n = geometry.points->count<float>() / 3;
  std::vector<float> out;
  out.reserve(3 * n + 4); // attachTriangles() appends padding
  out.resize(3 * n);
  forRanges(n, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; i++)
      store(Vec3f(m.point(Vec3d(vectorOf(p + 3 * i)))), &out[3 * i]);
  });
  return out;
}

BakedTriangles bakeTriangles(const Geometry& geometry, const Matrix4d& toKernel) {
  BakedTriangles out;
  out.vertices = bakePoints(geometry, toKernel);
  const uint32_t* index = geometry.indices->as<uint32_t>();
  const size_t count = geometry.primitives();
  const auto shape = [&](size_t t) {
    const float* v = out.vertices.data();
    return shapeOf(v + 3 * size_t(index[3 * t]), v + 3 * size_t(index[3 * t + 1]),
                   v + 3 * size_t(index[3 * t + 2]));
  };
  std::atomic<bool> clean{true};
  forRanges(count, [&](size_t begin, size_t end) {
    for (size_t t = begin; t < end; t++)
      if (shape(t) != TriangleShape::good) {
        clean = false;
        return;
      }
  });
  if (clean) return out;
  std::vector<TriangleShape> shapes(count);
  forRanges(count, [&](size_t begin, size_t end) {
    for (size_t t = begin; t < end; t++) shapes[t] = shape(t);
  });
  if (std::find(shapes.begin(), shapes.end(), TriangleShape::sliver) != shapes.end())
    out.openEdges = widenSlivers(out.vertices, index, shapes);
  for (size_t t = 0; t < count; t++) {
    if (shapes[t] == TriangleShape::degenerate) out.degenerate++;
    if (shapes[t] == TriangleShape::sliver) out.slivers.push_back(uint32_t(t));
    if (shapes[t] != TriangleShape::good) continue;
    out.kept.push_back(uint32_t(t));
    out.indices.insert(out.indices.end(), index + 3 * t, index + 3 * t + 3);
  }
  return out;
}

} // namespace openrt

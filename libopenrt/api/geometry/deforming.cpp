// deforming.cpp: estimates what a refitted tree costs by the surface area heuristic: the sum of the
// areas of its boxes by the area of the whole. In place of the tree's boxes there are those of the
// points in each cell of a grid of cubes over the mesh at rest.
#include "api/geometry/deforming.h"

#include <algorithm>
#include <vector>

#include "scene/vec3.h"

namespace openrt {
namespace {

constexpr size_t gridSize = 16;         // cells along the longest axis
constexpr size_t mostSamples = 1 << 17; // points that are looked at
constexpr double mostExpensive = 1.5;   // times the cost at rest

struct Bounds {
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  void add(const Vec3d& p) {
    low = min(low, p);
    high = max(high, p);
  }
  double area() const { // half the area of its surface
    if (!(low.x <= high.x)) return 0;
    const Vec3d size = high - low;
    return size.x * size.y + size.y * size.z + size.z * size.x;
  }
};

} // namespace

bool hasDeformedMuch(const Array& rest, const Array& now) {
  const size_t count = rest.count<float>() / 3, step = count / mostSamples + 1;
  const auto pointOf = [](const Array& points, size_t i) {
    return Vec3d(vectorOf(points.as<float>() + 3 * i));
  };
  Bounds wholeRest, wholeNow;
  for (size_t i = 0; i < count; i += step) {
    wholeRest.add(pointOf(rest, i));
    wholeNow.add(pointOf(now, i));
  }
  if (!(wholeRest.area() > 0)) return wholeNow.area() > 0;
  const double edge = largest(wholeRest.high - wholeRest.low) / gridSize;
  const auto cellAlong = [edge](double offset) {
    return std::min(size_t(offset / edge), gridSize - 1);
  };
  struct Cell {
    Bounds rest, now;
  };
  std::vector<Cell> cells(gridSize * gridSize * gridSize);
  for (size_t i = 0; i < count; i += step) {
    const Vec3d p = pointOf(rest, i);
    const Vec3d offset = p - wholeRest.low;
    const size_t number =
        (cellAlong(offset.x) * gridSize + cellAlong(offset.y)) * gridSize + cellAlong(offset.z);
    Cell& cell = cells[number];
    cell.rest.add(p);
    cell.now.add(pointOf(now, i));
  }
  double areaRest = 0, areaNow = 0;
  for (const Cell& cell : cells) {
    areaRest += cell.rest.area();
    areaNow += cell.now.area();
  }
  return areaNow * wholeRest.area() > mostExpensive * areaRest * wholeNow.area();
}

} // namespace openrt

// deforming.cpp: estimates what a refitted tree costs by the surface area heuristic: the sum of the
// areas of its boxes by the area of the whole. In place of the tree's boxes there are those of the
// points in each cell of a grid over the mesh at rest.
#include "api/geometry/deforming.h"

#include <algorithm>
#include <vector>

#include "scene/vec3.h"

namespace openrt {
namespace {

constexpr int gridSize = 16;            // cells along each axis
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
  const auto cellAlong = [](double place, double low, double high) {
    return high > low ? std::min(int((place - low) / (high - low) * gridSize), gridSize - 1) : 0;
  };
  struct Cell {
    Bounds rest, now;
  };
  std::vector<Cell> cells(gridSize * gridSize * gridSize);
  for (size_t i = 0; i < count; i += step) {
    const Vec3d p = pointOf(rest, i);
    const int x = cellAlong(p.x, wholeRest.low.x, wholeRest.high.x),
              y = cellAlong(p.y, wholeRest.low.y, wholeRest.high.y),
              z = cellAlong(p.z, wholeRest.low.z, wholeRest.high.z);
    Cell& cell = cells[size_t((x * gridSize + y) * gridSize + z)];
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

// texture_mapping.cpp: the default texture mapping by bounding box (clause 6.23).
#include "geometry/texture_mapping.h"

#include "geometry/bounds.h"
#include "geometry/vector_math.h"

namespace xvrml {

std::vector<Vec2f> defaultTextureMapping(std::span<const Vec3f> points,
                                         std::span<const uint32_t> indices) {
  std::vector<Vec2f> mapping(points.size());
  Box3 box = boundsOf(points, indices);
  if (box.empty) return mapping;
  double low[3] = {box.minimum.x, box.minimum.y, box.minimum.z};
  double size[3] = {box.maximum.x - low[0], box.maximum.y - low[1], box.maximum.z - low[2]};
  int s = 0;
  for (int axis = 1; axis < 3; axis++)
    if (size[axis] > size[s]) s = axis; // a tie keeps the earlier axis
  int t = s == 0 ? 1 : 0;
  for (int axis = t + 1; axis < 3; axis++)
    if (axis != s && size[axis] > size[t]) t = axis;
  if (!(size[s] > 0)) return mapping;
  for (size_t i = 0; i < points.size(); i++) {
    if (!isFinite(points[i])) continue;
    double p[3] = {points[i].x, points[i].y, points[i].z};
    // Unused points may lie anywhere, so the result is clamped.
    auto number = [](double v) { return float(std::min(std::max(v, -1e30), 1e30)); };
    mapping[i] = {number((p[s] - low[s]) / size[s]), number((p[t] - low[t]) / size[s])};
  }
  return mapping;
}

} // namespace xvrml

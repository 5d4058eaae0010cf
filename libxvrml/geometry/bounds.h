// bounds.h: bounding boxes of points and meshes. Only the points that indices refer to count,
// because a Coordinate may hold the points of many shapes. Used for default texture mapping and to
// fit a camera.
#pragma once

#include <cstdint>
#include <span>

#include "geometry/mesh.h"

namespace xvrml {

struct Box3 {
  Vec3f minimum, maximum;
  bool empty = true;
};

Box3 boundsOf(std::span<const Vec3f> points, std::span<const uint32_t> indices);
Box3 boundsOf(const Mesh& mesh); // uses the radius of a sphere

} // namespace xvrml

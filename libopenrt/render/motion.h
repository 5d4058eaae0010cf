// motion.h: how the placed geometries of a scene have moved since the frame before (RT_MOTION). The
// backend makes it between frames (backend/local/motions.cpp); render threads read it.
//
// A hit is a point of its geometry: by its barycentric coordinates, or by its direction from the
// centre of a sphere. The motion of the point is computed in double, from the geometry's own
// coordinates: the difference of the two matrices times the point, plus what the point itself has
// moved by in the geometry's frame. So it is 0 where nothing moved, however far away that is from
// the origin of the world.
#pragma once

#include <cstdint>
#include <vector>

#include "render/render_scene.h"
#include "scene/scene.h"

namespace openrt {

// A geometry that has moved: now and in the frame before.
struct Motion {
  Matrix4d now, before; // from the geometry's frame to the world
  ArrayPtr points;
  ArrayPtr pointsBefore;              // null: the points are the same
  float radius = 1, radiusBefore = 1; // radii of a sphere
};

struct Motions {
  static constexpr uint32_t resting = 0, isNew = 1, firstMoved = 2;
  // By record: resting, isNew (it was not there in the frame before), or firstMoved + index into
  // `moved`.
  std::vector<uint32_t> kind;
  std::vector<Motion> moved;
  bool allNew = false; // there was no frame before

  uint32_t kindOf(uint32_t record) const { return allNew ? isNew : kind[record]; }
};

// A plane in render space. normal: unit.
struct Plane {
  Vec3d point, normal;
  bool operator==(const Plane&) const = default;
};

// Returns the vector from where the hit's point was in the frame before to where it is now; NaN if
// it was not there. position: of the hit, in render space. [render]
Vec3d motionOf(const RenderScene& scene, const RayHits& hits, uint32_t lane, const Vec3f& position);

// Finds the plane at which a mirror reflects, now and in the frame before. `now` holds the tangent
// plane at the hit; it may become that of a flat triangle. Returns false, and leaves `before` as it
// is, if the mirror is new.
// * A flat triangle was in the plane of its three corners.
// * A sphere moves with its centre: it reflects in the same way however it turns.
// * Other curved surfaces are taken for a plane that moves with the point that was hit.
// [render]
bool findMirrorPlanes(const RenderScene& scene, const RayHits& hits, uint32_t lane, Plane& now,
                      Plane& before);

} // namespace openrt

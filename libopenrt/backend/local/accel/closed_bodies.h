// closed_bodies.h: tells hits that cannot be the first of their ray. A ray from outside of a closed
// mesh meets the front of one of its triangles before the back of any. If single precision finds a
// back first, the ray has passed the mesh exactly through a vertex (decision 54). Made between
// frames from an Accel, when the first query needs it, and again after changes; then immutable.
// [any thread]
#pragma once

#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "backend/local/accel/accel.h"

namespace openrt {

class ClosedBodies {
 public:
  // The Accel must outlive this object and stay as it is. former: of the scene before a change,
  // whose meshes are not looked at again where they are still in use; or null.
  ClosedBodies(const Accel& accel, const ClosedBodies* former);

  // Returns whether hit i is on the back of a closed mesh although the ray starts outside of its
  // bounds.
  bool denies(const Rays& rays, uint32_t i, const RayHits& hits) const;

 private:
  struct Shape {     // a mesh in the frame of its vertices
    int outward = 0; // 1 or -1: the kernel's normals point outwards or inwards; 0: is not closed
    Vec3d low, high;
  };
  struct Body { // a mesh where it is placed
    int outward = 0;
    Vec3f low, high; // bounds in render space
  };
  using Key = std::tuple<const float*, const uint32_t*, uint32_t>; // vertices, indices, number
  static Shape shapeOf(const Record& r);

  const Accel& accel_;
  std::map<Key, Shape> shapes_;
  // Own the vertices, so that equal addresses mean the same meshes.
  std::vector<std::shared_ptr<const Blas>> owners_;
  std::vector<Body> bodies_; // by record
};

} // namespace openrt

// exact_scene.h: all surfaces of a scene for exact ray queries. A ray meets every triangle that it
// crosses exactly once (crossing.h), whatever single precision makes of it. Made between frames
// from an Accel, when the first query needs it, and again after changes; then immutable. [any
// thread]
#pragma once

#include <memory>
#include <vector>

#include "backend/local/accel/accel.h"
#include "backend/local/crossing.h"

namespace openrt {

// The surface that is met is this: the vertices are floats, as Embree sees them. Those of an
// instance are mapped to render space by its matrix, whose elements are floats, in double
// precision. Equal vertices of one geometry have equal places. Spheres and analytic surfaces are
// intersected in double precision, in frames of their own.
class ExactScene {
 public:
  struct Hit {
    uint32_t record = noHit, primitive = 0;
    CrossingPoint at;
  };
  // The Accel must outlive the scene and stay as it is. former: the scene before a change, whose
  // meshes are kept where they are still in use; or null.
  ExactScene(const EmbreeDevice& device, const Accel& accel, const ExactScene* former);
  ~ExactScene();

  bool nearest(const ExactRay& ray, Hit& hit) const; // false: the ray hits nothing
  bool occluded(const ExactRay& ray) const;
  void all(const ExactRay& ray, std::vector<Hit>& hits) const; // in order of t
  size_t count(const ExactRay& ray) const;
  // Returns the unit normal in render space, on the front side.
  Vec3d normal(const Hit& hit, const ExactRay& ray) const;
  // Returns the point of a hit in render space.
  Vec3d point(const Hit& hit, const ExactRay& ray) const;

 private:
  struct Surface;
  struct Surfaces; // an ExactSearch of them
  class Nearest;

  const Accel& accel_;
  // Own the vertices, so that equal addresses mean the same meshes.
  std::vector<std::shared_ptr<const Blas>> owners_;
  std::unique_ptr<Surfaces> surfaces_;
};

} // namespace openrt

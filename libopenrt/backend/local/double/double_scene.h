// double_scene.h: all surfaces of a scene for ray queries in double precision. Made when the first
// such query needs it, and again after changes; then immutable. [any thread]
//
// The surfaces are those that the application gave: vertices in floats as they are stored, placed
// in the world by the product of the matrices of their instances. That product is rounded to
// double; nothing else is, and crossings are decided exactly. Unlike an ExactScene it knows no
// render space and no rounded places.
#pragma once

#include <memory>
#include <vector>

#include "backend/local/accel/accel.h"
#include "backend/local/accel/survey.h"
#include "backend/local/double/closest.h"

namespace openrt {

class DoubleScene {
 public:
  struct Input {
    const Scene& scene;
    const Flattened& flat;
    const Survey& survey;
    const Accel& accel; // its records are the ones that hits name
  };
  // former: the scene before a change, whose meshes are kept where they are still in use; or null.
  DoubleScene(const EmbreeDevice& device, const Input& input, const DoubleScene* former);
  ~DoubleScene();

  struct Hit {
    uint32_t record = noHit, primitive = 0;
    CrossingPoint at;
    bool ambiguous = false; // another surface is so near that it may be the first
  };
  // Returns whether the ray hits anything. The bound of the error includes that surfaces which are
  // nearer together than their bounds may be in another order.
  bool nearest(const DoubleRay& ray, Hit& hit) const;
  bool occluded(const DoubleRay& ray) const;
  void all(const DoubleRay& ray, std::vector<Hit>& hits) const; // in order of t
  size_t count(const DoubleRay& ray) const;
  struct Closest {
    uint32_t record = noHit, primitive = 0;
    DoubleClosest at;
    DoublePlace place; // on the surface that is given, if another one may be as near
    Vec3d normal;
  };
  // Finds the place of a triangle or sphere that is closest to a point, up to a distance. Returns
  // false if there is none.
  bool closest(const Vec3d& point, double radius, Closest& found) const;
  // Returns the record of a sphere that is none any more, because its matrix scales it unevenly;
  // noHit if there is none.
  uint32_t unevenSphere() const;
  // Returns the place of a hit in the world, and a bound of the error of its components.
  DoublePlace place(const Hit& hit, const DoubleRay& ray) const;
  // Returns the unit normal in the world, on the front side.
  Vec3d normal(const Hit& hit, const DoubleRay& ray) const;

 private:
  struct Surface;
  struct Surfaces; // an ExactSearch of them
  class Nearest;
  class ClosestVisitor;

  void addSurfaces(const EmbreeDevice& device, const Input& input, uint32_t cluster,
                   const DoubleScene* former);
  void addSurface(const EmbreeDevice& device, const Geometry& geometry, const Matrix4d& world,
                  uint32_t record, const DoubleScene* former);
  void approach(const Surface& surface, ClosestVisitor& to) const;
  Vec3d normalAt(const Surface& surface, uint32_t primitive, const Vec3d& place) const;

  std::unique_ptr<Surfaces> surfaces_;
};

} // namespace openrt

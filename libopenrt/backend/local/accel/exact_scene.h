// exact_scene.h: all surfaces of a scene for exact ray queries. A ray meets every triangle that it
// crosses exactly once (crossing.h), whatever single precision makes of it. Made between frames
// from an Accel, when the first query needs it, and again after changes; then immutable. [any
// thread]
#pragma once

#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "backend/local/accel/accel.h"
#include "backend/local/accel/candidates.h"
#include "backend/local/accel/crossing_collectors.h"
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
  struct Mesh;
  struct Surface;
  using Collector = CrossingCollector<Hit>;
  class Nearest;
  class MeshVisitor;
  class TopVisitor;
  using Key = std::tuple<const float*, const uint32_t*, uint32_t>; // vertices, indices, number
  std::shared_ptr<const Mesh> meshOf(const EmbreeDevice& device, const Record& r,
                                     const ExactScene* former);
  void makeTop(const EmbreeDevice& device);
  void search(const ExactRay& ray, Collector& to) const;
  double meet(const Surface& surface, const ExactRay& ray, Collector& to) const;
  double meetTriangle(const Surface& surface, uint32_t triangle, const ExactRay& ray,
                      Collector& to) const;
  double meetSphere(const Surface& surface, const ExactRay& ray, Collector& to) const;
  double meetAnalytic(const Surface& surface, const ExactRay& ray, Collector& to) const;

  const Accel& accel_;
  std::map<Key, std::shared_ptr<const Mesh>> meshes_; // each once, however often it is placed
  // Own the vertices, so that equal addresses mean the same meshes.
  std::vector<std::shared_ptr<const Blas>> owners_;
  std::vector<Surface> surfaces_;
  std::vector<uint32_t> surfaceOf_; // by record
  // The frame of top_: render space minus `center_`, times `unit_`.
  Vec3d center_;
  double unit_ = 1;
  std::unique_ptr<CandidateScene> top_; // the boxes of the surfaces; null if they are few
};

} // namespace openrt

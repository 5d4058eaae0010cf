// precise_scene.h: all surfaces of a scene for ray queries in double precision. Made when the first
// such query needs it, and again after changes; then immutable. [any thread]
//
// The surfaces are those that the application gave: vertices in floats as they are stored, placed
// in the world by the product of the matrices of their instances. That product is rounded to
// double; nothing else is. Unlike an ExactScene it knows no render space and no rounded places.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "backend/local/accel/accel.h"
#include "backend/local/accel/crossing_collectors.h"
#include "backend/local/accel/survey.h"
#include "backend/local/precise/closest.h"
#include "backend/local/precise/search_frame.h"

namespace openrt {

class PreciseScene {
 public:
  struct Input {
    const Scene& scene;
    const Flattened& flat;
    const Survey& survey;
    const Accel& accel; // its records are the ones that hits name
  };
  // former: the scene before a change, whose meshes are kept where they are still in use; or null.
  PreciseScene(const EmbreeDevice& device, const Input& input, const PreciseScene* former);
  ~PreciseScene();

  struct Hit {
    uint32_t record = noHit, primitive = 0;
    PreciseCrossing at;
    bool ambiguous = false; // another surface is so near that it may be the first
  };
  // Returns whether the ray hits anything. The bound of the error includes that surfaces which are
  // nearer together than their bounds may be in another order.
  bool nearest(const PreciseRay& ray, Hit& hit) const;
  bool occluded(const PreciseRay& ray) const;
  void all(const PreciseRay& ray, std::vector<Hit>& hits) const; // in order of t
  size_t count(const PreciseRay& ray) const;
  struct Closest {
    uint32_t record = noHit, primitive = 0;
    PreciseClosest at;
    PrecisePlace place; // on the surface that is given, if another one may be as near
    Vec3d normal;
  };
  // Finds the place of a triangle or sphere that is closest to a point, up to a distance. Returns
  // false if there is none.
  bool closest(const Vec3d& point, double radius, Closest& found) const;
  // Returns the record of a sphere that is none any more, because its matrix scales it unevenly;
  // noHit if there is none.
  uint32_t unevenSphere() const;
  // Returns the place of a hit in the world, and a bound of the error of its components.
  PrecisePlace place(const Hit& hit, const PreciseRay& ray) const;
  // Returns the unit normal in the world, on the front side.
  Vec3d normal(const Hit& hit, const PreciseRay& ray) const;

 private:
  struct Mesh;
  struct Surface;
  using Collector = CrossingCollector<Hit>;
  class Nearest;
  class MeshVisitor;
  class TopVisitor;
  class ClosestVisitor;
  using Key = std::pair<const Array*, const Array*>; // points and indices

  void addSurfaces(const EmbreeDevice& device, const Input& input, uint32_t cluster,
                   const PreciseScene* former);
  void addSurface(const EmbreeDevice& device, const Geometry& geometry, const Matrix4d& world,
                  uint32_t record, const PreciseScene* former);
  std::shared_ptr<const Mesh> meshOf(const EmbreeDevice& device, const Geometry& geometry,
                                     const PreciseScene* former);
  void makeTop(const EmbreeDevice& device);
  void search(const PreciseRay& ray, Collector& to) const;
  double meet(const Surface& surface, const PreciseRay& ray, Collector& to) const;
  double meetTriangle(const Surface& surface, uint32_t triangle, const PreciseRay& ray,
                      Collector& to) const;
  double meetMesh(const Surface& surface, const PreciseRay& ray, Collector& to) const;
  double meetSphere(const Surface& surface, const PreciseRay& ray, Collector& to) const;
  double meetAnalytic(const Surface& surface, const PreciseRay& ray, Collector& to) const;
  void approach(const Surface& surface, ClosestVisitor& to) const;
  Vec3d normalAt(const Surface& surface, uint32_t primitive, const Vec3d& place) const;

  std::map<Key, std::shared_ptr<const Mesh>> meshes_; // each once, however often it is placed
  std::vector<Surface> surfaces_;
  std::vector<uint32_t> surfaceOf_;     // by record
  SearchFrame frame_;                   // the frame of top_
  std::unique_ptr<CandidateScene> top_; // the boxes of the surfaces; null if they are few
};

} // namespace openrt

// survey.h: statistics of a flattened scene: bounds, triangle counts, how each geometry is built
// into the acceleration structure, and from these the origin and the scale of render space. The
// results depend only on the committed scene and the camera, never on earlier frames. Owned by
// AccelBuilder; called on the application thread, between frames.
#pragma once

#include <map>
#include <unordered_map>
#include <vector>

#include "backend/local/accel/size_groups.h"
#include "render/records.h"
#include "scene/flatten.h"

namespace openrt {

// How a geometry is built into its part.
enum class DrawnAs : uint8_t {
  baked,     // in an Embree scene of the part: the only one, unless sizes differ too much
  shared,    // in the Embree scene of its object, which has many instances
  ellipsoid, // as an instance of the unit sphere
  thin       // as lines or points, whose width in pixels depends on the camera
};

// Returns whether the records of a geometry have frames. root: in the static scene.
inline bool hasFrames(const Geometry& g, DrawnAs drawn, bool root) {
  if (drawn == DrawnAs::thin) return false;
  return !root || drawn == DrawnAs::shared || g.surface || g.primitive == edit::Primitive::Sphere;
}

struct ObjectInfo {
  uint64_t version = 0;
  std::vector<double> sizes; // half the diagonal of each geometry's bounds
  Box bounds;
  uint64_t triangles = 0;
  // It has lines, points or ellipsoids, which cannot be instanced, or sizes that do not fit into
  // one frame.
  bool bakeOnly = false;
};

struct PartInfo {
  std::vector<uint32_t> firstEntry; // for each item; an entry is one geometry of one item
  std::vector<DrawnAs> drawn;       // by entry
  Box bounds;                       // in the part's frame
  uint64_t triangles = 0;
  bool lines = false, points = false;
  uint32_t framed = 0;               // number of entries that have frames
  uint32_t baked = 0;                // number of Embree scenes with baked geometry
  std::vector<uint32_t> groups;      // which of them holds an entry; empty: the only one
  std::vector<uint32_t> sharedItems; // in order
  std::vector<std::pair<uint32_t, uint32_t>> ellipsoids; // (item, geometry), in order
  std::vector<uint32_t> clusters;                        // ascending
  uint32_t entries() const { return uint32_t(drawn.size()); }
  uint32_t groupOf(uint32_t entry) const { return groups.empty() ? 0 : groups[entry]; }
};

class Survey {
 public:
  // Surveys the whole scene.
  void take(const Scene& scene, const Flattened& flat);
  // Updates the survey after objects, dynamic before and after, were redefined. Returns false if
  // more than their Embree scenes must be rebuilt; then take() must follow.
  bool resurvey(const Scene& scene, const Flattened& flat, const std::vector<uint32_t>& objects);
  // Updates the bounds of clusters that moved.
  void place(const Flattened& flat, const std::vector<uint32_t>& clusters);

  const ObjectInfo& object(uint32_t id) const { return objects_.at(id); }
  const std::vector<PartInfo>& parts() const { return parts_; }
  uint32_t partOf(uint32_t object) const; // ~0: the object is not the root of a part
  uint64_t uniqueTriangles() const;

  // Returns the origin of render space for an eye: the eye's position, snapped to a grid. So
  // coordinates near the eye keep their precision, and few camera moves rebuild the scene. The cell
  // is a power of two, about as large as the scene, or smaller if most geometry is much smaller.
  Vec3d origin(const Vec3d& eye) const;
  // Returns the factor from render space to the space of the ray kernels: a power of two, 1 except
  // for extreme sizes.
  double scale(const Vec3d& origin) const;
  // Returns a distance from the origin beyond which there is nothing: a power of 1024, so that it
  // seldom changes.
  double reach(const Vec3d& origin) const;

 private:
  void measure(const Scene& scene, uint32_t object);
  PartInfo measurePart(const Scene& scene, const ScenePart& part, bool root) const;
  bool resurveyObject(const Scene& scene, const Flattened& flat, uint32_t object);
  void measureDetail(const Scene& scene, const Flattened& flat);
  void groupBaked(const Scene& scene, const ScenePart& part, PartInfo& info) const;
  bool isShared(uint32_t object) const;
  Box bounds() const;
  double farthest(const Vec3d& origin) const; // largest difference of a coordinate; 0: nothing
  std::map<uint32_t, ObjectInfo> objects_;
  // number of items that place an object, over all parts
  std::unordered_map<uint32_t, uint64_t> uses_;
  std::unordered_map<uint32_t, uint32_t> partOf_;
  std::vector<PartInfo> parts_;
  std::vector<Box> boxes_; // boxes around clusters, in the world
  int detail_ = 0;         // log2 of the median size of geometry
};

// Returns whether the matrix scales all directions equally, so that a sphere stays a sphere.
bool similarity(const Matrix4d& m);
Matrix4d uniformScale(double s);
Matrix4d matrixOf(const Affine& affine);

} // namespace openrt

// survey.h: what the parts of a flattened scene weigh: bounds, triangles, which objects are drawn
// as instances of their own, how each geometry is drawn; and from that the origin and the scale of
// render space. All of it is a function of the committed scene and the camera alone: nothing
// depends on what was rendered before. Kept by the builder; application thread, between frames.
#pragma once

#include <map>
#include <unordered_map>
#include <vector>

#include "backend/local/accel/bake.h"
#include "scene/flatten.h"

namespace openrt {

enum class DrawnAs : uint8_t { // within its part
  baked,                       // in the Embree scene of the part
  heavy,                       // in the Embree scene of its object, which many places share
  ellipsoid,                   // an instance of the unit sphere
  thin                         // line or point: pixels wide, so it changes with the camera
};

struct ObjectInfo {
  uint64_t version = 0;
  std::vector<Box> boxes; // by geometry
  Box bounds;
  uint64_t triangles = 0;
  bool bakeOnly = false; // lines, points and ellipsoids cannot be instanced
};

struct PartInfo {
  std::vector<uint32_t> firstEntry; // by item; an entry is a geometry of an item
  std::vector<DrawnAs> drawn;       // by entry
  Box bounds;                       // in the part's frame
  uint64_t triangles = 0;
  bool baked = false, lines = false, points = false;
  std::vector<uint32_t> heavyItems;                      // in order
  std::vector<std::pair<uint32_t, uint32_t>> ellipsoids; // (item, geometry), in order
  std::vector<uint32_t> clusters;                        // ascending
  uint32_t entries() const { return uint32_t(drawn.size()); }
};

class Survey {
 public:
  void take(const Scene& scene, const Flattened& flat);
  // After an object, dynamic before and after, was redefined. False if more follows from it than a
  // new Embree scene.
  bool retake(const Scene& scene, const Flattened& flat, uint32_t object);
  // After these clusters have moved.
  void place(const Flattened& flat, const std::vector<uint32_t>& clusters);

  const ObjectInfo& object(uint32_t id) const { return objects_.at(id); }
  const std::vector<PartInfo>& parts() const { return parts_; }
  uint32_t partOf(uint32_t object) const; // ~0: it is the root of no part
  uint64_t uniqueTriangles() const;

  // Of render space, for an eye. The eye's place on a grid: what is near it keeps its digits, and
  // few moves of the camera round the scene anew. The cell is a power of two, as large as the
  // scene; smaller where most of what is there is far smaller.
  Vec3d origin(const Vec3d& eye) const;
  // Render space x scale = the kernels' space; a power of two, 1 for all but extreme sizes.
  double scale(const Vec3d& origin) const;

 private:
  void measure(const Scene& scene, uint32_t object);
  PartInfo weigh(const Scene& scene, const ScenePart& part, bool root) const;
  bool isHeavy(uint32_t object) const;
  Box bounds() const;
  std::map<uint32_t, ObjectInfo> objects_;
  std::unordered_map<uint32_t, uint64_t> uses_; // items of an object over all parts
  std::unordered_map<uint32_t, uint32_t> partOf_;
  std::vector<PartInfo> parts_;
  std::vector<Box> boxes_; // of clusters, in the world
  int detail_ = 0;         // log2 of the median size of static geometry
};

// Whether lengths keep their ratios: a sphere stays one.
bool similarity(const Matrix4d& m);
Matrix4d uniformScale(double s);

} // namespace openrt

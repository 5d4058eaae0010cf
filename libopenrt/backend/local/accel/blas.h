// blas.h: a bottom-level acceleration structure (Blas): one Embree scene of geometries that do not
// move relative to each other. There is one for the static world, one for each part below a dynamic
// instance, and one for each object with many copies. Built between frames, immutable afterwards
// and shared by all its instances.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "backend/local/accel/embree_parts.h"
#include "scene/scene.h"

namespace openrt {

struct BakedTriangles;

struct Blas : PartScene {
  Matrix4d fromKernel; // from the Embree scene's frame, scaled near 1, to that of its contents
  std::vector<const float*> vertices; // vertices of triangles by entry, in the Embree scene's frame
  uint64_t degenerate = 0;            // number of dropped triangles
  bool instances = false;             // contains instances, so it cannot be instanced itself
  int8_t enlargement = 0;             // largest one of these (embree_parts.h)
  // For a mesh that deforms, which is part 0: what the tree was built of.
  struct Tree {
    ArrayPtr rest, indices;
    std::vector<uint32_t> kept; // numbers of the triangles; empty: all
    uint32_t mask = 0;
    bool slivers = false; // they are in part 1
    bool operator==(const Tree& other) const;
  };
  std::optional<Tree> tree;
  bool refitted = false; // the tree is that of a former Blas
};

// The unit sphere for each mask; ellipsoids are instances of it.
class UnitSpheres {
 public:
  explicit UnitSpheres(const EmbreeDevice& device) : device_(device) {}
  std::shared_ptr<const Blas> get(uint32_t mask);

 private:
  const EmbreeDevice& device_;
  std::map<uint32_t, std::shared_ptr<const Blas>> spheres_;
};

class BlasBuilder {
 public:
  // reach: of the scene, in the Embree scene's frame, for a Blas that may hold instances.
  BlasBuilder(const EmbreeDevice& device, UnitSpheres& spheres, size_t entries, double reach = 0);
  // Adds a geometry (triangles, a sphere or an analytic surface) as entry number `entry`. toKernel:
  // from its local frame to the Embree scene's.
  void add(const Geometry& geometry, const Matrix4d& toKernel, uint32_t entry, uint32_t mask);
  // Adds a mesh that deforms and is alone in its scene. Its tree is built of the points at rest and
  // refitted to those of now, so it does not depend on what was between. former: a scene of the
  // same entry, whose tree is taken over if it is the right one; or null.
  void addDeforming(const Geometry& geometry, const Matrix4d& toKernel, uint32_t entry,
                    uint32_t mask, Blas* former);
  // Adds an instance of another Blas; its entries are numbered from `entry` on.
  void addInstance(std::shared_ptr<const Blas> blas, const Matrix4d& toKernel, uint32_t entry);
  std::shared_ptr<Blas> finish();

 private:
  void addTriangles(const Geometry& geometry, BakedTriangles baked, uint32_t entry, uint32_t mask);
  void takeOver(Blas& former, std::vector<float> vertices);
  void addSphere(const Geometry& geometry, const Matrix4d& toKernel, uint32_t entry, uint32_t mask);
  void addAnalytic(const Geometry& geometry, const Matrix4d& toKernel, uint32_t entry,
                   uint32_t mask);
  Part& extend(const std::vector<float>& vertices, uint32_t entry, uint32_t mask, bool slivers,
               uint32_t& base);
  void merge(const std::vector<float>& vertices, const uint32_t* index,
             const std::vector<uint32_t>* which, size_t count, uint32_t entry, uint32_t mask);
  void mergeSlivers(const BakedTriangles& baked, const uint32_t* index, uint32_t entry,
                    uint32_t mask);

  const EmbreeDevice& device_;
  UnitSpheres& unitSpheres_;
  const double reach_;
  std::shared_ptr<Blas> blas_;
  // Triangles of small geometries, by (mask, slivers).
  std::map<std::pair<uint32_t, bool>, std::unique_ptr<Part>> merged_;
  std::map<uint32_t, std::unique_ptr<Part>> spheres_, hugeSpheres_, analytic_; // by mask
  struct VertexOf { // where an entry's vertices are stored
    uint32_t entry;
    const Part* part;
    size_t offset;
  };
  std::vector<VertexOf> vertexOf_;
  size_t triangles_ = 0;
  // For a mesh that deforms and gets a new tree: its vertices now.
  std::vector<float> deformed_;
};

// Returns the map to the frame of the bounds from a frame in which they have a size near 1 and are
// centred, or have this point of theirs at the origin.
Matrix4d kernelFrame(const Vec3d& low, const Vec3d& high,
                     const std::optional<Vec3d>& origin = std::nullopt);

} // namespace openrt

// body.h: one Embree scene made of geometries that keep their places to each other: the static
// world, the part under a dynamic instance, an object with many copies. Made between frames,
// immutable afterwards; shared by all places where it stands.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "backend/local/accel/embree_parts.h"
#include "scene/scene.h"

namespace openrt {

struct Body : PartScene {
  Matrix4d fromKernel; // the scene's frame, scaled near 1, to the frame of what it holds
  std::vector<const float*> vertices; // of triangles, by entry, in the scene's frame
  uint64_t degenerate = 0;            // triangles dropped
  bool instances = false;             // it holds some: it cannot be instanced itself
};

// The unit sphere, by mask: ellipsoids are instances of it.
class UnitSpheres {
 public:
  explicit UnitSpheres(const EmbreeDevice& device) : device_(device) {}
  std::shared_ptr<const Body> get(uint32_t mask);

 private:
  const EmbreeDevice& device_;
  std::map<uint32_t, std::shared_ptr<const Body>> spheres_;
};

class BodyBuilder {
 public:
  BodyBuilder(const EmbreeDevice& device, UnitSpheres& spheres, size_t entries);
  // A geometry, triangles or sphere, under an entry's number. toKernel: its local frame to the
  // scene's.
  void add(const Geometry& geometry, const Matrix4d& toKernel, uint32_t entry, uint32_t mask);
  // Another body within this one, its entries numbered from `entry` on.
  void addInstance(std::shared_ptr<const Body> body, const Matrix4d& toKernel, uint32_t entry);
  std::shared_ptr<Body> finish();

 private:
  void addTriangles(const Geometry& geometry, const Matrix4d& toKernel, uint32_t entry,
                    uint32_t mask);
  void addSphere(const Geometry& geometry, const Matrix4d& toKernel, uint32_t entry, uint32_t mask);
  Part& merge(const std::vector<float>& vertices, const uint32_t* index,
              const std::vector<uint32_t>* which, size_t count, uint32_t entry, uint32_t mask,
              bool slivers);

  const EmbreeDevice& device_;
  UnitSpheres& unitSpheres_;
  std::shared_ptr<Body> body_;
  std::map<std::pair<uint32_t, bool>, std::unique_ptr<Part>>
      merged_; // triangles of small geometries, by (mask, slivers)
  std::map<uint32_t, std::unique_ptr<Part>> spheres_, hugeSpheres_; // by mask
  struct VertexOf {                                                 // where an entry's vertices lie
    uint32_t entry;
    const Part* part;
    size_t offset;
  };
  std::vector<VertexOf> vertexOf_;
};

// The frame in which bounds are scaled near 1 around their centre, to the bounds' own frame.
Matrix4d kernelFrame(const Vec3d& low, const Vec3d& high);

} // namespace openrt

// accel.h: the scene as Embree holds it: one root scene; what is placed once (or is cheap) baked into it relative to the render
// origin, what is placed often as instances of object scenes scaled near 1. Built between frames, traced by render threads.
#pragma once

#include <array>
#include <atomic>
#include <map>
#include <memory>
#include <vector>

#include "backend/local/embree.h"
#include "render/rays.h"
#include "render/render_scene.h"
#include "scene/flatten.h"

namespace openrt {

struct EmbreeDevice {
  explicit EmbreeDevice(uint32_t threads);
  ~EmbreeDevice() { rtcReleaseDevice(device); }
  EmbreeDevice(const EmbreeDevice&) = delete;
  EmbreeDevice& operator=(const EmbreeDevice&) = delete;
  RTCDevice device;
  bool wide = true;              // packets of 16 are native
  std::atomic<int64_t> bytes{0}; // held by acceleration structures
};

// How one Embree geometry's primitives lead to records and primitives of ours.
struct Part {
  uint32_t record = 0;            // of every primitive, or
  std::vector<uint32_t> recordOf; // one a primitive (merged geometries)
  std::vector<uint32_t> primitiveOf;
  std::vector<float> vertices; // as Embree reads them
  std::vector<uint32_t> indices;
  ArrayPtr sharedIndices;
  uint32_t objectScene = ~0u; // an instance: index of its object scene; record is the placement's first
};

// An Embree scene with its parts by geometry id.
struct PartScene {
  PartScene() = default;
  PartScene(const PartScene&) = delete;
  PartScene& operator=(const PartScene&) = delete;
  ~PartScene() {
    if (scene) rtcReleaseScene(scene);
  }
  RTCScene scene = nullptr;
  std::vector<std::unique_ptr<Part>> parts;
};

struct PixelFootprint { // size of a pixel at a distance along the view axis, render space
  float constant = 0, slope = 0;
  float eye[3] = {}, axis[3] = {0, 0, -1};
};

// Makes records and the acceleration structure of a scene. origin: of render space, in the world.
class Accel final : public Intersector {
 public:
  Accel(std::shared_ptr<EmbreeDevice> device, const Scene& scene, const Flattened& flat, const ShaderTable& shaders,
        const Vec3d& origin, const PixelFootprint& footprint);

  std::vector<Record> records;
  std::vector<Bucket> buckets;
  bool hasTransparent = false, hasThin = false, hasInstances = false;
  uint64_t triangles = 0, uniqueTriangles = 0, degenerate = 0;
  double radius = 0; // half the diagonal of the scene's bounds
  mutable std::atomic<uint64_t> rejectedRays{0};

  uint64_t builds() const { return objectScenes_.size() + 1; } // scenes of objects, and what is baked
  void intersect(const Rays& rays, uint32_t mask, Coherence coherence, RayHits& hits) const override;
  void intersectFronts(const Rays& rays, uint32_t mask, RayHits& hits) const override;
  void occluded(const Rays& rays, uint32_t mask, Coherence coherence, uint8_t* blocked) const override;

 private:
  friend class AccelBuilder;
  template <class Packet>
  void intersectPackets(const Rays& rays, uint32_t mask, const QueryOptions& options, RayHits& hits) const;
  struct Found {
    uint32_t record, primitive;
  };
  Found find(uint32_t instance, uint32_t geometry, uint32_t primitive) const; // Embree's numbers to ours
  static void rejectBacks(const RTCFilterFunctionNArguments* a);
  template <class Packet> void occludedPackets(const Rays& rays, uint32_t mask, bool coherent, uint8_t* blocked) const;

  std::shared_ptr<EmbreeDevice> device_;
  PartScene root_;
  std::vector<std::unique_ptr<PartScene>> objectScenes_;
  float scale_ = 1; // render space x scale = the root scene's space; a power of two
};

} // namespace openrt

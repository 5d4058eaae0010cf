// embree_parts.h: Embree geometries made from parts. Each attaches a part under the geometry id
// that is its index in PartScene::parts and keeps it alive there.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "backend/local/accel/embree.h"
#include "scene/commit.h"
#include "scene/matrix.h"

namespace openrt {

struct EmbreeDevice {
  explicit EmbreeDevice(uint32_t threads);
  ~EmbreeDevice() { rtcReleaseDevice(device); }
  EmbreeDevice(const EmbreeDevice&) = delete;
  EmbreeDevice& operator=(const EmbreeDevice&) = delete;
  RTCDevice device;
  bool wide = true;                           // packets of 16 are native
  std::atomic<int64_t> bytes{0};              // held by acceleration structures
  mutable std::atomic<uint64_t> wrongHits{0}; // on slivers, of single precision, not taken
};

struct Body;

// How one Embree geometry's primitives lead to records and primitives of ours.
struct Part {
  uint32_t record = 0;            // of every primitive, or
  std::vector<uint32_t> recordOf; // one a primitive (merged geometries)
  std::vector<uint32_t> primitiveOf;
  std::vector<float> vertices; // as Embree reads them
  std::vector<uint32_t> indices;
  ArrayPtr sharedIndices;
  std::vector<uint8_t>
      openEdges; // of slivers, a triangle each: bits of edges that it shares with what is none
  std::vector<Matrix4d> spheres; // huge ones: the unit sphere's frame to that of the geometry
  std::atomic<uint64_t>* wrongHits = nullptr; // of slivers: the device's, which outlives it
  std::shared_ptr<const Body> object;         // an instance of it; record is the first of the place
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

inline constexpr uint32_t nextSlot = ~0u; // behind the parts there are

RTCScene newScene(const EmbreeDevice& device); // robust mode
// slivers: they are met in double precision.
void attachTriangles(PartScene& to, const EmbreeDevice& device, std::unique_ptr<Part> part,
                     uint32_t mask, bool slivers);
// The geometry of slivers, not yet attached; the part stays where it is.
RTCGeometry newSlivers(const EmbreeDevice& device, Part& part);
// Huge spheres and ellipsoids (render/huge_spheres.h): part.spheres, met in double precision.
void attachHugeSpheres(PartScene& to, const EmbreeDevice& device, std::unique_ptr<Part> part,
                       uint32_t mask);
RTCGeometry newHugeSpheres(const EmbreeDevice& device, Part& part); // not yet attached
// Spheres or round linear curves; part.vertices have stride 4: centre and radius. slot: the
// geometry id, of those in parts.
void attachRound(PartScene& to, const EmbreeDevice& device, std::unique_ptr<Part> part,
                 uint32_t mask, RTCGeometryType type, uint32_t slot = nextSlot);
// An instance of part->object.
void attachInstance(PartScene& to, const EmbreeDevice& device, std::unique_ptr<Part> part,
                    const Matrix4d& matrix, uint32_t slot = nextSlot);
void detach(PartScene& from, uint32_t slot); // nothing if the slot is empty
// Of the instance in a slot: places it, or takes it out of sight.
void setTransform(PartScene& in, uint32_t slot, const Matrix4d& matrix);
void setEnabled(PartScene& in, uint32_t slot, bool enabled);

} // namespace openrt

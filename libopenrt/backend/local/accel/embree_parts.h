// embree_parts.h: creates Embree geometries from parts. The attach functions add a part to an
// Embree scene. Its geometry id is its index in PartScene::parts, which owns it. Called between
// frames.
#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "backend/local/accel/embree_device.h"
#include "backend/local/accel/primitive_runs.h"
#include "backend/local/sliver_lanes.h"
#include "backend/local/sliver_pieces.h"
#include "scene/analytic.h"
#include "scene/commit.h"
#include "scene/matrix.h"
#include "scene/stipple.h"

namespace openrt {

struct Blas;

// An analytic surface in the frame of an Embree geometry.
struct PlacedSurface {
  std::shared_ptr<const AnalyticSurface> surface;
  Matrix4d toKernel, fromKernel;
};

// The buffers of one Embree geometry, and the map from its primitives to records and primitives of
// the scene.
struct Part {
  PrimitiveRuns primitives;
  std::vector<float> vertices; // in the layout that Embree reads
  std::vector<uint32_t> indices;
  ArrayPtr sharedIndices;
  // For lines: which part of its line each primitive is, from 0 to 1; empty if all are whole.
  struct Span {
    float from, to;
  };
  std::vector<Span> spans;
  // For lines: RTC_CURVE_FLAG_* of each primitive, where it is joined to its neighbours; empty if
  // none is.
  std::vector<uint8_t> joints;
  std::vector<std::vector<StippledLine>> stippled; // the lines of each geometry with a pattern
  // For slivers. A primitive is a piece of a triangle; the indices of all pieces are those of the
  // triangle.
  std::vector<uint8_t> openEdges; // bits of the open edges of the piece's triangle (sliver_edges.h)
  std::vector<Piece> pieces;
  std::vector<SliverOutline> outlines;
  std::vector<Matrix4d> spheres; // for huge spheres: unit sphere's frame to the geometry's frame
  std::vector<PlacedSurface> surfaces;        // for analytic surfaces
  std::atomic<uint64_t>* wrongHits = nullptr; // for slivers: the device's; it outlives the part
};

// One Embree geometry: a part, or an instance of another Embree scene. There may be a million
// instances, so an instance takes no memory besides its slot.
struct PartSlot {
  std::unique_ptr<Part> part;         // null for an instance
  std::shared_ptr<const Blas> object; // for an instance: the instanced scene
  uint32_t record = 0;                // for an instance: the first of its records
  bool enabled = true;
  int8_t enlargement = 0; // for an instance: see enlargementOf()
  bool used() const { return part || object; }
};

// An Embree scene and its parts, indexed by geometry id.
struct PartScene {
  PartScene() = default;
  PartScene(const PartScene&) = delete;
  PartScene& operator=(const PartScene&) = delete;
  ~PartScene() {
    if (scene) rtcReleaseScene(scene);
  }
  RTCScene scene = nullptr;
  std::vector<PartSlot> parts;
};

inline constexpr uint32_t nextSlot = ~0u; // the first id after the existing parts

RTCScene newScene(const EmbreeDevice& device); // Creates an empty scene in robust mode.
void setCompact(RTCScene scene); // makes a scene that is not yet committed take less memory
// Lets a scene that is not yet committed keep its trees from commit to commit.
void setDeforming(RTCScene scene);
// Attaches triangles; if `slivers`, as a user geometry that intersects in double precision.
// refitted: commits after setVertices() keep the tree, in a scene after setDeforming().
void attachTriangles(PartScene& to, const EmbreeDevice& device, std::unique_ptr<Part> part,
                     uint32_t mask, bool slivers, bool refitted = false);
// Replaces the vertices of the triangles in a slot, whose number stays.
void setVertices(PartScene& in, uint32_t slot, std::vector<float> vertices);
// Creates the user geometry of slivers without attaching it. The part must keep its address.
RTCGeometry newSlivers(const EmbreeDevice& device, Part& part);
// Attaches huge spheres and ellipsoids (render/huge_spheres.h) from part.spheres, intersected in
// double precision.
void attachHugeSpheres(PartScene& to, const EmbreeDevice& device, std::unique_ptr<Part> part,
                       uint32_t mask);
// Creates the user geometry of huge spheres without attaching it.
RTCGeometry newHugeSpheres(const EmbreeDevice& device, Part& part);
// Attaches quadrics and aspheres from part.surfaces, intersected in double precision.
void attachAnalytic(PartScene& to, const EmbreeDevice& device, std::unique_ptr<Part> part,
                    uint32_t mask);
// Creates the user geometry of analytic surfaces without attaching it.
RTCGeometry newAnalytic(const EmbreeDevice& device, Part& part);
// Attaches spheres or round linear curves. part.vertices have stride 4: centre and radius. slot:
// the geometry id.
void attachRound(PartScene& to, const EmbreeDevice& device, std::unique_ptr<Part> part,
                 uint32_t mask, RTCGeometryType type, uint32_t slot = nextSlot);
// Returns the exponent of a power of two by which the frame of an instance enlarges coordinates and
// directions at most; 0 if it does not. 127: by more than can be traced.
int8_t enlargementOf(const Matrix4d& matrix);
// Tells whether an instance can be traced by rays from everywhere within `reach` of the origin: in
// its frame their coordinates must not leave the range of the kernels.
bool isTraceable(const Matrix4d& matrix, double reach);
// Returns the largest coordinate of a ray's origin, and of its direction, for a scene with
// instances of this enlargement, all of which are traceable.
inline float largestCoordinate(int8_t enlargement) {
  return enlargement > 0 ? std::ldexp(1e17f, -enlargement) : 1e18f;
}
// Attaches an instance of another scene. record: the first of the instance's records.
void attachInstance(PartScene& to, const EmbreeDevice& device, std::shared_ptr<const Blas> object,
                    uint32_t record, const Matrix4d& matrix, uint32_t slot = nextSlot);
void detach(PartScene& from, uint32_t slot); // does nothing if the slot is empty
// setTransform() moves the instance in a slot, setEnabled() shows or hides it.
void setTransform(PartScene& in, uint32_t slot, const Matrix4d& matrix);
// Returns the matrix of the instance in a slot, which is made of floats.
Matrix4d transformOf(const PartScene& in, uint32_t slot);
void setEnabled(PartScene& in, uint32_t slot, bool enabled);

} // namespace openrt

// accel.h: the acceleration structure of a scene: two Embree scenes, traced one after the other.
//   static     everything that never moves, baked relative to the render origin, with instances of
//              objects that occur often
//   top level  an instance for every moving cluster (scene/flatten.h), and the lines and points,
//              which change with the camera; it is small and rebuilt when one of them moves
// A ray is first traced through the static scene, in packets of 16; its hit shortens the ray for
// the top level. (A single top level with an instance of everything static would cost as little to
// rebuild. But packets of 16 on instances are slow, and with the coherent flag Embree 3.13 never
// returns from some.) Changed between frames by AccelBuilder, traced by render threads.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "backend/local/accel/blas.h"
#include "render/rays.h"
#include "render/render_scene.h"

namespace openrt {

struct PacketRays;

class Accel final : public Intersector {
 public:
  std::vector<Record> records;
  std::vector<Bucket> buckets;
  bool hasTransparent = false;
  bool culls = false; // whether any visible record has culled back faces
  mutable std::atomic<uint64_t> rejectedRays{0};

  void intersect(const Rays& rays, uint32_t mask, Coherence coherence,
                 RayHits& hits) const override;
  void findLost(const Rays& rays, const uint8_t* aimed, RayHits& hits) const override;
  // Intersects without the search for hits that are lost at vertices.
  void intersectInSinglePrecision(const Rays& rays, uint32_t mask, Coherence coherence,
                                  RayHits& hits) const;
  void intersectFronts(const Rays& rays, uint32_t mask, RayHits& hits) const override;
  void occluded(const Rays& rays, uint32_t mask, Coherence coherence,
                uint8_t* blocked) const override;
  bool cullsBacks() const override { return culls; }
  void occludedByFronts(const Rays& rays, uint32_t mask, uint8_t* blocked) const override;
  void intersectOthers(const Rays& rays, const uint32_t* record, RayHits& hits) const override;
  void bounds(float low[3], float high[3]) const override;

  struct Nearest {
    uint32_t record = noHit, primitive = 0;
    double distance = 0;
    Vec3d point, normal; // normal: outward, unit
    double u = 0, v = 0;
  };
  // Finds the surface point closest to a point of render space, within `distance`. Returns false if
  // there is none. round: the result of spheres(). [any thread]
  bool nearest(const Vec3d& place, double distance, std::span<const uint32_t> round,
               Nearest& out) const;
  std::vector<uint32_t> spheres() const; // returns the records of all visible spheres
  struct Surface {
    uint32_t record;
    // To render space: of a sphere from the unit sphere's frame, of an analytic surface from its
    // own.
    Matrix4d toRender;
  };
  // Returns the largest coordinate of an origin of a ray, in render space.
  double reach() const { return 1e18 / double(scale_); }
  // Render space times this factor is the space of Embree's scenes.
  float scale() const { return scale_; }
  // Returns all visible triangle meshes, spheres and analytic surfaces.
  std::vector<Surface> surfaces() const;
  // Returns the Embree scenes that own the vertices of all records.
  std::vector<std::shared_ptr<const Blas>> owners() const;
  // Returns the first record of a cluster; the entries of its part follow in order.
  uint32_t firstRecord(uint32_t cluster) const { return placed_[cluster].firstRecord; }

 private:
  friend class AccelBuilder;
  struct Level { // one of the two scenes
    const PartScene* scene = nullptr;
    uint32_t masks = 0;     // union of the masks of its geometries; 0: the scene is empty
    bool instances = false; // whether the scene contains instances
    // Largest coordinate of the origin and of the direction of a ray, in the units of the kernels.
    float limit = 1e18f;
  };
  template <class Packet> void intersectPackets(const Level& level, const Rays& rays, uint32_t mask,
                                                const QueryOptions& options, bool first,
                                                RayHits& hits) const;
  template <class Packet> void occludedPackets(const Level& level, const Rays& rays, uint32_t mask,
                                               const QueryOptions& options, bool first,
                                               uint8_t* blocked) const;
  // Rays of a packet that were moved along their direction (accel_far.cpp). t is that of the moved
  // ray in the units of the kernel.
  struct FarRays {
    uint32_t lanes = 0;              // a bit for each ray that was moved
    double shift[16], perLength[16]; // by how much; units of the kernel in a length of t
    double distance(uint32_t i, double t) const { return (t + shift[i]) / perLength[i]; }
  };
  // Moves those rays of a packet that loadPacket() has rejected and that may hit something. Returns
  // how many rays stay rejected.
  uint32_t moveNear(const Rays& rays, const float* ends, uint32_t first, uint32_t size, int* valid,
                    const PacketRays& to, FarRays& far) const;
  void intersectLevel(const Level& level, const Rays& rays, uint32_t mask, bool coherent,
                      bool first, RayHits& hits) const;
  void occludedLevel(const Level& level, const Rays& rays, uint32_t mask, bool coherent, bool first,
                     uint8_t* blocked) const;
  // Hits that Embree lost at vertices (accel_leaks.cpp). trace: intersects rays as the query does.
  using Trace = std::function<void(const Rays& rays, RayHits& hits)>;
  void measure(); // sets low_ and high_
  bool mayHaveLeaked(const Rays& rays, uint32_t i) const;
  template <class Open, class Found> void searchLost(const Rays& rays, const Open& isOpen,
                                                     const Trace& trace, const Found& found) const;
  // aimed: null for all rays.
  void findLostHits(const Rays& rays, const uint8_t* aimed, const Trace& trace,
                    RayHits& hits) const;
  void findLostBlockers(const Rays& rays, const Trace& trace, uint8_t* blocked) const;
  // Maps Embree's ids to record and primitive.
  static PrimitiveId find(const PartScene& scene, uint32_t instance, uint32_t geometry,
                          uint32_t primitive);
  // Maps the place on a piece of a line to that on the line. The scene is the top level.
  static float placeOnLine(const PartScene& scene, uint32_t geometry, uint32_t primitive, float u);
  struct FilterContext {
    const Accel* accel;
    const Level* level;
    const uint32_t* record = nullptr; // for each ray the record to ignore
  };
  void intersectFiltered(const Rays& rays, uint32_t mask, RTCFilterFunctionN filter,
                         const uint32_t* record, RayHits& hits) const;
  struct PointSearch;
  bool updateNearest(const PrimitiveId& found, const Vec3d& p, Nearest& best) const;
  static bool visitNear(RTCPointQueryFunctionArguments* a);
  static PrimitiveId primitiveOfHit(const RTCFilterFunctionNArguments* a, unsigned i);
  static void rejectBacks(const RTCFilterFunctionNArguments* a);
  static void rejectRecord(const RTCFilterFunctionNArguments* a);

  struct PlacedCluster {
    uint32_t firstRecord = 0, firstSlot = 0, firstItem = 0, firstFrames = 0;
    bool shown = false, instances = false, transparent = false, culls = false;
    uint32_t rejected = 0; // visible items whose matrix is unusable
  };
  std::shared_ptr<EmbreeDevice> device_;
  std::shared_ptr<const Blas> static_;
  PartScene top_;
  Level staticLevel_, topLevel_;
  std::vector<PlacedCluster> placed_; // by cluster
  std::vector<RecordFrames> frames_;  // by cluster, of the entries that have any
  std::vector<Affine> toObject_;      // by cluster and item: Record::toObject
  Vec3d origin_;                      // the origin of render space, in the world
  Vec3f low_, high_;                  // bounds in render space, with a margin
  double reach_ = 0;                  // the size of the scene, in the units of the kernels
  float scale_ = 1; // render space x scale = the space of both Embree scenes; a power of two
};

} // namespace openrt

// accel.h: the scene as Embree holds it, in two scenes. The static one: what never moves, baked
// relative to the render origin, with instances of what stands there often. The top level: an
// instance for every cluster (scene/flatten.h) and the lines and points, which change with the
// camera; it is rebuilt when one of them moves, and it is small. A ray meets both, the static one
// first: it is traced as if nothing else were there, in packets of 16, and shortens the ray for the
// other. (One top level over an instance of everything static costs as little to rebuild, but
// packets of 16 on instances are slow, and with the coherent flag Embree 3.13 does not come back
// from some.) Changed between frames by AccelBuilder, traced by render threads.
#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <vector>

#include "backend/local/accel/body.h"
#include "render/rays.h"
#include "render/render_scene.h"

namespace openrt {

class Accel final : public Intersector {
 public:
  std::vector<Record> records;
  std::vector<Bucket> buckets;
  bool hasTransparent = false;
  mutable std::atomic<uint64_t> rejectedRays{0};

  void intersect(const Rays& rays, uint32_t mask, Coherence coherence,
                 RayHits& hits) const override;
  void intersectFronts(const Rays& rays, uint32_t mask, RayHits& hits) const override;
  void occluded(const Rays& rays, uint32_t mask, Coherence coherence,
                uint8_t* blocked) const override;
  void intersectOthers(const Rays& rays, const uint32_t* record, RayHits& hits) const override;
  void bounds(float low[3], float high[3]) const override;

  // A surface that a ray passes.
  struct Passed {
    uint32_t ray, record, primitive;
    float t, u, v, ng[3];
  };
  // All that the rays pass, by ray and distance. [any thread]
  void passed(const Rays& rays, std::vector<Passed>& out) const;
  // The surface point next to a place of render space, not farther than `distance`; false if there
  // is none. [any thread]
  struct Nearest {
    uint32_t record = noHit, primitive = 0;
    double distance = 0, point[3] = {}, normal[3] = {}, u = 0, v = 0; // normal: outwards, unit
  };
  // round: spheres().
  bool nearest(const double place[3], double distance, std::span<const uint32_t> round,
               Nearest& out) const;
  std::vector<uint32_t> spheres() const; // records of those in sight

 private:
  friend class AccelBuilder;
  struct Level { // one of the two scenes
    const PartScene* scene = nullptr;
    uint32_t masks = 0; // of what is in it; 0: nothing
    bool instances = false;
  };
  template <class Packet> void intersectPackets(const Level& level, const Rays& rays, uint32_t mask,
                                                const QueryOptions& options, bool first,
                                                RayHits& hits) const;
  template <class Packet> void occludedPackets(const Level& level, const Rays& rays, uint32_t mask,
                                               bool coherent, bool first, uint8_t* blocked) const;
  void intersectLevel(const Level& level, const Rays& rays, uint32_t mask, bool coherent,
                      bool first, RayHits& hits) const;
  void occludedLevel(const Level& level, const Rays& rays, uint32_t mask, bool coherent, bool first,
                     uint8_t* blocked) const;
  struct Found {
    uint32_t record, primitive;
  };
  // Embree's numbers to ours.
  static Found find(const PartScene& scene, uint32_t instance, uint32_t geometry,
                    uint32_t primitive);
  struct Filtered {
    const Accel* accel;
    const Level* level;
    const uint32_t* record = nullptr; // by lane: the one that does not count
    std::vector<Passed>* all = nullptr;
  };
  void intersectFiltered(const Rays& rays, uint32_t mask, RTCFilterFunctionN filter,
                         const uint32_t* record, RayHits& hits,
                         std::vector<Passed>* all = nullptr) const;
  static void collect(const RTCFilterFunctionNArguments* a);
  void settlePassed(const Rays& rays, Passed& p) const;
  struct PointSearch;
  bool measure(const Found& found, const Vec3d& p, Nearest& best) const;
  static bool visitNear(RTCPointQueryFunctionArguments* a);
  static Found foundBy(const RTCFilterFunctionNArguments* a, unsigned i);
  static void rejectBacks(const RTCFilterFunctionNArguments* a);
  static void rejectRecord(const RTCFilterFunctionNArguments* a);

  struct Placed { // a cluster
    uint32_t firstRecord = 0, firstSlot = 0;
    bool shown = false, instances = false, transparent = false;
    uint32_t rejected = 0; // items in sight whose matrix is not usable
  };
  std::shared_ptr<EmbreeDevice> device_;
  std::shared_ptr<const Body> static_;
  PartScene top_;
  Level staticLevel_, topLevel_;
  std::vector<Placed> placed_; // by cluster
  Vec3d origin_;
  float scale_ = 1; // render space x scale = the space of both scenes; a power of two
};

} // namespace openrt

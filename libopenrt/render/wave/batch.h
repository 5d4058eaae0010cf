// batch.h: the host's state for one batch of shading points. The functions of RtsHost work on it.
// [render]
#pragma once

#include <span>

#include "render/wave/faults.h"
#include "render/wave/path_states.h"
#include "render/wave/points.h"

namespace openrt {

struct Ledger;
class PathTracer;

struct RayCounters {
  uint64_t camera = 0, shadow = 0, secondary = 0;
  ShaderFaults faults;
};

// Holds what the stages of one render thread share.
struct StageContext {
  const RenderScene& scene;
  Arena& arena;
  RayCounters& counters;
  // The path tracer. Null if shaders are called outside of a frame: nothing is traced then, and
  // random points are (0.5, 0.5).
  PathTracer* tracer = nullptr;
  Ledger* ledger = nullptr; // gets what is cut from shadow rays; null: nobody counts it
};

// Lanes of a batch without hits: camera rays, or directions and places that an environment or a
// light is asked about.
struct BatchLanes {
  uint32_t count = 0;
  bool cameraRays = false; // the camera rays of all paths, in order
  // By lane of an environment's batch: 1 where the camera looks straight; null: nowhere.
  const uint32_t* straight = nullptr;
};

// The lights of a batch, and the one that is being evaluated (RtsHost.illuminate). The host
// allocates the arrays, by hit, with the first light.
struct BatchLights {
  uint32_t set = 0;       // index into RenderScene::lightSets
  uint32_t current = ~0u; // the light; index into the batch's lights
  bool directional = false;
  float* local[3] = {};
  float* toLight[3] = {};
  float* color[3] = {};
  float* ambient[3] = {};
  float* reach = nullptr; // distance to the light; 0 if there is no direction
  // Index of the sampled scene light; null: the same light for all hits.
  uint32_t* chosen = nullptr;
};

// The lobes that a shader has added (`surface`).
class BatchLobes {
 public:
  const RtsLobe* begin() const { return list_; }
  const RtsLobe* end() const { return list_ + count_; }
  const RtsLobe& operator[](uint32_t i) const { return list_[i]; }
  RtsLobe& operator[](uint32_t i) { return list_[i]; }
  uint32_t size() const { return count_; }
  // Adds a lobe without numbers. Returns null if there is no room for it.
  RtsLobe* add() {
    if (count_ == RTS_MAX_LOBES) return nullptr;
    return &(list_[count_++] = {});
  }
  void clear() { count_ = 0; }

 private:
  RtsLobe list_[RTS_MAX_LOBES]; // uninitialised from count_ on: most batches have one or two
  uint32_t count_ = 0;
};

} // namespace openrt

// A batch has hits (`points`) or lanes without hits.
struct RtsBatch : openrt::StageContext {
  explicit RtsBatch(const openrt::StageContext& context) : StageContext(context) {}
  // Makes a batch of hits of the rays that have the given states.
  RtsBatch(const openrt::StageContext& context, const openrt::Points& hits,
           const openrt::PathStates& rayStates)
      : StageContext(context), points(&hits), states(&rayStates), order(hits.order) {}

  const openrt::Points* points = nullptr;
  const openrt::PathStates* states = nullptr; // ray states of the wave, by lane
  const uint32_t* order = nullptr;            // lanes of the hits; null: camera rays, in order
  // Batch of a sampled light: indices into `points` of the hits that have sampled the light. Empty:
  // the batch has all points.
  std::span<const uint32_t> subset;
  const openrt::Crossing* crossing = nullptr; // boundaries of media by hit; null: there are none
  // By hit: 1 where the surface has RTS_IRRADIANCE; null: nowhere.
  const uint8_t* irradiance = nullptr;
  // By hit: number of rays it has traced; allocated with the first request.
  uint32_t* requests = nullptr;
  // The shader is asked what surfaces are, not what light they send: it gets no lights, and rays
  // that it traces are black.
  bool describes = false;
  openrt::BatchLanes lanes;
  openrt::BatchLights lights;
  uint32_t fog = 0; // Bucket::fog
  // By hit: share of the light that the fog in front of the hit lets pass; null: there is no fog.
  const float* throughFog = nullptr;
  openrt::BatchLobes lobes;

  // Return the number of hits, and the index into `points` of hit i. For batches with hits.
  uint32_t hitCount() const {
    return subset.empty() ? points->hits.count : uint32_t(subset.size());
  }
  uint32_t pointOf(uint32_t i) const { return subset.empty() ? i : subset[i]; }
  // Returns the number of hits or camera rays.
  uint32_t pointCount() const {
    if (points) return hitCount();
    return lanes.cameraRays ? lanes.count : 0;
  }
};

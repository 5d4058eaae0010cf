// batch.h: the host's state for one batch of shading points. The functions of RtsHost work on it.
// [render]
#pragma once

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
  PathTracer* tracer = nullptr; // as in RtsBatch
  Ledger* ledger = nullptr;     // as in RtsBatch
};

} // namespace openrt

struct RtsBatch {
  const openrt::RenderScene* scene = nullptr;
  openrt::Arena* arena = nullptr;
  openrt::RayCounters* counters = nullptr;
  const openrt::Points* points = nullptr;
  // Batch of a sampled light: indices into `points` of the hits that have sampled the light. Null:
  // the batch has all points.
  const uint32_t* subset = nullptr;
  uint32_t subsetSize = 0;
  uint32_t lightSet = 0;
  // The light that is being evaluated (illuminate). The host allocates these arrays with the first
  // light.
  float* local[3] = {};
  float* toLight[3] = {};
  float* color[3] = {};
  float* ambient[3] = {};
  float* reach = nullptr; // distance to the light; 0 if there is no direction
  uint32_t current = ~0u; // index into the batch's lights
  bool directional = false;
  // The shader is asked what surfaces are, not what light they send: it gets no lights, and rays
  // that it traces are black.
  bool describes = false;
  // By hit: index of the sampled scene light; null: the same light for all hits.
  uint32_t* chosen = nullptr;
  // The path tracer. Null if shaders are called outside of a frame: nothing is traced then, and
  // random points are (0.5, 0.5).
  openrt::PathTracer* tracer = nullptr;
  openrt::Ledger* ledger = nullptr; // gets what is cut from shadow rays; null: nobody counts it
  const openrt::PathStates* states = nullptr; // ray states of the wave, by lane
  const uint32_t* order = nullptr;            // lanes of the hits; null: camera rays, in order
  uint32_t rays = 0;                          // number of camera rays
  uint32_t lanes = 0; // number of lanes of a batch that has neither hits nor camera rays
  // By lane of an environment's batch: 1 where the camera looks straight; null: nowhere.
  const uint32_t* straight = nullptr;
  const openrt::Crossing* crossing = nullptr; // boundaries of media by hit; null: there are none
  // By hit: number of rays it has traced; allocated with the first request.
  uint32_t* requests = nullptr;
  // Lobes that the shader has added (`surface`).
  RtsLobe lobes[RTS_MAX_LOBES];
  uint32_t lobeCount = 0;

  // Return the number of hits, and the index into `points` of hit i. For batches with hits.
  uint32_t hitCount() const { return subset ? subsetSize : points->hits.count; }
  uint32_t pointOf(uint32_t i) const { return subset ? subset[i] : i; }
  // Returns the number of hits or camera rays.
  uint32_t pointCount() const { return points ? hitCount() : rays; }
  // Returns the number of lanes that the host functions write where the batch has no hits.
  uint32_t lanesWithoutHits() const { return rays ? rays : lanes; }
};

namespace openrt {

// Returns a batch without hits.
inline RtsBatch makeBatch(const StageContext& context) {
  RtsBatch batch;
  batch.scene = &context.scene;
  batch.arena = &context.arena;
  batch.counters = &context.counters;
  batch.tracer = context.tracer;
  batch.ledger = context.ledger;
  return batch;
}

// Returns a batch of hits of the rays that have the given states.
inline RtsBatch makeBatch(const StageContext& context, const Points& points,
                          const PathStates& states) {
  RtsBatch batch = makeBatch(context);
  batch.points = &points;
  batch.states = &states;
  batch.order = points.order;
  return batch;
}

inline StageContext contextOf(const RtsBatch& batch) {
  return {*batch.scene, *batch.arena, *batch.counters, batch.tracer, batch.ledger};
}

} // namespace openrt

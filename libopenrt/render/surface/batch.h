// batch.h: the host's side of one batch of shading points: what the functions of RtsHost work on.
// [render]
#pragma once

#include "render/path/ray_queue.h"
#include "render/surface/faults.h"
#include "render/surface/points.h"

namespace openrt {

class TileRenderer;

struct RayCounters {
  uint64_t camera = 0, shadow = 0, secondary = 0;
  ShaderFaults faults;
};

} // namespace openrt

struct RtsBatch {
  const openrt::RenderScene* scene = nullptr;
  openrt::Arena* arena = nullptr;
  openrt::RayCounters* counters = nullptr;
  const openrt::Points* points = nullptr;
  uint32_t lightSet = 0;
  // Light being looked at (illuminate): arrays of the host, made with the first light.
  float* local[3] = {};
  float* toLight[3] = {};
  float* color[3] = {};
  float* ambient[3] = {};
  float* reach = nullptr; // distance to the light; 0 where there is no direction
  uint32_t current = ~0u; // index into the batch's lights
  bool directional = false;
  uint32_t* chosen =
      nullptr; // by hit: the light of the scene that stands for many; null: one light for all hits
  // Who renders: null where shaders are asked outside of a picture. There nothing is traced, and
  // random points are the middle.
  openrt::TileRenderer* tracer = nullptr;
  const openrt::RayState* states = nullptr; // rays of the wave, by lane
  const uint32_t* order = nullptr;          // lanes of the hits; null: the camera's rays, in order
  uint32_t rays = 0;                        // number of these
  uint32_t* requests = nullptr;             // by hit: rays that it has sent; made with the first
  // Lobes that the shader has asked for (surface).
  RtsLobe lobes[RTS_MAX_LOBES];
  uint32_t lobeCount = 0;
};

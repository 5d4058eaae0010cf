// pixel_samples.h: what the paths of a wave have found so far. Each path is a sample of a pixel.
// [render]
#pragma once

#include <cstdint>

#include "render/wave/path_states.h"
#include "render/wave/points.h"

namespace openrt {

class FirstHits;

struct PixelSamples { // all arrays are indexed by path
  float *radiance[3], *alpha;
  float* reflection[3] = {}; // part of the radiance; null if the frame lacks RT_REFLECTION
  uint8_t* first;            // 1 until the first surface of the path has been shaded
  // The first surface; null if the frame does not have the channel.
  float *normal[3] = {}, *albedo[3] = {}, *position[3] = {}, *motion[3] = {}, *depth = nullptr;
  uint32_t* name = nullptr;
  // Pixels without light: 1 where the path has all of its light, because it leaves the scene at
  // once. Null: all paths have theirs.
  uint8_t* complete = nullptr;
  FirstHits* firstHits = nullptr; // RT_FOLLOW_IMAGES; null: first surfaces are recorded as they are

  // Allocates radiance and alpha, 0, of n paths. The first surfaces are not recorded.
  void allocate(Arena& arena, uint32_t n);
  // Allocates the arrays for the first surfaces. channels: RT_NORMAL and others.
  void allocateFirst(Arena& arena, uint32_t n, uint32_t channels);
  // Adds light that a ray of a path has found.
  void add(uint32_t path, PathFlags flags, const Vec3f& light) {
    store(load(radiance, path) + light, radiance, path);
    if (reflection[0] && flags.reflected()) store(load(reflection, path) + light, reflection, path);
  }
  // Records hit i as the first surface of a path.
  void storeFirst(const RenderScene& scene, const Points& points, uint32_t i, uint32_t path,
                  float* const albedoOfHits[3]);
};

} // namespace openrt

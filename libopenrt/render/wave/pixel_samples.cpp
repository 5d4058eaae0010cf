#include "render/wave/pixel_samples.h"

#include <algorithm>
#include <limits>

#include "render/motion.h"

namespace openrt {

void PixelSamples::allocate(Arena& arena, uint32_t n) {
  const uint32_t size = padded(n);
  for (auto& colour : radiance) colour = arena.takeZero<float>(size);
  alpha = arena.takeZero<float>(size);
  first = arena.takeZero<uint8_t>(size);
}

void PixelSamples::allocateFirst(Arena& arena, uint32_t n, uint32_t channels) {
  const uint32_t size = padded(n);
  const auto optional = [&](uint32_t channel) {
    return channels & channel ? arena.takeZero<float>(size) : nullptr;
  };
  for (int k = 0; k < 3; k++) {
    normal[k] = optional(RT_NORMAL);
    albedo[k] = optional(RT_ALBEDO);
    position[k] = optional(RT_POSITION);
    motion[k] = optional(RT_MOTION);
    reflection[k] = optional(RT_REFLECTION);
  }
  depth = optional(RT_DEPTH);
  if (depth) std::fill_n(depth, size, std::numeric_limits<float>::infinity());
  name = arena.takeZero<uint32_t>(size);
  std::fill_n(first, size, uint8_t(1));
}

void PixelSamples::storeFirst(const RenderScene& scene, const Points& points, uint32_t i,
                              uint32_t path, float* const albedoOfHits[3]) {
  const RtsHits& h = points.hits;
  name[path] = scene.records[points.record[i]].name;
  for (int k = 0; k < 3; k++) {
    if (normal[k]) normal[k][path] = h.normal[k][i];
    if (albedo[k]) albedo[k][path] = albedoOfHits[k][i];
    if (position[k]) position[k][path] = float(h.position[k][i] + scene.origin[k]);
  }
  if (motion[0])
    store(Vec3f(motionOf(scene, *points.rayHits, points.order[i], load(h.position, i))), motion,
          path);
  if (depth)
    depth[path] =
        dot(load(h.position, i) - scene.eye,
            scene.frame.depthAlong == RT_DEPTH_ALONG_RAY ? load(h.direction, i) : scene.depthAxis);
}

} // namespace openrt

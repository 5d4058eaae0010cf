#include "render/lights/openings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/surface/sanitize_output.h"
#include "shading/running.h"

namespace openrt {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();

// Rays that look for one light, and how they see it, by index into their lanes.
struct Look {
  float *origin[3], *direction[3], *distance, *radiance[3];
};

Look allocateLook(Arena& arena, uint32_t n) {
  Look look{};
  for (auto* arrays : {look.origin, look.direction, look.radiance})
    for (int k = 0; k < 3; k++) arrays[k] = arena.takeZero<float>(padded(n));
  look.distance = arena.take<float>(padded(n));
  return look;
}

void lookAt(const StageContext& context, const LightSlot& light, const Rays& rays,
            std::span<const uint32_t> lanes, const Look& look) {
  const uint32_t n = uint32_t(lanes.size());
  for (uint32_t i = 0; i < padded(n); i++) {
    const uint32_t lane = lanes[std::min(i, n - 1)];
    store(light.toLocal.point(load(rays.org, lane)), look.origin, i);
    store(light.toLocal.direction(load(rays.dir, lane)), look.direction, i);
    look.distance[i] = infinite;
  }
  RtsBatch batch(context);
  batch.lanes.count = n;
  const RtsClass& shaderClass = *light.shader.shaderClass;
  {
    const RunningShader running(shaderClass);
    shaderClass.opening(&context.scene.host, &batch, light.shader.params, n, look.origin,
                        look.direction, look.distance, look.radiance);
  }
  sanitizeOutput(shaderClass, batch, n, {look.radiance[0], look.radiance[1], look.radiance[2]});
}

// Lists the rays of camera paths that only specular surfaces have bent.
std::span<const uint32_t> listLookers(Arena& arena, const Wave& wave) {
  auto* lanes = arena.take<uint32_t>(wave.rays.count);
  uint32_t n = 0;
  for (uint32_t i = 0; i < wave.rays.count; i++)
    if (!wave.states.flagsOf(i).scattered()) lanes[n++] = i;
  return {lanes, n};
}

} // namespace

// An opening in the plane of a surface, as in a ceiling, lies before the surface.
SeenOpenings meetOpenings(const StageContext& context, const Wave& wave) {
  constexpr float inPlane = 1 + 1e-5f;
  SeenOpenings seen;
  const std::span<const LightSlot> lights = context.scene.lights;
  if (std::none_of(lights.begin(), lights.end(), [](const LightSlot& light) {
        return light.shader.shaderClass && light.shader.shaderClass->opening;
      }))
    return seen;
  Arena& arena = context.arena;
  auto* ended = arena.take<uint32_t>(wave.rays.count);
  auto* distance = arena.take<float>(wave.rays.count);
  for (auto& colour : seen.radiance) colour = arena.take<float>(wave.rays.count);
  std::fill_n(distance, wave.rays.count, infinite);
  ArenaScope scope(arena);
  const std::span<const uint32_t> lanes = listLookers(arena, wave);
  if (lanes.empty()) return seen;
  const Look look = allocateLook(arena, uint32_t(lanes.size()));
  for (const LightSlot& light : lights) {
    if (!light.shader.shaderClass || !light.shader.shaderClass->opening) continue;
    lookAt(context, light, wave.rays, lanes, look);
    for (uint32_t i = 0; i < lanes.size(); i++) {
      const uint32_t lane = lanes[i];
      const float at = look.distance[i];
      if (!(at > wave.rays.tnear[lane] && at <= wave.rays.tfar[lane] && at < distance[lane]) ||
          at > wave.hits.t[lane] * inPlane)
        continue;
      distance[lane] = at;
      store(load(look.radiance, i), seen.radiance, lane);
    }
  }
  uint32_t n = 0;
  for (const uint32_t lane : lanes) {
    if (!(distance[lane] < infinite)) continue;
    wave.hits.record[lane] = noHit;
    wave.hits.t[lane] = distance[lane];
    ended[n++] = lane;
  }
  seen.lanes = {ended, n};
  return seen;
}

void addOpenings(const StageContext& context, const SeenOpenings& seen, Wave& wave,
                 PixelSamples& found) {
  if (seen.lanes.empty()) return;
  const std::span<const RtsMedium> media = context.scene.shaders->media();
  for (const uint32_t lane : seen.lanes) {
    Vec3f throughput = load(wave.states.throughput, lane);
    // Rays in a medium that scatters have not been attenuated (absorbAlongRays).
    const uint16_t medium = mediumOf(wave.states.media[lane], media);
    if (!context.scene.mediumLights.empty() && medium && scatters(media[medium - 1]))
      absorb(medium, wave.hits.t[lane], media, throughput);
    const uint32_t path = wave.states.path[lane];
    const PathFlags flags = wave.states.flagsOf(lane);
    found.add(path, flags, throughput * load(seen.radiance, lane));
    if (!flags.deflected()) found.alpha[path] += (throughput.x + throughput.y + throughput.z) / 3;
  }
  const auto end = std::remove_if(wave.missed.begin(), wave.missed.end(), [&](uint32_t lane) {
    return std::binary_search(seen.lanes.begin(), seen.lanes.end(), lane);
  });
  wave.missed = wave.missed.first(size_t(end - wave.missed.begin()));
}

} // namespace openrt

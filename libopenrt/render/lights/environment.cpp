#include "render/lights/environment.h"

#include <algorithm>
#include <cmath>

#include "render/lights/emitters.h"
#include "render/surface/sanitize_output.h"
#include "shading/running.h"

namespace openrt {

SkyAlongRays evaluateSky(const StageContext& context, const Rays& rays, const uint32_t* lanes,
                         uint32_t n, const uint32_t* straight) {
  const uint32_t size = padded(n);
  SkyAlongRays sky;
  for (auto& a : sky.direction) a = context.arena.take<float>(size);
  for (auto& a : sky.rgba) a = context.arena.takeZero<float>(size);
  const RoleSlot& environment = context.scene.environment;
  for (uint32_t i = 0; i < size; i++) {
    const Vec3f direction =
        environment.toLocal.direction(load(rays.dir, lanes[std::min(i, n - 1)]));
    store(direction * (1 / length(direction)), sky.direction, i);
  }
  const ShaderSlot& shader = environment.shader;
  RtsBatch batch(context);
  batch.lanes.count = n;
  batch.lanes.straight = straight;
  {
    const RunningShader running(*shader.shaderClass);
    shader.shaderClass->miss(&context.scene.host, &batch, shader.params, n, sky.direction,
                             sky.rgba);
  }
  sanitizeOutput(*shader.shaderClass, batch, n,
                 {sky.rgba[0], sky.rgba[1], sky.rgba[2], sky.rgba[3]});
  return sky;
}

void addEnvironment(const StageContext& context, const Wave& wave, UnsampledLights& unsampled,
                    PixelSamples& found) {
  const Emitters& emitters = *context.scene.emitters;
  const RtsClass* shaderClass = context.scene.environment.shader.shaderClass;
  const uint32_t n = uint32_t(wave.missed.size());
  if (n == 0 || !shaderClass || !shaderClass->miss) return;
  ArenaScope scope(context.arena);
  auto* straight = context.arena.take<uint32_t>(padded(n));
  for (uint32_t i = 0; i < padded(n); i++)
    straight[i] = !wave.states.flagsOf(wave.missed[std::min(i, n - 1)]).deflected();
  const SkyAlongRays sky = evaluateSky(context, wave.rays, wave.missed.data(), n, straight);
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t lane = wave.missed[i], path = wave.states.path[lane];
    const float pdf = wave.states.pdf[lane];
    const PathFlags flags = wave.states.flagsOf(lane);
    float weight = 0, misWeight = 1;
    // Light sampling of the sky could also have chosen this direction, so BSDF sampling has this
    // MIS weight.
    if (pdf > 0 && emitters.any())
      misWeight =
          pdf / (pdf + emitters.skyPdf(wave.states.previousOf(lane), load(sky.direction, i)));
    const float unguidedWeight = wave.states.unguidedWeight[lane];
    unsampled.meetSky(flags, load(sky.rgba, i), unguidedWeight);
    // Light paths start in the sun, and photons guide other rays there.
    if (flags.specularSinceDiffuse() && emitters.hasSun()) {
      const bool leftToLightTracing =
          canOnlyReachSky(context.scene, flags) && emitters.sky()->isInSun(load(sky.direction, i));
      misWeight *= leftToLightTracing ? 0 : unguidedWeight;
    }
    Vec3f light;
    for (int k = 0; k < 3; k++) {
      const float throughput = wave.states.throughput[k][lane], radiance = sky.rgba[k][i];
      light[k] = std::isfinite(radiance) ? throughput * misWeight * radiance : 0;
      weight += throughput;
    }
    found.add(path, flags, light);
    if (!flags.deflected()) found.alpha[path] += weight / 3 * sky.rgba[3][i];
  }
}

namespace {

// Farther than any fog ends. Its square is a float.
constexpr float endless = 1e18f;

// Return the way from the eye to hit i, in render space: straight, and as a camera path has come.
Vec3f straightWayTo(const RtsBatch& batch, uint32_t i) {
  return load(batch.points->hits.position, i) - batch.scene.eye;
}
Vec3f pathTo(const RtsBatch& batch, uint32_t i) {
  const RtsHits& h = batch.points->hits;
  return batch.states->flagsOf(batch.order[i]).deflected() ? load(h.direction, i) * h.distance[i]
                                                           : straightWayTo(batch, i);
}

Vec3f extended(const Vec3f& way) {
  const float far = length(way);
  return far > 0 && std::isfinite(far) ? way * (1 / far) * endless : Vec3f{0, 0, endless};
}

// Evaluates the fog over the ways to the hits.
template <class Way> Fog fogAlong(const RtsBatch& batch, const Way& wayTo) {
  const RenderScene& scene = batch.scene;
  const bool own = batch.fog != 0; // the fog of an instance has the axes of the world
  const ShaderSlot shader =
      own ? scene.shaders->role(batch.fog, RTS_ENVIRONMENT) : scene.environment.shader;
  Fog fog;
  if (!shader.shaderClass || !shader.shaderClass->attenuate) return fog;
  const RtsHits& h = batch.points->hits;
  const uint32_t n = h.count, size = padded(n);
  float* fromEye[3];
  for (auto& a : fromEye) a = batch.arena.take<float>(size);
  auto* share = batch.arena.take<float>(size);
  for (uint32_t i = 0; i < size; i++) {
    const uint32_t hit = std::min(i, n - 1);
    const Vec3f way = wayTo(batch, hit);
    share[i] = fogCoordAt(scene, *batch.points, hit);
    const Vec3f toHit = share[i] < 0 ? way : extended(way);
    store(own ? toHit : scene.environment.toLocal.direction(toHit), fromEye, i);
  }
  for (auto& a : fog.airlight) a = batch.arena.takeZero<float>(size);
  fog.transmittance = batch.arena.takeZero<float>(size);
  RtsBatch lanes(static_cast<const StageContext&>(batch));
  lanes.lanes.count = n;
  const RunningShader running(*shader.shaderClass);
  shader.shaderClass->attenuate(&scene.host, &lanes, shader.params, n, fromEye, fog.airlight,
                                fog.transmittance);
  for (uint32_t i = 0; i < size; i++)
    if (share[i] >= 0) fog.transmittance[i] = 1 - share[i] * (1 - fog.transmittance[i]);
  return fog;
}

} // namespace

Fog fogAt(const RtsBatch& batch) {
  Fog fog = fogAlong(batch, pathTo);
  for (uint32_t i = 0; fog.transmittance && i < batch.points->hits.count; i++)
    if (batch.states->flagsOf(batch.order[i]).scattered()) fog.transmittance[i] = 1;
  return fog;
}

Fog fogBeforeEye(const RtsBatch& batch) { return fogAlong(batch, straightWayTo); }

} // namespace openrt

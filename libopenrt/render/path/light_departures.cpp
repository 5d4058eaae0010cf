#include "render/path/light_departures.h"

#include <algorithm>
#include <cmath>

#include "render/vectors.h"
#include "shading/running.h"

namespace openrt {

void LightDepartures::start(const PathSamples& samples, uint32_t n, RayQueue& queue) {
  ArenaScope scope(context_.arena);
  rays_.clear();
  departures_.assign(n, {});
  const RandomNumbers random = randomNumbersAtStart(samples, n, context_.arena);
  float *source[2], *place[2], *direction[2];
  random.drawPair(uint32_t(LightPair::source), context_.arena, source);
  random.drawPair(uint32_t(LightPair::place), context_.arena, place);
  random.drawPair(uint32_t(LightPair::direction), context_.arena, direction);
  for (uint32_t i = 0; i < n; i++) {
    const float at[2] = {place[0][i], place[1][i]}, aim[2] = {direction[0][i], direction[1][i]};
    rays_.push_back(
        sources_.sampleRay(context_.scene, source[0][i] + source[1][i] * 0x1p-24, at, aim));
    const LightSources::LightRay& ray = rays_.back();
    if (ray.weight > 0 && std::isfinite(ray.weight))
      queue.push(ray.origin, ray.direction, RayState{.path = i});
  }
}

// Computes the flux that a light without extent sends to a point, ignoring occlusion.
void LightDepartures::lampFlux(const LightSources::LightRay& start, const float at[3],
                               float flux[3]) {
  const RenderScene& scene = context_.scene;
  Arena& arena = context_.arena;
  const LightSlot& light = scene.lights[start.light];
  ArenaScope scope(arena);
  const Vector3 place = mapPoint(light.toLocal, at);
  float* local[3];
  RtsIllumination out{};
  for (int k = 0; k < 3; k++) {
    local[k] = arena.take<float>(lanes);
    std::fill_n(local[k], lanes, place[k]);
    out.toLight[k] = arena.takeZero<float>(lanes);
    out.color[k] = arena.takeZero<float>(lanes);
    out.ambient[k] = arena.takeZero<float>(lanes);
  }
  RtsBatch batch = makeBatch(context_);
  batch.lanes = 1;
  {
    const RunningShader running(*light.shader.shaderClass);
    light.shader.shaderClass->illuminate(&scene.host, &batch, light.shader.params, 1, local, &out);
  }
  double squaredDistance = 0;
  for (int k = 0; k < 3; k++) squaredDistance += std::pow(double(at[k]) - start.origin[k], 2);
  // The factor pi turns a light's colour into irradiance, because the colour is the radiance of a
  // white Lambert surface.
  const double scale = M_PI * start.weight * (start.parallel ? 1 : squaredDistance);
  for (int k = 0; k < 3; k++) {
    flux[k] = float(out.color[k][0] * scale);
    if (!(flux[k] > 0) || !std::isfinite(flux[k])) flux[k] = 0;
  }
}

bool LightDepartures::applyEmission(const Points& points, uint32_t i, RayState& state) {
  const LightSources::LightRay& start = rays_[state.path];
  Departure& departure = departures_[state.path];
  float flux[3] = {0, 0, 0};
  if (start.shape != LightSources::none) {
    context_.scene.emitters.shapes()->radiance(context_.scene, start.shape, start.place,
                                               start.direction, context_.arena, flux);
    for (float& x : flux) x = float(x * start.weight);
  } else {
    lampFlux(start, vectorAt(points.hits.position, i), flux);
    std::copy_n(flux, 3, departure.flux);
    departure.attenuationKnown = start.parallel;
  }
  for (int k = 0; k < 3; k++)
    state.throughput[k] *= flux[k] > 0 && std::isfinite(flux[k]) ? flux[k] : 0.0f;
  return largest(state.throughput) > 0;
}

void LightDepartures::updateAttenuation(uint32_t path) {
  const LightSources::LightRay& start = rays_[path];
  Departure& departure = departures_[path];
  if (departure.attenuationKnown) return;
  float at[3], flux[3];
  for (int k = 0; k < 3; k++)
    at[k] = float(start.origin[k] + departure.pathLength * start.direction[k]);
  lampFlux(start, at, flux);
  for (int k = 0; k < 3; k++) {
    const float change = departure.flux[k] > 0 ? flux[k] / departure.flux[k] : 0.0f;
    const bool rounding = departure.flux[k] > 0 && start.endless && std::fabs(change - 1) < 1e-3f;
    departure.attenuation[k] = rounding || !std::isfinite(change) ? 1.0f : change;
  }
}

void LightDepartures::applyAttenuation(RayState& state) {
  Departure& departure = departures_[state.path];
  if (departure.attenuationKnown) return;
  for (int k = 0; k < 3; k++) state.throughput[k] *= departure.attenuation[k];
  departure = {};
}

} // namespace openrt

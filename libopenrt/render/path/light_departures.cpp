#include "render/path/light_departures.h"

#include <algorithm>
#include <cmath>

#include "render/lights/emitters.h"
#include "render/lights/environment.h"
#include "shading/running.h"

namespace openrt {
namespace {

// Replaces negative flux and flux that is not finite by 0.
Vec3f checked(const Vec3f& flux) {
  const auto component = [](float x) { return x > 0 && std::isfinite(x) ? x : 0.0f; };
  return {component(flux.x), component(flux.y), component(flux.z)};
}

} // namespace

void LightDepartures::start(const LightSources& sources, const PathSamples& samples, uint32_t n,
                            RayQueue& queue) {
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
        sources.sampleRay(context_.scene, source[0][i] + source[1][i] * 0x1p-24, at, aim));
    const LightSources::LightRay& ray = rays_.back();
    departures_[i].pathLength = ray.skipped;
    if (ray.weight > 0 && std::isfinite(ray.weight))
      queue.push(ray.from, ray.direction, RayState{.path = i, .lightPathRatio = 1});
  }
  evaluateSun();
}

// Computes the flux of the paths that start in the sun.
void LightDepartures::evaluateSun() {
  Arena& arena = context_.arena;
  ArenaScope scope(arena);
  const auto all = uint32_t(rays_.size());
  Rays towards;
  towards.allocate(arena, all);
  auto* paths = arena.take<uint32_t>(all);
  uint32_t n = 0;
  for (uint32_t i = 0; i < all; i++) {
    if (!rays_[i].sun || !(rays_[i].weight > 0)) continue;
    store(-rays_[i].direction, towards.dir, n);
    paths[n++] = i;
  }
  if (n == 0) return;
  const SkyAlongRays sky = evaluateSky(context_, towards, arena.takeNumbers(n), n);
  for (uint32_t r = 0; r < n; r++)
    departures_[paths[r]].flux = checked(Vec3f(Vec3d(load(sky.rgba, r)) * rays_[paths[r]].weight));
}

// Returns the flux that a light without extent sends to a point, ignoring occlusion.
Vec3f LightDepartures::lampFlux(const LightSources::LightRay& start, const Vec3f& at) {
  const RenderScene& scene = context_.scene;
  Arena& arena = context_.arena;
  const LightSlot& light = scene.lights[start.light];
  ArenaScope scope(arena);
  const Vec3f place = light.toLocal.point(at);
  float* local[3];
  RtsIllumination out{};
  for (int k = 0; k < 3; k++) {
    local[k] = arena.take<float>(lanes);
    std::fill_n(local[k], lanes, place[k]);
    out.toLight[k] = arena.takeZero<float>(lanes);
    out.color[k] = arena.takeZero<float>(lanes);
    out.ambient[k] = arena.takeZero<float>(lanes);
  }
  RtsBatch batch(context_);
  batch.lanes.count = 1;
  {
    const RunningShader running(*light.shader.shaderClass);
    light.shader.shaderClass->illuminate(&scene.host, &batch, light.shader.params, 1, local, &out);
  }
  const Vec3d way = Vec3d(at) - Vec3d(start.origin);
  // The factor pi turns a light's colour into irradiance, because the colour is the radiance of a
  // white Lambert surface.
  const double scale = M_PI * start.weight * (start.parallel ? 1 : dot(way, way));
  return checked(Vec3f(Vec3d(load(out.color, 0)) * scale));
}

bool LightDepartures::applyEmission(const Points& points, uint32_t i, RayState& state) {
  const LightSources::LightRay& start = rays_[state.path];
  Departure& departure = departures_[state.path];
  Vec3f flux;
  if (start.shape != LightSources::none) {
    const Vec3f radiance = context_.scene.emitters->shapes()->radiance(
        context_.scene, start.shape, start.place, start.direction, context_.arena);
    flux = checked(Vec3f(Vec3d(radiance) * start.weight));
  } else if (start.sun) {
    flux = departure.flux;
  } else {
    flux = departure.flux = lampFlux(start, load(points.hits.position, i));
    departure.attenuationKnown = start.parallel;
  }
  state.throughput *= flux;
  return largest(state.throughput) > 0;
}

Vec3f LightDepartures::attenuationAfter(uint32_t path, double length) {
  const LightSources::LightRay& start = rays_[path];
  const Departure& departure = departures_[path];
  if (departure.attenuationKnown) return departure.attenuation;
  const Vec3f at(Vec3d(start.origin) + (departure.pathLength + length) * Vec3d(start.direction)),
      flux = lampFlux(start, at);
  Vec3f attenuation;
  for (int k = 0; k < 3; k++) {
    const float change = departure.flux[k] > 0 ? flux[k] / departure.flux[k] : 0.0f;
    const bool rounding = departure.flux[k] > 0 && start.endless && std::fabs(change - 1) < 1e-3f;
    attenuation[k] = rounding || !std::isfinite(change) ? 1.0f : change;
  }
  return attenuation;
}

void LightDepartures::updateAttenuation(uint32_t path) {
  departures_[path].attenuation = attenuationAfter(path, 0);
}

void LightDepartures::applyAttenuation(RayState& state) {
  Departure& departure = departures_[state.path];
  if (departure.attenuationKnown) return;
  state.throughput *= departure.attenuation;
  const bool scattered = departure.scattered;
  departure = {};
  departure.scattered = scattered;
}

float LightDepartures::irradianceFactor(uint32_t path, bool surface) const {
  const LightSources::LightRay& start = rays_[path];
  const bool lamp = start.shape == LightSources::none && !start.sun;
  if (!surface || !lamp || departures_[path].scattered) return 1;
  return context_.scene.lights[start.light].shader.traits & RTS_IRRADIANCE ? float(M_1_PI) : 1.0f;
}

} // namespace openrt

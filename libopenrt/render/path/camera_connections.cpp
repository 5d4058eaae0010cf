#include "render/path/camera_connections.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/lights/environment.h"
#include "render/lights/shadows.h"
#include "render/path/light_path_ratios.h"
#include "render/surface/adjoint.h"
#include "render/surface/lobes.h"
#include "shading/running.h"

namespace openrt {
namespace {

// Calls the camera's `project` for n places of its local space.
void callProject(const RtsBatch& batch, uint32_t n, const float* const local[3],
                 const float* const lens[2], RtsProjection& out) {
  const RenderScene& scene = batch.scene;
  const ShaderSlot& camera = scene.camera.shader;
  const float extent[2] = {float(scene.frame.width), float(scene.frame.height)};
  RtsBatch places = batch;
  places.points = nullptr; // the camera gets n places, not the hits
  places.lanes.count = n;
  const RunningShader running(*camera.shaderClass);
  camera.shaderClass->project(&scene.host, &places, camera.params, n, local, lens, extent, &out);
}

} // namespace

bool pixelsOf(const RtsBatch& batch, uint32_t n, const float* const position[3],
              float* const xy[2]) {
  const RoleSlot& camera = batch.scene.camera;
  if (!camera.shader.shaderClass || !camera.shader.shaderClass->project || n == 0) return false;
  Arena& arena = batch.arena;
  ArenaScope scope(arena);
  const uint32_t size = padded(n);
  float *local[3], *lens[2];
  RtsProjection seen{};
  for (int k = 0; k < 3; k++) {
    local[k] = arena.take<float>(size);
    seen.toEye[k] = arena.takeZero<float>(size);
  }
  for (int k = 0; k < 2; k++) {
    lens[k] = arena.take<float>(size);
    std::fill_n(lens[k], size, 0.5f);
    std::fill_n(xy[k], size, 0.0f);
    seen.xy[k] = xy[k];
  }
  seen.weight = arena.takeZero<float>(size);
  for (uint32_t i = 0; i < size; i++)
    store(camera.toLocal.point(load(position, std::min(i, n - 1))), local, i);
  callProject(batch, n, local, lens, seen);
  for (uint32_t i = 0; i < n; i++)
    if (!std::isfinite(xy[0][i]) || !std::isfinite(xy[1][i])) xy[0][i] = xy[1][i] = 0;
  return true;
}

CameraConnections projectToCamera(const RtsBatch& batch, const uint32_t* hit, uint32_t n,
                                  const float* const lens[2]) {
  const RenderScene& scene = batch.scene;
  const RoleSlot& camera = scene.camera;
  Arena& arena = batch.arena;
  const uint32_t size = padded(n);
  CameraConnections to{.count = n, .hit = hit};
  float *local[3], *square[2];
  RtsProjection seen{};
  for (int k = 0; k < 3; k++) {
    local[k] = arena.take<float>(size);
    to.direction[k] = arena.take<float>(size);
    seen.toEye[k] = arena.takeZero<float>(size);
  }
  for (int k = 0; k < 2; k++) {
    square[k] = arena.take<float>(size);
    seen.xy[k] = to.xy[k] = arena.takeZero<float>(size);
  }
  seen.weight = to.weight = arena.takeZero<float>(size);
  to.distance = arena.take<float>(size);
  for (uint32_t i = 0; i < size; i++) {
    const uint32_t h = hit[std::min(i, n - 1)];
    store(camera.toLocal.point(load(batch.points->hits.position, h)), local, i);
    for (int k = 0; k < 2; k++) square[k][i] = lens[k][h];
  }
  callProject(batch, n, local, square, seen);
  to.parallel = seen.parallel;
  for (uint32_t i = 0; i < n; i++) {
    const Vec3f toEye = camera.fromLocal.direction(load(seen.toEye, i));
    to.distance[i] = length(toEye);
    store(toEye / to.distance[i], to.direction, i);
  }
  return to;
}

double cameraArea(const RenderScene& scene) {
  const double determinant = determinantOf(scene.camera.toLocal);
  return std::cbrt(determinant * determinant);
}

const float* coveredPixels(const RtsBatch& batch, const uint32_t* hit, uint32_t n) {
  Arena& arena = batch.arena;
  auto* pixels = arena.take<float>(padded(n));
  ArenaScope scope(arena);
  auto* middle = arena.take<float>(batch.points->hits.count);
  std::fill_n(middle, batch.points->hits.count, 0.5f);
  const float* const lens[2] = {middle, middle};
  const CameraConnections to = projectToCamera(batch, hit, n, lens);
  const double area = cameraArea(batch.scene);
  for (uint32_t i = 0; i < n; i++) {
    const Vec3f normal = load(batch.points->hits.geometric, hit[i]);
    pixels[i] = float(area * double(to.weight[i] * std::fabs(dot(normal, load(to.direction, i)))));
  }
  return pixels;
}

// Rough boundaries scale radiance by eta squared, and not the flux that light paths carry.
void scatterToCamera(const RtsBatch& batch, const CameraConnections& to, const float* ratio,
                     float* const scattered[3]) {
  const RtsHits& hits = batch.points->hits;
  for (int k = 0; k < 3; k++) std::fill_n(scattered[k], to.count, 0.0f);
  LobeValues lobeValues(batch.arena, to.count, &batch);
  auto* share = batch.arena.take<float>(to.count);
  std::fill_n(share, to.count, 1.0f);
  for (uint32_t l = 0; l < batch.lobes.size(); l++) {
    const RtsLobe& lobe = batch.lobes[l];
    if (!nonSpecularFunctions(lobe)) continue;
    lobeValues.evaluate(lobe, hits, to.count, to.hit, to.direction);
    if (ratio)
      firstSurfaceShares(batch, lobe, to.count, to.hit, to.direction, lobeValues.pdf, ratio, share);
    for (uint32_t i = 0; i < to.count; i++) {
      const uint32_t h = to.hit[i];
      const Vec3f out = load(to.direction, i);
      const bool front = dot(load(hits.geometric, h), out) > 0;
      Vec3f w;
      if (!weightAt(lobe, h, w) || (!nonSpecularFunctions(lobe)->transmits && !front)) continue;
      const float factor = adjointCorrection(lobe, hits, h, out) / radianceScale(lobe, h, out) *
                           to.weight[i] * share[i];
      store(load(scattered, i) + w * load(lobeValues.value, i) * factor, scattered, i);
    }
  }
}

void traceToCamera(const RtsBatch& batch, const CameraConnections& to, float* const colour[3]) {
  ArenaScope scope(batch.arena);
  const Fog fog = fogBeforeEye(batch);
  for (uint32_t i = 0; fog.transmittance && i < to.count; i++)
    store(load(colour, i) * fog.transmittance[to.hit[i]], colour, i);
  ShadowRays rays = allocateShadowRays(batch.scene, to.count, batch.arena);
  rays.toCamera = true;
  uint32_t n = 0;
  for (uint32_t i = 0; i < to.count; i++) {
    if (!(to.weight[i] > 0) || !(colour[0][i] > 0 || colour[1][i] > 0 || colour[2][i] > 0))
      continue;
    const Vec3f direction = load(to.direction, i);
    store(liftPoint(*batch.points, to.hit[i], direction), rays.rays.org, n);
    store(direction, rays.rays.dir, n);
    rays.rays.tnear[n] = 0;
    rays.rays.tfar[n] = to.parallel ? std::numeric_limits<float>::infinity() : to.distance[i];
    rays.lane[n++] = i;
  }
  rays.rays.count = n;
  rays.hit = to.hit;
  traceTransmittance(batch, rays, colour);
}

} // namespace openrt

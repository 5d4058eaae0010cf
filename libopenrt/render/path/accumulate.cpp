#include "render/path/accumulate.h"

#include <algorithm>
#include <cmath>

namespace openrt {
namespace {

constexpr Vec3f one{1, 1, 1};

// Weights of what a hit shows of the light beyond its surface.
struct Shown {
  Vec3f clear; // straight transmission
  Vec3f seen;  // all specular lobes: also mirror images and refractions
};
Shown shownAt(const RtsBatch& batch, uint32_t i, bool visible) {
  if (!visible) return {one, one};
  Shown shown;
  for (uint32_t l = 0; l < batch.lobeCount; l++) {
    Vec3f w;
    if (nonSpecularFunctions(batch.lobes[l]) || !weightAt(batch.lobes[l], i, w)) continue;
    shown.seen += w;
    if (batch.lobes[l].kind == RTS_LOBE_TRANSPARENT) shown.clear += w;
  }
  return shown;
}

} // namespace

void addShading(const CameraPaths& paths, const RtsShading& shaded, const Fog& fog,
                PixelSamples& found) {
  const RtsBatch& batch = paths.batch;
  for (uint32_t i = 0; i < batch.points->hits.count; i++) {
    const RayState ray = (*batch.states)[batch.order[i]];
    const Vec3f transmission = min(max(Vec3f(), load(shaded.transmission, i)), one); // NaN: opaque
    for (int k = 0; k < 3; k++) {
      const float light = std::isfinite(shaded.radiance[k][i]) ? shaded.radiance[k][i] : 0.0f;
      found.radiance[k][ray.path] +=
          ray.throughput[k] * fog.attenuate(i, k, light, transmission[k]);
    }
    const float covered = dot(ray.throughput, one - transmission),
                through = dot(ray.throughput, transmission);
    if (!ray.flags.deflected()) found.alpha[ray.path] += covered / 3;
    if (found.first[ray.path])
      found.storeFirst(*batch.scene, *batch.points, i, ray.path, shaded.albedo);
    if (through <= 1e-6f)
      paths.ledger.cutByEnergy += double(through);
    else
      spawnStraightRay(paths, i, transmission, ray.media);
  }
}

void addSurface(const RtsBatch& batch, const RtsSurface& surface, const Boundaries& boundaries,
                const Fog& fog, PixelSamples& found) {
  const PathStates& states = *batch.states;
  for (uint32_t i = 0; i < batch.points->hits.count; i++) {
    const uint32_t lane = batch.order[i], path = states.path[lane];
    const bool visible = boundaries.visibleAt(i);
    const Shown shown = shownAt(batch, i, visible);
    const Vec3f throughput = load(states.throughput, lane);
    for (int k = 0; k < 3; k++) {
      const float radiance = surface.emission[k][i];
      const float light = fog.attenuate(i, k, std::isfinite(radiance) ? radiance : 0.0f,
                                        std::min(shown.seen[k], 1.0f));
      found.radiance[k][path] += throughput[k] * light;
    }
    const float covered = dot(throughput, one - min(shown.clear, one));
    if (!states.flagsOf(lane).deflected()) found.alpha[path] += covered / 3;
    if (found.first[path] && visible)
      found.storeFirst(*batch.scene, *batch.points, i, path, surface.albedo);
  }
}

} // namespace openrt

#include "render/path/accumulate.h"

#include <algorithm>
#include <cmath>

namespace openrt {
namespace {

// Weights of what a hit shows of the light beyond its surface.
struct Shown {
  float clear[3] = {0, 0, 0}; // straight transmission
  float seen[3] = {0, 0, 0};  // all specular lobes: also mirror images and refractions
};
Shown shownAt(const RtsBatch& batch, uint32_t i, bool visible) {
  if (!visible) return {{1, 1, 1}, {1, 1, 1}};
  Shown shown;
  for (uint32_t l = 0; l < batch.lobeCount; l++) {
    float w[3];
    if (nonSpecularFunctions(batch.lobes[l]) || !weightAt(batch.lobes[l], i, w)) continue;
    for (int k = 0; k < 3; k++) {
      shown.seen[k] += w[k];
      shown.clear[k] += batch.lobes[l].kind == RTS_LOBE_TRANSPARENT ? w[k] : 0.0f;
    }
  }
  return shown;
}

} // namespace

void addShading(const CameraPaths& paths, const RtsShading& shaded, const Fog& fog,
                PixelSamples& found) {
  const RtsBatch& batch = paths.batch;
  for (uint32_t i = 0; i < batch.points->hits.count; i++) {
    const RayState ray = (*batch.states)[batch.order[i]];
    float transmission[3], covered = 0, through = 0;
    for (int k = 0; k < 3; k++) {
      const float t = shaded.transmission[k][i];
      transmission[k] = t > 0 ? std::min(t, 1.0f) : 0.0f;
      const float light = std::isfinite(shaded.radiance[k][i]) ? shaded.radiance[k][i] : 0.0f;
      found.radiance[k][ray.path] +=
          ray.throughput[k] * fog.attenuate(i, k, light, transmission[k]);
      covered += ray.throughput[k] * (1 - transmission[k]);
      through += ray.throughput[k] * transmission[k];
    }
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
    float covered = 0;
    for (int k = 0; k < 3; k++) {
      const float radiance = surface.emission[k][i], throughput = states.throughput[k][lane];
      const float light = fog.attenuate(i, k, std::isfinite(radiance) ? radiance : 0.0f,
                                        std::min(shown.seen[k], 1.0f));
      found.radiance[k][path] += throughput * light;
      covered += throughput * (1 - std::min(shown.clear[k], 1.0f));
    }
    if (!states.flagsOf(lane).deflected()) found.alpha[path] += covered / 3;
    if (found.first[path] && visible)
      found.storeFirst(*batch.scene, *batch.points, i, path, surface.albedo);
  }
}

} // namespace openrt

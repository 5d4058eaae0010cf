#include "render/lights/lamps.h"

#include <algorithm>
#include <cmath>

#include "render/lights/shadows.h"
#include "render/surface/lobes.h"

namespace openrt {

// A light's colour is the radiance of a white Lambert surface that faces it (openrts.h), so the
// irradiance is pi times the colour.
void addLamps(RtsBatch& batch, float* const radiance[3]) {
  const RtsHost& host = batch.scene->host;
  const RtsHits& hits = batch.points->hits;
  Arena& arena = *batch.arena;
  uint32_t scattering = 0;
  for (uint32_t l = 0; l < batch.lobeCount; l++)
    scattering += nonSpecularFunctions(batch.lobes[l]) != nullptr;
  const uint32_t lights = scattering ? host.lights(&batch) : 0, n = hits.count;
  if (lights == 0) return;
  allocateLightArrays(batch, n);
  ArenaScope scope(arena);
  const uint32_t* all = arena.takeNumbers(n);
  auto* wanted = arena.take<uint8_t>(padded(n));
  LobeValues lobeValues(arena, n, &batch);
  float* response[3];
  for (auto& a : response) a = arena.take<float>(n);
  for (uint32_t light = 0; light < lights; light++) {
    ArenaScope inner(arena);
    RtsIllumination from{};
    host.illuminate(&batch, light, &hits, &from);
    for (auto* a : response) std::fill_n(a, n, 0.0f);
    std::fill_n(wanted, n, uint8_t(0));
    for (uint32_t l = 0; l < batch.lobeCount; l++) {
      const RtsLobe& lobe = batch.lobes[l];
      if (!nonSpecularFunctions(lobe)) continue;
      lobeValues.evaluate(lobe, hits, n, all, from.toLight);
      for (uint32_t i = 0; i < n; i++) {
        Vec3f w;
        if (!weightAt(lobe, i, w)) continue;
        w *= load(lobeValues.value, i);
        store(load(response, i) + w, response, i);
        if (w.x + w.y + w.z > 0)
          wanted[i] = dot(load(lobe.normal, i), load(from.toLight, i)) > 0 ? 1 : 2;
      }
    }
    host.shadow(&batch, light, &hits, wanted, &from);
    for (int k = 0; k < 3; k++)
      for (uint32_t i = 0; i < n; i++)
        if (wanted[i]) radiance[k][i] += response[k][i] * float(M_PI) * from.color[k][i];
  }
}

} // namespace openrt

#include "render/lights/lamps.h"

#include <algorithm>
#include <cmath>

#include "render/lights/shadows.h"
#include "render/surface/lobes.h"

namespace openrt {

// A light's colour is the radiance of a white Lambert surface that faces it (openrts.h), so the
// irradiance is pi times the colour.
void addLamps(RtsBatch& batch, const SentLight& sent) {
  const RtsHost& host = batch.scene.host;
  const RtsHits& hits = batch.points->hits;
  Arena& arena = batch.arena;
  uint32_t scattering = 0;
  for (uint32_t l = 0; l < batch.lobes.size(); l++)
    scattering += nonSpecularFunctions(batch.lobes[l]) != nullptr;
  const uint32_t lights = scattering ? host.lights(&batch) : 0, n = hits.count;
  if (lights == 0) return;
  allocateLightArrays(batch, n);
  ArenaScope scope(arena);
  const uint32_t* all = arena.takeNumbers(n);
  auto* wanted = arena.take<uint8_t>(padded(n));
  LobeValues lobeValues(arena, n, &batch);
  float *response[3], *coated[3] = {};
  for (auto& a : response) a = arena.take<float>(n);
  if (sent.coated[0])
    for (auto& a : coated) a = arena.take<float>(n);
  for (uint32_t light = 0; light < lights; light++) {
    ArenaScope inner(arena);
    RtsIllumination from{};
    host.illuminate(&batch, light, &hits, &from);
    for (auto* a : response) std::fill_n(a, n, 0.0f);
    for (auto* a : coated)
      if (a) std::fill_n(a, n, 0.0f);
    std::fill_n(wanted, n, uint8_t(0));
    for (uint32_t l = 0; l < batch.lobes.size(); l++) {
      const RtsLobe& lobe = batch.lobes[l];
      if (!nonSpecularFunctions(lobe)) continue;
      lobeValues.evaluate(lobe, hits, n, all, from.toLight);
      for (uint32_t i = 0; i < n; i++) {
        Vec3f w;
        if (!weightAt(lobe, i, w)) continue;
        w *= load(lobeValues.value, i);
        store(load(response, i) + w, response, i);
        if (coated[0] && lobe.coat) store(load(coated, i) + w, coated, i);
        if (w.x + w.y + w.z > 0)
          wanted[i] = dot(load(lobe.normal, i), load(from.toLight, i)) > 0 ? 1 : 2;
      }
    }
    host.shadow(&batch, light, &hits, wanted, &from);
    const auto addTo = [&](float* const to[3], const float* const by[3]) {
      for (int k = 0; k < 3; k++)
        for (uint32_t i = 0; i < n; i++)
          if (wanted[i]) to[k][i] += by[k][i] * float(M_PI) * from.color[k][i];
    };
    addTo(sent.radiance, response);
    if (coated[0]) addTo(sent.coated, coated);
  }
}

} // namespace openrt

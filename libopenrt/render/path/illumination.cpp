#include "render/path/illumination.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "render/lights/light_sampler.h"
#include "render/lights/shadows.h"
#include "render/path/path_tracer.h"
#include "render/surface/sanitize_output.h"
#include "render/wave/faults.h"
#include "shading/running.h"

namespace openrt {
namespace {

// Keeps the random points of light sampling apart from those of shaders.
constexpr uint32_t lightPair = 0x6c696768u;
constexpr uint32_t none = ~0u;

// Returns the light sampler of the batch; null if it evaluates every light of its set.
const LightSampler* lightSamplerOf(const RtsBatch& batch) {
  if (!batch.tracer || !batch.scene.lightSamplers) return nullptr;
  const LightSampler& sampler = (*batch.scene.lightSamplers)[batch.lights.set];
  return sampler.chooses() ? &sampler : nullptr;
}

const LightSlot& lightOf(const RtsBatch& batch, uint32_t i) {
  const LightSampler* sampler = lightSamplerOf(batch);
  return batch.scene
      .lights[sampler ? sampler->always()[i] : batch.scene.lightSets[batch.lights.set][i]];
}

void pointsToLocal(const Affine& m, uint32_t n, const float* const p[3], float* const out[3]) {
  for (int k = 0; k < 3; k++) {
    const float a = m.r[k][0], b = m.r[k][1], c = m.r[k][2], d = m.r[k][3];
    const float *x = p[0], *y = p[1], *z = p[2];
    float* o = out[k];
    for (uint32_t i = 0; i < n; i++) o[i] = a * x[i] + b * y[i] + c * z[i] + d;
  }
}

// Transforms light-space vectors to unit vectors in render space. Writes their lengths in render
// space to `reach`.
void directionsToRender(const Affine& m, uint32_t n, float* const v[3], float* reach) {
  for (uint32_t i = 0; i < n; i++) {
    const float x = v[0][i], y = v[1][i], z = v[2][i];
    const float a = m.r[0][0] * x + m.r[0][1] * y + m.r[0][2] * z;
    const float b = m.r[1][0] * x + m.r[1][1] * y + m.r[1][2] * z;
    const float c = m.r[2][0] * x + m.r[2][1] * y + m.r[2][2] * z;
    const float l = std::sqrt(a * a + b * b + c * c);
    const float k = l > 0 && l <= 1e30f ? 1 / l : 0.0f;
    v[0][i] = a * k;
    v[1][i] = b * k;
    v[2][i] = c * k;
    reach[i] = k > 0 ? l : 0.0f;
  }
}

// Evaluates one light at points, padded to whole groups of lanes, into the arrays of `out`. Returns
// whether the light is parallel.
bool evaluateLight(RtsBatch& batch, const LightSlot& light, uint32_t count,
                   const float* const position[3], float* const local[3], RtsIllumination& out,
                   float* reach) {
  const uint32_t n = padded(count);
  pointsToLocal(light.toLocal, n, position, local);
  for (float* a : out.ambient) std::fill_n(a, n, 0.0f);
  out.directional = 0;
  const float* places[3] = {local[0], local[1], local[2]};
  {
    const RunningShader running(*light.shader.shaderClass);
    light.shader.shaderClass->illuminate(&batch.scene.host, &batch, light.shader.params, n, places,
                                         &out);
  }
  sanitizeOutput(*light.shader.shaderClass, batch, count,
                 {out.toLight[0], out.toLight[1], out.toLight[2], out.color[0], out.color[1],
                  out.color[2], out.ambient[0], out.ambient[1], out.ambient[2]});
  directionsToRender(light.fromLocal, n, out.toLight, reach);
  return out.directional != 0;
}

// Turns the colours of a light into those that give its irradiance (RTS_IRRADIANCE). hit: the index
// of the hit that each colour belongs to; null: its own.
void takeIrradiance(const RtsBatch& batch, const LightSlot& light, uint32_t n, const uint32_t* hit,
                    float* const color[3]) {
  if (!batch.irradiance || !(light.shader.traits & RTS_IRRADIANCE)) return;
  for (uint32_t i = 0; i < n; i++)
    if (batch.irradiance[hit ? hit[i] : i]) store(load(color, i) * float(M_1_PI), color, i);
}

// Samples a light for each hit; the hits of each light are evaluated together.
void evaluateChosenLights(RtsBatch& batch, const LightSampler& sampler, const RtsHits& hits,
                          RtsIllumination& out) {
  Arena& arena = batch.arena;
  const uint32_t n = hits.count;
  batch.lights.chosen = arena.take<uint32_t>(padded(n));
  ArenaScope scope(arena);
  float* square[2] = {arena.take<float>(padded(n)), arena.take<float>(padded(n))};
  batch.tracer->randomPoints(batch, lightPair, square);
  auto* probability = arena.take<float>(n);
  auto* order = arena.take<uint32_t>(n);
  uint32_t lit = 0;
  for (int k = 0; k < 3; k++)
    for (float* a : {out.toLight[k], out.color[k], out.ambient[k]}) std::fill_n(a, padded(n), 0.0f);
  std::fill_n(batch.lights.reach, padded(n), 0.0f);
  for (uint32_t i = 0; i < n; i++) {
    const LightSampler::Choice c =
        sampler.choose(load(hits.position, i), load(hits.normal, i),
                       double(square[0][i]) + double(square[1][i]) * 0x1p-24);
    batch.lights.chosen[i] = c.probability > 0 ? c.light : none;
    probability[i] = c.probability;
    if (c.probability > 0) order[lit++] = i;
  }
  std::sort(order, order + lit, [&](uint32_t a, uint32_t b) {
    return batch.lights.chosen[a] != batch.lights.chosen[b]
               ? batch.lights.chosen[a] < batch.lights.chosen[b]
               : a < b;
  });
  for (uint32_t begin = 0, end; begin < lit; begin = end) {
    const uint32_t light = batch.lights.chosen[order[begin]];
    for (end = begin + 1; end < lit && batch.lights.chosen[order[end]] == light;) end++;
    const uint32_t m = end - begin, size = padded(m);
    ArenaScope inner(arena);
    RtsIllumination part{};
    float *position[3], *local[3];
    for (int k = 0; k < 3; k++) {
      position[k] = arena.take<float>(size);
      local[k] = arena.take<float>(size);
      part.toLight[k] = arena.take<float>(size);
      part.color[k] = arena.take<float>(size);
      part.ambient[k] = arena.take<float>(size);
      for (uint32_t i = 0; i < size; i++)
        position[k][i] = hits.position[k][order[begin + std::min(i, m - 1)]];
    }
    auto* reach = arena.take<float>(size);
    const float* const places[3] = {position[0], position[1], position[2]};
    // The light's own batch: the host's functions write a value for each of its hits, not for each
    // hit of the surface.
    RtsBatch own = batch;
    own.subset = {order + begin, m};
    own.requests = nullptr;
    own.lanes = {.count = m, .cameraRays = true};
    if (batch.order) {
      auto* lanesOfHits = arena.take<uint32_t>(m);
      for (uint32_t i = 0; i < m; i++) lanesOfHits[i] = batch.order[order[begin + i]];
      own.order = lanesOfHits;
    }
    const bool parallel =
        evaluateLight(own, batch.scene.lights[light], m, places, local, part, reach);
    takeIrradiance(batch, batch.scene.lights[light], m, order + begin, part.color);
    for (uint32_t i = 0; i < m; i++) {
      const uint32_t to = order[begin + i];
      for (int k = 0; k < 3; k++) {
        out.toLight[k][to] = part.toLight[k][i];
        out.color[k][to] = part.color[k][i] / probability[to];
        out.ambient[k][to] = part.ambient[k][i] / probability[to];
      }
      batch.lights.reach[to] = parallel ? std::numeric_limits<float>::infinity() : reach[i];
    }
  }
}

} // namespace

// Allocates the arrays here, because callers open an arena scope for each light.
uint32_t lightCount(RtsBatch& batch) {
  if (batch.describes) return 0;
  if (batch.points) allocateLightArrays(batch, batch.points->hits.count);
  const LightSampler* sampler = lightSamplerOf(batch);
  return uint32_t(sampler ? sampler->always().size() + 1
                          : batch.scene.lightSets[batch.lights.set].size());
}

void illuminateHits(RtsBatch& batch, uint32_t i, const RtsHits& hits, RtsIllumination& out) {
  allocateLightArrays(batch, hits.count);
  for (int k = 0; k < 3; k++) {
    out.toLight[k] = batch.lights.toLight[k];
    out.color[k] = batch.lights.color[k];
    out.ambient[k] = batch.lights.ambient[k];
  }
  batch.lights.current = i;
  batch.lights.chosen = nullptr;
  if (const LightSampler* sampler = lightSamplerOf(batch);
      sampler && i == sampler->always().size()) {
    evaluateChosenLights(batch, *sampler, hits, out);
    out.directional = 0;
    batch.lights.directional = false;
    return;
  }
  batch.lights.directional = evaluateLight(batch, lightOf(batch, i), hits.count, hits.position,
                                           batch.lights.local, out, batch.lights.reach);
  if (batch.points && &hits == &batch.points->hits)
    takeIrradiance(batch, lightOf(batch, i), hits.count, nullptr, out.color);
}

void shadowHits(RtsBatch& batch, uint32_t i, const RtsHits& hits, const uint8_t* wanted,
                RtsIllumination& light) {
  if (!batch.scene.frame.shadows || batch.lights.current != i || &hits != &batch.points->hits)
    return;
  if (!batch.lights.chosen) {
    if (!(lightOf(batch, i).shader.traits & RTS_NO_SHADOW)) castShadows(batch, wanted, light);
    return;
  }
  ArenaScope scope(batch.arena);
  auto* casts = batch.arena.take<uint8_t>(padded(hits.count));
  for (uint32_t h = 0; h < hits.count; h++)
    casts[h] = batch.lights.chosen[h] == none ||
                       (batch.scene.lights[batch.lights.chosen[h]].shader.traits & RTS_NO_SHADOW)
                   ? 0
                   : wanted[h];
  castShadows(batch, casts, light);
}

} // namespace openrt

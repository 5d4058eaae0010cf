// light_sampler.cpp: builds the light samplers. The falloff of a light is measured, because its
// extent does not describe it.
#include "render/lights/light_sampler.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "render/surface/batch.h"
#include "scene/transports.h"
#include "shading/running.h"

namespace openrt {
namespace {

struct Placed { // a light with an extent, transformed to render space
  uint32_t light;
  RtsExtent extent;
  float position[3], axis[3];
  bool similar; // the transform is a similarity: angles are those of the light's space
  double stretch;
};

bool finite(const float* values, int n) {
  return std::all_of(values, values + n, [](float x) { return std::isfinite(x); });
}

bool place(const RenderScene& scene, uint32_t number, Placed& out) {
  const LightSlot& slot = scene.lights[number];
  const RtsClass& c = *slot.shader.shaderClass;
  RtsExtent& e = out.extent;
  e = {};
  if (!c.extent) return false;
  {
    const RunningShader running(c);
    if (!c.extent(&scene.host, slot.shader.params, &e) || e.parallel) return false;
  }
  if (!finite(e.position, 3) || !finite(e.direction, 3) || !(e.power >= 0) || !(e.radius >= 0) ||
      std::isnan(e.cosine))
    return false;
  out.light = number;
  double gram[3][3] = {}, length = 0;
  out.stretch = 0;
  const auto& m = slot.fromLocal.r;
  for (int i = 0; i < 3; i++) {
    out.position[i] = m[i][3];
    out.axis[i] = 0;
    for (int k = 0; k < 3; k++) {
      out.position[i] += m[i][k] * e.position[k];
      out.axis[i] += m[i][k] * e.direction[k];
      out.stretch += double(m[i][k]) * m[i][k];
      for (int j = 0; j < 3; j++) gram[k][j] += double(m[i][k]) * m[i][j];
    }
    length += double(out.axis[i]) * out.axis[i];
  }
  out.similar = length > 0;
  for (int k = 0; k < 3; k++)
    for (int j = 0; j < 3; j++)
      out.similar &= std::fabs(gram[k][j] - (k == j ? gram[0][0] : 0)) < 1e-4 * gram[0][0];
  // Upper bound of the length of a transformed unit vector.
  out.stretch = out.similar ? std::sqrt(gram[0][0]) : std::sqrt(out.stretch);
  for (float& a : out.axis) a = length > 0 ? float(a / std::sqrt(length)) : 0;
  return finite(out.position, 3) && finite(out.axis, 3);
}

// Computes the mean colour of a light at `distance` and at twice that along its axis.
void measure(const RenderScene& scene, const Placed& p, float distance, Arena& arena,
             double out[2]) {
  ArenaScope scope(arena);
  const LightSlot& slot = scene.lights[p.light];
  float* local[3];
  RtsIllumination light{};
  for (int k = 0; k < 3; k++) {
    local[k] = arena.takeZero<float>(lanes);
    light.toLight[k] = arena.takeZero<float>(lanes);
    light.color[k] = arena.takeZero<float>(lanes);
    light.ambient[k] = arena.takeZero<float>(lanes);
    for (uint32_t i = 0; i < lanes; i++) {
      const auto& m = slot.toLocal.r[k];
      local[k][i] = m[3];
      for (int j = 0; j < 3; j++)
        local[k][i] += m[j] * (p.position[j] + p.axis[j] * distance * (i == 0 ? 1.0f : 2.0f));
    }
  }
  const float* const places[3] = {local[0], local[1], local[2]};
  RayCounters counters;
  RtsBatch batch;
  batch.scene = &scene;
  batch.arena = &arena;
  batch.counters = &counters;
  batch.lanes = 2;
  {
    const RunningShader running(*slot.shader.shaderClass);
    slot.shader.shaderClass->illuminate(&scene.host, &batch, slot.shader.params, 2, places, &light);
  }
  for (int i = 0; i < 2; i++) {
    out[i] = 0;
    for (int k = 0; k < 3; k++)
      if (light.color[k][i] > 0 && std::isfinite(light.color[k][i]))
        out[i] += double(light.color[k][i]) / 3;
  }
}

LightBounds boundsOf(const RenderScene& scene, const Placed& p, float distance, Arena& arena) {
  LightBounds b;
  for (int k = 0; k < 3; k++) {
    b.low[k] = b.high[k] = p.position[k];
    b.axis[k] = p.axis[k];
  }
  b.cosineNormals = p.similar && p.extent.cosine > -1 ? std::min(p.extent.cosine, 1.0f) : -1;
  b.cosineEmission = 1; // light is emitted only within the cone
  const double reach = double(p.extent.radius) * p.stretch;
  if (std::isfinite(reach) && reach < double(b.reach)) b.reach = float(reach);
  const float near = reach > 0 ? std::min(distance, float(reach / 4)) : distance;
  double seen[2];
  measure(scene, p, near, arena, seen);
  // Fits I / d^2 + E to both values. The colour of a light is that of a white surface, irradiance
  // over pi.
  const double flat = std::max(0.0, (4 * seen[1] - seen[0]) / 3);
  const double solidAngle = 2 * M_PI * (1 - std::clamp(double(p.extent.cosine), -1.0, 1.0 - 1e-6));
  // Mean intensity, in units of the light's space.
  const double mean = double(p.extent.power) / solidAngle / M_PI * p.stretch * p.stretch;
  const double falling = std::max((seen[0] - flat) * near * near, flat > 0 ? 0 : mean);
  b.intensity = float(std::min(falling, 1e30));
  b.irradiance = float(std::min(flat, 1e30));
  return b;
}

bool sameLights(const RenderScene& a, const RenderScene& b) {
  if (a.lightSets != b.lightSets || a.lights.size() != b.lights.size() || a.textures != b.textures)
    return false;
  // the parameter block of an unchanged shader stays the same
  for (size_t i = 0; i < a.lights.size(); i++) {
    const LightSlot &x = a.lights[i], &y = b.lights[i];
    if (x.shader.shaderClass != y.shader.shaderClass || x.shader.params != y.shader.params ||
        std::memcmp(&x.toLocal, &y.toLocal, sizeof x.toLocal) != 0)
      return false;
  }
  return true;
}

} // namespace

LightSampler::LightSampler(const RenderScene& scene, const std::vector<uint32_t>& set) {
  std::vector<Placed> placed;
  float low[3], high[3];
  for (const uint32_t light : set) {
    Placed p;
    if (set.size() <= few || !place(scene, light, p)) {
      always_.push_back(light);
      continue;
    }
    for (int k = 0; k < 3; k++) {
      low[k] = placed.empty() ? p.position[k] : std::min(low[k], p.position[k]);
      high[k] = placed.empty() ? p.position[k] : std::max(high[k], p.position[k]);
    }
    placed.push_back(p);
  }
  if (placed.empty()) return;
  double square = 0;
  for (int k = 0; k < 3; k++) square += (double(high[k]) - low[k]) * (double(high[k]) - low[k]);
  const auto distance = float(square > 0 ? std::min(std::sqrt(square) / 4, 1e15)
                                         : 1); // distance at which strengths are compared
  Arena arena;
  std::vector<LightBounds> bounds;
  for (const Placed& p : placed) {
    const LightBounds b = boundsOf(scene, p, distance, arena);
    if (!(b.intensity > 0 || b.irradiance > 0)) {
      always_.push_back(p.light); // no light was measured, so its falloff is not known
      continue;
    }
    bounds.push_back(b);
    chosen_.push_back(p.light);
  }
  tree_.build(bounds);
}

LightSampler::Choice LightSampler::choose(const float place[3], const float normal[3],
                                          double pick) const {
  const LightTree::Choice c = tree_.choose(place, normal, pick, LightTree::Side::likely);
  return {c.probability > 0 ? chosen_[c.light] : 0, c.probability};
}

std::shared_ptr<const std::vector<LightSampler>> makeLightSamplers(const RenderScene& scene,
                                                                   const RenderScene* before) {
  const bool many = tracesPaths(scene.frame.transport) &&
                    std::any_of(scene.lightSets.begin(), scene.lightSets.end(),
                                [](const auto& s) { return s.size() > LightSampler::few; });
  if (!many) return nullptr;
  if (before && before->lightSamplers && sameLights(scene, *before)) return before->lightSamplers;
  auto sets = std::make_shared<std::vector<LightSampler>>();
  for (const auto& set : scene.lightSets) sets->emplace_back(scene, set);
  return sets;
}

} // namespace openrt

// light_sampler.cpp: builds the light samplers. The falloff of a light is measured, because its
// extent does not describe it.
#include "render/lights/light_sampler.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "render/wave/batch.h"
#include "scene/transports.h"
#include "shading/running.h"

namespace openrt {
namespace {

struct Placed { // a light with an extent, transformed to render space
  uint32_t light;
  RtsExtent extent;
  Vec3f position, axis;
  bool similar; // the transform is a similarity: angles are those of the light's space
  double stretch;
};

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
  if (!isFinite(vectorOf(e.position)) || !isFinite(vectorOf(e.direction)) || !(e.power >= 0) ||
      !(e.radius >= 0) || std::isnan(e.cosine))
    return false;
  out.light = number;
  const Affine& m = slot.fromLocal;
  out.position = m.pointFromTranslation(vectorOf(e.position));
  const Vec3d axis(m.direction(vectorOf(e.direction)));
  out.axis = Vec3f(normalize(axis));
  out.similar = length(axis) > 0;
  const Vec3d x(m.column(0));
  for (int k = 0; k < 3; k++)
    for (int j = 0; j < 3; j++) // the columns of a similarity are orthogonal and equally long
      out.similar &= std::fabs(dot(Vec3d(m.column(k)), Vec3d(m.column(j))) -
                               (k == j ? dot(x, x) : 0)) < 1e-4 * dot(x, x);
  // Upper bound of the length of a transformed unit vector.
  out.stretch = out.similar ? length(x) : std::sqrt(squaredNormOf(m));
  return isFinite(out.position) && isFinite(out.axis);
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
  }
  for (uint32_t i = 0; i < lanes; i++) {
    const Vec3f at = p.position + p.axis * distance * (i == 0 ? 1.0f : 2.0f);
    store(slot.toLocal.pointFromTranslation(at), local, i);
  }
  const float* const places[3] = {local[0], local[1], local[2]};
  RayCounters counters;
  RtsBatch batch({scene, arena, counters});
  batch.lanes.count = 2;
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
  b.low = b.high = p.position;
  b.axis = p.axis;
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
  Vec3f low, high;
  for (const uint32_t light : set) {
    Placed p;
    if (set.size() <= few || !place(scene, light, p)) {
      always_.push_back(light);
      continue;
    }
    low = placed.empty() ? p.position : min(low, p.position);
    high = placed.empty() ? p.position : max(high, p.position);
    placed.push_back(p);
  }
  if (placed.empty()) return;
  const double diagonal = length(Vec3d(high) - Vec3d(low));
  const auto distance =
      float(diagonal > 0 ? std::min(diagonal / 4, 1e15) : 1); // at which strengths are compared
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

LightSampler::Choice LightSampler::choose(const Vec3f& place, const Vec3f& normal,
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

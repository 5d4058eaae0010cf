#include "render/path/accumulate.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/path/accumulate.cpp"
#include <hwy/foreach_target.h>

#include "render/lanes/lanes-inl.h"
#include "render/surface/lobes.h"

HWY_BEFORE_NAMESPACE();
namespace openrt {
namespace HWY_NAMESPACE {
namespace {

// Weights of what hits show of the light beyond their surface.
struct Shown {
  LaneVec clear; // straight transmission
  LaneVec seen;  // all specular lobes: also mirror images and refractions
};

// Returns what the hits from i on show. hidden: as in lightOfHits().
Shown shownAt(const RtsBatch& batch, const uint32_t* hidden, uint32_t i) {
  const Lanes zero = lanesOf(0), one = lanesOf(1);
  Shown shown{{zero, zero, zero}, {zero, zero, zero}};
  for (uint32_t l = 0; l < batch.lobes.size(); l++) {
    const RtsLobe& lobe = batch.lobes[l];
    if (nonSpecularFunctions(lobe)) continue;
    const LaneVec w = checked(load(lobe.weight, i));
    shown.seen = shown.seen + w;
    if (lobe.kind == RTS_LOBE_TRANSPARENT) shown.clear = shown.clear + w;
  }
  if (!hidden) return shown;
  const Mask all = loadMask(hidden + i);
  const LaneVec ones{one, one, one};
  return {select(all, ones, shown.clear), select(all, ones, shown.seen)};
}

// Returns one colour of the light that the hits from i on send through the fog: Fog::attenuate().
Lanes attenuate(const Fog& fog, uint32_t i, int colour, Lanes light, Lanes seen) {
  if (!fog.transmittance) return light;
  const Lanes one = lanesOf(1), transmittance = load(fog.transmittance + i);
  return transmittance * light +
         (one - transmittance) * load(fog.airlight[colour] + i) * (one - min(seen, one));
}

} // namespace

// Computes what each hit adds to the radiance and the alpha of its path. hidden: not 0 where a
// boundary has no effect on light; null: nowhere.
void lightOfHits(const RtsBatch& batch, const SentLight& sent, const Fog& fog,
                 const uint32_t* hidden, float* const radiance[3], float* alpha) {
  const Lanes zero = lanesOf(0), one = lanesOf(1);
  const auto uncovered = [&](Lanes clear) { return one - min(clear, one); };
  const uint32_t n = batch.points->hits.count;
  for (uint32_t i = 0; i < n; i += width()) {
    const LaneVec throughput = gather(batch.states->throughput, indicesFrom(batch.order, i, n));
    const Shown shown = shownAt(batch, hidden, i);
    const auto arriving = [&](int colour, Lanes seen) {
      const Lanes light = load(sent.radiance[colour] + i);
      return attenuate(fog, i, colour, select(isFinite(light), light, zero), seen);
    };
    const LaneVec light{arriving(0, shown.seen.x), arriving(1, shown.seen.y),
                        arriving(2, shown.seen.z)};
    store(throughput * light, radiance, i);
    const LaneVec covered{uncovered(shown.clear.x), uncovered(shown.clear.y),
                          uncovered(shown.clear.z)};
    store(dot(throughput, covered) / lanesOf(3), alpha + i);
  }
}

} // namespace HWY_NAMESPACE
} // namespace openrt
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <algorithm>
#include <cmath>

#include "render/lights/shadows.h"
#include "render/path/first_hits.h"

namespace openrt {
HWY_EXPORT(lightOfHits);

namespace {

// Returns where a boundary has no effect on light, as a mask by hit; null if there are none.
const uint32_t* hiddenHits(const RtsBatch& batch, const Boundaries& boundaries) {
  if (!boundaries.crossing) return nullptr;
  const uint32_t n = batch.points->hits.count;
  auto* hidden = batch.arena.take<uint32_t>(padded(n));
  for (uint32_t i = 0; i < padded(n); i++) hidden[i] = !boundaries.visibleAt(std::min(i, n - 1));
  return hidden;
}

// Adds light that the coat of the first surface of a path has reflected to RT_REFLECTION.
void addCoated(const PathStates& states, uint32_t lane, const Vec3f& light, float transmittance,
               PixelSamples& found) {
  const PathFlags flags = states.flagsOf(lane);
  if (flags.reflected() || flags.scattered()) return; // PixelSamples::add(); not the first surface
  const Vec3f arriving = load(states.throughput, lane) * (transmittance * light);
  const uint32_t path = states.path[lane];
  float* const* const reflection = found.of(RT_REFLECTION);
  if (isFinite(arriving)) store(load(reflection, path) + arriving, reflection, path);
}

} // namespace

void addShading(const CameraPaths& paths, const RtsShading& shaded, const Fog& fog,
                PixelSamples& found) {
  constexpr Vec3f one{1, 1, 1};
  const RtsBatch& batch = paths.batch;
  for (uint32_t i = 0; i < batch.points->hits.count; i++) {
    const RayState ray = (*batch.states)[batch.order[i]];
    const Vec3f transmission = min(max(Vec3f(), load(shaded.transmission, i)), one); // NaN: opaque
    Vec3f arriving;
    for (int k = 0; k < 3; k++) {
      const float light = std::isfinite(shaded.radiance[k][i]) ? shaded.radiance[k][i] : 0.0f;
      arriving[k] = ray.throughput[k] * fog.attenuate(i, k, light, transmission[k]);
    }
    found.add(ray.path, ray.flags, arriving);
    const float covered = dot(ray.throughput, one - transmission),
                through = dot(ray.throughput, transmission);
    if (!ray.flags.deflected()) found.alpha[ray.path] += covered / 3;
    if (found.first[ray.path]) {
      found.first[ray.path] = 0;
      if (!found.firstHits || !found.firstHits->takeShading(batch, i, transmission))
        storeFirstHit({batch.scene, *batch.points, i, shaded.albedo}, ray.path, found);
    }
    if (through <= 1e-6f)
      paths.ledger.cutByEnergy += double(through);
    else
      spawnStraightRay(paths, i, transmission, ray.media,
                       {.guided = false, .sampled = passesStraight(shaderAt(batch, i))});
  }
}

// Several hits may belong to one path, so what the vector lanes have computed is added hit by hit.
void addSurface(const RtsBatch& batch, const RtsSurface& surface, const SentLight& sent,
                const Boundaries& boundaries, const Fog& fog, PixelSamples& found) {
  ArenaScope scope(batch.arena);
  const PathStates& states = *batch.states;
  const uint32_t n = batch.points->hits.count;
  float *radiance[3], *alpha = batch.arena.take<float>(padded(n));
  for (auto& a : radiance) a = batch.arena.take<float>(padded(n));
  HWY_DYNAMIC_DISPATCH(lightOfHits)
  (batch, sent, fog, hiddenHits(batch, boundaries), radiance, alpha);
  const ImageLead* leads = nullptr;
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t lane = batch.order[i], path = states.path[lane];
    found.add(path, states.flagsOf(lane), load(radiance, i));
    if (sent.coated[0])
      addCoated(states, lane, load(sent.coated, i), fog.transmittance ? fog.transmittance[i] : 1,
                found);
    if (!states.flagsOf(lane).deflected()) found.alpha[path] += alpha[i];
    if (found.first[path] && boundaries.visibleAt(i)) {
      found.first[path] = 0;
      if (found.firstHits && !leads) leads = findImageLeads(batch, boundaries);
      if (!leads || !found.firstHits->takeSurface(batch, boundaries, i, leads[i]))
        storeFirstHit({batch.scene, *batch.points, i, surface.albedo}, path, found);
    }
  }
}

} // namespace openrt
#endif

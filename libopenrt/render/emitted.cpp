// emitted.cpp: light of emitters and of the sky at diffuse surfaces: for each hit one place is chosen, looked at by a ray, and
// weighed against the directions that the surface chooses itself. Part of TileRenderer.
#include <algorithm>
#include <cmath>

#include "render/paths.h"
#include "render/scatter.h"

namespace openrt {
// From where, and to which side of it, a surface that does not transmit sees emitters.
Receiver TileRenderer::receiverOf(const Points& points, uint32_t i) const {
  Receiver from;
  float p[3];
  for (int k = 0; k < 3; k++) p[k] = points.hits.position[k][i], from.normal[k] = points.hits.geometric[k][i];
  offsetPoint(p, from.normal, points.error[i], from.position);
  return from;
}

void TileRenderer::addEmitters(const RtsBatch& batch, const Points& points, const uint32_t* order, const Paths& paths,
                               float* const chance[], float* const radiance[3]) {
  ArenaScope scope(arena_);
  const RtsHits& hits = points.hits;
  const Emitters& emitters = scene_.emitters;
  Rays rays;
  rays.allocate(arena_, hits.count);
  auto* sights = arena_.take<Sight>(hits.count);
  auto* hitOf = arena_.take<uint32_t>(hits.count); // of the batch, by sight
  uint32_t n = 0;
  for (uint32_t i = 0; i < hits.count; i++) {
    bool wanted = false;
    for (uint32_t l = 0; l < batch.lobeCount; l++) wanted |= chance[l] && chance[l][i] > 0;
    if (!wanted) continue;
    const RayState& ray = paths.state[order[i]];
    float pick, spare, u, v;
    sampleAt(ray.path, pairOf(ray, Draw::emitter), pick, spare);
    sampleAt(ray.path, pairOf(ray, Draw::place), u, v);
    const Receiver from = receiverOf(points, i);
    const Sight sight = emitters.choose(from, pick, u, v);
    if (!(sight.density > 0)) continue;
    for (int k = 0; k < 3; k++) rays.org[k][n] = from.position[k], rays.dir[k][n] = sight.direction[k];
    rays.tnear[n] = 0;
    rays.tfar[n] = sight.distance * (1 + 0x1p-10f);
    hitOf[n] = i;
    sights[n++] = sight;
  }
  if (n == 0) return;
  rays.count = n;
  counters_.shadow += n;
  RayHits found;
  found.allocate(arena_, n);
  scene_.kernel->intersect(rays, maskAll, Coherence::incoherent, found);
  lookThroughBacks(rays, found);

  const auto add = [&](uint32_t ray, const float light[3]) {
    const Sight& sight = sights[ray];
    const uint32_t hit = hitOf[ray];
    const float direction[3] = {rays.dir[0][ray], rays.dir[1][ray], rays.dir[2][ray]};
    for (uint32_t l = 0; l < batch.lobeCount; l++) {
      if (!chance[l] || !(chance[l][hit] > 0)) continue;
      const RtsLobe& lobe = batch.lobes[l];
      const float normal[3] = {lobe.normal[0][hit], lobe.normal[1][hit], lobe.normal[2][hit]};
      const float answer = dot3(normal, direction) * float(M_1_PI);
      if (!(answer > 0)) continue;
      const float scale = answer / (sight.density + chance[l][hit] * answer); // balance heuristic over the density
      for (int k = 0; k < 3; k++)
        if (std::isfinite(light[k])) radiance[k][hit] += lobe.weight[k][hit] * scale * light[k];
    }
  };
  auto* lanes = arena_.take<uint32_t>(n);
  auto* sorted = arena_.take<uint32_t>(n);
  uint32_t skies = 0, lit = 0;
  for (uint32_t r = 0; r < n; r++)
    if (sights[r].record == noHit && found.record[r] == noHit) lanes[skies++] = r;
  if (skies) {
    float *local[3], *rgba[4];
    skyAt(rays, lanes, skies, local, rgba);
    for (uint32_t i = 0; i < skies; i++) {
      const float light[3] = {rgba[0][i], rgba[1][i], rgba[2][i]};
      add(lanes[i], light);
    }
  }
  for (uint32_t r = 0; r < n; r++)
    if (found.record[r] != noHit && emitters.sees(sights[r], found.record[r], found.primitive[r], found.t[r])) lanes[lit++] = r;
  if (lit == 0) return;
  auto* travelled = arena_.takeZero<float>(padded(n));
  std::vector<uint32_t> counts;
  std::vector<BucketRange> ranges;
  sortByBucket(scene_, found, lanes, lit, sorted, counts, ranges);
  for (const BucketRange& range : ranges) {
    const RtsClass& shaderClass = *scene_.buckets[range.bucket].shaderClass;
    if (!shaderClass.surface) continue;
    const uint32_t m = range.end - range.begin;
    const Points seen = makePoints(scene_, rays, found, sorted + range.begin, m, travelled, arena_);
    RtsSurface surface{};
    for (auto& e : surface.emission) e = arena_.takeZero<float>(padded(m));
    RtsBatch inner = makeBatch();
    inner.points = &seen;
    shaderClass.surface(&scene_.host, &inner, &seen.hits, &surface);
    for (uint32_t i = 0; i < m; i++) {
      const float light[3] = {surface.emission[0][i], surface.emission[1][i], surface.emission[2][i]};
      add(sorted[range.begin + i], light);
    }
  }
}

} // namespace openrt

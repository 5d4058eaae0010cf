// emitted.cpp: light of emitters and of the sky at diffuse surfaces: for each hit one place is chosen, looked at by a ray, and
// weighed against the directions that the surface chooses itself. Part of TileRenderer.
#include <algorithm>
#include <cmath>
#include <limits>

#include "render/paths.h"
#include "render/scatter.h"

namespace openrt {
namespace {

// A place looked at from one hit.
struct Sight {
  uint32_t hit;                     // of the batch
  const Emitters::Triangle* target; // null: the sky
  float distance, density;          // by solid angle, the choice among all included
};

} // namespace

void TileRenderer::addEmitters(const RtsBatch& batch, const Points& points, const uint32_t* order, const Paths& paths,
                               float* const chance[], float* const radiance[3]) {
  ArenaScope scope(arena_);
  const RtsHits& hits = points.hits;
  const Emitters& emitters = scene_.emitters;
  Rays rays;
  rays.allocate(arena_, hits.count);
  auto* sights = arena_.take<Sight>(hits.count);
  uint32_t n = 0;
  const float skyShare = emitters.skyShare();
  for (uint32_t i = 0; i < hits.count; i++) {
    bool wanted = false;
    for (uint32_t l = 0; l < batch.lobeCount; l++) wanted |= chance[l] && chance[l][i] > 0;
    if (!wanted) continue;
    const RayState& ray = paths.state[order[i]];
    float pick, spare, u, v, direction[3];
    sampleAt(ray.path, pairOf(ray, Draw::emitter), pick, spare);
    sampleAt(ray.path, pairOf(ray, Draw::place), u, v);
    const float g[3] = {hits.geometric[0][i], hits.geometric[1][i], hits.geometric[2][i]};
    const float p[3] = {hits.position[0][i], hits.position[1][i], hits.position[2][i]};
    float origin[3];
    offsetPoint(p, g, points.error[i], origin);
    Sight sight{i, nullptr, std::numeric_limits<float>::infinity(), 0};
    if (pick < skyShare) {
      float local[3];
      sight.density = skyShare * emitters.sky.sample(u, v, local);
      const auto& m = scene_.environment.fromLocal.r;
      for (int k = 0; k < 3; k++) direction[k] = m[k][0] * local[0] + m[k][1] * local[1] + m[k][2] * local[2];
    } else {
      sight.target = &emitters.pick((pick - skyShare) / (1 - skyShare));
      float corner[3][3], way[3], a[3], b[3];
      cornersOf(scene_.records[sight.target->record], sight.target->primitive, corner);
      const float root = std::sqrt(u), w[3] = {1 - root, root * (1 - v), root * v}; // uniform on the triangle
      for (int k = 0; k < 3; k++) {
        way[k] = w[0] * corner[0][k] + w[1] * corner[1][k] + w[2] * corner[2][k] - origin[k];
        a[k] = corner[1][k] - corner[0][k], b[k] = corner[2][k] - corner[0][k];
      }
      const float normal[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
      const float square = dot3(way, way), distance = std::sqrt(square);
      const float projected = std::fabs(dot3(normal, way)) / (2 * distance); // area x cosine
      for (int k = 0; k < 3; k++) direction[k] = way[k] / distance;
      sight.distance = distance;
      sight.density = (1 - skyShare) * sight.target->probability * square / projected;
    }
    if (!(sight.density > 0) || !std::isfinite(sight.density) || !(dot3(direction, g) > 0)) continue;
    for (int k = 0; k < 3; k++) rays.org[k][n] = origin[k], rays.dir[k][n] = direction[k];
    rays.tnear[n] = 0;
    rays.tfar[n] = sight.target ? sight.distance * (1 + 0x1p-10f) : sight.distance;
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
    const float direction[3] = {rays.dir[0][ray], rays.dir[1][ray], rays.dir[2][ray]};
    for (uint32_t l = 0; l < batch.lobeCount; l++) {
      if (!chance[l] || !(chance[l][sight.hit] > 0)) continue;
      const RtsLobe& lobe = batch.lobes[l];
      const float normal[3] = {lobe.normal[0][sight.hit], lobe.normal[1][sight.hit], lobe.normal[2][sight.hit]};
      const float answer = dot3(normal, direction) * float(M_1_PI);
      if (!(answer > 0)) continue;
      const float scale = answer / (sight.density + chance[l][sight.hit] * answer); // balance heuristic over the density
      for (int k = 0; k < 3; k++)
        if (std::isfinite(light[k])) radiance[k][sight.hit] += lobe.weight[k][sight.hit] * scale * light[k];
    }
  };
  auto* lanes = arena_.take<uint32_t>(n);
  auto* sorted = arena_.take<uint32_t>(n);
  uint32_t skies = 0, lit = 0;
  for (uint32_t r = 0; r < n; r++)
    if (!sights[r].target && found.record[r] == noHit) lanes[skies++] = r;
  if (skies) {
    float *local[3], *rgba[4];
    skyAt(rays, lanes, skies, local, rgba);
    for (uint32_t i = 0; i < skies; i++) {
      const float light[3] = {rgba[0][i], rgba[1][i], rgba[2][i]};
      add(lanes[i], light);
    }
  }
  // The ray has met its triangle, or, at an edge, a neighbour of the same surface at the same distance.
  for (uint32_t r = 0; r < n; r++) {
    if (!sights[r].target || found.record[r] != sights[r].target->record) continue;
    const bool there = found.primitive[r] == sights[r].target->primitive ||
                       std::fabs(found.t[r] - sights[r].distance) <= 0x1p-16f * sights[r].distance;
    if (there) lanes[lit++] = r;
  }
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

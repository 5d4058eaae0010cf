// queries.cpp: ray queries of the local backend, in blocks spread over the threads.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "backend/local/local.h"

namespace openrt {
namespace {

constexpr size_t block = 4096;

// Outward unit normal in the world: the kernel's, brought out of the instance and turned to the front.
void worldNormal(const Record& r, const RayHits& hits, uint32_t i, float out[3]) {
  const float k[3] = {hits.ng[0][i], hits.ng[1][i], hits.ng[2][i]};
  double n[3] = {k[0], k[1], k[2]};
  if (r.instanced)
    for (int j = 0; j < 3; j++)
      n[j] = double(r.kernelNormal[j][0]) * k[0] + double(r.kernelNormal[j][1]) * k[1] + double(r.kernelNormal[j][2]) * k[2];
  const double l = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  const double s = l > 0 ? (r.flip ? -1 : 1) / l : 0;
  for (int j = 0; j < 3; j++) out[j] = float(n[j] * s);
}

template <class F> void parallelBlocks(uint32_t threads, size_t count, const F& f) {
  tbb::task_arena arena{int(threads)};
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<size_t>(0, (count + block - 1) / block, 1), [&](const auto& range) {
      for (size_t b = range.begin(); b < range.end(); b++) f(b * block, std::min(block, count - b * block));
    });
  });
}

} // namespace

void LocalBackend::loadRays(std::span<const RTray> rays, size_t first, Rays& to) const {
  for (uint32_t i = 0; i < to.count; i++) {
    const RTray& ray = rays[first + i];
    for (int k = 0; k < 3; k++) {
      to.org[k][i] = float(ray.origin[k] - snapshot_->origin[k]);
      to.dir[k][i] = ray.direction[k];
    }
    to.tnear[i] = ray.tnear, to.tfar[i] = ray.tfar;
  }
}

void LocalBackend::castRays(std::span<const RTray> rays, std::span<RThit> hits) {
  prepare();
  parallelBlocks(threads_, rays.size(), [&](size_t first, size_t n) {
    Arena arena;
    Rays batch;
    batch.allocate(arena, uint32_t(n));
    RayHits found;
    found.allocate(arena, uint32_t(n));
    loadRays(rays, first, batch);
    accel_->intersect(batch, maskAll, Coherence::incoherent, found);
    for (uint32_t i = 0; i < n; i++) hits[first + i] = hitOf(found, i);
  });
}

RThit LocalBackend::hitOf(const RayHits& found, uint32_t i) const {
  RThit hit{};
  hit.t = std::numeric_limits<float>::infinity();
  if (found.record[i] == noHit) return hit;
  const Record& r = accel_->records[found.record[i]];
  hit.t = found.t[i], hit.u = found.u[i], hit.v = found.v[i];
  worldNormal(r, found, i, hit.normal);
  hit.instance = r.instance, hit.name = r.name, hit.primitive = found.primitive[i], hit.userData = r.userData;
  return hit;
}

// The camera's own ray in render space: what the picture shows, also where the world's coordinates are too large for float.
bool LocalBackend::pick(double x, double y, RThit& hit) {
  prepare();
  Arena arena;
  Rays ray;
  ray.allocate(arena, 1);
  float origin[3], direction[3];
  if (!cameraRay(x, y, origin, direction)) return false;
  for (int k = 0; k < 3; k++) ray.org[k][0] = origin[k], ray.dir[k][0] = direction[k];
  ray.tnear[0] = 0, ray.tfar[0] = std::numeric_limits<float>::infinity();
  RayHits found;
  found.allocate(arena, 1);
  accel_->intersect(ray, maskAll, Coherence::incoherent, found);
  if (found.record[0] != noHit && culled(*snapshot_, ray, found, 0)) accel_->intersectFronts(ray, maskAll, found);
  hit = hitOf(found, 0);
  return true;
}

void LocalBackend::occludedRays(std::span<const RTray> rays, std::span<uint8_t> occluded) {
  prepare();
  parallelBlocks(threads_, rays.size(), [&](size_t first, size_t n) {
    Arena arena;
    Rays batch;
    batch.allocate(arena, uint32_t(n));
    loadRays(rays, first, batch);
    accel_->occluded(batch, maskAll, Coherence::incoherent, occluded.data() + first);
  });
}

} // namespace openrt

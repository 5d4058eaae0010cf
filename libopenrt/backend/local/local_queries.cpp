// local_queries.cpp: Answers ray, hit and closest-point queries in single precision, in blocks
// distributed over threads. Called on the application's thread.
//
// All hits of a ray are found exactly (accel/exact_scene.h). Nearest hits and occlusion are found
// by Embree, and again exactly where its single precision may have decided wrongly: see
// accel/doubts.h.
#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "backend/local/accel/doubts.h"
#include "backend/local/local_queries.h"
#include "parallel_for.h"
#include "render/wave/batch.h"
#include "shading/running.h"

namespace openrt {
namespace {

constexpr size_t block = 4096;
constexpr float mostFinite = std::numeric_limits<float>::max();

// Transforms the kernel's normal from the instance's frame to the world's axes, turns it to the
// front side and normalises it.
Vec3f worldNormal(const Record& r, const Vec3f& kernel) {
  const Vec3d k(kernel), n = r.instanced ? r.frames->kernelNormal * k : k;
  const double l = length(n);
  return Vec3f(n * (l > 0 ? (r.flip ? -1 : 1) / l : 0));
}

// Returns by what the direction of a ray is multiplied before the kernel gets it: a power of two
// for very short directions, else 1. Embree treats components below 1e-18 as 1e-18, so rays with
// such directions would pass between triangles.
inline float directionScale(const RTray& ray) {
  const float most = largest(abs(vectorOf(ray.direction)));
  if (!(most < 0x1p-20f && most > 0)) [[likely]]
    return 1;
  return std::ldexp(1.0f, std::min(-std::ilogb(most), 126));
}

// Returns whether neighbouring rays run side by side, as those of a pinhole camera, of a lidar's
// scan lines or of a grid do, so that Embree should trace packets of them together. It looks at a
// few pairs; where it errs, only time is lost.
bool areCoherent(const Rays& rays, float sceneSize) {
  constexpr uint32_t pairs = 16, apart = 8;
  if (rays.count < 2 * apart) return false;
  const float reach = sceneSize / 64;
  uint32_t close = 0;
  for (uint32_t k = 0; k < pairs; k++) {
    const uint32_t i = uint32_t(uint64_t(k) * (rays.count - apart) / pairs);
    const Vec3f d = load(rays.dir, i), e = load(rays.dir, i + apart);
    const float along = dot(d, e);
    const bool parallel = along > 0 && along * along > 0.99f * dot(d, d) * dot(e, e);
    close += parallel && largest(abs(load(rays.org, i) - load(rays.org, i + apart))) < reach;
  }
  return close >= pairs - 2; // a scan line may end between two rays
}

// Calls f(block) for the numbers below `count`, on all threads.
template <class F> void forNumbers(uint32_t threads, size_t count, const F& f) {
  tbb::task_arena arena{int(threads)};
  arena.execute([&] {
    parallelFor(tbb::blocked_range<size_t>(0, count, 1), [&](const auto& range) {
      for (size_t b = range.begin(); b < range.end(); b++) f(b);
    });
  });
}

template <class F> void parallelBlocks(uint32_t threads, size_t count, const F& f) {
  forNumbers(threads, (count + block - 1) / block,
             [&](size_t b) { f(b * block, std::min(block, count - b * block)); });
}

} // namespace

LocalQueries::LocalQueries(std::shared_ptr<EmbreeDevice> device, uint32_t threads,
                           std::function<PreparedGeometry()> prepare)
    : device_(std::move(device)), threads_(threads), prepare_(std::move(prepare)) {}

LocalQueries::~LocalQueries() = default;

void LocalQueries::clear() {
  exact_ = nullptr;
  double_ = nullptr;
  bodies_ = nullptr;
}

void LocalQueries::loadRays(std::span<const RTray> rays, const RayOrder::Block& block,
                            Rays& to) const {
  const Vec3d origin = vectorOf(at_->snapshot.origin);
  for (uint32_t i = 0; i < to.count; i++) {
    const RTray& ray = rays[block.first + block.offset[i]];
    store(Vec3f(Vec3d(vectorOf(ray.origin)) - origin), to.org, i);
    const float scale = directionScale(ray);
    store(scale * vectorOf(ray.direction), to.dir, i);
    to.tnear[i] = ray.tnear / scale;
    // No hit is so far that its distance in lengths of the given direction is no float.
    to.tfar[i] = scale == 1 ? ray.tfar : std::min(ray.tfar, mostFinite) / scale;
  }
}

void LocalQueries::forBatches(
    std::span<const RTray> rays, float sceneSize,
    const std::function<void(const RayOrder::Block& block, Arena& arena, Rays& batch)>& use) {
  // Memory that is given back after each block would cost a tenth of the time of coherent rays.
  struct Memory {
    Arena arena;
    RayOrder::Block block;
  };
  tbb::enumerable_thread_specific<Memory> memories;
  const RayOrder order(rays, sceneSize);
  forNumbers(threads_, order.blocks(), [&](size_t number) {
    Memory& own = memories.local();
    ArenaScope scope(own.arena);
    order.get(number, own.block);
    Rays batch;
    batch.allocate(own.arena, own.block.count);
    loadRays(rays, own.block, batch);
    use(own.block, own.arena, batch);
  });
}

const ExactScene& LocalQueries::exactScene() {
  prepare();
  if (!exact_ || exactIsFormer_) {
    exact_ = std::make_unique<const ExactScene>(*device_, at_->accel, exact_.get());
    exactIsFormer_ = false;
  }
  return *exact_;
}

const ClosedBodies& LocalQueries::closedBodies() {
  prepare();
  if (!bodies_ || bodiesAreFormer_) {
    bodies_ = std::make_unique<const ClosedBodies>(at_->accel, bodies_.get());
    bodiesAreFormer_ = false;
  }
  return *bodies_;
}

bool LocalQueries::loadExact(const RTray& ray, ExactRay& to) const {
  const Vec3d origin = Vec3d(vectorOf(ray.origin)) - vectorOf(at_->snapshot.origin),
              direction(vectorOf(ray.direction));
  const double size = dot(abs(direction), {1, 1, 1});
  // Comparisons with NaN are false.
  if (!(largest(abs(origin)) <= at_->accel.reach() && isFinite(vectorOf(ray.origin)) && size > 0 &&
        size <= 1e18 && ray.tnear >= 0 && ray.tnear <= ray.tfar && ray.tnear <= mostFinite))
    return false;
  to = exactRay(origin, direction, ray.tnear, ray.tfar, 0x1p-30);
  return true;
}

void LocalQueries::forEachExact(std::span<const RTray> rays, const uint8_t* some,
                                const std::function<void(size_t, const ExactRay&)>& use,
                                const std::function<void(size_t)>& refuse) {
  parallelBlocks(threads_, rays.size(), [&](size_t first, size_t n) {
    uint64_t refused = 0;
    for (size_t i = first; i < first + n; i++) {
      if (some && !some[i]) continue;
      ExactRay ray;
      if (loadExact(rays[i], ray)) {
        use(i, ray);
      } else if (refuse) {
        refuse(i);
        refused++;
      }
    }
    if (refused) at_->accel.rejectedRays += refused;
  });
}

bool LocalQueries::isDoubtful(const Doubts& doubts, const Rays& rays, uint32_t i,
                              const RayHits& found) const {
  if (found.record[i] == noHit) return doubts.miss(rays, i);
  return doubts.hit(at_->accel.records[found.record[i]], rays, i, found);
}

template <class Take>
std::vector<uint8_t> LocalQueries::findNearest(std::span<const RTray> rays, const Take& take) {
  const ClosedBodies& bodies = closedBodies();
  const Doubts doubts(at_->accel, at_->accel.scale());
  std::vector<uint8_t> again(rays.size());
  std::atomic<bool> any{false};
  forBatches(rays, doubts.size, [&](const RayOrder::Block& block, Arena& arena, Rays& batch) {
    RayHits found;
    found.allocate(arena, batch.count);
    const Coherence coherence =
        areCoherent(batch, doubts.size) ? Coherence::coherent : Coherence::incoherent;
    at_->accel.intersectInSinglePrecision(batch, maskAll, coherence, found);
    bool some = false;
    auto* suspects = arena.take<uint8_t>(batch.count);
    doubts.suspect(batch, found, suspects);
    for (uint32_t i = 0; i < batch.count; i++) {
      const size_t ray = block.first + block.offset[i];
      take(ray, found, i);
      // A ray that hits nothing is a suspect: its t is infinite.
      if (!suspects[i] && !Doubts::hidesFront(at_->accel.records[found.record[i]])) continue;
      if (isDoubtful(doubts, batch, i, found) ||
          (found.record[i] != noHit && bodies.denies(batch, i, found))) {
        again[ray] = 1;
        some = true;
      }
    }
    if (some) any = true;
  });
  if (!any) again.clear();
  return again;
}

void LocalQueries::castRays(std::span<const RTray> rays, std::span<RThit> hits) {
  const std::vector<uint8_t> again =
      findNearest(rays, [&](size_t ray, const RayHits& found, uint32_t i) {
        hits[ray] = hitOf(found, i);
        if (const float scale = directionScale(rays[ray]); scale != 1) hits[ray].t *= scale;
      });
  if (again.empty()) return;
  const ExactScene& scene = exactScene();
  forEachExact(rays, again.data(), [&](size_t i, const ExactRay& ray) {
    ExactScene::Hit found;
    scene.nearest(ray, found);
    hits[i] = hitOf(found, ray, rays[i]);
  });
}

RThit LocalQueries::hitOf(const ExactScene::Hit& found, const ExactRay& ray,
                          const RTray& asked) const {
  RThit hit{};
  hit.t = std::numeric_limits<float>::infinity();
  if (found.record == noHit) return hit;
  const Record& r = at_->accel.records[found.record];
  hit.t = std::clamp(float(found.at.t * ray.unit), asked.tnear, std::min(asked.tfar, mostFinite));
  hit.u = float(found.at.u);
  hit.v = float(found.at.v);
  store(Vec3f(exact_->normal(found, ray)), hit.normal);
  hit.instance = r.instance;
  hit.name = r.name;
  hit.primitive = found.primitive;
  hit.userData = r.userData;
  return hit;
}

RThit LocalQueries::hitOf(const RayHits& found, uint32_t i) const {
  RThit hit{};
  hit.t = std::numeric_limits<float>::infinity();
  if (found.record[i] == noHit) return hit;
  const Record& r = at_->accel.records[found.record[i]];
  hit.t = found.t[i];
  hit.u = found.u[i];
  hit.v = found.v[i];
  store(worldNormal(r, load(found.ng, i)), hit.normal);
  hit.instance = r.instance;
  hit.name = r.name;
  hit.primitive = found.primitive[i];
  hit.userData = r.userData;
  return hit;
}

void LocalQueries::countHits(std::span<const RTray> rays, std::span<uint32_t> counts) {
  const ExactScene& scene = exactScene();
  forEachExact(
      rays, nullptr, [&](size_t i, const ExactRay& ray) { counts[i] = uint32_t(scene.count(ray)); },
      [&](size_t i) { counts[i] = 0; });
}

void LocalQueries::listHits(std::span<const RTray> rays, std::span<const size_t> first,
                            std::span<RThit> hits) {
  const ExactScene& scene = exactScene();
  RThit none{};
  none.t = std::numeric_limits<float>::infinity();
  const auto write = [&](size_t ray, std::span<const ExactScene::Hit> all, const ExactRay& exact) {
    for (size_t i = first[ray]; i < first[ray + 1]; i++) {
      const size_t k = i - first[ray];
      hits[i] = k < all.size() ? hitOf(all[k], exact, rays[ray]) : none;
    }
  };
  forEachExact(
      rays, nullptr,
      [&](size_t i, const ExactRay& ray) {
        std::vector<ExactScene::Hit> all;
        scene.all(ray, all);
        write(i, all, ray);
      },
      [&](size_t i) { write(i, {}, {}); });
}

void LocalQueries::requireNoAnalytic() {
  prepare();
  for (const Record& r : at_->accel.records)
    if (r.surface)
      throw std::runtime_error("the scene has a quadric or an asphere, whose closest points cannot "
                               "be found: make it of triangles, or leave it out");
}

void LocalQueries::closestPoints(std::span<const float> points, float radius,
                                 std::span<RTclosest> closest) {
  requireNoAnalytic();
  const Vec3d origin = vectorOf(at_->snapshot.origin);
  const std::vector<uint32_t> round = at_->accel.spheres();
  parallelBlocks(threads_, closest.size(), [&](size_t first, size_t n) {
    for (size_t i = first; i < first + n; i++) {
      RTclosest& out = closest[i] = {};
      out.distance = std::numeric_limits<float>::infinity();
      const Vec3d place = Vec3d(vectorOf(&points[3 * i])) - origin;
      Accel::Nearest found;
      if (!at_->accel.nearest(place, radius, round, found)) continue;
      const Record& r = at_->accel.records[found.record];
      out.distance = float(found.distance);
      out.u = float(found.u);
      out.v = float(found.v);
      store(Vec3f(found.point + origin), out.point);
      store(Vec3f(found.normal), out.normal);
      out.instance = r.instance;
      out.name = r.name;
      out.primitive = found.primitive;
      out.userData = r.userData;
    }
  });
}

// The ray is in render space, which has the world's unit of length.
bool LocalQueries::cameraRay(double x, double y, Vec3f& origin, Vec3f& direction) const {
  const ShaderSlot& camera = at_->snapshot.camera.shader;
  if (!camera.shaderClass || at_->snapshot.frame.width == 0) return false;
  Arena arena;
  RtsRays local;
  for (int k = 0; k < 3; k++) {
    local.origin[k] = arena.takeZero<float>(lanes);
    local.direction[k] = arena.takeZero<float>(lanes);
  }
  float* xy[2] = {arena.take<float>(lanes), arena.take<float>(lanes)};
  std::fill_n(xy[0], lanes, float(x));
  std::fill_n(xy[1], lanes, float(y));
  const float* points[2] = {xy[0], xy[1]};
  const float size[2] = {float(at_->snapshot.frame.width), float(at_->snapshot.frame.height)};
  RayCounters counters;
  RtsBatch batch({at_->snapshot, arena, counters});
  // Without a tracer, random points are (0.5, 0.5): the middle of the lens.
  batch.lanes = {.count = lanes, .cameraRays = true};
  {
    const RunningShader running(*camera.shaderClass);
    camera.shaderClass->generate(&at_->snapshot.host, &batch, camera.params, 1, points, size,
                                 &local);
  }
  const Affine& toRender = at_->snapshot.camera.fromLocal;
  origin = toRender.point(load(local.origin, 0));
  const Vec3d towards = toRender.direction(Vec3d(load(local.direction, 0)));
  direction = Vec3f(towards / length(towards));
  return true;
}

// Traces the camera's ray in render space, so that the result matches the picture even where world
// coordinates are too large for float.
bool LocalQueries::pick(double x, double y, RThit& hit) {
  prepare();
  Arena arena;
  Rays ray;
  ray.allocate(arena, 1);
  Vec3f origin, direction;
  if (!cameraRay(x, y, origin, direction)) return false;
  store(origin, ray.org, 0);
  store(direction, ray.dir, 0);
  ray.tnear[0] = 0;
  ray.tfar[0] = std::numeric_limits<float>::infinity();
  RayHits found;
  found.allocate(arena, 1);
  at_->accel.intersect(ray, maskAll, Coherence::incoherent, found);
  if (found.record[0] != noHit && isCulledHit(at_->snapshot, ray, found, 0))
    at_->accel.intersectFronts(ray, maskAll, found);
  hit = hitOf(found, 0);
  return true;
}

// An occlusion query of Embree is a third faster, but does not say where it hit.
void LocalQueries::occludedRays(std::span<const RTray> rays, std::span<uint8_t> occluded) {
  const std::vector<uint8_t> again =
      findNearest(rays, [&](size_t ray, const RayHits& found, uint32_t i) {
        occluded[ray] = found.record[i] != noHit;
      });
  if (again.empty()) return;
  const ExactScene& scene = exactScene();
  forEachExact(rays, again.data(),
               [&](size_t i, const ExactRay& ray) { occluded[i] = scene.occluded(ray); });
}

} // namespace openrt

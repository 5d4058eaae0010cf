// precise_queries.cpp: answers ray queries in double precision, on threads of its own.
// Called on the application's thread.
#include <tbb/task_arena.h>

#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>

#include "backend/local/local_queries.h"
#include "parallel_for.h"

namespace openrt {
namespace {

constexpr size_t block = 256;
constexpr double farthest = 1e18, infinite = std::numeric_limits<double>::infinity();

// Returns false if the ray is refused. Comparisons with NaN are false.
bool load(const RTrayd& from, PreciseRay& to) {
  to = {vectorOf(from.origin), vectorOf(from.direction), from.tnear, from.tfar};
  const double most = largest(abs(to.direction));
  return isFinite(to.origin) && isFinite(to.direction) && largest(abs(to.origin)) <= farthest &&
         most > 0 && most <= farthest && to.near >= 0 && to.near < infinite && to.near <= to.far;
}

RThitd nothing() {
  RThitd hit{};
  hit.t = infinite;
  return hit;
}

} // namespace

const PreciseScene& LocalQueries::precise() {
  prepare();
  if (!precise_ || preciseIsFormer_) {
    const PreciseScene::Input input{at_->scene, at_->flat, at_->survey, at_->accel};
    precise_ = std::make_unique<const PreciseScene>(*device_, input, precise_.get());
    if (rtcGetDeviceError(device_->device) == RTC_ERROR_OUT_OF_MEMORY) {
      precise_ = nullptr;
      throw std::bad_alloc();
    }
    preciseIsFormer_ = false;
  }
  return *precise_;
}

// Calls use(i, ray) for every ray, and refuse(i) for those that cannot be traced.
template <class Use, class Refuse> void
LocalQueries::forEachPrecise(std::span<const RTrayd> rays, const Use& use, const Refuse& refuse) {
  tbb::task_arena arena{int(threads_)};
  arena.execute([&] {
    parallelFor(tbb::blocked_range<size_t>(0, rays.size(), block), [&](const auto& range) {
      uint64_t refused = 0;
      for (size_t i = range.begin(); i < range.end(); i++) {
        PreciseRay ray;
        if (load(rays[i], ray)) {
          use(i, ray);
        } else {
          refuse(i);
          refused++;
        }
      }
      if (refused) at_->accel.rejectedRays += refused;
    });
  });
}

RThitd LocalQueries::hitOf(const PreciseScene::Hit& found, const PreciseRay& ray) const {
  const Record& r = at_->accel.records[found.record];
  RThitd hit{};
  hit.t = found.at.t;
  hit.u = found.at.u;
  hit.v = found.at.v;
  const PrecisePlace place = precise_->place(found, ray);
  store(place.point, hit.position);
  store(precise_->normal(found, ray), hit.normal);
  hit.tError = found.at.tError;
  hit.uvError = found.at.uvError;
  hit.positionError = place.error;
  hit.userData = r.userData;
  hit.instance = r.instance;
  hit.name = r.name;
  hit.primitive = found.primitive;
  return hit;
}

void LocalQueries::castPrecise(std::span<const RTrayd> rays, std::span<RThitd> hits) {
  const PreciseScene& scene = precise();
  forEachPrecise(
      rays,
      [&](size_t i, const PreciseRay& ray) {
        PreciseScene::Hit found;
        hits[i] = scene.nearest(ray, found) ? hitOf(found, ray) : nothing();
      },
      [&](size_t i) { hits[i] = nothing(); });
}

void LocalQueries::occludePrecise(std::span<const RTrayd> rays, std::span<uint8_t> occluded) {
  const PreciseScene& scene = precise();
  forEachPrecise(
      rays, [&](size_t i, const PreciseRay& ray) { occluded[i] = scene.occluded(ray); },
      [&](size_t i) { occluded[i] = 0; });
}

void LocalQueries::countPrecise(std::span<const RTrayd> rays, std::span<uint32_t> counts) {
  const PreciseScene& scene = precise();
  forEachPrecise(
      rays, [&](size_t i, const PreciseRay& ray) { counts[i] = uint32_t(scene.count(ray)); },
      [&](size_t i) { counts[i] = 0; });
}

void LocalQueries::listPrecise(std::span<const RTrayd> rays, std::span<const size_t> first,
                               std::span<RThitd> hits) {
  const PreciseScene& scene = precise();
  const auto fillRest = [&](size_t ray, size_t written) {
    for (size_t i = first[ray] + written; i < first[ray + 1]; i++) hits[i] = nothing();
  };
  forEachPrecise(
      rays,
      [&](size_t ray, const PreciseRay& exact) {
        thread_local std::vector<PreciseScene::Hit> all;
        scene.all(exact, all);
        const size_t room = first[ray + 1] - first[ray], count = std::min(all.size(), room);
        for (size_t i = 0; i < count; i++) hits[first[ray] + i] = hitOf(all[i], exact);
        fillRest(ray, count);
      },
      [&](size_t ray) { fillRest(ray, 0); });
}

void LocalQueries::closestPrecise(std::span<const double> points, double radius,
                                  std::span<RThitd> closest) {
  requireNoAnalytic();
  const PreciseScene& scene = precise();
  if (scene.unevenSphere() != noHit)
    throw std::runtime_error("the scene has a sphere with different scales along its axes, whose "
                             "closest points cannot be found in double precision: make it of "
                             "triangles, or ask in single precision");
  tbb::task_arena arena{int(threads_)};
  arena.execute([&] {
    parallelFor(tbb::blocked_range<size_t>(0, closest.size(), block), [&](const auto& range) {
      for (size_t i = range.begin(); i < range.end(); i++) {
        const Vec3d point = vectorOf(&points[3 * i]);
        RThitd& hit = closest[i] = nothing();
        PreciseScene::Closest found;
        if (!isFinite(point) || largest(abs(point)) > farthest ||
            !scene.closest(point, radius, found))
          continue;
        const Record& r = at_->accel.records[found.record];
        hit.t = found.at.distance;
        hit.u = found.at.u;
        hit.v = found.at.v;
        store(found.place.point, hit.position);
        store(found.normal, hit.normal);
        hit.tError = found.at.distanceError;
        hit.uvError = found.at.uvError;
        hit.positionError = found.place.error;
        hit.userData = r.userData;
        hit.instance = r.instance;
        hit.name = r.name;
        hit.primitive = found.primitive;
      }
    });
  });
}

} // namespace openrt

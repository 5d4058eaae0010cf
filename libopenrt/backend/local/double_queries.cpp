// double_queries.cpp: answers ray queries in double precision, on threads of its own.
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
bool load(const RTrayd& from, DoubleRay& to) {
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

// Returns the answer for a place on a surface; its place along the ray and on the primitive is
// left.
RThitd answerAt(const Record& record, uint32_t primitive, const DoublePlace& place,
                const Vec3d& normal) {
  RThitd hit{};
  store(place.point, hit.position);
  store(normal, hit.normal);
  hit.positionError = place.error;
  hit.userData = record.userData;
  hit.instance = record.instance;
  hit.name = record.name;
  hit.primitive = primitive;
  return hit;
}

} // namespace

const DoubleScene& LocalQueries::doubleScene() {
  prepare();
  if (!double_ || doubleIsFormer_) {
    const DoubleScene::Input input{at_->scene, at_->flat, at_->survey, at_->accel};
    double_ = std::make_unique<const DoubleScene>(*device_, input, double_.get());
    doubleIsFormer_ = false;
  }
  return *double_;
}

// Calls use(i, ray) for every ray, and refuse(i) for those that cannot be traced.
template <class Use, class Refuse> void
LocalQueries::forEachDouble(std::span<const RTrayd> rays, const Use& use, const Refuse& refuse) {
  tbb::task_arena arena{int(threads_)};
  arena.execute([&] {
    parallelFor(tbb::blocked_range<size_t>(0, rays.size(), block), [&](const auto& range) {
      uint64_t refused = 0;
      for (size_t i = range.begin(); i < range.end(); i++) {
        DoubleRay ray;
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

RThitd LocalQueries::hitOf(const DoubleScene::Hit& found, const DoubleRay& ray) const {
  RThitd hit = answerAt(at_->accel.records[found.record], found.primitive,
                        double_->place(found, ray), double_->normal(found, ray));
  hit.t = found.at.t;
  hit.u = found.at.u;
  hit.v = found.at.v;
  hit.tError = found.at.tError;
  hit.uvError = found.at.uvError;
  return hit;
}

void LocalQueries::castDouble(std::span<const RTrayd> rays, std::span<RThitd> hits) {
  const DoubleScene& scene = doubleScene();
  forEachDouble(
      rays,
      [&](size_t i, const DoubleRay& ray) {
        DoubleScene::Hit found;
        hits[i] = scene.nearest(ray, found) ? hitOf(found, ray) : nothing();
      },
      [&](size_t i) { hits[i] = nothing(); });
}

void LocalQueries::occludeDouble(std::span<const RTrayd> rays, std::span<uint8_t> occluded) {
  const DoubleScene& scene = doubleScene();
  forEachDouble(
      rays, [&](size_t i, const DoubleRay& ray) { occluded[i] = scene.occluded(ray); },
      [&](size_t i) { occluded[i] = 0; });
}

void LocalQueries::countDouble(std::span<const RTrayd> rays, std::span<uint32_t> counts) {
  const DoubleScene& scene = doubleScene();
  forEachDouble(
      rays, [&](size_t i, const DoubleRay& ray) { counts[i] = uint32_t(scene.count(ray)); },
      [&](size_t i) { counts[i] = 0; });
}

void LocalQueries::listDouble(std::span<const RTrayd> rays, std::span<const size_t> first,
                              std::span<RThitd> hits) {
  const DoubleScene& scene = doubleScene();
  const auto fillRest = [&](size_t ray, size_t written) {
    for (size_t i = first[ray] + written; i < first[ray + 1]; i++) hits[i] = nothing();
  };
  forEachDouble(
      rays,
      [&](size_t i, const DoubleRay& ray) {
        thread_local std::vector<DoubleScene::Hit> all;
        scene.all(ray, all);
        const size_t room = first[i + 1] - first[i], count = std::min(all.size(), room);
        for (size_t k = 0; k < count; k++) hits[first[i] + k] = hitOf(all[k], ray);
        fillRest(i, count);
      },
      [&](size_t ray) { fillRest(ray, 0); });
}

void LocalQueries::closestDouble(std::span<const double> points, double radius,
                                 std::span<RThitd> closest) {
  requireNoAnalytic();
  const DoubleScene& scene = doubleScene();
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
        DoubleScene::Closest found;
        if (!isFinite(point) || largest(abs(point)) > farthest ||
            !scene.closest(point, radius, found))
          continue;
        hit =
            answerAt(at_->accel.records[found.record], found.primitive, found.place, found.normal);
        hit.t = found.at.distance;
        hit.u = found.at.u;
        hit.v = found.at.v;
        hit.tError = found.at.distanceError;
        hit.uvError = found.at.uvError;
      }
    });
  });
}

} // namespace openrt

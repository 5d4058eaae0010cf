// local_queries.h: answers ray queries and picks on the committed scene in this process. A query
// prepares the geometry of the scene, and nothing that only pictures need. Called on the
// application's thread; it works on threads of its own.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "backend/local/accel/accel.h"
#include "backend/local/accel/closed_bodies.h"
#include "backend/local/accel/exact_scene.h"
#include "backend/local/accel/survey.h"
#include "backend/local/double/double_scene.h"
#include "backend/local/ray_order.h"
#include "backend/queries.h"
#include "render/render_scene.h"

namespace openrt {

struct Doubts;

// The committed scene, ready for queries.
struct PreparedGeometry {
  const Scene& scene;
  const Flattened& flat;
  const Survey& survey;
  const Accel& accel;
  const RenderScene& snapshot;
};

class LocalQueries final : public Queries {
 public:
  // prepare: brings the geometry up to date. Its result stays until the next call.
  LocalQueries(std::shared_ptr<EmbreeDevice> device, uint32_t threads,
               std::function<PreparedGeometry()> prepare);
  ~LocalQueries() override;
  // The geometry is about to change. The structures made of it are kept for its meshes.
  void outdate() { exactIsFormer_ = doubleIsFormer_ = bodiesAreFormer_ = true; }
  // The geometry is gone.
  void clear();

  void castRays(std::span<const RTray> rays, std::span<RThit> hits) override;
  void occludedRays(std::span<const RTray> rays, std::span<uint8_t> occluded) override;
  bool pick(double x, double y, RThit& hit) override;
  void countHits(std::span<const RTray> rays, std::span<uint32_t> counts) override;
  void listHits(std::span<const RTray> rays, std::span<const size_t> first,
                std::span<RThit> hits) override;
  void closestPoints(std::span<const float> points, float radius,
                     std::span<RTclosest> closest) override;
  void castDouble(std::span<const RTrayd> rays, std::span<RThitd> hits) override;
  void occludeDouble(std::span<const RTrayd> rays, std::span<uint8_t> occluded) override;
  void countDouble(std::span<const RTrayd> rays, std::span<uint32_t> counts) override;
  void listDouble(std::span<const RTrayd> rays, std::span<const size_t> first,
                  std::span<RThitd> hits) override;
  void closestDouble(std::span<const double> points, double radius,
                     std::span<RThitd> closest) override;

 private:
  void prepare() { at_.emplace(prepare_()); }
  // Makes the scene for exact queries of what is committed, if it does not exist yet.
  const ExactScene& exactScene();
  // Finds the closed meshes of what is committed, likewise.
  const ClosedBodies& closedBodies();
  // Makes the scene for queries in double precision, likewise (double_queries.cpp).
  const DoubleScene& doubleScene();
  void requireNoAnalytic(); // throws if the scene has quadrics or aspheres
  // Computes the ray of the camera through a pixel.
  bool cameraRay(double x, double y, Vec3f& origin, Vec3f& direction) const;
  // Calls `use` for blocks of rays, converted to render space, on all threads.
  void forBatches(
      std::span<const RTray> rays, float sceneSize,
      const std::function<void(const RayOrder::Block& block, Arena& arena, Rays& batch)>& use);
  void loadRays(std::span<const RTray> rays, const RayOrder::Block& block, Rays& to) const;
  // Calls `use` for every ray of which `some` is not 0 (null: all), on all threads. Rays that
  // cannot be traced are counted and left out; `refuse` is called for them.
  void forEachExact(std::span<const RTray> rays, const uint8_t* some,
                    const std::function<void(size_t ray, const ExactRay& exact)>& use,
                    const std::function<void(size_t ray)>& refuse = {});
  // Makes the exact ray of a query; returns false if it cannot be traced.
  bool loadExact(const RTray& ray, ExactRay& to) const;
  template <class Use, class Refuse>
  void forEachDouble(std::span<const RTrayd> rays, const Use& use, const Refuse& refuse);
  // Finds the nearest hits of rays in single precision and calls take(ray, hits, index of its hit)
  // for each, on all threads. Returns by ray whether it must be decided again; empty: none must.
  template <class Take>
  std::vector<uint8_t> findNearest(std::span<const RTray> rays, const Take& take);
  bool isDoubtful(const Doubts& doubts, const Rays& rays, uint32_t i, const RayHits& found) const;
  RThit hitOf(const RayHits& found, uint32_t i) const;
  RThit hitOf(const ExactScene::Hit& found, const ExactRay& ray, const RTray& asked) const;
  RThitd hitOf(const DoubleScene::Hit& found, const DoubleRay& ray) const;

  std::shared_ptr<EmbreeDevice> device_;
  uint32_t threads_;
  std::function<PreparedGeometry()> prepare_;
  std::optional<PreparedGeometry> at_; // geometry of the query in progress
  // Null until a query needs them.
  std::unique_ptr<const ExactScene> exact_;
  std::unique_ptr<const DoubleScene> double_;
  std::unique_ptr<const ClosedBodies> bodies_;
  bool exactIsFormer_ = false, doubleIsFormer_ = false, bodiesAreFormer_ = false;
};

} // namespace openrt

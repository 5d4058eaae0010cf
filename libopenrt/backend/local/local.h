// local.h: the backend that renders in this process. It applies commits to its scene, rebuilds what
// they changed, and renders frames and answers queries on its own threads. Called on one thread,
// except cancel(), progress() and snapshot(), which any thread may call.
#pragma once

#include <atomic>
#include <functional>
#include <memory>

#include "backend/backend.h"
#include "backend/local/accel/accel_build.h"
#include "backend/local/accel/closed_bodies.h"
#include "backend/local/accel/exact_scene.h"
#include "backend/local/precise/precise_scene.h"
#include "backend/local/ray_order.h"
#include "backend/surface_queries.h"
#include "render/frame/renderer.h"
#include "scene/history.h"

namespace openrt {

struct Doubts;

class LocalBackend final : public Backend, public SurfaceQueries {
 public:
  explicit LocalBackend(const BackendOptions& options);
  ~LocalBackend() override;
  void apply(std::shared_ptr<const Commit> commit) override;
  bool keepSums(const SumsRequest& request) override;
  std::shared_ptr<FrameSums> sums() const override;
  void start() override;
  void wait() override;
  void cancel() override;
  float progress() const override;
  bool snapshot(RTenum channel, std::span<float> out) const override;
  bool read(RTenum channel, std::span<float> out) const override;
  void stats(RTstats& stats) const override;
  void castRays(std::span<const RTray> rays, std::span<RThit> hits) override;
  void occludedRays(std::span<const RTray> rays, std::span<uint8_t> occluded) override;
  void countHits(std::span<const RTray> rays, std::span<uint32_t> counts) override;
  void listHits(std::span<const RTray> rays, std::span<const size_t> first,
                std::span<RThit> hits) override;
  void closestPoints(std::span<const float> points, float radius,
                     std::span<RTclosest> closest) override;
  void castPrecise(std::span<const RTrayd> rays, std::span<RThitd> hits) override;
  void occludePrecise(std::span<const RTrayd> rays, std::span<uint8_t> occluded) override;
  void countPrecise(std::span<const RTrayd> rays, std::span<uint32_t> counts) override;
  void listPrecise(std::span<const RTrayd> rays, std::span<const size_t> first,
                   std::span<RThitd> hits) override;
  void closestPrecise(std::span<const double> points, double radius,
                      std::span<RThitd> closest) override;
  bool pick(double x, double y, RThit& hit) override;

  // Returns the committed scene as the threads render it; rebuilds it if anything changed. It stays
  // unchanged until the next apply().
  std::shared_ptr<const RenderScene> prepared();

 private:
  void prepare(); // makes a new snapshot of the committed scene if anything changed since the last
  // Likewise, and makes the photons that guide the paths of its frame. cancel() ends that early.
  void prepareFrame();
  void updateAccel(RenderScene& next);
  void updateMotions(RenderScene& next, std::vector<uint32_t> moved, bool all);
  void makeShaders(RenderScene& next) const;
  void makeLights(RenderScene& next, const Flattened& flat, const Vec3d& origin) const;
  void makeCamera(RenderScene& next, const Vec3d& origin) const;
  PixelFootprint footprint(const RenderScene& next) const;
  Vec3d eye() const;
  // Computes the ray of the snapshot's camera through a pixel.
  bool cameraRay(double x, double y, Vec3f& origin, Vec3f& direction) const;
  RThit hitOf(const RayHits& found, uint32_t i) const;
  // Calls `use` for blocks of rays, converted to render space, on all threads.
  void forBatches(
      std::span<const RTray> rays, float sceneSize,
      const std::function<void(const RayOrder::Block& block, Arena& arena, Rays& batch)>& use);
  // Makes the scene for exact queries of what is committed, if it does not exist yet.
  const ExactScene& exact();
  // Finds the closed meshes of what is committed, likewise.
  const ClosedBodies& closedBodies();
  // Makes the scene for queries in double precision, likewise (precise_queries.cpp).
  const PreciseScene& precise();
  template <class Use, class Refuse>
  void forEachPrecise(std::span<const RTrayd> rays, const Use& use, const Refuse& refuse);
  void requireNoAnalytic(); // throws if the scene has quadrics or aspheres
  RThitd hitOf(const PreciseScene::Hit& found, const PreciseRay& ray) const;
  // Calls `use` for every ray of which `some` is not 0 (null: all), on all threads. Rays that
  // cannot be traced are counted and left out; `refuse` is called for them.
  void forEachExact(std::span<const RTray> rays, const uint8_t* some,
                    const std::function<void(size_t ray, const ExactRay& exact)>& use,
                    const std::function<void(size_t ray)>& refuse = {});
  // Makes the exact ray of a query; returns false if it cannot be traced.
  bool loadExact(const RTray& ray, ExactRay& to) const;
  // Finds the nearest hits of rays in single precision and calls take(ray, hits, index of its hit)
  // for each, on all threads. Returns by ray whether it must be decided again; empty: none must.
  template <class Take>
  std::vector<uint8_t> findNearest(std::span<const RTray> rays, const Take& take);
  bool isDoubtful(const Doubts& doubts, const Rays& rays, uint32_t i, const RayHits& found) const;
  RThit hitOf(const ExactScene::Hit& found, const ExactRay& ray, const RTray& asked) const;
  void loadRays(std::span<const RTray> rays, const RayOrder::Block& block, Rays& to) const;

  BackendOptions options_;
  uint32_t threads_;
  std::shared_ptr<EmbreeDevice> device_;
  AccelBuilder builder_;
  Scene scene_;
  SceneHistory history_;       // what has changed since the last frame of each view
  uint64_t snapshotFrame_ = 0; // number of the history at the last prepare()
  SceneChanges changes_;       // since the last prepare()
  std::shared_ptr<RenderScene> snapshot_;
  bool guided_ = false;            // it has the photons that it needs
  std::atomic<bool> stop_ = false; // cancel() was called since prepareFrame()
  std::shared_ptr<Accel> accel_;
  // They belong to accel_, and are null until a query needs them. Those before a change are kept
  // for their meshes.
  std::unique_ptr<const ExactScene> exact_;
  std::unique_ptr<const PreciseScene> precise_;
  std::unique_ptr<const ClosedBodies> bodies_;
  bool exactIsFormer_ = false, preciseIsFormer_ = false, bodiesAreFormer_ = false;
  Flattened flat_;
  PixelFootprint footprint_;
  // scopedLights_: some light has a scope. recordsUnmoved_: every record is in the same place as in
  // the last snapshot.
  bool scopedLights_ = false, recordsUnmoved_ = false;
  std::string transportReason_; // why the snapshot's transport was chosen
  uint32_t unreachedLights_ = 0, transportLeavesOut_ = 0;
  bool warnedOfNearLamp_ = false, warnedOfAnalyticLamp_ = false;
  SumsRequest keep_;
  // Guards frame_ against cancel(), progress(), snapshot() and sums(), and finished_ against the
  // last.
  mutable std::mutex mutex_;
  std::shared_ptr<Frame> frame_, finished_;
  double commitSeconds_ = 0, buildSeconds_ = 0;
};

} // namespace openrt

// local.h: the backend that renders in this process: applies commits to its scene, builds what they
// changed, renders frames.
#pragma once

#include <functional>
#include <memory>

#include "backend/backend.h"
#include "backend/local/accel/accel_build.h"
#include "backend/surface_queries.h"
#include "render/frame/renderer.h"

namespace openrt {

class LocalBackend final : public Backend, public SurfaceQueries {
 public:
  explicit LocalBackend(const BackendOptions& options);
  ~LocalBackend() override;
  void apply(std::shared_ptr<const Commit> commit) override;
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
  bool pick(double x, double y, RThit& hit) override;

  // The committed scene as threads render it, made if anything changed; it stays as it is until the
  // next apply().
  std::shared_ptr<const RenderScene> prepared();

 private:
  void prepare(); // the snapshot of the committed scene, if anything changed since the last
  void bringUpToDate(RenderScene& next);
  void makeShaders(RenderScene& next) const;
  void makeLights(RenderScene& next, const Flattened& flat, const Vec3d& origin) const;
  void makeCamera(RenderScene& next, const Vec3d& origin) const;
  PixelFootprint footprint(const RenderScene& next) const;
  Vec3d eye() const;
  bool cameraRay(double x, double y, float origin[3], float direction[3]) const; // of the snapshot
  RThit hitOf(const RayHits& found, uint32_t i) const;
  // Portions of rays, loaded, on all threads.
  void forBatches(std::span<const RTray> rays,
                  const std::function<void(size_t first, Arena& arena, Rays& batch)>& use);
  void forPassed(std::span<const RTray> rays,
                 const std::function<void(size_t ray, std::span<const Accel::Passed>)>& take);
  void loadRays(std::span<const RTray> rays, size_t first, Rays& to) const;

  BackendOptions options_;
  uint32_t threads_;
  std::shared_ptr<EmbreeDevice> device_;
  AccelBuilder builder_;
  Scene scene_;
  SceneChanges changes_; // since the last prepare()
  std::shared_ptr<RenderScene> snapshot_;
  std::shared_ptr<Accel> accel_;
  Flattened flat_;
  PixelFootprint footprint_;
  bool scopedLights_ = false,
       samePlaces_ = false;     // samePlaces_: of the records, as in the last snapshot
  std::string transportReason_; // of the snapshot
  uint32_t unreachedLights_ = 0, transportLeavesOut_ = 0;
  bool saidNearLamp_ = false;
  mutable std::mutex mutex_; // frame_ as seen by cancel(), progress() and snapshot()
  std::shared_ptr<Frame> frame_, finished_;
  double commitSeconds_ = 0, buildSeconds_ = 0;
};

} // namespace openrt

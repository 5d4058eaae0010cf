// local.h: the backend that renders in this process. It applies commits to its scene, rebuilds what
// they changed, and renders frames and answers queries on its own threads. Called on one thread,
// except cancel(), progress() and snapshot(), which any thread may call.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "backend/backend.h"
#include "backend/local/local_queries.h"
#include "backend/local/snapshots.h"
#include "render/frame/renderer.h"

namespace openrt {

class LocalBackend final : public Backend {
 public:
  explicit LocalBackend(const BackendOptions& options);
  ~LocalBackend() override;
  void apply(std::shared_ptr<const Commit> commit) override;
  void setPatience(double seconds) override;
  bool keepSums(const SumsRequest& request) override;
  std::shared_ptr<FrameSums> sums() const override;
  void start() override;
  void wait() override;
  void cancel() override;
  float progress() const override;
  bool snapshot(RTenum channel, std::span<float> out) const override;
  bool read(RTenum channel, std::span<float> out) const override;
  void stats(RTstats& stats) const override;
  Queries* queries() override { return &queries_; }

  // Returns the committed scene as the threads render it; rebuilds it if anything changed. It stays
  // unchanged until the next apply().
  std::shared_ptr<const RenderScene> prepared();

 private:
  // Adds what a frame needs: the transport, and the tables by which it samples light. A frame whose
  // channels show no light has no tables.
  void prepareLight();
  void sampleLight(RenderScene& next, const RenderScene* before);
  // Adds the photons that guide the paths of a frame. cancel() ends that early.
  void prepareFrame();

  BackendOptions options_;
  uint32_t threads_;
  std::shared_ptr<EmbreeDevice> device_;
  LocalQueries queries_;
  Snapshots snapshots_;
  std::shared_ptr<RenderScene> snapshot_; // the one of the last frame
  // The last snapshots that prepareLight() has completed, and that have tables for light.
  std::shared_ptr<RenderScene> ready_, lit_;
  bool guided_ = false;            // it has the photons that it needs
  std::atomic<bool> stop_ = false; // cancel() was called since prepareFrame()
  std::string transportReason_;    // why the snapshot's transport was chosen
  uint32_t unreachedLights_ = 0, transportLeavesOut_ = 0;
  bool warnedOfNearLamp_ = false, warnedOfAnalyticLamp_ = false;
  SumsRequest keep_;
  // Guards frame_ against cancel(), progress(), snapshot() and sums(), and finished_ against the
  // last.
  mutable std::mutex mutex_;
  std::shared_ptr<Frame> frame_, finished_;
  // Whether the frame in flight, and the finished one, show an earlier scene.
  bool isOutdated_ = false, wasOutdated_ = false;
};

} // namespace openrt

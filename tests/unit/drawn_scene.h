// drawn_scene.h: small scenes drawn through the C API, as the commits that backends receive, and
// prepared for rendering. For tests of the code behind the API.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "api/context.h"
#include "backend/local/local.h"
#include "drawing.h"
#include "shading/registry.h"

namespace openrt::test {

using namespace drawing;
using Commits = std::vector<std::shared_ptr<const Commit>>;

class KeepingBackend final : public Backend {
 public:
  explicit KeepingBackend(std::shared_ptr<Commits> commits) : commits_(std::move(commits)) {}
  void apply(std::shared_ptr<const Commit> commit) override {
    commits_->push_back(std::move(commit));
  }
  void start() override {}
  void wait() override {}
  void cancel() override {}
  float progress() const override { return 1; }
  bool read(RTenum, std::span<float>) const override { return false; }
  void stats(RTstats&) const override {}

 private:
  std::shared_ptr<Commits> commits_;
};

// Returns what `draw` commits: one commit for each rtRender() in it.
inline Commits drawn(const std::function<void()>& draw) {
  auto commits = std::make_shared<Commits>();
  drawIn(adoptContext(
             std::make_shared<Context>(ContextConfig{}, std::make_unique<KeepingBackend>(commits))),
         draw);
  return *commits;
}

struct Settings {
  int samples = 16, transport = RT_TRANSPORT_PATH, width = 20, height = 18, tile = 0;
  uint32_t channels = RT_RGBA;
  double targetError = 0, timeLimit = 0;
  int replicates = 0;
  bool progressive = false;
};

inline void set(const Settings& s) {
  rtFrameBuffer(s.width, s.height, s.channels);
  rtQuality(RT_SAMPLES_PER_PIXEL, s.samples);
  rtQuality(RT_TRANSPORT, s.transport);
  rtQuality(RT_TILE_SIZE, s.tile);
  rtQuality(RT_REPLICATES, s.replicates);
  rtQualityf(RT_TARGET_ERROR, s.targetError);
  rtQualityf(RT_TIME_LIMIT, s.timeLimit);
  rtQuality(RT_PROGRESSIVE, s.progressive);
  rtQuality(RT_MAX_DEPTH, 6);
}

// The room, prepared on a backend of its own.
class Room {
 public:
  explicit Room(const Settings& settings, uint32_t threads = 1) : shaders_(shaderFolders("")) {
    BackendOptions options;
    options.threads = threads;
    options.shaders = &shaders_;
    backend_ = std::make_unique<LocalBackend>(options);
    for (const auto& commit : drawn([&] {
           drawRoom();
           set(settings);
           rtRender();
         }))
      backend_->apply(commit);
    scene_ = backend_->prepared();
  }
  const std::shared_ptr<const RenderScene>& scene() const { return scene_; }
  LocalBackend& backend() { return *backend_; }

 private:
  ShaderRegistry shaders_;
  std::unique_ptr<LocalBackend> backend_;
  std::shared_ptr<const RenderScene> scene_;
};

} // namespace openrt::test

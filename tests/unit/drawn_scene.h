// drawn_scene.h: small scenes drawn through the C API, as the commits that backends receive, and
// prepared for rendering. For tests of the code behind the API.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "api/context.h"
#include "backend/local/local.h"
#include "openrt/openrt.h"
#include "shading/registry.h"

namespace openrt::test {

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
  void castRays(std::span<const RTray>, std::span<RThit>) override {}
  void occludedRays(std::span<const RTray>, std::span<uint8_t>) override {}
  bool pick(double, double, RThit&) override { return false; }

 private:
  std::shared_ptr<Commits> commits_;
};

// Returns what `draw` commits: one commit for each rtRender() in it.
inline Commits drawn(const std::function<void()>& draw) {
  auto commits = std::make_shared<Commits>();
  const RTcontext context = adoptContext(
      std::make_shared<Context>(ContextConfig{}, std::make_unique<KeepingBackend>(commits)));
  draw();
  EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
  rtDeleteContext(context);
  return *commits;
}

struct Settings {
  int samples = 16, transport = RT_TRANSPORT_PATH, width = 20, height = 18, tile = 0;
  uint32_t channels = RT_RGBA;
  double targetError = 0, timeLimit = 0;
  int replicates = 0;
  bool progressive = false;
};
inline constexpr uint32_t everyChannel = (RT_MOTION << 1) - 1;

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

inline RTid colored(const char* shaderClass, const char* parameter, std::array<float, 3> color) {
  const RTid shader = rtNewShader(rtNewShaderClass(shaderClass, nullptr));
  rtBindShader(shader);
  if (parameter) rtParameter3f(rtParameterHandle(parameter), color[0], color[1], color[2]);
  rtBindShader(0);
  return shader;
}

inline RTid square(RTid shader, float half) {
  const RTid object = rtBeginObject(0);
  rtBindShader(shader);
  rtBegin(RT_QUADS);
  rtNormal3f(0, 0, 1);
  for (const auto& c : {std::array{-half, -half}, {half, -half}, {half, half}, {-half, half}})
    rtVertex3f(c[0], c[1], 0);
  rtEnd();
  rtEndObject();
  rtBindShader(0);
  return object;
}

inline void at(double x, double y, double z, RTid object, double turn = 0) {
  rtPushMatrix();
  rtTranslated(x, y, z);
  rtRotated(turn, 1, 0, 0);
  rtInstantiateObject(object);
  rtPopMatrix();
}

inline void lookFrom(double x, double y, double z) {
  rtPushMatrix();
  rtLookAt(x, y, z, 0, 0, 0, 0, 1, 0);
  rtPerspective(40);
  rtPopMatrix();
}

// Draws a floor of two coincident faces, a lamp, a mirror and a glass ball, so that paths split,
// continue and hit ties.
inline void drawRoom() {
  rtLoadIdentity();
  at(0, -1, 0, square(colored("Diffuse", "reflectance", {.8f, .3f, .2f}), 4), -90);
  at(0, -1, 0, square(colored("Diffuse", "reflectance", {.2f, .3f, .8f}), 4), -90);
  at(0, 2.5, 0, square(colored("Diffuse", "emission", {9, 9, 8}), .3f), 90);
  at(-1, 0, -1, square(colored("Mirror", "reflectance", {.9f, .9f, .9f}), .8f), 10);
  const RTid glass = colored("Glass", nullptr, {});
  const RTid ball = rtBeginObject(0);
  rtBindShader(glass);
  rtSphere(.6f);
  rtEndObject();
  rtBindShader(0);
  at(.6, 0, 0, ball);
  lookFrom(0, .5, 5);
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

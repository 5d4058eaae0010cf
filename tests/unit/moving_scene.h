// moving_scene.h: a scene whose instances and objects change in every way over several frames, as
// commits, and the pictures that a backend makes of them. For tests of RT_MOTION in recordings and
// clusters.
#pragma once

#include <cstring>
#include <functional>
#include <vector>

#include "scene/channels.h"
#include "unit/drawn_scene.h"

namespace openrt::test {

inline constexpr int movingFrames = 7;

// Draws the frames. In each one something else has changed since the one before.
inline void drawMovingFrames(const std::function<void()>& render = rtRender) {
  const auto cloth = [](RTid object, double bulge, int cells) {
    return net(
        [=](double u, double v) {
          return Point{.5 * u, .5 * v, bulge * u * v};
        },
        object, cells);
  };
  const auto move = [](RTid instance, double x, double y, double turn) {
    rtPushMatrix();
    rtLoadIdentity();
    rtTranslated(x, y, 0);
    rtRotated(turn, 0, 1, .2);
    double m[16];
    rtGetMatrixd(m);
    rtPopMatrix();
    rtInstanceMatrix(instance, m);
  };
  rtLoadIdentity();
  const RTid sheet = cloth(0, 0, 4), mirror = colored("Mirror", nullptr, {}),
             round = ball(colored("Diffuse", "reflectance", {.7f, .5f, .3f}), .3f);
  const auto group = [&](RTid object, double up) {
    const RTid defined = rtBeginObject(object);
    at(-.5, up, 0, round);
    at(.5, 0, up, sheet);
    rtEndObject();
    return defined;
  };
  const RTid pair = group(0, 0);
  at(0, -1, 0, square(mirror, 3), -90);
  at(0, 0, -2, pair);
  const RTid moving = rtInstantiateObject(pair), still = rtInstantiateObject(sheet);
  move(still, 1.5, .5, 30);
  lookFrom(0, 1, 6);
  render();
  move(moving, .2, .3, 20);
  render();
  cloth(sheet, .2, 4); // other vertices
  move(moving, .1, .3, 10);
  render();
  group(pair, .2); // other instances of the same objects
  render();
  const RTid fresh = rtInstantiateObject(round);
  cloth(sheet, .3, 5); // other triangles
  render();
  rtDeleteInstance(fresh);
  rtInstanceVisible(still, 0);
  move(moving, 0, 0, 0);
  render();
  render(); // nothing has changed
}

// followImages: RT_FOLLOW_IMAGES. views: RT_VIEW of each frame; those that are missing have view 0.
inline Commits movingCommits(bool followImages, const std::vector<int>& views = {}) {
  Commits commits = drawn([&] {
    set({.samples = 2,
         .width = 30,
         .height = 22,
         .channels =
             RT_RGBA | RT_DEPTH | RT_NORMAL | RT_ALBEDO | RT_POSITION | RT_NAME | RT_MOTION});
    rtQuality(RT_FOLLOW_IMAGES, followImages);
    size_t frame = 0;
    drawMovingFrames([&] {
      const int view = frame < views.size() ? views[frame] : 0;
      frame++;
      rtQuality(RT_VIEW, view);
      rtRender();
    });
  });
  EXPECT_EQ(commits.size(), size_t(movingFrames));
  return commits;
}

// Returns all channels of the finished frame of a backend, one after the other.
inline std::vector<float> channelsOf(const Backend& backend, const edit::FrameSettingsT& frame) {
  std::vector<float> all;
  for (uint32_t channel = 1; channel <= allChannels; channel <<= 1) {
    if (!(frame.channels & channel)) continue;
    const size_t begin = all.size();
    all.resize(begin + size_t(frame.width) * frame.height * channelComponents(channel));
    EXPECT_TRUE(backend.read(channel, std::span(all).subspan(begin)));
  }
  return all;
}

// A local backend that renders frames of commits.
class FramePlayer {
 public:
  explicit FramePlayer(uint32_t threads = 1) : shaders_(shaderFolders("")) {
    BackendOptions options;
    options.threads = threads;
    options.shaders = &shaders_;
    backend_ = std::make_unique<LocalBackend>(options);
  }
  void apply(const std::shared_ptr<const Commit>& commit) {
    for (const auto& entry : commit->edits.edits)
      if (const auto* settings = entry->any.AsFrameSettings()) frame_ = *settings;
    backend_->apply(commit);
  }
  std::vector<float> render() {
    backend_->start();
    backend_->wait();
    return channelsOf(*backend_, frame_);
  }
  std::vector<float> render(const std::shared_ptr<const Commit>& commit) {
    apply(commit);
    return render();
  }
  const ShaderRegistry& shaders() const { return shaders_; }

 private:
  ShaderRegistry shaders_;
  std::unique_ptr<LocalBackend> backend_;
  edit::FrameSettingsT frame_;
};

inline bool sameBytes(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

} // namespace openrt::test

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
  const auto net = [](RTid object, float bulge, int cells) {
    std::vector<float> points;
    std::vector<uint32_t> corners;
    for (int y = 0; y <= cells; y++)
      for (int x = 0; x <= cells; x++) {
        const float u = 2 * float(x) / float(cells) - 1, v = 2 * float(y) / float(cells) - 1;
        points.insert(points.end(), {.5f * u, .5f * v, bulge * u * v});
        const auto i = uint32_t(y * (cells + 1) + x), above = i + uint32_t(cells) + 1;
        if (x < cells && y < cells)
          corners.insert(corners.end(), {i, i + 1, above, above, i + 1, above + 1});
      }
    const RTid defined = rtBeginObject(object);
    rtVertexPointer(3, RT_FLOAT, 0, points.data());
    rtDrawElements(RT_TRIANGLES, corners.size(), corners.data(), points.size() / 3);
    rtVertexPointer(3, RT_FLOAT, 0, nullptr);
    rtEndObject();
    return defined;
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
  const RTid cloth = net(0, 0, 4), mirror = colored("Mirror", nullptr, {});
  rtBindShader(colored("Diffuse", "reflectance", {.7f, .5f, .3f}));
  const RTid ball = rtBeginObject(0);
  rtSphere(.3f);
  rtEndObject();
  rtBindShader(0);
  const auto group = [&](RTid object, double up) {
    const RTid defined = rtBeginObject(object);
    at(-.5, up, 0, ball);
    at(.5, 0, up, cloth);
    rtEndObject();
    return defined;
  };
  const RTid pair = group(0, 0);
  at(0, -1, 0, square(mirror, 3), -90);
  at(0, 0, -2, pair);
  const RTid moving = rtInstantiateObject(pair), still = rtInstantiateObject(cloth);
  move(still, 1.5, .5, 30);
  lookFrom(0, 1, 6);
  render();
  move(moving, .2, .3, 20);
  render();
  net(cloth, .2f, 4); // other vertices
  move(moving, .1, .3, 10);
  render();
  group(pair, .2); // other instances of the same objects
  render();
  const RTid fresh = rtInstantiateObject(ball);
  net(cloth, .3f, 5); // other triangles
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

// scissor.cpp: a frame with rtScissor has the bytes of the whole frame inside of its rectangle, in
// every channel, for every transport, any number of threads, and progressively; and it takes its
// share of the work.
#include <map>

#include "drawing.h"
#include "numeric/support.h"

namespace numeric {
namespace {

using namespace drawing;
using Channels = std::map<uint32_t, std::vector<float>>;

struct Rectangle {
  int x, y, width, height;
};

struct Settings {
  int samples = 16, transport = RT_TRANSPORT_PATH, width = 70, height = 50, tile = 0;
  uint32_t channels = RT_RGBA;
  bool progressive = false;
};

class Scissor : public testing::Test {
 protected:
  void open(int threads) {
    if (context_) rtDeleteContext(context_);
    context_ = contextWith(threads);
    ASSERT_NE(context_, nullptr) << (rtGetError(), rtGetErrorMessage());
    drawRoom();
    Shader lamp("VRML97DirectionalLight");
    lamp.set("direction", {-.3, -1, -.4}).set("intensity", {.5});
    rtUseLight(lamp);
  }
  void TearDown() override {
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
    rtDeleteContext(context_);
  }

  static Channels render(const Settings& s, const Rectangle& r) {
    rtFrameBuffer(s.width, s.height, s.channels);
    rtScissor(r.x, r.y, r.width, r.height);
    rtQuality(RT_SAMPLES_PER_PIXEL, s.samples);
    rtQuality(RT_TRANSPORT, s.transport);
    rtQuality(RT_PROGRESSIVE, s.progressive);
    rtQuality(RT_TILE_SIZE, s.tile);
    rtQuality(RT_MAX_DEPTH, 6);
    rtRender();
    Channels out;
    for (uint32_t channel = 1; channel <= s.channels; channel <<= 1)
      if (s.channels & channel) out[channel] = readChannel(channel, s.width, s.height);
    return out;
  }

  static uint64_t raysOf() {
    RTstats stats{};
    stats.size = sizeof stats;
    rtGetStats(&stats);
    return stats.rays.camera;
  }

  static void expectSameInside(const Settings& s, const Rectangle& r, const Channels& whole,
                               const Channels& part) {
    for (const auto& [channel, plane] : whole) {
      const size_t components = plane.size() / (size_t(s.width) * size_t(s.height));
      size_t different = 0;
      for (int y = std::max(r.y, 0); y < std::min(r.y + r.height, s.height); y++)
        for (int x = r.x; x < std::min(r.x + r.width, s.width); x++)
          for (size_t k = 0; k < components; k++) {
            const size_t at = (size_t(y) * size_t(s.width) + size_t(x)) * components + k;
            const float a = plane[at], b = part.at(channel)[at];
            different += !(a == b || (std::isnan(a) && std::isnan(b)));
          }
      EXPECT_EQ(different, 0u) << "channel " << channel << ", " << r.x << "," << r.y << " "
                               << r.width << "x" << r.height;
    }
  }

  void expectSame(const Settings& s, const std::vector<Rectangle>& rectangles) {
    // Motion is unknown in the first frame of a context.
    const Settings first{.samples = 1, .channels = s.channels};
    open(2);
    render(first, {0, 0, 1, 1});
    const Channels whole = render(s, {0, 0, 0, 0});
    for (const int threads : {1, 3}) {
      open(threads);
      render(first, {0, 0, 1, 1});
      for (const Rectangle& r : rectangles) expectSameInside(s, r, whole, render(s, r));
    }
  }

  RTcontext context_ = nullptr;
};

const std::vector<Rectangle> inside = {{20, 10, 17, 9}, {33, 21, 1, 1}, {3, 3, 60, 40}};
const std::vector<Rectangle> anywhere = {
    {20, 10, 17, 9}, {0, 0, 5, 5}, {60, 40, 10, 10}, {60, 40, 500, 500}, {0, 0, 70, 50}};

TEST_F(Scissor, PixelsAreThoseOfTheWholeFrame) {
  for (const int samples : {1, 4, 16, 37}) expectSame({.samples = samples}, anywhere);
  expectSame({.samples = 4, .tile = 4}, anywhere);
  expectSame({.samples = 37, .progressive = true}, anywhere);
}

TEST_F(Scissor, AllChannelsAreThoseOfTheWholeFrame) {
  expectSame({.samples = 40, .channels = everyChannel & ~uint32_t(RT_ERROR | RT_TRUST)}, anywhere);
  expectSame({.samples = 40, .channels = everyChannel}, inside);
  expectSame({.samples = 8, .tile = 5, .channels = everyChannel}, inside);
}

TEST_F(Scissor, EveryTransportHasThePixelsOfTheWholeFrame) {
  for (const int transport : {RT_TRANSPORT_AUTO, RT_TRANSPORT_DIRECT, RT_TRANSPORT_WHITTED,
                              RT_TRANSPORT_PATH, RT_TRANSPORT_LIGHT})
    expectSame({.samples = 33, .transport = transport, .channels = RT_RGBA | RT_ERROR | RT_TRUST},
               inside);
}

TEST_F(Scissor, WorkIsThatOfTheTilesThatItTouches) {
  open(2);
  const Settings s{.samples = 16, .width = 160, .height = 160, .tile = 16};
  render(s, {0, 0, 0, 0});
  const uint64_t all = raysOf();
  ASSERT_EQ(all, uint64_t(160 * 160 * 16));
  render(s, {16, 32, 16, 16});
  EXPECT_EQ(raysOf(), all / 100);
  render(s, {15, 32, 16, 16});
  EXPECT_EQ(raysOf(), all / 50);
}

TEST_F(Scissor, OneOutsideGivesNoSamples) {
  open(2);
  const Settings s{.samples = 4, .channels = RT_RGBA | RT_SAMPLES};
  for (const Rectangle& r : {Rectangle{70, 0, 5, 5}, {0, 50, 5, 5}, {65535, 65535, 65536, 65536}}) {
    const Channels none = render(s, r);
    for (const float n : none.at(RT_SAMPLES)) ASSERT_EQ(n, 0);
    EXPECT_EQ(raysOf(), 0u);
  }
  const Channels whole = render(s, {0, 0, 0, 0});
  for (const float n : whole.at(RT_SAMPLES)) ASSERT_EQ(n, 4);
}

TEST_F(Scissor, ImpossibleOnesAreRefused) {
  open(1);
  const Rectangle wrong[] = {{-1, 0, 5, 5}, {0, -1, 5, 5},    {0, 0, 5, 0},    {0, 0, 0, 5},
                             {0, 0, -5, 5}, {65536, 0, 5, 5}, {0, 0, 65537, 5}};
  for (const Rectangle& r : wrong) {
    rtScissor(r.x, r.y, r.width, r.height);
    EXPECT_EQ(rtGetError(), RTenum(RT_INVALID_VALUE)) << r.x << "," << r.y;
  }
}

} // namespace
} // namespace numeric

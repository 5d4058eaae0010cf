// progressive.cpp: RT_PROGRESSIVE shows the whole picture early and ends with the same bytes as the
// frame rendered in one go. Tested for several numbers of threads, samples and channels, with
// pilots, replicates and paths from lamps.
#include <algorithm>
#include <map>

#include "drawing.h"
#include "numeric/support.h"

namespace numeric {
namespace {

using namespace drawing;
using Channels = std::map<uint32_t, std::vector<float>>;

struct Settings {
  int samples = 16, transport = RT_TRANSPORT_PATH, width = 50, height = 40;
  double targetError = 0;
  int replicates = 0;
  uint32_t channels = RT_RGBA;
};

class Progressive : public testing::Test {
 protected:
  void open(int threads) {
    if (context_) rtDeleteContext(context_);
    context_ = contextWith(threads);
    ASSERT_NE(context_, nullptr) << (rtGetError(), rtGetErrorMessage());
    scene();
  }
  void TearDown() override {
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
    rtDeleteContext(context_);
  }

  static void scene() {
    drawRoom();
    Shader lamp("VRML97DirectionalLight");
    lamp.set("direction", {-.3, -1, -.4}).set("intensity", {.5});
    rtUseLight(lamp);
  }

  static void set(const Settings& s, bool progressive) {
    rtFrameBuffer(s.width, s.height, s.channels);
    rtQuality(RT_SAMPLES_PER_PIXEL, s.samples);
    rtQuality(RT_TRANSPORT, s.transport);
    rtQuality(RT_REPLICATES, s.replicates);
    rtQualityf(RT_TARGET_ERROR, s.targetError);
    rtQuality(RT_PROGRESSIVE, progressive);
    rtQuality(RT_MAX_DEPTH, 6);
  }
  static Channels read(const Settings& s) {
    Channels out;
    for (uint32_t channel = 1; channel <= s.channels; channel <<= 1)
      if (s.channels & channel) out[channel] = readChannel(channel, s.width, s.height);
    return out;
  }
  static Channels render(const Settings& s, bool progressive) {
    set(s, progressive);
    rtRender();
    return read(s);
  }

  void expectSameBytes(const Settings& s) {
    open(2);
    const Channels expected = render(s, false);
    for (const int threads : {1, 2, 5}) {
      open(threads);
      const Channels got = render(s, true);
      for (const auto& [channel, plane] : expected)
        EXPECT_TRUE(
            std::equal(plane.begin(), plane.end(), got.at(channel).begin(),
                       [](float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }))
            << "channel " << channel << ", " << threads << " threads";
    }
  }

  RTcontext context_ = nullptr;
};

TEST_F(Progressive, EndsWithTheBytesOfOneGo) {
  for (const int samples : {1, 7, 31, 32, 33, 45, 64}) expectSameBytes({.samples = samples});
}

TEST_F(Progressive, AllChannelsHaveTheBytesOfOneGo) {
  expectSameBytes(
      {.samples = 37, .channels = everyChannel & ~uint32_t(RT_ERROR | RT_TRUST | RT_VARIANCE)});
  expectSameBytes({.samples = 37, .channels = RT_RGBA | RT_VARIANCE});
  expectSameBytes({.samples = 72, .width = 33, .height = 20, .channels = everyChannel});
}

TEST_F(Progressive, RaysThatSplitHaveTheBytesOfOneGo) {
  expectSameBytes(
      {.samples = 36, .transport = RT_TRANSPORT_WHITTED, .channels = RT_RGBA | RT_NAME});
}

TEST_F(Progressive, ReplicatesHaveTheBytesOfOneGo) {
  expectSameBytes(
      {.samples = 40, .width = 20, .height = 20, .replicates = 8, .channels = everyChannel});
}

TEST_F(Progressive, ATargetErrorHasTheBytesOfOneGo) {
  expectSameBytes(
      {.samples = 256, .width = 34, .height = 20, .targetError = .1, .channels = everyChannel});
  expectSameBytes(
      {.samples = 32, .width = 34, .height = 20, .targetError = .1, .channels = everyChannel});
}

TEST_F(Progressive, PathsFromLampsHaveTheBytesOfOneGo) {
  expectSameBytes({.samples = 34, .transport = RT_TRANSPORT_LIGHT, .width = 34, .height = 20});
  expectSameBytes({.samples = 128,
                   .transport = RT_TRANSPORT_LIGHT,
                   .width = 20,
                   .height = 18,
                   .targetError = .2,
                   .channels = everyChannel});
}

// Snapshots of a frame that would take minutes show the whole picture, with more and more samples.
TEST_F(Progressive, TheWholePictureIsSeenEarly) {
  for (const int transport : {RT_TRANSPORT_PATH, RT_TRANSPORT_LIGHT}) {
    open(2);
    const Settings s{.samples = 65536,
                     .transport = transport,
                     .width = 200,
                     .height = 150,
                     .channels = RT_RGBA | RT_SAMPLES};
    set(s, true);
    rtSwapBuffers();
    std::vector<float> samples(size_t(s.width) * size_t(s.height)), rgba(4 * samples.size());
    float least = 0;
    while (least < 4) { // never ends if the picture is rendered tile by tile
      ASSERT_EQ(rtSnapshot(context_, RT_SAMPLES, samples.data(), samples.size()), 1);
      const auto [low, high] = std::minmax_element(samples.begin(), samples.end());
      EXPECT_GE(*low, least);
      // One complete round, and the next one in progress.
      EXPECT_LE(*high, std::max(4 * *low, 2.0f));
      least = *low;
    }
    EXPECT_EQ(rtSnapshot(context_, RT_RGBA, rgba.data(), rgba.size()), 1);
    EXPECT_GT(rtProgress(context_), 0);
    rtCancel(context_);
    rtFrameBuffer(1, 1, RT_RGBA);
    rtQuality(RT_SAMPLES_PER_PIXEL, 1);
    rtSwapBuffers(); // the frame above is complete now
    rtReadPixels(RT_SAMPLES, samples.data(), samples.size());
    EXPECT_GE(*std::min_element(samples.begin(), samples.end()),
              least); // samples already shown are not lost
    rtReadPixels(RT_RGBA, rgba.data(), rgba.size());
    for (size_t i = 0; i < rgba.size(); i++) ASSERT_TRUE(std::isfinite(rgba[i]));
  }
}

// With one sample a picture is rendered in one go. The next frames are progressive again.
TEST_F(Progressive, MayBeSwitchedBetweenFrames) {
  open(2);
  const Settings s{.samples = 33}, one{.samples = 1};
  const Channels a = render(s, true), b = render(one, true), c = render(s, false),
                 d = render(one, false);
  EXPECT_EQ(a, c);
  EXPECT_EQ(b, d);
}

} // namespace
} // namespace numeric

// openrt_api_async.cpp: frames in flight on the rendering backend: cancelling in each phase and
// from another thread, progress, snapshots, and edits that affect only the next frame.
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "openrt/openrt.h"

namespace {

using namespace std::chrono_literals;

class Async : public testing::Test {
 protected:
  static constexpr int width = 64, height = 48;
  void SetUp() override {
    context = rtNewContext("threads=2");
    ASSERT_NE(context, nullptr) << (rtGetError(), rtGetErrorMessage());
    shader = rtNewShader(rtNewShaderClass("VRML97", nullptr));
    rtBindShader(shader);
    emissive = rtParameterHandle("emissiveColor");
    rtParameter3f(emissive, 0.5f, 0, 0);
    object = rtBeginObject(0);
    rtBegin(RT_QUADS);
    rtVertex3f(-9, -9, 0);
    rtVertex3f(9, -9, 0);
    rtVertex3f(9, 9, 0);
    rtVertex3f(-9, 9, 0);
    rtEnd();
    rtEndObject();
    instance = rtInstantiateObject(object);
    rtTranslated(0, 0, 5);
    rtOrtho(2);
    rtLoadIdentity();
    rtFrameBuffer(width, height, RT_RGBA | RT_DEPTH | RT_SAMPLES);
    rtQuality(RT_SAMPLES_PER_PIXEL, 1);
  }
  void TearDown() override {
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
    rtDeleteContext(context);
  }
  // Sets up more work than a test can wait for; the frame must be cancelled.
  void endless() {
    rtQuality(RT_SAMPLES_PER_PIXEL, 65536);
    rtFrameBuffer(2048, 2048, RT_RGBA | RT_DEPTH | RT_SAMPLES);
  }
  std::vector<float> red() {
    std::vector<float> rgba(size_t(4) * width * height), result;
    rtReadPixels(RT_RGBA, rgba.data(), rgba.size());
    for (size_t i = 0; i < rgba.size(); i += 4) result.push_back(rgba[i]);
    return result;
  }
  RTcontext context = nullptr;
  RTid shader = 0, object = 0, instance = 0;
  int emissive = -1;
};

TEST_F(Async, SwapBuffersIsOneFrameLate) {
  rtSwapBuffers();
  float pixel[4];
  rtReadPixels(RT_RGBA, pixel, 4);
  // The first frame is in flight and none is finished.
  EXPECT_EQ(rtGetError(), RTenum(RT_INVALID_OPERATION));
  rtParameter3f(emissive, 0.25f, 0, 0);
  rtSwapBuffers();
  for (float r : red()) ASSERT_EQ(r, 0.5f);
  rtSwapBuffers();
  for (float r : red()) ASSERT_EQ(r, 0.25f);
}

TEST_F(Async, EditsInFlightReachTheNextFrameAlone) {
  rtQuality(RT_SAMPLES_PER_PIXEL, 64);
  rtSwapBuffers();
  // Changes parameters, matrices, geometry and deletes objects, all while the frame renders.
  rtParameter3f(emissive, 1, 0, 0);
  const double away[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 100, 0, 0, 1};
  rtInstanceMatrix(instance, away);
  rtBeginObject(object);
  rtSphere(0.5f);
  rtEndObject();
  rtDeleteObject(object);
  rtFrameBuffer(8, 8, RT_RGBA);
  rtQuality(RT_SAMPLES_PER_PIXEL, 1);
  rtSwapBuffers();
  for (float r : red()) ASSERT_NEAR(r, 0.5f, 1e-6f); // the size, too, is that of the previous frame
  rtSwapBuffers();
  std::vector<float> rgba(4 * 8 * 8, 5.0f);
  rtReadPixels(RT_RGBA, rgba.data(), rgba.size());
  for (size_t i = 0; i < rgba.size(); i++) ASSERT_EQ(rgba[i], 0.0f);
}

TEST_F(Async, CancelWithoutAFrameDoesNothing) {
  rtCancel(context); // before the first commit
  EXPECT_EQ(rtProgress(context), 1.0f);
  rtRender();
  rtCancel(context); // after the frame
  for (float r : red()) ASSERT_EQ(r, 0.5f);
  rtSwapBuffers();
  rtSwapBuffers(); // a cancellation before a frame does not affect it
  for (float r : red()) ASSERT_EQ(r, 0.5f);
}

TEST_F(Async, CancelInFlightEndsIt) {
  endless();
  rtSwapBuffers();
  EXPECT_LT(rtProgress(context), 1.0f);
  rtCancel(context);
  rtCancel(context); // cancelling twice is like once
  rtFrameBuffer(width, height, RT_RGBA);
  rtQuality(RT_SAMPLES_PER_PIXEL, 1);
  rtSwapBuffers(); // returns soon: the endless frame ends with its finished tiles
  std::vector<float> samples(size_t(2048) * 2048);
  rtReadPixels(RT_SAMPLES, samples.data(), samples.size());
  size_t none = 0;
  for (float s : samples) none += s == 0;
  EXPECT_GT(none, samples.size() / 2);
  rtSwapBuffers();
  for (float r : red()) ASSERT_EQ(r, 0.5f);
}

TEST_F(Async, CancelFromAnotherThreadEndsRtRender) {
  endless();
  std::atomic<bool> done{false};
  std::thread other([&] {
    while (!done) { // also before the frame has begun
      rtCancel(context);
      const float p = rtProgress(context);
      EXPECT_TRUE(p >= 0 && p <= 1);
      std::this_thread::sleep_for(1ms);
    }
  });
  rtRender();
  done = true;
  other.join();
  std::vector<float> samples(size_t(2048) * 2048);
  rtReadPixels(RT_SAMPLES, samples.data(), samples.size());
  EXPECT_EQ(samples.back(), 0.0f);
}

TEST_F(Async, ASnapshotHoldsWhatIsFinished) {
  std::vector<float> rgba(size_t(4) * 512 * 512, 9.0f), depth(size_t(512) * 512, 9.0f);
  EXPECT_EQ(rtSnapshot(context, RT_RGBA, rgba.data(), rgba.size()), 0); // nothing in flight
  rtFrameBuffer(512, 512, RT_RGBA | RT_DEPTH);
  rtQuality(RT_SAMPLES_PER_PIXEL, 4096);
  rtSwapBuffers();
  for (int i = 0; i < 5000 && rtProgress(context) == 0; i++) std::this_thread::sleep_for(1ms);
  EXPECT_GT(rtProgress(context), 0.0f);
  EXPECT_EQ(rtSnapshot(context, RT_RGBA, rgba.data(), rgba.size()), 1);
  EXPECT_EQ(rtSnapshot(context, RT_DEPTH, depth.data(), depth.size()), 1);
  // The frame has no such channel.
  EXPECT_EQ(rtSnapshot(context, RT_NORMAL, depth.data(), depth.size()), 0);
  // The buffer is too small.
  EXPECT_EQ(rtSnapshot(context, RT_RGBA, rgba.data(), rgba.size() - 1), 0);
  size_t finished = 0;
  for (size_t i = 0; i < depth.size(); i++) {
    ASSERT_TRUE(std::isinf(depth[i]) || std::fabs(depth[i] - 5) < 1e-4f) << depth[i];
    ASSERT_TRUE(rgba[4 * i] == 0 || std::fabs(rgba[4 * i] - 0.5f) < 1e-5f);
    finished += rgba[4 * i] != 0;
  }
  EXPECT_GT(finished, 0u);
  rtCancel(context);
  // The frame in flight now is endless, too; deleting the context cancels it.
  rtSwapBuffers();
}

TEST_F(Async, DeletingTheContextEndsItsFrame) {
  endless();
  rtSwapBuffers();
  rtDeleteContext(context);
  EXPECT_EQ(rtGetCurrent(), nullptr);
  rtCancel(context);
  EXPECT_EQ(rtGetError(), RTenum(RT_INVALID_VALUE)); // the handle is no longer valid
  EXPECT_EQ(rtProgress(context), 0.0f);
  EXPECT_EQ(rtGetError(), RTenum(RT_INVALID_VALUE));
  context = nullptr;
}

TEST_F(Async, QueriesAndStatisticsWhileAFrameIsInFlight) {
  rtQuality(RT_SAMPLES_PER_PIXEL, 64);
  rtSwapBuffers();
  const RTray ray{{0, 0, 5}, 0, {0, 0, -1}, INFINITY};
  RThit hit{};
  rtCastRays(1, &ray, &hit);
  EXPECT_NEAR(hit.t, 5, 1e-5f);
  EXPECT_EQ(rtPick(width / 2, height / 2, &hit), 1);
  EXPECT_EQ(hit.instance, instance);
  rtDeleteInstance(instance);
  rtCastRays(1, &ray, &hit); // queries use the last committed scene
  EXPECT_NEAR(hit.t, 5, 1e-5f);
  RTstats stats{};
  stats.size = sizeof stats;
  rtGetStats(&stats);
  EXPECT_EQ(stats.scene.triangles, 2u);
  rtSwapBuffers();
  for (float r : red()) ASSERT_NEAR(r, 0.5f, 1e-6f);
}

TEST_F(Async, RtRenderGivesUpTheFrameInFlight) {
  endless();
  rtSwapBuffers();
  rtFrameBuffer(width, height, RT_RGBA);
  rtQuality(RT_SAMPLES_PER_PIXEL, 1);
  rtParameter3f(emissive, 0.75f, 0, 0);
  rtRender();
  for (float r : red()) ASSERT_EQ(r, 0.75f);
  EXPECT_EQ(rtProgress(context), 1.0f);
}

} // namespace

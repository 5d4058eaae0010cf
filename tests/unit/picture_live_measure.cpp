// picture_live_measure.cpp: sensors are read between live frames, as Renderer::measure reads them,
// and leave the frames as they are.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "libpicture/live.h"
#include "libpicture/measure.h"

using namespace picture;
using State = LiveRenderer::State;

namespace {

// A light of VRML97 above sensors, and a ball below them that they do not see. A sensor reads pi
// times the radiance that the light gives to a white surface: its cosine.
constexpr const char* lampAbove = R"(#VRML V2.0 utf8
Viewpoint { position 0 -3 6 }
DEF Lamp PointLight { location 0 2 0 attenuation 1 0 0 ambientIntensity 0 }
Transform { translation 0 -3 0 children Shape {
  appearance Appearance { material Material { } } geometry Sphere { } } }
DEF Below ORTSensor { size 2 2 columns 2 rows 2 }
DEF Beside ORTSensor { position 1 0 0 }
)";

std::unique_ptr<xvrml::Browser> browserOf(const char* text = lampAbove) {
  return std::make_unique<xvrml::Browser>(xvrml::loadWorldFromMemory(text, "lamp.wrl"));
}

RenderSettings settings() {
  RenderSettings settings;
  settings.threads = 2;
  return settings;
}

LiveFrame frameOf(int samples = 4) {
  LiveFrame frame;
  frame.width = 32;
  frame.height = 24;
  frame.samples = samples;
  return frame;
}

void waitFor(LiveRenderer& live) {
  while (live.state() != State::idle) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

LiveReadings read(LiveRenderer& live, const LiveMeasure& measure) {
  live.measure(measure);
  waitFor(live);
  std::optional<LiveReadings> readings = live.takeReadings();
  EXPECT_TRUE(readings);
  EXPECT_FALSE(live.takeReadings()) << "they are given once";
  return readings ? *readings : LiveReadings{};
}

LivePicture finish(LiveRenderer& live, const LiveFrame& frame) {
  live.start(frame);
  waitFor(live);
  LivePicture picture;
  EXPECT_TRUE(live.look(picture) && picture.finished);
  return picture;
}

} // namespace

TEST(LiveMeasure, readsWhatTheRendererReads) {
  const auto browser = browserOf();
  RenderSettings still = settings();
  still.samples = 64;
  const std::vector<Measurement> wanted = Renderer(*browser, still).measure({});
  ASSERT_EQ(wanted.size(), 2);
  LiveRenderer live(*browser, settings());
  const LiveReadings made = read(live, {.samples = 64});
  EXPECT_EQ(made.failure, "");
  ASSERT_EQ(made.sensors.size(), 2);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(made.sensors[i].sensor.name, wanted[i].sensor.name);
    EXPECT_EQ(made.sensors[i].value, wanted[i].value);
    EXPECT_EQ(made.sensors[i].halfWidth, wanted[i].halfWidth);
  }
}

TEST(LiveMeasure, aSensorAtASurfaceReadsTheSideThatIsSeen) {
  const auto browser = browserOf();
  LiveRenderer live(*browser, settings());
  const double point[3] = {1, 0, 0}, up[3] = {0, 1, 0}, down[3] = {0, -1, 0};
  const double expected = M_PI * 2 / std::hypot(1.0, 2.0);
  EXPECT_NEAR(double(read(live, {.samples = 16}).sensors.at(1).value[0]), expected, 1e-4);
  for (const double* normal : {up, down}) {
    const LiveReadings top =
        read(live, {.sensors = {sensorAt(point, normal, down)}, .samples = 16});
    EXPECT_NEAR(double(top.sensors.at(0).value[0]), expected, 1e-4);
    const LiveReadings under =
        read(live, {.sensors = {sensorAt(point, normal, up)}, .samples = 16});
    EXPECT_LT(double(under.sensors.at(0).value[0]), .15 * expected) << "what the ball reflects";
  }
}

TEST(LiveMeasure, framesBeforeAndAfterItAreTheSame) {
  const auto browser = browserOf();
  LiveRenderer live(*browser, settings());
  const LivePicture before = finish(live, frameOf());
  read(live, {.samples = 16});
  LivePicture rest;
  EXPECT_FALSE(live.look(rest)) << "it is no frame";
  Picture copied;
  uint64_t number = 0;
  EXPECT_TRUE(live.copy(copied, &number));
  EXPECT_EQ(number, before.number);
  EXPECT_EQ(copied.width, 32);
  EXPECT_TRUE(live.recolour(before.number, 1.0));
  EXPECT_TRUE(live.look(rest));
  EXPECT_EQ(finish(live, frameOf()).rgb, before.rgb) << "the headlight is on again";
}

TEST(LiveMeasure, followsTheWorld) {
  const auto browser = browserOf();
  LiveRenderer live(*browser, settings());
  const auto below = [&] { return double(read(live, {.samples = 4}).sensors.at(0).value[0]); };
  const double first = below();
  EXPECT_GT(first, 1);
  browser->set(*browser->node("Lamp"), "intensity", xvrml::Value(.5f));
  browser->tick(1);
  EXPECT_NEAR(below(), first / 2, 1e-5);
}

TEST(LiveMeasure, isRefusedBesideAFrameAndCanBeCancelled) {
  const auto browser = browserOf();
  LiveRenderer live(*browser, settings());
  LiveFrame slow = frameOf(65536);
  slow.width = slow.height = 256;
  live.start(slow);
  EXPECT_THROW(live.measure({}), std::logic_error);
  live.cancel();
  waitFor(live);
  LivePicture rest;
  while (live.look(rest)) {}
  live.measure({.samples = 1 << 20});
  EXPECT_THROW(live.start(frameOf()), std::logic_error);
  live.cancel();
  waitFor(live);
  const std::optional<LiveReadings> readings = live.takeReadings();
  ASSERT_TRUE(readings);
  EXPECT_EQ(readings->failure, "the measurement was cancelled");
  EXPECT_EQ(read(live, {.samples = 4}).sensors.size(), 2);
}

TEST(LiveMeasure, aSensorWithWrongFieldsIsNamed) {
  const auto browser = browserOf("#VRML V2.0 utf8\nDEF Flat ORTSensor { direction 0 0 0 }");
  LiveRenderer live(*browser, settings());
  EXPECT_EQ(read(live, {}).failure, "ORTSensor Flat: direction has no length");
  finish(live, frameOf());
}

TEST(LiveMeasure, canBeGivenUpInFlight) {
  const auto browser = browserOf();
  LiveRenderer live(*browser, settings());
  live.measure({.samples = 1 << 20});
}

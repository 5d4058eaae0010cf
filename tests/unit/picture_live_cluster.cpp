// picture_live_cluster.cpp: live pictures with overlapping frames. Each frame has its own bytes,
// size and time; the last one completes by itself; both frames in flight are cancelled together.
// The cluster consists of this process alone, because nobody answers at its workers' address.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <thread>
#include <vector>

#include <malloc.h>

#include "libpicture/cluster.h"
#include "libpicture/live.h"

using namespace picture;
using State = LiveRenderer::State;

namespace {

constexpr const char* world = R"(#VRML V2.0 utf8
NavigationInfo { headlight FALSE }
Viewpoint { position 0 0 6 }
DirectionalLight { direction -1 -1 -2 }
Background { skyColor 0.2 0.3 0.4 }
DEF Place Transform { children
  Shape { appearance Appearance { material Material { diffuseColor 0.9 0.2 0.1 } } geometry Box { } } }
)";

std::unique_ptr<xvrml::Browser> browserOf() {
  return std::make_unique<xvrml::Browser>(xvrml::loadWorldFromMemory(world, "live_cluster.wrl"));
}

void moveTo(xvrml::Browser& browser, double x) {
  browser.set(*browser.node("Place"), "translation", xvrml::Value(xvrml::Vec3f{float(x), 0, 0}));
  browser.tick(browser.now() + .01);
}

RenderSettings alone() {
  RenderSettings settings;
  settings.threads = 2;
  settings.channels = RT_RGBA | RT_DEPTH | RT_NAME;
  return settings;
}

RenderSettings clustered() {
  RenderSettings settings = alone();
  ClusterSettings cluster;
  cluster.workers = "127.0.0.1:1";
  settings.cluster = std::make_shared<Cluster>(cluster, settings);
  return settings;
}

LiveFrame frameOf(int width = 64, int height = 48, int samples = 4) {
  LiveFrame frame;
  frame.width = width;
  frame.height = height;
  frame.samples = samples;
  return frame;
}

// Returns a frame that runs until it is cancelled.
LiveFrame longFrame(int width = 512) { return frameOf(width, 384, 65536); }

void nap() { std::this_thread::sleep_for(std::chrono::microseconds(200)); }

void waitFor(LiveRenderer& live, State state) {
  while (live.state() != state) nap();
}

LivePicture ended(LiveRenderer& live) {
  LivePicture picture;
  EXPECT_TRUE(live.look(picture));
  EXPECT_TRUE(picture.ended);
  EXPECT_EQ(live.takeFailure(), "");
  return picture;
}

LivePicture finish(LiveRenderer& live, const LiveFrame& frame) {
  live.start(frame);
  waitFor(live, State::idle);
  return ended(live);
}

Picture still(xvrml::Browser& browser, const LiveFrame& frame) {
  RenderSettings settings = alone();
  settings.width = frame.width;
  settings.height = frame.height;
  settings.samples = frame.samples;
  return Renderer(browser, settings).render(frame.view).picture;
}

// Starts two frames, so that both are in flight.
void startTwo(LiveRenderer& live, const LiveFrame& first, const LiveFrame& second) {
  live.start(first);
  waitFor(live, State::ready);
  live.start(second);
  while (live.state() == State::mapping) nap();
}

size_t countOf(const char* folder) {
  return size_t(std::distance(std::filesystem::directory_iterator(folder),
                              std::filesystem::directory_iterator()));
}

} // namespace

// Each frame has another camera position, size and number of samples; nothing of one shows in
// another.
TEST(LiveCluster, framesThatOverlapComeInTheirOrderAndAreTheStillOnes) {
  constexpr int frames = 12;
  const auto frame = [](int i) {
    return frameOf(64 + 9 * (i % 4), 48 + 5 * (i % 3), 40 + 13 * (i % 3));
  };
  const auto browser = browserOf();
  LiveRenderer live(*browser, clustered());
  std::vector<LivePicture> pictures;
  int started = 0, overlapping = 0;
  while (pictures.size() < frames) {
    LivePicture picture;
    while (live.look(picture)) {
      ASSERT_EQ(picture.rgb.size(), size_t(3 * picture.width * picture.height));
      if (picture.ended) pictures.push_back(std::move(picture));
    }
    const State state = live.state();
    if (started == frames || (state != State::idle && state != State::ready)) {
      nap();
      continue;
    }
    overlapping += state == State::ready;
    moveTo(*browser, .3 * started);
    live.start(frame(started++));
  }
  EXPECT_EQ(live.state(), State::idle);
  EXPECT_EQ(live.takeFailure(), "");
  EXPECT_GT(overlapping, frames / 2);
  int together = 0;
  for (int i = 0; i < frames; ++i) {
    SCOPED_TRACE(i);
    const auto other = browserOf();
    moveTo(*other, .3 * i);
    const LivePicture& made = pictures[size_t(i)];
    ASSERT_EQ(made.width, frame(i).width);
    EXPECT_TRUE(made.finished);
    EXPECT_EQ(made.samples, frame(i).samples);
    EXPECT_EQ(made.rgb, displayBytes(still(*other, frame(i))));
    EXPECT_EQ(made.stats.rays.camera,
              uint64_t(made.width) * uint64_t(made.height) * uint64_t(frame(i).samples));
    EXPECT_GT(made.seconds, 0);
    EXPECT_LE(made.alone, made.seconds);
    together += made.alone < made.seconds;
  }
  EXPECT_GT(together, frames / 2);
  Picture last;
  ASSERT_TRUE(live.copy(last));
  const auto other = browserOf();
  moveTo(*other, .3 * (frames - 1));
  const Picture expected = still(*other, frame(frames - 1));
  EXPECT_EQ(last.planes, expected.planes);
  EXPECT_EQ(last.names, expected.names);
}

TEST(LiveCluster, oneAfterTheOtherIsAloneAllTheTime) {
  const auto browser = browserOf(), other = browserOf();
  LiveRenderer live(*browser, clustered());
  for (int i = 0; i < 3; ++i) {
    const LivePicture picture = finish(live, frameOf());
    EXPECT_EQ(picture.alone, picture.seconds);
    EXPECT_EQ(picture.rgb, displayBytes(still(*other, frameOf())));
  }
}

// A single frame in flight can be watched, even if another one could follow.
TEST(LiveCluster, theFrameInFlightIsSeen) {
  const auto browser = browserOf();
  LiveRenderer live(*browser, clustered());
  live.start(longFrame());
  LivePicture picture;
  // Never ends if the picture does not come early.
  while (!live.look(picture) || picture.covered < 1) nap();
  EXPECT_EQ(live.state(), State::ready);
  EXPECT_FALSE(picture.ended);
  Picture all;
  ASSERT_TRUE(live.copy(all));
  EXPECT_EQ(all.width, 512);
}

TEST(LiveCluster, noMoreThanTwoAreInFlight) {
  const auto browser = browserOf();
  LiveRenderer live(*browser, clustered());
  startTwo(live, longFrame(), longFrame(400));
  EXPECT_EQ(live.state(), State::rendering);
  EXPECT_THROW(live.start(frameOf()), std::logic_error);
  LivePicture picture;
  for (int i = 0; i < 20; ++i, nap())
    // With two frames in flight it is not known which one it would be.
    EXPECT_FALSE(live.look(picture));
}

// The older frame is cancelled together with the newer. Its finished part is delivered. Neither
// frame stays in flight.
TEST(LiveCluster, cancellingEndsBothAndWhatIsFinishedStays) {
  const auto browser = browserOf(), other = browserOf();
  LiveRenderer live(*browser, clustered());
  live.start(longFrame(500));
  LivePicture picture;
  while (!live.look(picture) || picture.covered < 1) nap();
  live.start(longFrame(400));
  while (live.state() == State::mapping) nap();
  live.cancel();
  EXPECT_NE(live.state(), State::ready);
  waitFor(live, State::idle);
  const LivePicture older = ended(live), newer = ended(live);
  EXPECT_EQ(older.width, 500);
  EXPECT_FALSE(older.finished);
  EXPECT_EQ(older.covered, 1);
  EXPECT_EQ(newer.width, 400);
  EXPECT_FALSE(newer.finished);
  for (size_t i = 0; i < newer.rgb.size(); i += 3)
    ASSERT_GT(newer.rgb[i + 2], 0) << i; // every pixel of this scene has some blue
  EXPECT_FALSE(live.look(picture));
  EXPECT_EQ(finish(live, frameOf()).rgb, displayBytes(still(*other, frameOf())));
}

// Cancels at any time: while the world is read, while the frame is begun, and after.
TEST(LiveCluster, cancelledAtAnyTimeLeavesTheNextFrameWhole) {
  const auto browser = browserOf(), other = browserOf();
  LiveRenderer live(*browser, clustered());
  for (int i = 0; i < 40; ++i) {
    live.start(longFrame());
    if (i % 2) {
      waitFor(live, State::ready);
      live.start(longFrame(400));
    }
    std::this_thread::sleep_for(std::chrono::microseconds(50 * (i / 2)));
    live.cancel();
    waitFor(live, State::idle); // never ends if one frame is not reached
  }
  LivePicture picture;
  while (live.look(picture)) EXPECT_FALSE(picture.finished);
  EXPECT_EQ(finish(live, frameOf()).rgb, displayBytes(still(*other, frameOf())));
}

TEST(LiveCluster, canBeGivenUpInFlight) {
  const auto browser = browserOf();
  const RenderSettings settings = clustered();
  for (int i = 0; i < 6; ++i) {
    LiveRenderer live(*browser, settings);
    if (i % 3 == 0)
      live.start(longFrame());
    else
      startTwo(live, longFrame(), longFrame());
  }
  const auto other = browserOf();
  LiveRenderer live(*browser, settings); // the cluster is free again
  EXPECT_EQ(finish(live, frameOf()).rgb, displayBytes(still(*other, frameOf())));
}

TEST(LiveCluster, aFailureBehindAFrameInFlightIsToldAndOver) {
  const auto browser = browserOf(), other = browserOf();
  LiveRenderer live(*browser, clustered());
  live.start(longFrame());
  waitFor(live, State::ready);
  live.change([](RenderSettings& s) { s.environment = "there-is-no-such-picture.hdr"; });
  live.start(frameOf());
  waitFor(live, State::idle);
  EXPECT_NE(live.takeFailure().find("there-is-no-such-picture.hdr"), std::string::npos);
  live.change([](RenderSettings& s) { s.environment.clear(); });
  EXPECT_EQ(finish(live, frameOf()).rgb, displayBytes(still(*other, frameOf())));
}

TEST(LiveCluster, framesLeaveNothingBehind) {
  const auto browser = browserOf();
  LiveRenderer live(*browser, clustered());
  const auto look = [&](int frames) {
    LivePicture picture;
    for (int i = 0; i < frames; ++i) {
      while (live.state() != State::idle && live.state() != State::ready) nap();
      moveTo(*browser, .1 * (i % 7));
      live.start(frameOf(16, 12, 1 + i % 3));
      if (i % 4 == 0) live.cancel();
      live.look(picture);
    }
    waitFor(live, State::idle);
    while (live.look(picture)) {}
  };
  look(300);
  constexpr int frames = 300;
  // A leak grows in every round. A message or connection in progress at the end of a round does
  // not.
  bool grows = true;
  for (int round = 0; round < 3 && grows; ++round) {
    const size_t threads = countOf("/proc/self/task"), files = countOf("/proc/self/fd"),
                 bytes = mallinfo2().uordblks;
    look(frames);
    // The unreachable address is tried again and again, so a few files may be open.
    grows = countOf("/proc/self/task") > threads || mallinfo2().uordblks > bytes + 200u * frames ||
            countOf("/proc/self/fd") > files + 2;
  }
  EXPECT_FALSE(grows);
}

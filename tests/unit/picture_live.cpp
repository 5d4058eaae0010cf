// picture_live.cpp: live pictures equal those of Renderer, arrive without waiting, can be
// cancelled, and do not block the world during rendering.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include "libpicture/live.h"

using namespace picture;
using State = LiveRenderer::State;

namespace {

constexpr const char* twoShapes = R"(#VRML V2.0 utf8
NavigationInfo { headlight FALSE }
DEF Eye Viewpoint { position 0 0 6 }
DirectionalLight { direction -1 -1 -2 }
Background { skyColor 0.2 0.3 0.4 }
Shape { appearance Appearance { material DEF Paint Material { diffuseColor 0.9 0.2 0.1 } } geometry Sphere { } }
DEF Place Transform { translation 2 0 0 children Shape { appearance Appearance { material Material { } } geometry Box { } } }
)";

std::unique_ptr<xvrml::Browser> browserOf(const char* text = twoShapes) {
  return std::make_unique<xvrml::Browser>(xvrml::loadWorldFromMemory(text, "live.wrl"));
}

RenderSettings settingsOf(uint32_t channels = RT_RGBA) {
  RenderSettings settings;
  settings.threads = 2;
  settings.channels = channels;
  return settings;
}

LiveFrame frameOf(int width = 64, int height = 48, int samples = 4) {
  LiveFrame frame;
  frame.width = width;
  frame.height = height;
  frame.samples = samples;
  return frame;
}

void nap() { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }

void waitFor(LiveRenderer& live) {
  while (live.state() != State::idle) nap();
}

LivePicture finish(LiveRenderer& live, const LiveFrame& frame) {
  live.start(frame);
  waitFor(live);
  EXPECT_EQ(live.takeFailure(), "");
  LivePicture picture;
  EXPECT_TRUE(live.look(picture));
  EXPECT_TRUE(picture.finished);
  EXPECT_EQ(picture.covered, 1);
  return picture;
}

RenderResult still(xvrml::Browser& browser, RenderSettings settings, const LiveFrame& frame) {
  settings.width = frame.width;
  settings.height = frame.height;
  settings.samples = frame.samples;
  return Renderer(browser, settings).render(frame.view);
}

// A frame that runs until it is cancelled.
LiveFrame longFrame() { return frameOf(512, 384, 65536); }

uint8_t redAt(const LivePicture& picture, double x, double y) {
  const size_t pixel =
      size_t(y * picture.height) * size_t(picture.width) + size_t(x * picture.width);
  return picture.rgb.at(3 * pixel);
}

size_t countOf(const char* folder) {
  return size_t(std::distance(std::filesystem::directory_iterator(folder),
                              std::filesystem::directory_iterator()));
}

} // namespace

TEST(Live, finishedPictureHasTheBytesOfTheStillOne) {
  const uint32_t channels = RT_RGBA | RT_DEPTH | RT_NAME | RT_NORMAL;
  for (const int samples : {1, 2, 16, 40}) {
    const LiveFrame frame = frameOf(64, 48, samples);
    const auto world = browserOf(), other = browserOf();
    const RenderResult expected = still(*world, settingsOf(channels), frame);
    LiveRenderer live(*other, settingsOf(channels));
    const LivePicture picture = finish(live, frame);
    EXPECT_EQ(picture.rgb, displayBytes(expected.picture));
    EXPECT_EQ(picture.samples, samples);
    EXPECT_EQ(picture.map.shapes, 2u);
    Picture all;
    ASSERT_TRUE(live.copy(all));
    EXPECT_EQ(all.planes, expected.picture.planes);
    EXPECT_EQ(all.names, expected.picture.names);
  }
}

TEST(Live, aFinishedPictureIsShownInOtherColoursWithoutAnotherFrame) {
  const auto browser = browserOf();
  LiveRenderer live(*browser, settingsOf());
  EXPECT_FALSE(live.recolour(1, 0)) << "there is no picture";
  LiveFrame inFalseColours = frameOf();
  inFalseColours.falseColour = 0;
  const LivePicture expected = finish(live, inFalseColours), own = finish(live, frameOf());
  EXPECT_FALSE(live.recolour(own.number - 1, 0)) << "another frame has been started";
  ASSERT_TRUE(live.recolour(own.number, 0));
  LivePicture shown;
  ASSERT_TRUE(live.look(shown));
  EXPECT_EQ(shown.number, own.number);
  EXPECT_TRUE(shown.finished);
  EXPECT_EQ(shown.rgb, expected.rgb);
  EXPECT_EQ(shown.scaleEnd, expected.scaleEnd);
  EXPECT_FALSE(live.look(shown)) << "once";
  ASSERT_TRUE(live.recolour(own.number, {}));
  ASSERT_TRUE(live.look(shown));
  EXPECT_EQ(shown.rgb, own.rgb);
  EXPECT_EQ(live.state(), State::idle);
}

TEST(Live, nothingIsThereBeforeTheFirstFrame) {
  const auto browser = browserOf();
  LiveRenderer live(*browser, settingsOf());
  LivePicture picture;
  Picture all;
  EXPECT_EQ(live.state(), State::idle);
  EXPECT_FALSE(live.look(picture));
  EXPECT_FALSE(live.copy(all));
  EXPECT_TRUE(live.viewpoints().empty());
  live.cancel();
  EXPECT_EQ(live.takeFailure(), "");
}

TEST(Live, aPictureIsGivenOnce) {
  const auto browser = browserOf();
  LiveRenderer live(*browser, settingsOf());
  finish(live, frameOf());
  LivePicture again;
  EXPECT_FALSE(live.look(again));
  EXPECT_EQ(live.viewpoints().size(), 1u);
}

TEST(Live, theFrameInFlightIsSeenAndEndsEarly) {
  const auto browser = browserOf();
  LiveRenderer live(*browser, settingsOf());
  live.start(longFrame());
  LivePicture picture;
  while (!live.look(picture) || picture.covered < 1)
    nap(); // never ends if the whole picture does not come early
  EXPECT_FALSE(picture.finished);
  EXPECT_LT(picture.samples, 60000);
  EXPECT_EQ(live.state(), State::rendering);
  EXPECT_THROW(live.start(frameOf()), std::logic_error);
  live.cancel();
  waitFor(live);
  LivePicture last;
  if (live.look(last)) {
    EXPECT_FALSE(last.finished);
    EXPECT_TRUE(last.ended);
    EXPECT_GE(last.samples, picture.samples);
  }
  Picture all;
  EXPECT_TRUE(live.copy(all));
  EXPECT_EQ(all.planes.size(), 1u); // only rgba was requested
  finish(live, frameOf());
}

TEST(Live, cancelledAtOnceLeavesTheNextFrameWhole) {
  const auto browser = browserOf(), other = browserOf();
  LiveRenderer live(*browser, settingsOf());
  for (int i = 0; i < 20; ++i) {
    live.start(longFrame());
    live.cancel();
    waitFor(live);
  }
  EXPECT_EQ(finish(live, frameOf()).rgb,
            displayBytes(still(*other, settingsOf(), frameOf()).picture));
}

TEST(Live, canBeGivenUpInFlight) {
  const auto browser = browserOf();
  for (int i = 0; i < 10; ++i) {
    LiveRenderer live(*browser, settingsOf());
    live.start(longFrame());
    if (i % 2) continue;
    while (live.state() == State::mapping) nap();
  }
}

TEST(Live, pixelsWithoutSamplesShowThePictureBefore) {
  const auto browser = browserOf();
  LiveRenderer live(*browser, settingsOf());
  const LivePicture small = finish(live, frameOf(8, 6, 1));
  live.start(frameOf(1600, 1200, 4096));
  LivePicture picture;
  while (!live.look(picture)) nap();
  live.cancel();
  EXPECT_EQ(picture.width, 1600);
  EXPECT_EQ(picture.rgb.size(), size_t(1600 * 1200 * 3));
  for (size_t i = 0; i < picture.rgb.size(); i += 3)
    ASSERT_GT(picture.rgb[i + 2], 0) << i; // every pixel of this scene has some blue
}

// Changes to the world during rendering show in the next picture, not in this one.
TEST(Live, theWorldIsFreeWhileRendering) {
  const auto browser = browserOf();
  LiveRenderer live(*browser, settingsOf());
  live.start(frameOf(64, 48, 256));
  while (live.state() == State::mapping) nap();
  browser->set(*browser->node("Place"), "translation", xvrml::Value(xvrml::Vec3f{-2, 0, 0}));
  browser->tick(1);
  waitFor(live);
  LivePicture before;
  ASSERT_TRUE(live.look(before));
  const LivePicture after = finish(live, frameOf());
  const uint8_t sky = redAt(before, 0.1, 0.5), box = redAt(before, 0.9, 0.5);
  EXPECT_NE(sky, box);
  EXPECT_NEAR(redAt(after, 0.9, 0.5), sky, 2);
  EXPECT_GT(redAt(after, 0.1, 0.5), sky + 20);
}

TEST(Live, anotherCameraMakesNothingAnew) {
  const auto browser = browserOf();
  LiveRenderer live(*browser, settingsOf());
  const LivePicture first = finish(live, frameOf());
  LiveFrame frame = frameOf(32, 24, 1);
  frame.view.viewer = browser->camera(4.0 / 3);
  for (int i = 0; i < 3; ++i) {
    frame.view.viewer->matrix[12] += 0.5;
    const LivePicture next = finish(live, frame);
    EXPECT_EQ(next.map.objectsDefined, first.map.objectsDefined);
    EXPECT_EQ(next.map.instancesMoved, first.map.instancesMoved);
    EXPECT_EQ(next.map.parametersSet, first.map.parametersSet);
    EXPECT_EQ(next.map.regroupings, first.map.regroupings);
    EXPECT_EQ(next.stats.bvh.objectBuilds, first.stats.bvh.objectBuilds);
    EXPECT_EQ(next.stats.bvh.topLevelBuilds, first.stats.bvh.topLevelBuilds);
  }
}

TEST(Live, aGivenViewerIsWhereItIsLookedFrom) {
  const auto browser = browserOf();
  LiveRenderer live(*browser, settingsOf());
  LiveFrame away = frameOf();
  away.view.viewer = browser->camera(4.0 / 3);
  away.view.viewer->matrix[12] = 1000;
  const LivePicture nothing = finish(live, away);
  for (size_t i = 3; i < nothing.rgb.size(); ++i) ASSERT_EQ(nothing.rgb[i], nothing.rgb[i % 3]);
}

// Refines until the target error is reached, with as many samples as that takes.
TEST(Live, aTargetErrorEndsTheRefinement) {
  const auto browser = browserOf(), other = browserOf();
  RenderSettings settings = settingsOf();
  settings.error = 0.05;
  LiveRenderer live(*browser, settings);
  const LiveFrame frame = frameOf(64, 48, 256);
  const LivePicture picture = finish(live, frame);
  EXPECT_LT(picture.samples, 256);
  EXPECT_GE(picture.samples, 32);
  EXPECT_LE(picture.stats.error.mean, 0.05);
  EXPECT_EQ(picture.rgb, displayBytes(still(*other, settings, frame).picture));
}

TEST(Live, failuresAreToldAndOver) {
  const auto browser = browserOf();
  RenderSettings settings = settingsOf();
  settings.environment = "there-is-no-such-picture.hdr";
  LiveRenderer live(*browser, settings);
  live.start(frameOf());
  waitFor(live);
  LivePicture picture;
  EXPECT_FALSE(live.look(picture));
  EXPECT_NE(live.takeFailure().find("there-is-no-such-picture.hdr"), std::string::npos);
  EXPECT_EQ(live.takeFailure(), "");
  live.change([](RenderSettings& s) { s.environment.clear(); });
  finish(live, frameOf());
}

TEST(Live, anotherWorldIsShownAfterTheFirst) {
  const auto browser = browserOf();
  LiveRenderer live(*browser, settingsOf());
  finish(live, frameOf());
  browser->replaceWorld({});
  const LivePicture empty = finish(live, frameOf());
  EXPECT_EQ(empty.map.shapes, 0u);
}

// Threads, files and memory are all released. mallinfo2 counts bytes, so the result does not depend
// on the rest of the machine.
TEST(Live, framesLeaveNothingBehind) {
  const auto browser = browserOf();
  LiveRenderer live(*browser, settingsOf());
  const auto look = [&](int frames) {
    LivePicture picture;
    for (int i = 0; i < frames; ++i) {
      LiveFrame frame = frameOf(16, 12, 1 + i % 3);
      frame.view.viewer = browser->camera(4.0 / 3);
      frame.view.viewer->matrix[12] = i % 7;
      browser->tick(browser->now() + 0.01);
      live.start(frame);
      if (i % 4 == 0) live.cancel();
      waitFor(live);
      live.look(picture);
    }
  };
  look(50);
  const size_t threads = countOf("/proc/self/task"), files = countOf("/proc/self/fd");
  const size_t bytes = mallinfo2().uordblks;
  constexpr int frames = 300;
  look(frames);
  EXPECT_EQ(countOf("/proc/self/task"), threads);
  EXPECT_EQ(countOf("/proc/self/fd"), files);
  const size_t after = mallinfo2().uordblks;
  EXPECT_LT(after > bytes ? after - bytes : 0, 100u * frames);
}

namespace {

// A temporary folder with files that Inlines refer to; removed after the test.
class LiveInlines : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / fmt::format("live_inlines_{}", getpid());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  void write(const std::string& name, const std::string& body) {
    std::ofstream(folder_ / name) << "#VRML V2.0 utf8\n" << body;
  }
  std::unique_ptr<xvrml::Browser> browserOf(const std::string& name, bool inlines) {
    xvrml::LoadOptions options;
    options.loadInlines = inlines;
    return std::make_unique<xvrml::Browser>(xvrml::loadWorld((folder_ / name).string(), options));
  }
  std::filesystem::path folder_;
};

} // namespace

// Inlines that load while pictures are made cost only what they add. In the end the picture equals
// that of the world loaded at once.
TEST_F(LiveInlines, comeBitByBit) {
  std::string world =
      "Viewpoint { position 0 0 12 }\n"
      "Shape { appearance Appearance { material Material { } } geometry Sphere { radius 0.5 } }\n";
  constexpr int parts = 5;
  for (int i = 0; i < parts; ++i) {
    write(fmt::format("part{}.wrl", i),
          fmt::format("Transform {{ translation 0 {} 0 children Shape {{ appearance Appearance {{ "
                      "material Material {{ diffuseColor 0 {} 1 }} }} geometry Box {{ }} }} }}",
                      i % 2, 0.2 * i));
    world += fmt::format(
        "Transform {{ translation {} 0 0 children DEF Part{} Inline {{ url \"part{}.wrl\" }} }}\n",
        2 * i - 4, i, i);
  }
  write("world.wrl", world);
  const auto browser = browserOf("world.wrl", false);
  LiveRenderer live(*browser, settingsOf());
  LivePicture picture = finish(live, frameOf());
  EXPECT_EQ(picture.map.shapes, 1u);
  std::vector<uint64_t> defined;
  for (int i = 0; i < parts; ++i) {
    const uint64_t before = picture.map.objectsDefined;
    ASSERT_TRUE(browser->loadInline(*browser->node(fmt::format("Part{}", i))));
    picture = finish(live, frameOf());
    EXPECT_EQ(picture.map.shapes, uint64_t(2 + i));
    defined.push_back(picture.map.objectsDefined - before);
  }
  for (const uint64_t count : defined) EXPECT_EQ(count, 1u) << "objects made for one that came";
  const auto whole = browserOf("world.wrl", true);
  EXPECT_EQ(picture.rgb, displayBytes(still(*whole, settingsOf(), frameOf()).picture));
}

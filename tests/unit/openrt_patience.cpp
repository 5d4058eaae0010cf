// openrt_patience.cpp: frames that do not wait for acceleration structures (RT_PATIENCE): what they
// show meanwhile, what follows, and that nothing of it is left in later pictures.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <random>
#include <vector>

#if defined(__linux__)
#include <sys/resource.h>
#include <unistd.h>
#endif

#include "drawing.h"

namespace {

using namespace drawing;
using Pixels = std::vector<float>;

constexpr int width = 24, height = 20;
constexpr uint32_t channels = RT_RGBA | RT_DEPTH | RT_NAME | RT_POSITION | RT_MOTION;
// Nothing is built within this time; a net of so many cells takes a hundred thousand times as long.
constexpr double noPatience = 1e-9;
constexpr int manyCells = 300;
constexpr int mostFrames = 100'000; // an end for tests that fail

bool isOutdated() {
  RTstats stats{};
  stats.size = sizeof stats;
  rtGetStats(&stats);
  return stats.outdated != 0;
}

Pixels picture() {
  rtRender();
  return readChannels(channels, width, height);
}

Pixels patientPicture() {
  rtQualityf(RT_PATIENCE, 0);
  return picture();
}

// Renders without patience until a frame shows all commits. Calls `edit` before each frame.
Pixels pictureInTheEnd(const std::function<void(int)>& edit = [](int) {}) {
  rtQualityf(RT_PATIENCE, noPatience);
  for (int frame = 0; frame < mostFrames; frame++) {
    edit(frame);
    Pixels shown = picture();
    if (!isOutdated()) return shown;
  }
  ADD_FAILURE() << "the structures were never ready";
  return {};
}

void lookAlong(double x) {
  rtPushMatrix();
  rtLookAt(x, .4, 6, x, 0, 0, 0, 1, 0);
  rtPerspective(40);
  rtPopMatrix();
}

std::array<double, 16> placedAt(double x, double y, double z) {
  return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1};
}

// A lamp, a square at rest, one that may move, and a net whose structures take long.
class World {
 public:
  World() {
    rtLoadIdentity();
    rtFrameBuffer(width, height, channels);
    rtQuality(RT_SAMPLES_PER_PIXEL, 1);
    lamp_ = rtUseLight(rtNewShader(rtNewShaderClass("VRML97PointLight", nullptr)));
    moveLamp(1);
    dark_ = colored("Diffuse", "reflectance", {.3f, .4f, .3f});
    rtLoadName(1);
    back_ = square(colored("Diffuse", "reflectance", {.8f, .3f, .2f}), 2);
    at(0, 0, -1, back_);
    rtLoadName(2);
    moving_ = at(0, 0, .5, square(colored("Diffuse", "reflectance", {.2f, .3f, .8f}), .4f));
    rtInstanceHint(moving_, RT_DYNAMIC);
    lookAlong(0);
    rtRender();
  }
  void moveLamp(double x) const { rtLightMatrix(lamp_, placedAt(x, 2, 4).data()); }
  void move(double z) const { rtInstanceMatrix(moving_, placedAt(0, 0, z).data()); }
  // Defines the net, again if there is one, and places it.
  void showNet(double bulge, int cells = manyCells, RTenum hint = RT_STATIC) {
    if (net_) rtObjectHint(net_, hint);
    rtLoadName(3);
    rtBindShader(dark_);
    net_ = net(
        [=](double u, double v) {
          return Point{u - 1, v, bulge * std::sin(9 * u) * std::cos(7 * v)};
        },
        net_, cells);
    rtBindShader(0);
    if (!netPlace_) netPlace_ = at(0, 0, 0, net_);
  }
  void setNetVisible(bool visible) const {
    if (netPlace_) rtInstanceVisible(netPlace_, visible);
  }
  void hideNet() {
    if (netPlace_) rtDeleteInstance(netPlace_);
    netPlace_ = 0;
  }
  void dropNet() {
    hideNet();
    if (net_) rtDeleteObject(net_);
    net_ = 0;
  }

 private:
  RTid lamp_ = 0, dark_ = 0, back_ = 0, moving_ = 0, net_ = 0, netPlace_ = 0;
};

void inContext(const std::function<void(World&)>& draw) {
  drawIn(contextWith(2), [&] {
    World world;
    draw(world);
  });
}

bool isEqual(const Pixels& a, const Pixels& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

// Camera, lamps and settings are those of the frame; what is there is what was there before.
TEST(Patience, AFrameShowsTheSceneBeforeFromItsOwnCamera) {
  Pixels without, with, shown;
  inContext([&](World& world) {
    lookAlong(.5);
    world.moveLamp(-1);
    rtQuality(RT_SEED, 7);
    without = patientPicture();
    world.showNet(.1);
    with = patientPicture();
  });
  inContext([&](World& world) {
    world.showNet(.1);
    lookAlong(.2);
    rtQualityf(RT_PATIENCE, noPatience);
    picture();
    EXPECT_TRUE(isOutdated());
    lookAlong(.5);
    world.moveLamp(-1);
    rtQuality(RT_SEED, 7);
    shown = picture();
    EXPECT_TRUE(isOutdated());
  });
  EXPECT_TRUE(isEqual(shown, without));
  EXPECT_FALSE(isEqual(shown, with));
}

TEST(Patience, InTheEndAllCommitsAreShown) {
  Pixels expected, shown;
  inContext([&](World& world) {
    world.showNet(.1);
    lookAlong(.7);
    patientPicture();
    expected = patientPicture();
    EXPECT_FALSE(isOutdated());
  });
  inContext([&](World& world) {
    world.showNet(.1);
    shown = pictureInTheEnd([](int frame) { lookAlong(frame % 2 ? .1 : .7); });
    lookAlong(.7);
    shown = pictureInTheEnd();
  });
  EXPECT_TRUE(isEqual(shown, expected));
}

// Structures of before are not updated while frames use them.
TEST(Patience, WhatIsDefinedAgainOrAppearsIsBuiltBeside) {
  inContext([](World& world) {
    world.showNet(.1, manyCells, RT_DYNAMIC);
    patientPicture();
    for (const double bulge : {.2, .3}) { // from the second on it is dynamic
      world.showNet(bulge, manyCells + int(10 * bulge), RT_DYNAMIC);
      rtQualityf(RT_PATIENCE, noPatience);
      picture();
      EXPECT_TRUE(isOutdated()) << bulge;
      pictureInTheEnd();
    }
    world.dropNet();
    world.showNet(.1);
    world.setNetVisible(false);
    patientPicture();
    world.setNetVisible(true);
    rtQualityf(RT_PATIENCE, noPatience);
    picture();
    EXPECT_TRUE(isOutdated());
    pictureInTheEnd();
    world.setNetVisible(false);
    patientPicture();
    world.setNetVisible(true);
    rtQualityf(RT_PATIENCE, noPatience);
    picture();
    EXPECT_FALSE(isOutdated()) << "its structures are still there";
  });
}

TEST(Patience, AFrameWithoutItWaits) {
  Pixels expected, shown;
  inContext([&](World& world) {
    world.showNet(.1);
    world.move(.6);
    expected = patientPicture();
  });
  inContext([&](World& world) {
    world.showNet(.1);
    rtQualityf(RT_PATIENCE, noPatience);
    picture();
    EXPECT_TRUE(isOutdated());
    world.move(.6);
    shown = patientPicture();
    EXPECT_FALSE(isOutdated());
  });
  EXPECT_TRUE(isEqual(shown, expected)) << "also RT_MOTION: it is that since what was shown";
}

TEST(Patience, RayQueriesWait) {
  inContext([](World& world) {
    world.showNet(0);
    rtQualityf(RT_PATIENCE, noPatience);
    picture();
    EXPECT_TRUE(isOutdated());
    RTray ray{};
    ray.origin[0] = -1;
    ray.origin[1] = .03f;
    ray.origin[2] = 5;
    ray.direction[2] = -1;
    ray.tfar = 100;
    RThit hit{};
    rtCastRays(1, &ray, &hit);
    EXPECT_NEAR(hit.t, 5, 1e-5);
    EXPECT_EQ(hit.name, 3u);
    picture();
    EXPECT_FALSE(isOutdated()) << "the structures are there";
  });
}

TEST(Patience, AFrameOfAnotherCameraWaits) {
  Pixels expected, shown;
  inContext([&](World& world) {
    world.showNet(.1);
    rtOrtho(3);
    expected = patientPicture();
  });
  inContext([&](World& world) {
    world.showNet(.1);
    rtOrtho(3);
    rtQualityf(RT_PATIENCE, noPatience);
    shown = picture();
    EXPECT_FALSE(isOutdated());
  });
  EXPECT_TRUE(isEqual(shown, expected));
}

// Returns z of the middle pixel in a channel of three numbers.
float middleZ(uint32_t channel) {
  return readChannel(channel, width, height)[3 * size_t(height / 2 * width + width / 2) + 2];
}

// The square in the middle moves with each commit, but not with each frame.
TEST(Patience, MotionIsThatSinceTheFrameBefore) {
  inContext([](World& world) {
    rtQualityf(RT_PATIENCE, noPatience);
    float before = middleZ(RT_POSITION);
    EXPECT_NEAR(before, .5, 1e-5);
    int outdated = 0, moved = 0;
    double z = .5;
    for (int appears = 0; appears < 3; appears++) {
      world.showNet(.1 * appears);
      int after = 0;
      for (int frame = 0; frame < mostFrames && after < 3; frame++) {
        world.move(z += 2e-5);
        rtRender();
        const float now = middleZ(RT_POSITION);
        ASSERT_NEAR(middleZ(RT_MOTION), now - before, 2e-6) << frame;
        moved += now != before;
        before = now;
        outdated += isOutdated();
        after += !isOutdated();
      }
      world.dropNet();
      EXPECT_NEAR(before, z, 1e-5);
    }
    EXPECT_GT(outdated, 0);
    EXPECT_GE(moved, 9);
  });
}

// Views that take turns, while structures are built in between: each has its own frame before.
TEST(Patience, MotionOfViewsThatTakeTurnsIsThatSinceTheirOwnFrame) {
  inContext([](World& world) {
    double z = .5;
    std::array<float, 2> before{};
    int outdated = 0;
    for (int frame = 0; frame < 120; frame++) {
      const size_t view = size_t(frame) * 3 / 7 % 2; // two or three frames of each
      rtQuality(RT_VIEW, int32_t(view));
      rtQualityf(RT_PATIENCE, frame < 6 ? 0 : noPatience);
      if (frame % 20 == 10) world.showNet(.1);
      if (frame % 20 == 17) world.dropNet();
      world.move(z += 1e-3);
      rtRender();
      const float now = middleZ(RT_POSITION);
      if (frame >= 6) {
        ASSERT_NEAR(middleZ(RT_MOTION), now - before[view], 3e-6) << frame;
      }
      before[view] = now;
      outdated += isOutdated();
    }
    EXPECT_GT(outdated, 0);
  });
}

#if defined(__linux__)
// Embree notes quietly that memory was short. In a process of its own, whose address space has room
// for so many MB more.
void renderWithRoom(int room) {
  inContext([=](World& world) {
    world.showNet(.1);
    long pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    rlimit limit{rlim_t(pages) * rlim_t(::sysconf(_SC_PAGESIZE)) + (rlim_t(room) << 20),
                 RLIM_INFINITY};
    ::setrlimit(RLIMIT_AS, &limit);
    bool isRight = true;
    const auto showsNet = [] {
      const std::vector<float> names = readChannel(RT_NAME, width, height);
      return std::find(names.begin(), names.end(), 3.0f) != names.end();
    };
    for (int frame = 0; frame < 3; frame++) {
      rtRender();
      isRight = isRight && (rtGetError() == RT_OUT_OF_MEMORY || showsNet());
    }
    limit.rlim_cur = RLIM_INFINITY;
    ::setrlimit(RLIMIT_AS, &limit);
    rtRender();
    ::_exit(isRight && rtGetError() == RT_NO_ERROR && showsNet() ? 0 : 1);
  });
}

TEST(ShortMemory, EachFrameFailsOrIsRight) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  for (const int room : {1, 4, 10, 20, 40})
    EXPECT_EXIT(renderWithRoom(room), testing::ExitedWithCode(0), "") << room;
}
#endif

// A texture that is new in each frame takes memory until it is applied.
TEST(Patience, CommitsThatWaitTakeABoundedMemory) {
  inContext([](World& world) {
    constexpr int side = 2048;                                // 16 MB in four bytes a texel
    constexpr int most = (128 << 20) / (4 * side * side) + 2; // frames that stand in
    const std::vector<uint8_t> texels(size_t(4) * side * side);
    RTid texture = 0;
    rtGenTextures(1, &texture);
    rtBindTexture(texture);
    int longest = 0, outdated = 0;
    for (int frame = 0; frame < 2 * most; frame++) {
      world.showNet(.01 * frame, 2 * manyCells); // structures are never ready for long
      rtTexImage2D(4, side, side, RT_UNSIGNED_BYTE, texels.data());
      rtQualityf(RT_PATIENCE, noPatience);
      picture();
      outdated = isOutdated() ? outdated + 1 : 0;
      longest = std::max(longest, outdated);
    }
    EXPECT_GT(longest, 0);
    EXPECT_LE(longest, most);
  });
}

// Edits of every kind while structures are built: meshes that come, go, are defined again and
// deform, and things that move.
void editAtRandom(World& world, std::mt19937& random) {
  const auto below = [&](uint32_t n) { return random() % n; };
  switch (below(8)) {
  case 0: world.showNet(.01 * below(20)); break;
  case 1: world.showNet(.01 * below(20), 40); break;
  case 2: world.showNet(.01 * below(20), 200, RT_DYNAMIC); break;
  case 3: world.hideNet(); break;
  case 4: world.dropNet(); break;
  case 5: world.setNetVisible(below(2)); break;
  case 6: world.move(.01 * below(90)); break;
  default: world.moveLamp(.1 * below(20)); break;
  }
  lookAlong(.01 * below(50));
}

TEST(Patience, EditsMeanwhileEndInTheSamePicture) {
  constexpr int edits = 14;
  for (uint32_t seed = 0; seed < 12; seed++) {
    const auto last = [&](double patience) {
      Pixels shown;
      inContext([&](World& world) {
        std::mt19937 random(seed);
        for (int i = 0; i < edits; i++) {
          editAtRandom(world, random);
          rtQualityf(RT_PATIENCE, patience);
          picture();
        }
        patientPicture();
        shown = patientPicture(); // nothing has moved since the frame before
      });
      return shown;
    };
    EXPECT_TRUE(isEqual(last(noPatience), last(0))) << seed;
  }
}

TEST(Patience, AContextMayEndMeanwhile) {
  for (int i = 0; i < 5; i++)
    inContext([](World& world) {
      world.showNet(.1);
      rtQualityf(RT_PATIENCE, noPatience);
      rtSwapBuffers();
    });
}

} // namespace

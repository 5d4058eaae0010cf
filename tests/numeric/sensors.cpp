// sensors.cpp: photometric sensors: units, what a reading includes, and the promise of its
// interval.
#include <algorithm>

#include "numeric/sensor_scene.h"

namespace numeric {
namespace {

TEST_F(Sensors, AColourCountsByItsLuminance) {
  Shader sky("VRML97Environment");
  sky.setList("skyColor", {1, 2, 4});
  rtUseEnvironment(sky);
  const double luminance = .2126 * 1 + .7152 * 2 + .0722 * 4;
  EXPECT_NEAR(read({0, 0, 0}, up, RT_MEASURE_LUMINANCE).value, luminance, 1e-5);
  expectReading(read({0, 0, 0}, up), pi * luminance, 1e-3);
}

TEST_F(Sensors, OneCandelaGivesOneLuxAtOneMetre) {
  use(bulb({0, 0, 2}, 4 * pi * 100)); // 100 cd
  EXPECT_NEAR(read({0, 0, 0}, up).value, 25, 1e-4);
  EXPECT_NEAR(read({0, 0, 1}, up).value, 100, 1e-3);
  EXPECT_EQ(read({0, 0, 0}, below).value, 0) << "the light comes from behind";
}

// Without surfaces and sky no random path can find light.
TEST_F(Sensors, ALampAloneIsReadExactly) {
  use(bulb({0, 1.5, 2}, 4 * pi));
  for (const int samples : {32, 256}) {
    rtQuality(RT_SAMPLES_PER_PIXEL, samples);
    const Reading got = read({0, 0, 0}, up);
    EXPECT_NEAR(got.value, .8 / 6.25, 1e-6);
    EXPECT_EQ(got.halfWidth, 0);
    EXPECT_TRUE(got.trusted);
  }
}

// Nothing behind a sensor can send light to it, whether it is black or white.
TEST_F(Sensors, ALampAboveAFloorIsReadExactly) {
  floor();
  use(bulb({0, 1.5, 2}, 4 * pi));
  for (const double above : {1e-5, .5}) {
    const double height = 2 - above, distance = std::hypot(1.5, height);
    const Reading got = read({0, 0, above}, up);
    EXPECT_NEAR(got.value, height / (distance * distance * distance), 1e-6);
    EXPECT_EQ(got.halfWidth, 0);
    EXPECT_TRUE(got.trusted);
  }
  const Reading beneath = read({0, 0, -.5}, up);
  EXPECT_FALSE(beneath.trusted && beneath.halfWidth == 0) << "the floor might send light";
}

// The light of lamps goes straight through glass, and the glass absorbs on the way (Beer-Lambert):
// with the lamp behind the glass, inside of it, and with the sensor inside.
TEST_F(Sensors, AbsorbingGlassDimsTheLightOfLamps) {
  const double a = .7, passes = 1 - .04, candela = 100;
  Shader glass("Glass");
  glass.set("index", {1.5}).set("absorption", {a, a, a});
  ball(glass, 1);
  use(bulb({0, 0, 3}, 4 * pi * candela));
  EXPECT_NEAR(read({0, 0, -2}, up).value, candela / 25 * passes * passes * std::exp(-2 * a), 1e-4);
  EXPECT_NEAR(read({0, 0, 0}, up).value, candela / 9 * passes * std::exp(-a), 1e-4);
  EXPECT_NEAR(read({0, 0, 2}, up).value, candela, 1e-3) << "beside the glass";
}

TEST_F(Sensors, ASensorIsNotSeen) { // neither by the lamp nor by another point of the grid
  lamp(rectangle(.5, 1));
  const double expected = pi * polygon(rectangle(.5, 1));
  for (const Reading& r : readGrid({{0, 0, 0}, {1e-6, 0, 0}, {0, -1e-6, 0}, 4, 4}))
    expectReading(r, expected);
}

TEST_F(Sensors, TheGridHasItsPointsInTheMiddlesOfItsCells) {
  use(bulb({0, 0, 2}, 4 * pi));
  const std::vector<Reading> got = readGrid({{1, 2, 0}, {4, 0, 0}, {0, -6, 0}, 4, 3});
  for (int row = 0; row < 3; row++)
    for (int column = 0; column < 4; column++) {
      const double x = 1 - 2 + (column + .5), y = 2 + 3 - 2 * (row + .5);
      const double d = std::sqrt(x * x + y * y + 4);
      EXPECT_NEAR(got[size_t(4 * row + column)].value, 2 / (d * d * d), 1e-6);
    }
}

TEST_F(Sensors, APointOnASurfaceIsLitByWhatIsAboveIt) {
  floor();
  lamp(rectangle(.5, 1));
  expectReading(read({0, 0, 1e-5}, up), pi * polygon(rectangle(.5, 1)));
}

TEST_F(Sensors, AnEmptySceneIsDark) {
  const Reading dark = read({0, 0, 0}, up);
  EXPECT_EQ(dark.value, 0);
  EXPECT_FALSE(dark.trusted && dark.halfWidth > 0);
}

TEST_F(Sensors, TheyFollowPathsUnlessLightPathsAreAskedFor) {
  floor();
  lamp(rectangle(.5, 1));
  const double expected = pi * polygon(rectangle(.5, .999));
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_AUTO);
  expectReading(read({0, 0, .001}, up), expected);
  EXPECT_EQ(stats().transport.chosen, RTenum(RT_TRANSPORT_PATH));
  EXPECT_STREQ(stats().transport.reason, "sensors follow paths");
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_LIGHT); // nothing mirrors or refracts
  expectReading(read({0, 0, .001}, up), expected);
  EXPECT_EQ(stats().transport.chosen, RTenum(RT_TRANSPORT_LIGHT));
}

// A room with a lamp, a box and coloured walls.
class Room : public Sensors {
 protected:
  void SetUp() override {
    Sensors::SetUp();
    build();
  }
  static void build() {
    quad({-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}, .4);
    quad({-2, -2, 3}, {2, -2, 3}, {2, 2, 3}, {-2, 2, 3}, .8);
    quad({-2, -2, 0}, {-2, 2, 0}, {-2, 2, 3}, {-2, -2, 3}, .5);
    quad({2, -2, 0}, {2, 2, 0}, {2, 2, 3}, {2, -2, 3}, .6);
    quad({-2, 2, 0}, {2, 2, 0}, {2, 2, 3}, {-2, 2, 3}, .7);
    quad({-.5, -.5, 1.5}, {.5, -.5, 1.5}, {.5, .5, 1.5}, {-.5, .5, 1.5}, .3);
    std::vector<Vec> panel = rectangle(.4, 2.95);
    std::reverse(panel.begin(), panel.end()); // it faces down
    lamp(panel, 1000, true);
  }
  static std::vector<Reading> table() {
    return readGrid({{0, 0, .75}, {3, 0, 0}, {0, -3, 0}, 6, 6});
  }
};

TEST_F(Room, OfTheIntervals95PercentHold) {
  rtQuality(RT_SAMPLES_PER_PIXEL, 16384);
  std::vector<double> truth(36, 0);
  constexpr int references = 4, seeds = 80;
  for (int seed = 0; seed < references; seed++) {
    rtQuality(RT_SEED, 1000 + seed);
    const std::vector<Reading> got = table();
    for (size_t i = 0; i < 36; i++) truth[i] += got[i].value / references;
  }
  for (const int samples : {64, 256}) {
    rtQuality(RT_SAMPLES_PER_PIXEL, samples);
    int held = 0, all = 0, untrusted = 0;
    for (int seed = 0; seed < seeds; seed++) {
      rtQuality(RT_SEED, seed);
      const std::vector<Reading> got = table();
      for (size_t i = 0; i < 36; i++) {
        untrusted += !got[i].trusted;
        if (!got[i].trusted) continue;
        held += std::fabs(got[i].value - truth[i]) <= got[i].halfWidth;
        all++;
      }
    }
    const double coverage = double(held) / all;
    printf("%d samples: coverage %.4f of %d intervals, %d not trusted\n", samples, coverage, all,
           untrusted);
    EXPECT_NEAR(coverage, .95, .02);
    EXPECT_GT(all, 20 * untrusted);
  }
}

TEST_F(Room, AnyNumberOfThreadsMakesTheSameBytes) {
  rtQuality(RT_SAMPLES_PER_PIXEL, 128);
  const std::vector<Reading> one = table();
  const RTcontext before = rtGetCurrent();
  for (const char* threads : {"threads=2", "threads=5"}) {
    const RTcontext other = rtNewContext(threads);
    rtLoadIdentity();
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
    rtQuality(RT_MAX_DEPTH, 64);
    rtQuality(RT_SAMPLES_PER_PIXEL, 128);
    build();
    const std::vector<Reading> got = table();
    for (size_t i = 0; i < one.size(); i++) {
      EXPECT_EQ(got[i].value, one[i].value);
      EXPECT_EQ(got[i].halfWidth, one[i].halfWidth);
    }
    rtDeleteContext(other);
    rtMakeCurrent(before);
  }
}

TEST_F(Room, ATargetErrorIsReached) {
  rtQuality(RT_SAMPLES_PER_PIXEL, 65536);
  rtQualityf(RT_TARGET_ERROR, .01);
  table();
  EXPECT_LT(stats().error.halfWidth, .0115);
  EXPECT_GT(stats().error.halfWidth, .001) << "it stops before all samples are taken";
}

} // namespace
} // namespace numeric

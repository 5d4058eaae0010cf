// sensors_behind_optics.cpp: sensors under RT_TRANSPORT_LIGHT: the light of lamps that arrives by
// way of mirrors and glass is the mean over each sensor's cell, against closed forms.
#include <algorithm>

#include "numeric/sensor_scene.h"

namespace numeric {
namespace {

class SensorsBehindOptics : public Sensors {
 protected:
  static constexpr double candela = 100;

  void SetUp() override {
    Sensors::SetUp();
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_LIGHT);
  }
  static Shader source(Vec at) { return bulb(at, 4 * pi * candela); }
  static Shader mirror(double reflectance = 1) {
    return Shader("Mirror").set("reflectance", {reflectance, reflectance, reflectance});
  }
  // A grid of n x n points that looks down, its middle at (x, 0, z).
  static Grid looksDown(double x, double z, double edge, int n) {
    return {{x, 0, z}, {edge, 0, 0}, {0, edge, 0}, n, n};
  }
  // Returns the mean of f(x, y) over cell i of looksDown().
  template <class F> static double meanOver(const Grid& g, size_t i, const F& f) {
    constexpr int parts = 20;
    const double step = g.across.x / g.columns;
    const auto column = double(i % size_t(g.columns)), row = double(i / size_t(g.columns));
    double sum = 0;
    for (int a = 0; a < parts; a++)
      for (int b = 0; b < parts; b++)
        sum += f(g.middle.x - g.across.x / 2 + (column + (a + .5) / parts) * step,
                 g.middle.y + ((row + (b + .5) / parts) / g.rows - .5) * g.down.y);
    return sum / (parts * parts);
  }
  // The illuminance of a source at height h above or below the plane, at a distance r across.
  static double under(double h, double x, double y) {
    const double d2 = x * x + y * y + h * h;
    return candela * h / (d2 * std::sqrt(d2));
  }
};

// The image of a lamp in a mirror is as far behind it as the lamp is before it. The lamp itself is
// behind the sensors.
TEST_F(SensorsBehindOptics, AMirrorGivesTheLightOfTheImageAndTheIntervalsHold) {
  use(source({0, 0, 3}));
  placeAt(0, square(mirror(.8), 4));
  const Grid grid = looksDown(.7, 2, 2, 4);
  std::vector<double> expected;
  for (size_t i = 0; i < 16; i++)
    expected.push_back(.8 * meanOver(grid, i, [](double x, double y) { return under(5, x, y); }));
  for (const int samples : {16, 256}) {
    rtQuality(RT_SAMPLES_PER_PIXEL, samples);
    int held = 0, all = 0;
    double sum = 0, expectedSum = 0;
    for (int seed = 0; seed < 40; seed++) {
      rtQuality(RT_SEED, seed);
      const std::vector<Reading> got = readGrid(grid);
      for (size_t i = 0; i < got.size(); i++) {
        held += std::fabs(got[i].value - expected[i]) <= got[i].halfWidth;
        all++;
        sum += got[i].value;
        expectedSum += expected[i];
      }
    }
    const double coverage = double(held) / all;
    printf("%d samples: coverage %.4f of %d intervals\n", samples, coverage, all);
    EXPECT_GT(coverage, .93);
    // Cells that few paths cross use the variance of their neighbours, too, if that is larger.
    EXPECT_LT(coverage, samples == 16 ? 1 : .975);
    EXPECT_NEAR(sum / expectedSum, 1, samples == 16 ? .06 : .015);
  }
  EXPECT_EQ(stats().transport.chosen, RTenum(RT_TRANSPORT_LIGHT));
  EXPECT_EQ(stats().transport.unreachedLights, 0u);
}

// D17: a paraboloid with a point source in its focus sends out a parallel beam. A ring of the
// beam has the light of the cone that the source sends to it: I / (f^2 (1 + r^2 / 4 f^2)^2) lux.
TEST_F(SensorsBehindOptics, AParaboloidMakesABeamOfKnownIlluminance) {
  constexpr double f = 1, aperture = 1.2, above = 3;
  const RTid object = rtBeginObject(0);
  rtBindShader(mirror());
  rtAsphere(1 / (2 * f), -1, 0, nullptr, 0, aperture);
  rtEndObject();
  rtBindShader(0);
  place(object);
  use(source({0, 0, f}));
  const auto beam = [](double x, double y) {
    const double r2 = x * x + y * y, ring = 1 + r2 / (4 * f * f);
    return r2 < aperture * aperture ? candela / (f * f * ring * ring) : 0;
  };
  rtQuality(RT_SAMPLES_PER_PIXEL, 1024);
  const Grid grid = looksDown(0, above, 4, 16);
  const std::vector<Reading> got = readGrid(grid);
  const double cell = (4. / 16) * (4. / 16);
  double flux = 0, direct = 0;
  int held = 0, dark = 0;
  for (size_t i = 0; i < got.size(); i++) {
    const double x = -2 + (double(i % 16) + .5) / 4, y = -2 + (double(i / 16) + .5) / 4;
    const double expected = under(above - f, x, y) + meanOver(grid, i, beam);
    held += std::fabs(got[i].value - expected) <= got[i].halfWidth + 2e-5 * expected;
    dark += beam(x, y) == 0 && got[i].value <= 1.00002 * under(above - f, x, y);
    direct += under(above - f, x, y) * cell;
    flux += got[i].value * cell;
    EXPECT_GT(got[i].halfWidth, 0) << "also beside the beam some path might have come";
  }
  EXPECT_GT(held, int(.9 * 256));
  EXPECT_GT(dark, 128);
  // All light of the cone to the rim is in the beam: 2 pi I (1 - cos), tan(half the angle) = r /
  // 2f.
  const double tangent = aperture / (2 * f),
               cosine = (1 - tangent * tangent) / (1 + tangent * tangent);
  EXPECT_NEAR((flux - direct) / (2 * pi * candela * (1 - cosine)), 1, 2e-3);
}

// The sensor lies in a slab that absorbs and does not refract.
TEST_F(SensorsBehindOptics, LightIsAbsorbedUpToTheSensor) {
  constexpr double absorption = .7, height = 3;
  const Shader clear =
      Shader("Glass").set("index", {1}).set("absorption", {absorption, absorption, absorption});
  const RTid object = rtBeginObject(0);
  rtBindShader(clear);
  rtQuadric(std::array<double, 10>{0, 0, 1, 0, 0, 0, 0, 0, 0, -1}.data(),
            std::array<double, 3>{-9, -9, -1}.data(), std::array<double, 3>{9, 9, 1}.data());
  rtEndObject();
  rtBindShader(0);
  place(object);
  use(source({0, 0, height}));
  rtQuality(RT_SAMPLES_PER_PIXEL, 1024);
  Grid grid = looksDown(.5, 0, 1, 4);
  grid.down.y = -1; // it looks up
  const std::vector<Reading> got = readGrid(grid);
  for (size_t i = 0; i < got.size(); i++) {
    const double expected = meanOver(grid, i, [](double x, double y) {
      const double d = std::sqrt(x * x + y * y + height * height);
      return under(height, x, y) * std::exp(-absorption * d / height);
    });
    EXPECT_NEAR(got[i].value, expected, 2 * got[i].halfWidth) << i;
    EXPECT_LT(got[i].halfWidth, .1 * expected);
    EXPECT_TRUE(got[i].trusted) << "light paths tell, although no path from the sensor finds light";
  }
}

// A lamp with an area, above a ball of glass: paths from sensors find it by chance, so that both
// ways of measuring must agree.
class UnderABall : public SensorsBehindOptics {
 protected:
  static void build() {
    const RTid object = rtBeginObject(0);
    rtBindShader(Shader("Glass"));
    rtSphere(.5);
    rtEndObject();
    rtBindShader(0);
    placeAt(1, object);
    placeAt(0, square(matt(.5), 3));
    placeAt(3, square(matt(0, 500), .3), true);
  }
  // Points in the shadow of the ball, where all light of the lamp comes through it.
  static Grid table() { return {{0, 0, 1e-4}, {.7, 0, 0}, {0, -.7, 0}, 4, 4}; }
};

// Paths from the sensors measure at points. So their grid is fine, and its means are compared.
TEST_F(UnderABall, SensorsAgreeWithPathsFromTheSensors) {
  build();
  rtQuality(RT_MAX_DEPTH, 12);
  rtQuality(RT_SAMPLES_PER_PIXEL, 4096);
  const std::vector<Reading> light = readGrid(table());
  constexpr int fine = 8; // points of the fine grid along the edge of a cell
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  rtQuality(RT_SEED, 3);
  rtQuality(RT_SAMPLES_PER_PIXEL, 1024);
  Grid grid = table();
  grid.columns *= fine;
  grid.rows *= fine;
  const std::vector<Reading> path = readGrid(grid);
  for (size_t i = 0; i < light.size(); i++) {
    double mean = 0, variance = 0;
    for (size_t j = 0; j < size_t(fine * fine); j++) {
      const size_t row = i / 4 * fine + j / fine, column = i % 4 * fine + j % fine;
      const Reading& r = path[row * 4 * fine + column];
      mean += r.value / (fine * fine);
      variance += r.halfWidth * r.halfWidth / std::pow(fine, 4);
    }
    // Twice the joint interval, and the error of the mean over points at the rim of the caustic.
    EXPECT_NEAR(light[i].value, mean,
                2 * std::hypot(light[i].halfWidth, std::sqrt(variance)) + .02 * mean)
        << i;
  }
}

TEST_F(UnderABall, AnyNumberOfThreadsMakesTheSameBytes) {
  std::vector<std::vector<Reading>> all;
  const RTcontext before = rtGetCurrent();
  for (const char* threads : {"threads=1", "threads=3"}) {
    const RTcontext other = rtNewContext(threads);
    rtLoadIdentity();
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_LIGHT);
    rtQuality(RT_SAMPLES_PER_PIXEL, 128);
    build();
    all.push_back(readGrid(table()));
    rtDeleteContext(other);
    rtMakeCurrent(before);
  }
  for (size_t i = 0; i < all[0].size(); i++) {
    EXPECT_GT(all[0][i].value, 0);
    EXPECT_EQ(all[0][i].value, all[1][i].value);
    EXPECT_EQ(all[0][i].halfWidth, all[1][i].halfWidth);
  }
}

// Rays that do not start in a plane have no cells, and a luminance is seen at a point.
TEST_F(UnderABall, OtherSensorsFollowPaths) {
  build();
  const auto expectPaths = [](RTenum measure) {
    rtQuality(RT_MEASURE, int(measure));
    rtQuality(RT_SAMPLES_PER_PIXEL, 16);
    rtFrameBuffer(2, 2, RT_RGBA);
    rtRender();
    EXPECT_EQ(stats().transport.chosen, RTenum(RT_TRANSPORT_PATH));
    EXPECT_STREQ(stats().transport.reason, "sensors follow paths");
    rtQuality(RT_MEASURE, RT_MEASURE_NOTHING);
  };
  rtPushMatrix();
  rtLookAt(0, 0, 2, 0, 0, 0, 0, 1, 0);
  rtPerspective(40);
  rtPopMatrix();
  expectPaths(RT_MEASURE_ILLUMINANCE);
  rtPushMatrix();
  rtLookAt(0, 0, 2, 0, 0, 0, 0, 1, 0);
  rtOrtho(1);
  rtPopMatrix();
  expectPaths(RT_MEASURE_LUMINANCE);
}

} // namespace
} // namespace numeric

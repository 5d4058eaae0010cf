// light_tracing.cpp: RT_TRANSPORT_LIGHT: light that arrives via mirrors and lenses, against closed
// forms and path tracing.
#include <algorithm>
#include <cmath>
#include <vector>

#include "numeric/support.h"

namespace numeric {
namespace {

class LightTracing : public Scene {
 protected:
  void SetUp() override {
    Scene::SetUp();
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_LIGHT);
  }
  static std::vector<float> picture(int edge, int samples) {
    rtQuality(RT_SAMPLES_PER_PIXEL, samples);
    std::vector<float> out = Scene::picture(edge);
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
    return out;
  }
  // Above the floor z = 0, with the radius .5.
  static void placeGlassBall() {
    const RTid ball = rtBeginObject(0);
    rtBindShader(Shader("Glass"));
    rtSphere(.5);
    rtEndObject();
    rtBindShader(0);
    placeAt(.8, ball);
  }
};

// A lamp over a mirror lights a ceiling as the lamp and its mirror image would. The camera looks at
// a part of the ceiling beside both. A parallel view shows the same; the mirror is behind its
// plane.
TEST_F(LightTracing, AMirrorSendsOnTheLightOfItsImage) {
  const double half = .05, lampAt = 1, ceilingAt = 2, reflectance = .8, radiance = 100, x = .7;
  Shader mirror("Mirror");
  mirror.set("reflectance", {reflectance, reflectance, reflectance});
  placeAt(0, square(mirror, 2));
  placeAt(lampAt, square(matt(0, radiance), half), true);
  placeAt(ceilingAt, square(matt(.5), 10), true);
  cameraAt({x, 0, 1.2}, {x, 0, ceilingAt}, 50);
  // path: ceiling, mirror, lamp; excludes interreflection on the ceiling
  rtQuality(RT_MAX_DEPTH, 2);
  // Returns the irradiance at (px, py) from a square source at height h, small compared with h.
  const auto from = [&](double px, double py, double h) {
    const double d2 = px * px + py * py + h * h;
    return radiance * 4 * half * half * h * h / (d2 * d2);
  };
  const double seen = .8 * std::tan(25 * pi / 180);
  double direct = 0, mirrored = 0;
  constexpr int n = 100;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      const double px = x + seen * (2 * (i + .5) / n - 1), py = seen * (2 * (j + .5) / n - 1);
      direct += from(px, py, ceilingAt - lampAt) / (n * n);
      mirrored += reflectance * from(px, py, ceilingAt + lampAt) / (n * n);
    }
  const double before = .5 / pi * direct, expected = .5 / pi * (direct + mirrored),
               tolerance = .02 * (expected - before) + .001 * expected;
  EXPECT_NEAR(mean(picture(4, 32768)), expected, tolerance);
  EXPECT_EQ(stats().transport.chosen, RTenum(RT_TRANSPORT_LIGHT));
  rtPushMatrix();
  rtLoadIdentity();
  rtLookAt(x, 0, 1.2, x, 0, ceilingAt, 0, 1, 0);
  rtOrtho(2 * seen);
  rtPopMatrix();
  EXPECT_NEAR(mean(picture(4, 32768)), expected, tolerance);
}

// Each path is found by exactly one of the two methods, so the picture agrees with path tracing.
TEST_F(LightTracing, ACausticHasTheLightThatPathTracingFinds) {
  placeAt(0, square(matt(.7), 3));
  placeGlassBall();
  placeAt({-1.6, 0, 1}, square(Shader("Mirror"), .3));
  placeAt({.5, 0, 3}, square(matt(.3, 5), .6), true);
  rtPushMatrix();
  rtLoadIdentity();
  rtLookAt(0, -4, 2.5, 0, 0, .4, 0, 0, 1);
  rtPerspective(40);
  rtPopMatrix();
  constexpr int edge = 16, block = 4;
  rtQuality(RT_MAX_DEPTH, 12);
  const std::vector<float> light = picture(edge, 1024);
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  rtQuality(RT_SEED, 7);
  const std::vector<float> path = picture(edge, 8192);
  for (int by = 0; by < edge / block; by++)
    for (int bx = 0; bx < edge / block; bx++) {
      double a = 0, b = 0;
      for (int y = by * block; y < (by + 1) * block; y++)
        for (int x = bx * block; x < (bx + 1) * block; x++) {
          a += light[4 * size_t(y * edge + x)] / (block * block);
          b += path[4 * size_t(y * edge + x)] / (block * block);
        }
      EXPECT_NEAR(a, b, .03 * b + .002) << bx << " " << by;
    }
}

// A lamp far away without attenuation lights as one whose rays are parallel, at any distance. Both
// light the floor through a ball of glass; the brightest pixels are the caustic.
TEST_F(LightTracing, ALampFarAwayLightsAsParallelRays) {
  placeAt(0, square(matt(.7), 2));
  placeGlassBall();
  cameraAt({0, -4, 1.5}, {0, 0, .3}, 50);
  const auto caustic = [](const Shader& light) {
    const RTid lamp = use(light);
    const std::vector<float> rgba = picture(16, 512);
    rtRemoveLight(lamp);
    std::vector<double> red;
    for (size_t i = 0; i < rgba.size(); i += 4) red.push_back(double(rgba[i]));
    std::sort(red.begin(), red.end());
    return red[red.size() - 1] + red[red.size() - 2] + red[red.size() - 3];
  };
  const Vec from{1 / 3., 2 / 3., 2 / 3.};
  const double expected = caustic(directional({-from.x, -from.y, -from.z}));
  for (const double distance : {3e2, 1e4, 1e6, 1e7, 1e8, 1e12}) {
    Shader lamp = point({from.x * distance, from.y * distance, from.z * distance}, {1, 0, 0});
    EXPECT_NEAR(caustic(lamp.set("radius", {1e30})), expected, .03 * expected) << distance;
  }
}

TEST_F(LightTracing, ThePictureDoesNotDependOnThreads) {
  std::vector<std::vector<float>> pictures;
  const RTcontext own = rtGetCurrent();
  for (const char* config : {"threads=1", "threads=3"}) {
    const RTcontext context = rtNewContext(config);
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_LIGHT);
    placeAt(0, square(matt(.7), 3));
    const RTid ball = rtBeginObject(0);
    rtBindShader(Shader("Glass"));
    rtSphere(.5);
    rtEndObject();
    rtBindShader(0);
    placeAt(.8, ball);
    placeAt({.5, 0, 3}, square(matt(.3, 5), .6), true);
    cameraAt({0, -4, 2.5}, {0, 0, .4}, 40);
    pictures.push_back(picture(20, 8));
    rtDeleteContext(context);
  }
  rtMakeCurrent(own);
  EXPECT_EQ(pictures[0], pictures[1]);
}

} // namespace
} // namespace numeric

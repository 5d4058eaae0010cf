// guided_light.cpp: light of small lamps that path tracing finds by way of mirrors and glass,
// against closed forms and against pictures without photons.
#include <cmath>
#include <string>
#include <vector>

#include "numeric/lamp_scene.h"

namespace numeric {
namespace {

class GuidedLight : public Lamps {
 protected:
  static Shader mirror(double reflectance) {
    Shader s("Mirror");
    s.set("reflectance", {reflectance, reflectance, reflectance});
    return s;
  }
  static RTid sphere(const Shader& shader, double radius) {
    const RTid object = rtBeginObject(0);
    rtBindShader(shader);
    rtSphere(float(radius));
    rtEndObject();
    rtBindShader(0);
    return object;
  }
  static std::vector<float> picture(int edge, int samples, int seed) {
    rtQuality(RT_SAMPLES_PER_PIXEL, samples);
    rtQuality(RT_SEED, seed);
    return Scene::picture(edge);
  }
};

// A lamp over a mirror lights a ceiling as the lamp and its mirror image would. The mirror image
// fills a thousandth of what the ceiling sees, so BSDF sampling alone would need some hundred times
// the samples for this tolerance.
TEST_F(GuidedLight, AMirrorSendsOnTheLightOfASmallLamp) {
  const double half = .02, lampAt = 1, ceilingAt = 2, reflectance = .8, radiance = 1000, x = .7;
  rtQuality(RT_MAX_DEPTH, 2); // ceiling, mirror, lamp; excludes interreflection on the ceiling
  placeAt(0, square(mirror(reflectance), 2));
  placeAt(lampAt, square(matt(0, radiance), half), true);
  placeAt(ceilingAt, square(matt(.5), 10), true);
  cameraAt({x, 0, 1.2}, {x, 0, ceilingAt}, 50);
  // Returns the irradiance at (px, py) from a square source at height h, small compared with h.
  const auto from = [&](double px, double py, double h) {
    const double d2 = px * px + py * py + h * h;
    return radiance * 4 * half * half * h * h / (d2 * d2);
  };
  double expected = 0;
  constexpr int n = 100;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      const double seen = .8 * std::tan(25 * degree), px = x + seen * (2 * (i + .5) / n - 1),
                   py = seen * (2 * (j + .5) / n - 1);
      expected +=
          .5 / pi / (n * n) *
          (from(px, py, ceilingAt - lampAt) + reflectance * from(px, py, ceilingAt + lampAt));
    }
  expectQ("mirrored", Scene::mean(picture(8, 64, 1)), expected, .004);
}

// The caustic that a mirror shows has the light of the caustic times the mirror's reflectance.
// Parallel projections, one of them mirrored, see the same part of the floor.
TEST_F(GuidedLight, ACausticSeenInAMirrorHasTheLightOfTheCaustic) {
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_LIGHT);
  rtQuality(RT_MAX_DEPTH, 8);
  placeAt(0, square(matt(.7), 3));
  placeAt(.8, sphere(Shader("Glass"), .5));
  placeAt({.4, 0, 3}, square(matt(0, 500), .03), true);
  const auto seenFrom = [](Vec from, Vec to) {
    rtPushMatrix();
    rtLoadIdentity();
    rtLookAt(from.x, from.y, from.z, to.x, to.y, to.z, 0, 0, 1);
    rtOrtho(.2);
    rtPopMatrix();
    return Scene::mean(picture(8, 1024, 1));
  };
  // Past the ball: the line of sight rises by 1.4 for 1.
  constexpr double caustic = -.145, mirrorAt = -3, mirrored = 2 * mirrorAt - caustic, rise = 1.4;
  const double direct = seenFrom({-1.4, 0, rise * (caustic + 1.4)}, {caustic, 0, 0});
  rtPushMatrix();
  rtTranslated(mirrorAt, 0, rise * (caustic - mirrorAt));
  rtRotated(90, 0, 1, 0);
  place(square(mirror(.5), .3));
  rtPopMatrix();
  const double inMirror = seenFrom({-2, 0, rise * (-2 - mirrored)}, {mirrored, 0, 0});
  EXPECT_GT(direct, .05);
  EXPECT_NEAR(inMirror, .5 * direct, .03 * direct);
}

// Pictures with photons agree with pictures of so few samples that none are traced.
TEST_F(GuidedLight, PhotonsDoNotChangeTheMean) {
  rtQuality(RT_MAX_DEPTH, 6);
  placeAt(0, square(matt(.7), 3));
  placeAt(.8, sphere(Shader("Glass"), .5));
  placeAt({-1.6, 0, .6}, sphere(mirror(.9), .4));
  placeAt({.5, 0, 3}, square(matt(.3, 5), .5), true);
  cameraAt({0, -4, 2.5}, {0, 0, .4}, 40);
  double without = 0, with = 0;
  constexpr int rounds = 256, few = 8, many = 512;
  for (int r = 0; r < rounds; r++) without += Scene::mean(picture(8, few, 100 + r)) / rounds;
  for (int r = 0; r < rounds * few / many; r++)
    with += Scene::mean(picture(8, many, 1 + r)) / (rounds * few / many);
  EXPECT_NEAR(with, without, .01 * without);
}

// Paths of three surfaces by way of a floor, a mirror and a ceiling do not count where two are the
// limit, with photons or without.
TEST_F(GuidedLight, PhotonsDoNotMakePathsLonger) {
  rtQuality(RT_MAX_DEPTH, 2);
  placeAt(0, square(matt(.8), 2));
  placeAt(2, square(matt(.8), 2), true);
  placeAt({0, 0, .5}, sphere(mirror(.9), .4));
  placeAt({.6, 0, 1}, square(matt(0, 20), .1), true);
  cameraAt({-1.2, 0, 1}, {-1.2, 0, 2}, 40);
  double without = 0, with = 0;
  constexpr int rounds = 512, few = 8, many = 512;
  for (int r = 0; r < rounds; r++) without += Scene::mean(picture(8, few, 100 + r)) / rounds;
  for (int r = 0; r < rounds * few / many; r++)
    with += Scene::mean(picture(8, many, 1 + r)) / (rounds * few / many);
  EXPECT_NEAR(with, without, .01 * without);
}

TEST_F(GuidedLight, ThePictureDoesNotDependOnThreads) {
  std::vector<std::vector<float>> pictures;
  const RTcontext own = rtGetCurrent();
  for (const char* config : {"threads=1", "threads=3"}) {
    const RTcontext context = rtNewContext(config);
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
    placeAt(0, square(matt(.7), 3));
    placeAt(.8, sphere(Shader("Glass"), .5));
    placeAt({.5, 0, 3}, square(matt(.3, 5), .1), true);
    cameraAt({0, -4, 2.5}, {0, 0, .4}, 40);
    pictures.push_back(picture(20, 32, 1));
    RTstats stats{};
    stats.size = sizeof stats;
    rtGetStats(&stats);
    EXPECT_NE(std::string(stats.transport.reason).find(", guided"), std::string::npos);
    rtDeleteContext(context);
  }
  rtMakeCurrent(own);
  EXPECT_EQ(pictures[0], pictures[1]);
}

} // namespace
} // namespace numeric

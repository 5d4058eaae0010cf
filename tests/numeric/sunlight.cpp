// sunlight.cpp: the sun of a sky by way of mirrors and glass, against closed forms.
#include <cmath>
#include <string>
#include <vector>

#include "numeric/lamp_scene.h"

namespace numeric {
namespace {

class Sunlight : public Lamps {
 protected:
  // A dark sky with a sun at an angle (degrees) from the zenith, which is +z here, towards +x. Its
  // radiance falls linearly to that of the sky at its radius.
  static void shine(double angle, double radius, double radiance, double rest = 0) {
    Shader sky("VRML97Environment");
    const auto bright = float(radiance), dark = float(rest);
    const float colors[] = {bright, bright, bright, dark, dark, dark}, angles[] = {float(radius)};
    rtBindShader(sky);
    rtParameterfv(rtParameterHandle("skyColor"), 6, colors);
    rtParameterfv(rtParameterHandle("skyAngle"), 1, angles);
    rtBindShader(0);
    rtPushMatrix();
    rtRotated(angle, 0, 1, 0);
    rtRotated(90, 1, 0, 0);
    rtUseEnvironment(sky);
    rtPopMatrix();
  }
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
  static std::string reason() {
    RTstats stats{};
    stats.size = sizeof stats;
    rtGetStats(&stats);
    return stats.transport.reason;
  }
};

// The sun lights a ceiling by way of a mirror on the floor. Light samples cannot find it, and BSDF
// sampling alone would find it with one sample in 50,000.
TEST_F(Sunlight, AMirrorSendsSunlightToACeiling) {
  const double radius = .0046, radiance = 2e5, angle = 45, reflectance = .8, x = -2;
  rtQuality(RT_MAX_DEPTH, 2); // ceiling, mirror, sky; excludes interreflection on the ceiling
  shine(angle, radius, radiance);
  placeAt(0, square(mirror(reflectance), .5));
  placeAt({x, 0, 2}, square(matt(.5), 1), true);
  cameraAt({x, 0, 1.2}, {x, 0, 2}, 20);
  const double irradiance = radiance * pi * radius * radius / 3 * std::cos(angle * degree),
               expected = reflectance * .5 / pi * irradiance;
  expectQ("guided", Scene::mean(picture(8, 1024, 1)), expected, .01);
  EXPECT_NE(reason().find(", guided"), std::string::npos);
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_LIGHT);
  expectQ("light paths", Scene::mean(picture(8, 16384, 1)), expected, .04);
}

// Pictures with photons and pictures with light paths agree with pictures of so few samples that
// neither photons nor light paths take part.
TEST_F(Sunlight, PhotonsAndLightPathsDoNotChangeTheMean) {
  rtQuality(RT_MAX_DEPTH, 6);
  shine(25, .3, 40, .5);
  placeAt(0, square(matt(.7), 3));
  placeAt(.8, sphere(Shader("Glass"), .5));
  placeAt({-1.6, 0, .6}, sphere(mirror(.9), .4));
  cameraAt({0, -4, 2.5}, {0, 0, .4}, 40);
  const auto mean = [](int samples, int rounds) {
    double sum = 0;
    for (int r = 0; r < rounds; r++) sum += Scene::mean(picture(8, samples, 1 + r)) / rounds;
    return sum;
  };
  const double without = mean(8, 256);
  EXPECT_NEAR(mean(512, 4), without, .01 * without);
  EXPECT_NE(reason().find(", guided"), std::string::npos);
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_LIGHT);
  EXPECT_NEAR(mean(512, 4), without, .01 * without);
}

// A sky of one radiance has no sun: nothing is guided, and `light` finds all of it from the camera.
TEST_F(Sunlight, AnEvenSkyHasNoSun) {
  rtQuality(RT_MAX_DEPTH, 6);
  shine(0, .3, 1, 1);
  placeAt(0, square(matt(.7), 3));
  placeAt(.8, sphere(Shader("Glass"), .5));
  cameraAt({0, -4, 2.5}, {0, 0, .4}, 40);
  const std::vector<float> path = picture(8, 64, 1);
  EXPECT_EQ(reason().find(", guided"), std::string::npos);
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_LIGHT);
  EXPECT_EQ(picture(8, 64, 1), path);
}

// Light paths from a sun are worth while if something mirrors or refracts.
TEST_F(Sunlight, WorldsWithASunAndGlassAreLightTraced) {
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_AUTO);
  placeAt(0, square(matt(.7), 3));
  cameraAt({0, -4, 2.5}, {0, 0, .4}, 40);
  const auto chosen = [] {
    picture(4, 2, 1);
    RTstats stats{};
    stats.size = sizeof stats;
    rtGetStats(&stats);
    return stats.transport.chosen;
  };
  shine(25, .005, 40000, .5);
  EXPECT_EQ(chosen(), RT_TRANSPORT_PATH);
  placeAt(.8, sphere(Shader("Glass"), .5));
  EXPECT_EQ(chosen(), RT_TRANSPORT_LIGHT);
  shine(25, .005, .5, .5);
  EXPECT_EQ(chosen(), RT_TRANSPORT_PATH);
}

TEST_F(Sunlight, ThePictureDoesNotDependOnThreads) {
  const RTcontext own = rtGetCurrent();
  for (const RTenum transport : {RT_TRANSPORT_PATH, RT_TRANSPORT_LIGHT}) {
    std::vector<std::vector<float>> pictures;
    for (const char* config : {"threads=1", "threads=3"}) {
      const RTcontext context = rtNewContext(config);
      rtQuality(RT_TRANSPORT, int(transport));
      shine(25, .005, 40000, .5);
      placeAt(0, square(matt(.7), 3));
      placeAt(.8, sphere(Shader("Glass"), .5));
      cameraAt({0, -4, 2.5}, {0, 0, .4}, 40);
      pictures.push_back(picture(20, 32, 1));
      rtDeleteContext(context);
    }
    EXPECT_EQ(pictures[0], pictures[1]);
  }
  rtMakeCurrent(own);
}

} // namespace
} // namespace numeric

// glossy_light.cpp: caustics of glossy surfaces that light paths and camera paths make together
// (render/lights/light_path_weights.h), against path tracing.
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "numeric/support.h"

namespace numeric {
namespace {

constexpr int edge = 16, half = edge / 2, pictures = 24;

// The mean of each quarter of a picture, and its standard error.
struct Quarters {
  std::array<double, 4> mean{}, error{};
};

class GlossyLight : public Scene {
 protected:
  static std::vector<float> picture(RTenum transport, int samples, int seed) {
    rtQuality(RT_TRANSPORT, int(transport));
    rtQuality(RT_SAMPLES_PER_PIXEL, samples);
    rtQuality(RT_SEED, seed);
    return Scene::picture(edge);
  }
  static bool hasGlossyPaths() {
    return std::string(stats().transport.reason).find(", glossy") != std::string::npos;
  }
  // Renders independent pictures, whose spread tells the error of their mean.
  static Quarters quarters(RTenum transport, int samples, int seed) {
    Quarters out;
    for (int p = 0; p < pictures; p++) {
      const std::vector<float> rgba = picture(transport, samples, seed + p);
      for (int q = 0; q < 4; q++) {
        double sum = 0;
        for (int y = q / 2 * half; y < (q / 2 + 1) * half; y++)
          for (int x = q % 2 * half; x < (q % 2 + 1) * half; x++)
            sum += double(rgba[4 * size_t(y * edge + x)]) / (half * half);
        out.mean[size_t(q)] += sum;
        out.error[size_t(q)] += sum * sum;
      }
    }
    for (size_t q = 0; q < 4; q++) {
      out.mean[q] /= pictures;
      const double variance = out.error[q] / pictures - out.mean[q] * out.mean[q];
      out.error[q] = std::sqrt(std::max(0.0, variance) / (pictures - 1));
    }
    return out;
  }
  // Expects the same means by path tracing and with light paths, which are less noisy.
  static void expectSameMeans(const std::function<void()>& build, int pathSamples,
                              int lightSamples) {
    const RTcontext own = rtGetCurrent(), context = rtNewContext("threads=1");
    build();
    const Quarters light = quarters(RT_TRANSPORT_LIGHT, lightSamples, 1000);
    EXPECT_TRUE(hasGlossyPaths()) << stats().transport.reason;
    rtDeleteContext(context);
    rtMakeCurrent(own);
    build();
    const Quarters path = quarters(RT_TRANSPORT_PATH, pathSamples, 1);
    EXPECT_FALSE(hasGlossyPaths());
    for (size_t q = 0; q < 4; q++) {
      const double error = std::hypot(light.error[q], path.error[q]);
      EXPECT_LT(std::fabs(light.mean[q] - path.mean[q]), 3 * error)
          << "quarter " << q << ": " << light.mean[q] << " +- " << light.error[q] << ", "
          << path.mean[q] << " +- " << path.error[q];
    }
  }
  // The camera does not see the lamps, whose edges would be all of the noise.
  static void lookAtTheFloor() {
    rtPushMatrix();
    rtLoadIdentity();
    rtLookAt(0, -2.5, .5, 0, 0, 0, 0, 0, 1);
    rtPerspective(45);
    rtPopMatrix();
  }
  static Shader brass(double roughness) {
    Shader s("Metal");
    s.set("n", {.45, .62, 1.15}).set("k", {3.6, 2.6, 2}).set("roughness", {roughness});
    return s;
  }
  static RTid ball(const Shader& shader, double radius) {
    const RTid object = rtBeginObject(0);
    rtBindShader(shader);
    rtSphere(float(radius));
    rtEndObject();
    rtBindShader(0);
    return object;
  }
};

// A small lamp close to a ball of rough metal, over a matt floor that the camera sees.
TEST_F(GlossyLight, ARoughBallOverAFloor) {
  const auto build = [] {
    placeAt(0, square(matt(.6), 4));
    placeAt({0, 0, 1}, ball(brass(.15), .4));
    placeAt({.9, 0, 1.6}, ball(matt(0, 300), .05));
    lookAtTheFloor();
    rtQuality(RT_MAX_DEPTH, 6);
  };
  expectSameMeans(build, 512, 64);
}

// The same with bumps of shading normals on the glossy surface, a coat with a matt base, and a
// mirror between the glossy surface and the floor.
TEST_F(GlossyLight, ACoatedPanelAndAMirror) {
  const auto build = [] {
    Shader coat("Plastic");
    coat.set("roughness", {.08});
    Shader mirror("Mirror");
    placeAt(0, square(matt(.6), 4));
    placeAt({-.8, 0, 1.5}, square(coat, .5), true);
    placeAt({.8, 0, .4}, ball(brass(.2), .3));
    rtPushMatrix();
    rtTranslated(1.6, 0, 1);
    rtRotated(-90, 0, 1, 0);
    place(square(mirror, .6));
    rtPopMatrix();
    placeAt({-.5, .3, 1.3}, ball(matt(0, 2000), .015));
    lookAtTheFloor();
    rtQuality(RT_MAX_DEPTH, 6);
  };
  expectSameMeans(build, 512, 64);
}

// Rough glass transmits, where both sides count its lobes as Lambertian.
TEST_F(GlossyLight, ABallOfRoughGlass) {
  const auto build = [] {
    Shader glass("RoughGlass");
    glass.set("roughness", {.15});
    placeAt(0, square(matt(.6), 4));
    placeAt({0, 0, .8}, ball(glass, .4));
    placeAt({.3, 0, 2}, ball(matt(0, 300), .05));
    lookAtTheFloor();
    rtQuality(RT_MAX_DEPTH, 6);
  };
  expectSameMeans(build, 512, 64);
}

TEST_F(GlossyLight, ThePictureDoesNotDependOnThreads) {
  std::vector<std::vector<float>> made;
  const RTcontext own = rtGetCurrent();
  for (const char* config : {"threads=1", "threads=2"}) {
    const RTcontext context = rtNewContext(config);
    placeAt(0, square(matt(.6), 4));
    placeAt({0, 0, 1}, ball(brass(.15), .4));
    placeAt({.9, 0, 1.6}, ball(matt(0, 300), .05));
    lookAtTheFloor();
    made.push_back(picture(RT_TRANSPORT_LIGHT, 32, 1));
    EXPECT_TRUE(hasGlossyPaths());
    rtDeleteContext(context);
  }
  rtMakeCurrent(own);
  EXPECT_EQ(made[0], made[1]);
}

} // namespace
} // namespace numeric

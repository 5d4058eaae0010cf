// glossy_light.cpp: light that light paths and camera paths make together
// (render/lights/light_path_weights.h), against path tracing: caustics of glossy surfaces, and what
// mirrors and smooth glass send of emissive shapes. Also how many light paths there are.
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
  // Returns whether the reason for the transport says that light is shared in a way.
  static bool says(const char* way) {
    return std::string(stats().transport.reason).find(way) != std::string::npos;
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
  // Expects the same means by path tracing and with light paths, which are less noisy. way: says
  // that light is shared; empty: it need not be.
  static void expectSameMeans(const std::function<void()>& build, int pathSamples, int lightSamples,
                              const char* way = ", glossy") {
    const RTcontext own = rtGetCurrent(), context = rtNewContext("threads=1");
    build();
    const Quarters light = quarters(RT_TRANSPORT_LIGHT, lightSamples, 1000);
    EXPECT_TRUE(says(way)) << stats().transport.reason;
    rtDeleteContext(context);
    rtMakeCurrent(own);
    build();
    const Quarters path = quarters(RT_TRANSPORT_PATH, pathSamples, 1);
    EXPECT_FALSE(*way && says(way));
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
  // A floor is seen in a mirror, where light paths are connected to it and not to the camera. The
  // lamp is too high to be seen.
  static void aFloorInAMirror(const std::function<void()>& ball) {
    Shader mirror("Mirror");
    placeAt(0, square(matt(.6), 4));
    ball();
    rtPushMatrix();
    rtTranslated(0, 1.5, 1.2);
    rtRotated(90, 1, 0, 0);
    place(square(mirror, 1.2));
    rtPopMatrix();
    rtPushMatrix();
    rtLoadIdentity();
    rtLookAt(0, -1, 1.2, 0, 1.5, .5, 0, 0, 1);
    rtPerspective(30);
    rtPopMatrix();
    rtQuality(RT_MAX_DEPTH, 6);
  }
  // A matt wall is lit by a panel of a half edge and by its image in a mirror on the floor.
  static void aWallOverAMirror(double panel, double radiance, double height) {
    Shader mirror("Mirror");
    placeAt(0, square(mirror, 1.5));
    placeAt(height, square(matt(0, radiance), panel), true);
    rtPushMatrix();
    rtTranslated(0, 1.6, 0);
    rtRotated(90, 1, 0, 0);
    place(square(matt(.6), 3));
    rtPopMatrix();
    rtPushMatrix();
    rtLoadIdentity();
    rtLookAt(0, -2.5, .6, 0, 1.6, .6, 0, 0, 1);
    rtPerspective(12);
    rtPopMatrix();
    rtQuality(RT_MAX_DEPTH, 6);
  }
  // A matt room is lit by a small lamp in a ball of glass: all its light comes by way of the glass.
  static void aRoomWithAGlobeLamp() {
    constexpr double half = 1, reflectance = .4;
    const RTid wall = square(matt(reflectance), half);
    constexpr double turns[6][3] = {{0, 1, 0},   {90, 1, 0}, {180, 1, 0},
                                    {-90, 1, 0}, {90, 0, 1}, {-90, 0, 1}};
    for (const auto& [degrees, x, y] : turns) {
      rtPushMatrix();
      rtRotated(degrees, x, y, 0);
      rtTranslated(0, 0, -half);
      place(wall);
      rtPopMatrix();
    }
    placeAt({.2, .3, .5}, ball(Shader("Glass"), .15));
    placeAt({.2, .3, .5}, ball(matt(0, 200), .1));
    rtPushMatrix();
    rtLoadIdentity();
    rtLookAt(-.8, -.8, -.6, .9, -.2, -.5, 0, 0, 1);
    rtPerspective(60);
    rtPopMatrix();
    rtQuality(RT_MAX_DEPTH, 16); // what deeper paths bring is below the noise
  }
  static double noise(const Quarters& of) {
    return of.error[0] + of.error[1] + of.error[2] + of.error[3];
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
    glass.set("roughness", {.3});
    placeAt(0, square(matt(.6), 4));
    placeAt({0, 0, .6}, ball(glass, .2));
    placeAt({.1, 0, 1.1}, ball(matt(0, 1500), .03));
    lookAtTheFloor();
    rtQuality(RT_MAX_DEPTH, 6);
  };
  expectSameMeans(build, 512, 64);
}

TEST_F(GlossyLight, AFloorInAMirror) {
  const auto build = [] {
    aFloorInAMirror([] {
      placeAt({1, .2, .9}, ball(brass(.15), .3));
      placeAt({1.5, .2, 1.7}, ball(matt(0, 400), .05));
    });
  };
  expectSameMeans(build, 512, 64, ", connected");
}

// The same with a coated panel, whose light comes to a rough floor by way of a second matt surface.
TEST_F(GlossyLight, ARoughFloorInAMirror) {
  const auto build = [] {
    aFloorInAMirror([] {
      Shader coat("Plastic"), metal("Metal");
      coat.set("roughness", {.15});
      metal.set("roughness", {.5});
      placeAt({0, 0, .02}, square(metal, .8));
      placeAt({1.45, .2, 1.35}, square(coat, .1), true);
      placeAt({1.45, .2, 1.2}, ball(matt(0, 600), .03));
      rtPushMatrix();
      rtTranslated(-1.8, 0, 1);
      rtRotated(90, 0, 1, 0);
      place(square(matt(.7), 1));
      rtPopMatrix();
    });
  };
  expectSameMeans(build, 512, 64, ", connected");
}

// A wide lamp, which camera paths find in the mirror, and a small one, which light paths find.
TEST_F(GlossyLight, AWideAndASmallLampOverAMirror) {
  const auto build = [] {
    aWallOverAMirror(.8, 2, 2.5);
    placeAt({1, 0, 1.5}, ball(matt(0, 100), .05));
  };
  expectSameMeans(build, 512, 64, ", shared");
}

// Light of a wide lamp comes through a ball of glass to a matt floor.
TEST_F(GlossyLight, AWideLampThroughGlass) {
  const auto build = [] {
    Shader glass("Glass");
    placeAt(0, square(matt(.6), 4));
    placeAt({0, 0, .6}, ball(glass, .4));
    placeAt(2.5, square(matt(0, 3), 1), true);
    lookAtTheFloor();
    rtQuality(RT_MAX_DEPTH, 6);
  };
  expectSameMeans(build, 512, 64, "");
}

// A ball of rough glass is seen over a mirror. Light paths leave the glass towards the camera, and
// their flux is not scaled as radiance is.
TEST_F(GlossyLight, RoughGlassOverAMirror) {
  const auto build = [] {
    Shader glass("RoughGlass"), mirror("Mirror");
    glass.set("roughness", {.4});
    placeAt(-1.5, square(mirror, 4));
    placeAt({0, 0, 1}, ball(glass, .8));
    placeAt({0, 1, 5}, square(matt(0, 6), 1.5), true);
    rtPushMatrix();
    rtLoadIdentity();
    rtLookAt(0, -6, 1, 0, 0, 1, 0, 0, 1);
    rtPerspective(14);
    rtPopMatrix();
    rtQuality(RT_MAX_DEPTH, 12);
  };
  expectSameMeans(build, 128, 128, "");
}

// The light of a large lamp by way of a mirror is not left to light paths, which bring it in few
// samples.
TEST_F(GlossyLight, AWideLampOverAMirror) {
  aWallOverAMirror(1, 2, 1.5);
  const double light = noise(quarters(RT_TRANSPORT_LIGHT, 64, 1000));
  EXPECT_TRUE(says(", shared")) << stats().transport.reason;
  EXPECT_LT(light, 1.5 * noise(quarters(RT_TRANSPORT_PATH, 64, 1)));
}

TEST_F(GlossyLight, ConnectionsDoNotDependOnThreads) {
  std::vector<std::vector<float>> made;
  const RTcontext own = rtGetCurrent();
  for (const char* config : {"threads=1", "threads=2"}) {
    const RTcontext context = rtNewContext(config);
    aFloorInAMirror([] {
      placeAt({1, .2, .9}, ball(brass(.15), .3));
      placeAt({1.5, .2, 1.7}, ball(matt(0, 400), .05));
    });
    made.push_back(picture(RT_TRANSPORT_LIGHT, 32, 1));
    EXPECT_TRUE(says(", connected"));
    rtDeleteContext(context);
  }
  rtMakeCurrent(own);
  EXPECT_EQ(made[0], made[1]);
}

// Light paths bring nearly all of the noise, so there are several for each camera path.
TEST_F(GlossyLight, ARoomWithAGlobeLamp) {
  expectSameMeans(aRoomWithAGlobeLamp, 128, 32, " light");
}

TEST_F(GlossyLight, SeveralLightPathsDoNotDependOnThreads) {
  std::vector<std::vector<float>> made;
  const RTcontext own = rtGetCurrent();
  for (const char* config : {"threads=1", "threads=2"}) {
    const RTcontext context = rtNewContext(config);
    aRoomWithAGlobeLamp();
    made.push_back(picture(RT_TRANSPORT_LIGHT, 32, 1));
    EXPECT_TRUE(says(" light")) << stats().transport.reason;
    rtDeleteContext(context);
  }
  rtMakeCurrent(own);
  EXPECT_EQ(made[0], made[1]);
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
    EXPECT_TRUE(says(", glossy"));
    rtDeleteContext(context);
  }
  rtMakeCurrent(own);
  EXPECT_EQ(made[0], made[1]);
}

} // namespace
} // namespace numeric

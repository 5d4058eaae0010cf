// hard_cases.cpp: geometry at the limits of single precision: N5, N9, N10, N11, N14, N15, N21, N22
// of the accuracy catalogue.
#include <cstring>
#include <limits>
#include <random>

#include "numeric/support.h"

namespace numeric {
namespace {

class HardCases : public Scene {
 protected:
  static RTid glow(double r, double g, double b) {
    return Shader("VRML97").set("diffuseColor", {0, 0, 0}).set("emissiveColor", {r, g, b});
  }
  static size_t missed(const std::vector<RTray>& rays) {
    std::vector<RThit> hits(rays.size());
    rtCastRays(rays.size(), rays.data(), hits.data());
    size_t count = 0;
    for (const RThit& h : hits) count += !std::isfinite(h.t);
    return count;
  }
};

// A plane of 1e4, seen from a height of 1, ends 1e-4 below the horizon.
TEST_F(HardCases, N5AHorizonAtGrazingAngles) {
  rtPushMatrix();
  rtRotated(-90, 1, 0, 0);
  place(square(glow(1, 1, 1), 1e4));
  rtPopMatrix();
  rtPushMatrix();
  rtTranslated(0, 1, 0);
  rtPerspective(.04);
  rtPopMatrix();
  rtQuality(RT_SAMPLES_PER_PIXEL, 64);
  const std::vector<float> rgba = picture(16);
  const double half = std::tan(.02 * pi / 180), expected = .5 - 1e-4 / (2 * half);
  EXPECT_NEAR(mean(rgba), expected, .01 * expected);
  for (float v : rgba) EXPECT_TRUE(std::isfinite(v));
}

TEST_F(HardCases, N9OfTwoInOnePlaceTheSameIsSeen) {
  std::vector<float> first;
  for (const char* threads : {"threads=1", "threads=2", "threads=8"}) {
    RTcontext before = rtGetCurrent(), context = rtNewContext(threads);
    place(square(glow(1, 0, 0)));
    place(square(glow(0, 1, 0)));
    rtPushMatrix();
    rtTranslated(0, 0, 5);
    rtRotated(20, 1, 1, 0);
    rtPerspective(60);
    rtPopMatrix();
    rtQuality(RT_SAMPLES_PER_PIXEL, 4);
    const std::vector<float> rgba = picture(64);
    if (first.empty()) first = rgba;
    EXPECT_EQ(std::memcmp(first.data(), rgba.data(), rgba.size() * sizeof(float)), 0) << threads;
    rtDeleteContext(context);
    rtMakeCurrent(before);
  }
}

TEST_F(HardCases, N10TinyThingsOnAHugePlane) {
  place(square(glow(1, 1, 1), 1e7));
  const RTid object = rtBeginObject(0);
  rtBegin(RT_QUADS);
  rtVertex3d(-5e-4, -5e-4, 1e-3);
  rtVertex3d(5e-4, -5e-4, 1e-3);
  rtVertex3d(5e-4, 5e-4, 1e-3);
  rtVertex3d(-5e-4, 5e-4, 1e-3);
  rtEnd();
  rtEndObject();
  std::vector<RTray> rays;
  for (int i = 0; i < 400; i++) {
    const double x = (i % 20 - 10) * .37, y = (i / 20 - 10) * .41;
    rtPushMatrix();
    rtTranslated(x, y, 0);
    place(object);
    rtPopMatrix();
    rays.push_back({{float(x), float(y), 1}, 0, {0, 0, -1}, 10});
  }
  rtRender();
  std::vector<RThit> hits(rays.size());
  rtCastRays(rays.size(), rays.data(), hits.data());
  for (const RThit& h : hits) EXPECT_NEAR(h.t, .999, 1e-5);
}

TEST_F(HardCases, N11LongThinStripsAreClosed) {
  const RTid object = rtBeginObject(0);
  constexpr int strips = 100;
  for (int i = 0; i < strips; i++) {
    const double y = 1e-2 * i;
    rtBegin(RT_QUADS);
    rtVertex3d(-5e4, y, 0);
    rtVertex3d(5e4, y, 0);
    rtVertex3d(5e4, 1e-2 * (i + 1), 0);
    rtVertex3d(-5e4, 1e-2 * (i + 1), 0);
    rtEnd();
  }
  rtEndObject();
  place(object);
  rtRender();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> along(-4.9e4, 4.9e4), across(1e-6, 1e-2 * strips - 1e-6),
      tilt(-.3, .3);
  std::vector<RTray> rays;
  for (int i = 0; i < 200000; i++) {
    const float x = float(along(random)), y = float(across(random)), a = float(tilt(random));
    rays.push_back({{x, y, 1}, 0, {a, 0, -1}, std::numeric_limits<float>::infinity()});
  }
  EXPECT_EQ(missed(rays), 0u);
}

// The corners and normals of a ball of 24 x 12 faces.
RTid coarseBall(RTid shader) {
  const RTid object = rtBeginObject(0);
  rtBindShader(shader);
  rtBegin(RT_QUADS);
  const auto corner = [](int ring, int k) {
    const double a = pi * ring / 12, b = 2 * pi * k / 24, x = std::sin(a) * std::cos(b),
                 y = std::cos(a), z = std::sin(a) * std::sin(b);
    rtNormal3f(float(x), float(y), float(z));
    rtVertex3d(x, y, z);
  };
  for (int ring = 0; ring < 12; ring++)
    for (int k = 0; k < 24; k++) {
      corner(ring, k);
      corner(ring, k + 1);
      corner(ring + 1, k + 1);
      corner(ring + 1, k);
    }
  rtEnd();
  rtEndObject();
  rtBindShader(0);
  return object;
}

TEST_F(HardCases, N14ATerminatorOfSmoothNormals) {
  const Shader white("Diffuse");
  use(directional({-1, 0, -.2}));
  const RTid smooth = rtBeginObject(0);
  rtBindShader(white);
  rtSphere(1);
  rtEndObject();
  rtBindShader(0);
  rtPushMatrix();
  rtTranslated(0, 0, 9);
  rtOrtho(2);
  rtPopMatrix();
  rtQuality(RT_SAMPLES_PER_PIXEL, 16);
  const RTid exact = place(smooth);
  const std::vector<float> truth = picture(32);
  rtDeleteInstance(exact);
  place(coarseBall(white));
  const std::vector<float> coarse = picture(32);
  EXPECT_NEAR(mean(coarse), mean(truth), .03 * mean(truth)); // the silhouette accounts for 1.5 %
  for (size_t i = 0; i < truth.size(); i += 4) {
    const double x = (double(i / 4 % 32) + .5) / 16 - 1, y = 1 - (double(i / 4 / 32) + .5) / 16,
                 z2 = 1 - x * x - y * y;
    if (z2 < .25) continue;
    const double cosine = (x + .2 * std::sqrt(z2)) / std::sqrt(1.04);
    if (cosine < -.28) { // more than one facet beyond the terminator
      EXPECT_EQ(coarse[i], 0) << x << ' ' << y;
    }
    if (cosine > .28) { EXPECT_NEAR(coarse[i], truth[i], .08) << x << ' ' << y; }
  }
}

TEST_F(HardCases, N15NormalsOfNoLengthStandForTheFace) {
  const RTid object = rtBeginObject(0);
  rtBindShader(Shader("VRML97"));
  rtBegin(RT_QUADS);
  rtNormal3f(0, 0, 0);
  rtVertex3d(-1, -1, 0);
  rtVertex3d(1, -1, 0);
  rtVertex3d(1, 1, 0);
  rtVertex3d(-1, 1, 0);
  rtEnd();
  rtBegin(RT_TRIANGLES); // narrows to zero width between two corners
  rtNormal3f(0, 0, 1);
  rtVertex3d(2, -1, 0);
  rtNormal3f(0, 0, -1);
  rtVertex3d(4, -1, 0);
  rtNormal3f(0, 0, 1);
  rtVertex3d(2, 1, 0);
  rtEnd();
  rtEndObject();
  rtBindShader(0);
  place(object);
  use(tilted(60));
  expectGrey(look(.3, .2), .4);
  for (int i = 0; i <= 20; i++) EXPECT_TRUE(std::isfinite(look(2.1 + .085 * i, -.95).r));
}

TEST_F(HardCases, N21EyesInOddPlacesSeeNumbers) {
  use(tilted(10));
  const RTid ball = rtBeginObject(0);
  rtSphere(1);
  rtEndObject();
  place(ball);
  place(square(Shader("Glass"), 3));
  for (const double fov : {.001 * 180 / pi, 60., 3.1 * 180 / pi})
    for (const double z :
         {0., 1., .5, -1e-7}) { // at the centre, on the surface, inside, in the plane
      rtPushMatrix();
      rtTranslated(0, 0, z);
      rtPerspective(fov);
      rtPopMatrix();
      for (float v : picture(8)) EXPECT_TRUE(std::isfinite(v)) << fov << ' ' << z;
    }
}

TEST_F(HardCases, N22AnyNumberOfThreadsMakesTheSameBytes) {
  std::vector<float> first;
  for (const char* threads : {"threads=1", "threads=2", "threads=8"}) {
    RTcontext before = rtGetCurrent(), context = rtNewContext(threads);
    place(square(Shader("Diffuse")));
    rtPushMatrix();
    rtTranslated(0, .5, 1);
    rtRotated(180, 1, 0, 0);
    place(square(Shader("Diffuse").set("emission", {4, 3, 2}), .3));
    rtRotated(30, 0, 1, 0);
    place(square(Shader("Glass"), .5));
    rtPopMatrix();
    rtPushMatrix();
    rtTranslated(0, 0, 3);
    rtPerspective(50);
    rtPopMatrix();
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
    rtQuality(RT_SAMPLES_PER_PIXEL, 8);
    const std::vector<float> rgba = picture(50);
    if (first.empty()) first = rgba;
    EXPECT_EQ(std::memcmp(first.data(), rgba.data(), rgba.size() * sizeof(float)), 0) << threads;
    rtDeleteContext(context);
    rtMakeCurrent(before);
  }
}

// Light between walls whose emission is near the largest float adds up to more than a float holds.
TEST_F(HardCases, RadianceBeyondFloatsStaysFinite) {
  for (const double height : {-1., 1.}) placeAt(height, square(matt(.9, 3e38)), height > 0);
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  rtQuality(RT_SAMPLES_PER_PIXEL, 16);
  rtQuality(RT_MAX_DEPTH, 8);
  const Rgba seen = look(0, 0, 0);
  EXPECT_NEAR(seen.r, 1e36, 1e31);
  EXPECT_GT(stats().leftOut.clipped, 1e36);
  rtQuality(RT_MEASURE, RT_MEASURE_ILLUMINANCE);
  EXPECT_NEAR(look(0, 0, 0).g, 1e36, 1e31);
}

} // namespace
} // namespace numeric

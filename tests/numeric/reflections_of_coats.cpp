// reflections_of_coats.cpp: RT_REFLECTION against Fresnel's equations: the light that varnish and
// the surface of plastic reflect, apart from the colour below, under a uniform sky.
#include "numeric/support.h"

namespace numeric {
namespace {

class ReflectionsOfCoats : public Scene {
 protected:
  static constexpr double skyRadiance = 3, index = 1.5;

  void SetUp() override {
    Scene::SetUp();
    Shader sky("VRML97Environment");
    sky.setList("skyColor", {skyRadiance, skyRadiance, skyRadiance});
    rtUseEnvironment(sky);
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  }
  static Shader plastic() {
    return Shader("Plastic")
        .set("color", {.02, .3, .6})
        .set("index", {index})
        .set("roughness", {0});
  }
  // Returns the reflectance of a smooth boundary for unpolarised light.
  static double fresnel(double cosine, double n = index) {
    const double behind = std::sqrt(1 - (1 - cosine * cosine) / (n * n)),
                 s = (cosine - n * behind) / (cosine + n * behind),
                 p = (n * cosine - behind) / (n * cosine + behind);
    return (s * s + p * p) / 2;
  }
  struct Seen {
    Vec all, reflected;
  };
  // Returns what is seen of the origin at an angle from the axis +z.
  static Seen see(double degrees, int samples = 1) {
    rtQuality(RT_SAMPLES_PER_PIXEL, samples);
    rtFrameBuffer(1, 1, RT_RGBA | RT_REFLECTION);
    rtPushMatrix();
    rtLoadIdentity();
    rtRotated(degrees, 0, 1, 0);
    rtTranslated(0, 0, 20);
    rtOrtho(1e-6);
    rtPopMatrix();
    rtRender();
    float rgba[4], reflected[3];
    rtReadPixels(RT_RGBA, rgba, 4);
    rtReadPixels(RT_REFLECTION, reflected, 3);
    return {{rgba[0], rgba[1], rgba[2]}, {reflected[0], reflected[1], reflected[2]}};
  }
  static void expectReflected(const Seen& seen, double expected, double relative = 1e-5) {
    for (const double c : {seen.reflected.x, seen.reflected.y, seen.reflected.z})
      expectClose(c, expected, relative);
  }
};

// Whitted's transport follows what the coat reflects without random decisions.
TEST_F(ReflectionsOfCoats, AreThatOfFresnelWhateverTheColourBelow) {
  place(square(plastic(), 10));
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_WHITTED);
  for (const double degrees : {0.0, 30.0, 60.0, 80.0}) {
    SCOPED_TRACE(degrees);
    expectReflected(see(degrees), skyRadiance * fresnel(std::cos(degrees * pi / 180)));
  }
}

// Path tracing follows it with a probability, and has the colour below besides. With n samples the
// standard deviation is below 2 / sqrt(n) of the value.
TEST_F(ReflectionsOfCoats, HaveTheSameMeanInPathTracing) {
  constexpr int samples = 16384;
  place(square(plastic(), 10));
  for (const double degrees : {0.0, 60.0, 80.0}) {
    SCOPED_TRACE(degrees);
    const Seen seen = see(degrees, samples);
    expectReflected(seen, skyRadiance * fresnel(std::cos(degrees * pi / 180)), 5 * 2 / 128.);
    EXPECT_GT(seen.all.z, 1.5 * seen.reflected.z);
  }
}

// The plane is seen in a mirror above the camera: the mirror dims its light.
TEST_F(ReflectionsOfCoats, AreDimmedByAMirrorThatShowsThem) {
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_WHITTED);
  Shader mirror("Mirror");
  mirror.set("reflectance", {.5, .25, .125});
  rtPushMatrix();
  rtTranslated(-15, 0, 15);
  rtRotated(90, 0, 1, 0);
  place(square(mirror, 10)); // faces +x, in the plane x = -15
  rtPopMatrix();
  // The camera in (0, 0, 15) sees the mirror in (-15, 0, 10), and there the plane in (15, 0, 0).
  place(square(plastic(), 40));
  rtFrameBuffer(1, 1, RT_RGBA | RT_REFLECTION);
  rtPushMatrix();
  rtLoadIdentity();
  rtTranslated(0, 0, 15);
  rtRotated(std::atan2(15, 5) * 180 / pi, 0, 1, 0); // looks towards (-15, 0, -5)
  rtOrtho(1e-6);
  rtPopMatrix();
  rtRender();
  float rgba[4], reflected[3];
  rtReadPixels(RT_RGBA, rgba, 4);
  rtReadPixels(RT_REFLECTION, reflected, 3);
  EXPECT_GT(reflected[0], 0);
  expectClose(reflected[1], reflected[0] / 2);
  expectClose(reflected[2], reflected[0] / 4);
}

// The stock shaders say which of their lobes are coats.
TEST_F(ReflectionsOfCoats, ExistOnRoughVarnishPaintAndHighlights) {
  const auto expectACoat = [](const Shader& shader) {
    place(square(shader, 10));
    const Seen seen = see(30, 1024);
    EXPECT_GT(seen.reflected.x, 0);
    EXPECT_GT(seen.all.x, 1.01 * seen.reflected.x);
  };
  const auto beginAnew = [&] {
    TearDown();
    SetUp();
  };
  expectACoat(plastic().set("roughness", {.3}));
  beginAnew();
  expectACoat(Shader("Phong").set("specularColor", {.5, .5, .5}));
  beginAnew();
  expectACoat(Shader("CarPaint"));
  beginAnew();
  expectACoat(Shader("Reflector").set("dust", {.5}));
}

// Under a black body all light comes from the coat: images of the sky, light samples of an area
// lamp, and the highlight of a point lamp.
TEST_F(ReflectionsOfCoats, AreAllLightOfABlackBody) {
  place(square(plastic().set("color", {0, 0, 0}).set("roughness", {.3}), 10));
  placeAt({0, 3, 4}, square(matt(0, 20), 1), true);
  use(point({-3, 0, 5}, {1, 0, 0}));
  for (const double degrees : {0.0, 30.0, 60.0}) {
    SCOPED_TRACE(degrees);
    const Seen seen = see(degrees, 64);
    EXPECT_GT(seen.all.x, 0);
    expectClose(seen.reflected.x, seen.all.x);
    expectClose(seen.reflected.y, seen.all.y);
    expectClose(seen.reflected.z, seen.all.z);
  }
}

// The highlight of a lamp has its closed form, and the colour below is not part of it.
TEST_F(ReflectionsOfCoats, HoldTheHighlightsOfLamps) {
  rtUseEnvironment(0);
  Shader phong("Phong");
  phong.set("specularColor", {.25, .25, .25}).set("diffuseColor", {.5, .5, .5});
  place(square(phong, 10));
  use(point({0, 0, 5}, {1, 0, 0}));
  const Seen both = see(20);
  phong.set("diffuseColor", {0, 0, 0});
  const Seen highlight = see(20);
  EXPECT_GT(highlight.all.x, 0);
  expectClose(both.reflected.x, highlight.all.x);
  EXPECT_GT(both.all.x, 1.1 * both.reflected.x);
}

TEST_F(ReflectionsOfCoats, DoNotExistWithoutACoat) {
  for (const char* name : {"Diffuse", "Mirror", "Metal", "Glass"}) {
    SCOPED_TRACE(name);
    TearDown();
    SetUp();
    place(square(Shader(name), 10));
    expectReflected(see(30, 64), 0);
  }
}

// A part of the light is never more than the whole, also where coats see each other.
TEST_F(ReflectionsOfCoats, AreNeverMoreThanTheRadiance) {
  place(square(plastic(), 10));
  placeAt(3, square(plastic(), 1), true);
  for (const double degrees : {10.0, 50.0}) {
    SCOPED_TRACE(degrees);
    const Seen seen = see(degrees, 256);
    EXPECT_GT(seen.reflected.x, 0);
    EXPECT_LE(seen.reflected.x, seen.all.x);
    EXPECT_LE(seen.reflected.y, seen.all.y);
    EXPECT_LE(seen.reflected.z, seen.all.z);
  }
}

TEST_F(ReflectionsOfCoats, AreNotFollowedInDirectLight) {
  place(square(plastic(), 10));
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_DIRECT);
  expectReflected(see(30), 0);
}

} // namespace
} // namespace numeric

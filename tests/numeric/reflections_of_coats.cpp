// reflections_of_coats.cpp: RT_REFLECTION against Fresnel's equations: the light that varnish and
// the surface of plastic reflect, apart from the colour below. The sky is uniform, so reflections
// have no noise.
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
  static Shader plastic(double roughness = 0) {
    return Shader("Plastic").set("color", {.02, .3, .6}).set("index", {index}).set(
        "roughness", {roughness});
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

TEST_F(ReflectionsOfCoats, AreThatOfFresnelWhateverTheColourBelow) {
  place(square(plastic(), 10));
  for (const double degrees : {0.0, 30.0, 60.0, 80.0}) {
    SCOPED_TRACE(degrees);
    const Seen seen = see(degrees);
    expectReflected(seen, skyRadiance * fresnel(std::cos(degrees * pi / 180)));
    EXPECT_GT(seen.all.z, seen.reflected.z); // the colour below is not part of it
  }
}

// A glossy coat reflects the sky by its facets. Light samples of the lobe are not part of the
// channel, so a mean over many samples is less than what the coat reflects in all.
TEST_F(ReflectionsOfCoats, OfRoughCoatsAreTheDirectionsOfTheirLobe) {
  place(square(plastic(.1), 10));
  const Seen seen = see(0, 4096);
  EXPECT_GT(seen.reflected.x, 0);
  EXPECT_LT(seen.reflected.x, 1.05 * skyRadiance * fresnel(1));
  expectReflected(seen, seen.reflected.x, 1e-5); // no colour
}

TEST_F(ReflectionsOfCoats, AreDimmedByAMirrorThatShowsThem) {
  Shader mirror("Mirror");
  mirror.set("reflectance", {.5, .25, .125});
  place(square(plastic(), 10));
  // The camera looks up at a mirror in z = 30, which shows the plane below.
  placeAt(30, square(mirror, 10), true);
  rtPushMatrix();
  rtLoadIdentity();
  rtTranslated(0, 0, 20);
  rtRotated(180, 1, 0, 0);
  rtOrtho(1e-6);
  rtPopMatrix();
  rtFrameBuffer(1, 1, RT_RGBA | RT_REFLECTION);
  rtRender();
  float reflected[3];
  rtReadPixels(RT_REFLECTION, reflected, 3);
  // The coat reflects the mirror, which reflects the plane, and so on: the colours fade as the
  // mirror's.
  EXPECT_GT(reflected[0], reflected[1]);
  EXPECT_GT(reflected[1], reflected[2]);
}

TEST_F(ReflectionsOfCoats, DoNotExistWithoutACoat) {
  for (const char* name : {"Diffuse", "Mirror", "Metal", "Glass"}) {
    SCOPED_TRACE(name);
    TearDown();
    SetUp();
    place(square(Shader(name), 10));
    expectReflected(see(30), 0);
  }
}

// The parts that a surface shows are those of the whole, also at a second coat: it belongs to what
// the first one reflects or to the light on the first one.
TEST_F(ReflectionsOfCoats, AreNeverMoreThanTheRadiance) {
  place(square(plastic(), 10));
  placeAt(3, square(plastic(.05), 1), true);
  for (const double degrees : {10.0, 50.0}) {
    SCOPED_TRACE(degrees);
    const Seen seen = see(degrees, 256);
    EXPECT_LE(seen.reflected.x, seen.all.x);
    EXPECT_LE(seen.reflected.y, seen.all.y);
    EXPECT_LE(seen.reflected.z, seen.all.z);
  }
}

TEST_F(ReflectionsOfCoats, AreZeroWithoutRandomPaths) {
  place(square(plastic(), 10));
  for (const int transport : {RT_TRANSPORT_DIRECT, RT_TRANSPORT_WHITTED}) {
    rtQuality(RT_TRANSPORT, transport);
    expectReflected(see(30), 0);
  }
}

} // namespace
} // namespace numeric

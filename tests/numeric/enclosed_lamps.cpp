// enclosed_lamps.cpp: RT_TRANSPORT_LIGHT with point lights behind glass and mirrors. The
// attenuation counts the whole way to the first surface that scatters. Glass of index 1 is
// invisible, so the picture must equal the one with straight shadow rays.
#include <cmath>
#include <string>
#include <vector>

#include "numeric/support.h"

namespace numeric {
namespace {

constexpr double lampAt = 2;

class EnclosedLamps : public Scene {
 protected:
  void SetUp() override {
    Scene::SetUp();
    rtPushMatrix();
    rtLoadIdentity();
    rtTranslated(0, 0, 1.4); // under the ball, towards the floor
    rtPerspective(100);
    rtPopMatrix();
  }
  static Shader lamp(bool spot, const std::vector<double>& attenuation) {
    Shader s(spot ? "VRML97SpotLight" : "VRML97PointLight");
    s.set("location", {0, 0, lampAt})
        .set("attenuation", {attenuation[0], attenuation[1], attenuation[2]});
    if (spot) s.set("direction", {.2, 0, -1}).set("beamWidth", {.3}).set("cutOffAngle", {.7});
    return s;
  }
  static Shader floor(bool material) {
    return material ? Shader("VRML97").set("diffuseColor", {.5, .5, .5})
                    : Shader("Diffuse").set("reflectance", {.5, .5, .5});
  }
  static RTid ball(double radius, double z = lampAt) {
    const RTid object = rtBeginObject(0);
    rtBindShader(Shader("Glass").set("index", {1}));
    rtSphere(radius);
    rtEndObject();
    rtBindShader(0);
    return placeAt(z, object);
  }
  // Returns the picture's mean for a transport.
  static double meanOf(RTenum transport) {
    rtQuality(RT_TRANSPORT, transport);
    rtQuality(RT_SAMPLES_PER_PIXEL, transport == RT_TRANSPORT_LIGHT ? 512 : 64);
    const double value = mean(picture(8));
    EXPECT_EQ(stats().transport.chosen, transport);
    return value;
  }
  static void expectAsThroughAir() { expectLit(meanOf(RT_TRANSPORT_PATH)); }
  static void expectLit(double expected) {
    EXPECT_GT(expected, .001);
    EXPECT_NEAR(meanOf(RT_TRANSPORT_LIGHT), expected, .02 * expected);
  }
};

struct Case {
  const char* name;
  bool spot, material;
  std::vector<double> attenuation;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class EnclosedLampsOnFloors : public EnclosedLamps, public testing::WithParamInterface<Case> {};

TEST_P(EnclosedLampsOnFloors, GlassOfIndexOneTakesNoLight) {
  place(square(floor(GetParam().material), 3));
  use(lamp(GetParam().spot, GetParam().attenuation));
  const double withoutGlass = meanOf(RT_TRANSPORT_PATH);
  for (const double radius : {.05, .1, .5}) {
    SCOPED_TRACE(radius);
    const RTid glass = ball(radius);
    expectLit(withoutGlass);
    rtDeleteInstance(glass);
  }
}

INSTANTIATE_TEST_SUITE_P(All, EnclosedLampsOnFloors,
                         testing::Values(Case{"PointConstant", false, false, {1, 0, 0}},
                                         Case{"PointBySquare", false, false, {0, 0, 1}},
                                         Case{"PointOfAllTerms", false, false, {.5, .3, .2}},
                                         Case{"SpotConstant", true, false, {1, 0, 0}},
                                         Case{"SpotBySquare", true, false, {0, 0, 1}},
                                         Case{"PointConstantOnVrml97", false, true, {1, 0, 0}},
                                         Case{"PointBySquareOnVrml97", false, true, {0, 0, 1}},
                                         Case{"SpotConstantOnVrml97", true, true, {1, 0, 0}},
                                         Case{"SpotBySquareOnVrml97", true, true, {0, 0, 1}}),
                         [](const testing::TestParamInfo<Case>& of) {
                           return std::string(of.param.name);
                         });

TEST_F(EnclosedLamps, ABallBetweenTheLampAndTheFloor) { // part of the light passes through the ball
  place(square(floor(false), 3));
  ball(.15, lampAt - .4);
  use(lamp(false, {1, 0, 0}));
  expectAsThroughAir();
}

// A light without shadows shines straight through the glass. Light that reaches the floor through
// the glass must not be added to that.
TEST_F(EnclosedLamps, ALightWithoutShadowsCountsOnce) {
  place(square(floor(false), 3));
  use(lamp(false, {1, 0, 0}).setInt("shadows", 0));
  const double withoutGlass = meanOf(RT_TRANSPORT_PATH);
  ball(.5, lampAt - .8);
  expectLit(withoutGlass);
}

TEST_F(EnclosedLamps, ShellsInShellsAndALampInAScaledSpace) {
  place(square(floor(false), 3));
  for (const double radius : {.05, .2, .45}) ball(radius);
  rtPushMatrix();
  rtTranslated(0, 0, lampAt);
  rtScaled(3, 3, 3); // the attenuation uses distances in the lamp's own space
  use(Shader("VRML97PointLight").set("attenuation", {.1, .5, 2}));
  rtPopMatrix();
  expectAsThroughAir();
}

// Light that a floor scatters to the wall no longer depends on the distance to the lamp.
TEST_F(EnclosedLamps, ScatteredLightKeepsItsAttenuation) {
  place(square(floor(false), 3));
  rtPushMatrix();
  rtTranslated(-1.2, 0, 0);
  rtRotated(90, 0, 1, 0);
  place(square(floor(true), 3));
  rtPopMatrix();
  ball(.1);
  use(lamp(false, {1, 0, 0}));
  expectAsThroughAir();
}

TEST_F(EnclosedLamps, NothingIsLitBeyondTheRadiusOfTheLamp) {
  place(square(floor(false), 3));
  ball(.1);
  use(lamp(false, {0, 0, 1}).set("radius", {lampAt - .01}));
  EXPECT_EQ(meanOf(RT_TRANSPORT_LIGHT), 0);
}

// The illuminance falls with the square of the distance.
TEST_F(EnclosedLamps, AMeasuredLuminaireInGlass) {
  place(square(floor(false), 3));
  Shader s("Luminaire");
  s.set("location", {0, 0, lampAt});
  const std::string profile =
      "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0\n1 1 1\n0 45 90\n0\n10 5 0\n";
  rtBindShader(s);
  rtParameterString(rtParameterHandle("profile"), profile.c_str());
  rtBindShader(0);
  ball(.1);
  use(s);
  expectAsThroughAir();
}

// A mirror under the lamp lights a ceiling like the lamp's mirror image, attenuated by the distance
// of the image.
TEST_F(EnclosedLamps, AMirrorShowsTheLampAtItsImage) {
  constexpr double ceilingAt = 2, height = 1.5, reflectance = .8, x = .7, reach = .5;
  const double attenuation[3] = {.2, .4, .1};
  rtPushMatrix();
  rtTranslated(0, 0, ceilingAt);
  rtRotated(180, 1, 0, 0);
  place(square(floor(false), 10));
  rtPopMatrix();
  place(square(Shader("Mirror").set("reflectance", {reflectance, reflectance, reflectance}), .7));
  use(lamp(false, {.2, .4, .1}).set("location", {0, 0, height}));
  rtPushMatrix();
  rtLoadIdentity();
  rtLookAt(x, 0, 1.2, x, 0, ceilingAt, 0, 1, 0);
  rtPerspective(2 * std::atan(reach / (ceilingAt - 1.2)) * 180 / pi);
  rtPopMatrix();
  const auto from = [&](double px, double py, double h) {
    const double d = std::sqrt(px * px + py * py + h * h);
    return .5 * h / d / std::fmax(attenuation[0] + d * (attenuation[1] + d * attenuation[2]), 1);
  };
  double direct = 0, mirrored = 0;
  constexpr int n = 50;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      const double px = x + reach * (2 * (i + .5) / n - 1), py = reach * (2 * (j + .5) / n - 1);
      direct += from(px, py, ceilingAt - height) / (n * n);
      mirrored += reflectance * from(px, py, ceilingAt + height) / (n * n);
    }
  rtQuality(RT_MAX_DEPTH, 2);
  const double before = meanOf(RT_TRANSPORT_PATH); // includes interreflection on the ceiling
  EXPECT_NEAR(meanOf(RT_TRANSPORT_LIGHT) - before, mirrored, .04 * mirrored);
  ball(.1, height);           // all light is now traced from the lamp
  rtQuality(RT_MAX_DEPTH, 3); // ball, mirror, ceiling
  EXPECT_NEAR(meanOf(RT_TRANSPORT_LIGHT), direct + mirrored, .04 * (direct + mirrored));
}

TEST_F(EnclosedLamps, ThePictureDoesNotDependOnThreads) {
  std::vector<std::vector<float>> pictures;
  const RTcontext own = rtGetCurrent();
  for (const char* config : {"threads=1", "threads=3"}) {
    const RTcontext context = rtNewContext(config);
    rtLoadIdentity();
    place(square(floor(false), 3));
    ball(.1);
    ball(.3);
    use(lamp(true, {.5, .3, .2}));
    rtPushMatrix();
    rtLoadIdentity();
    rtTranslated(0, 0, 1.4);
    rtPerspective(100);
    rtPopMatrix();
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_LIGHT);
    rtQuality(RT_SAMPLES_PER_PIXEL, 32);
    pictures.push_back(picture(20));
    EXPECT_GT(mean(pictures.back()), 0);
    rtDeleteContext(context);
  }
  rtMakeCurrent(own);
  EXPECT_EQ(pictures[0], pictures[1]);
}

} // namespace
} // namespace numeric

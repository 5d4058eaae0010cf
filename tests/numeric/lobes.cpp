// lobes.cpp: surfaces described by lobes, against closed forms: mirrors, glass, metal, furnaces
// (accuracy catalogue D1 to D15, G1, G2, G4). Uses the C API.
#include "numeric/support.h"

namespace numeric {
namespace {

class Lobes : public Scene {
 protected:
  void SetUp() override {
    Scene::SetUp();
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_WHITTED); // emissive surfaces would select path tracing
  }
  static Shader glowing(double radiance, double reflectance = 0) {
    Shader s("Diffuse");
    s.set("reflectance", {reflectance, reflectance, reflectance})
        .set("emission", {radiance, radiance, radiance});
    return s;
  }
  static void slab(double top, double bottom, RTid glass) {
    placeAt(top, square(glass));
    placeAt(bottom, square(glass), true);
  }
  static void environment(double radiance) {
    Shader sky("VRML97Environment");
    const float r = float(radiance);
    sky.setList("skyColor", {r, r, r});
    rtUseEnvironment(sky);
  }
};

constexpr double R = .04; // reflectance of glass of index 1.5 at normal incidence

TEST_F(Lobes, DiffuseAnswersLightsAsLambertSays) {
  Shader s("Diffuse");
  s.set("reflectance", {.5, .25, .125});
  place(square(s));
  use(tilted(60));
  expectColor(look(), {.25, .125, .0625});
}

TEST_F(Lobes, D1ASlabLetsThroughAllInnerReflections) {
  slab(2, 1, Shader("Glass"));
  placeAt(0, square(glowing(1)));
  expectGrey(look(), (1 - R) / (1 + R), 1e-4); // the ray tree is cut off at 1/4096 of the light
}

TEST_F(Lobes, D1ASlabReflectsTheRest) {
  slab(2, 1, Shader("Glass"));
  placeAt(0, square(glowing(0)));
  rtPushMatrix();
  placeAt(30, square(glowing(1)), true);
  rtPopMatrix();
  expectGrey(look(), 2 * R / (1 + R), 1e-3);
}

TEST_F(Lobes, D2ASlabThatAbsorbs) {
  Shader glass("Glass");
  glass.set("absorption", {1, 2, 0});
  slab(2, 1, glass);
  placeAt(0, square(glowing(1)));
  const auto t = [](double a) { return (1 - R) * (1 - R) * a / (1 - R * R * a * a); };
  EXPECT_NEAR(t(std::exp(-1)), .339111, 1e-6);
  expectColor(look(), {t(std::exp(-1)), t(std::exp(-2)), t(1)}, 1e-4);
}

TEST_F(Lobes, D3FresnelAtFortyFiveDegreesAveragedAtEachBoundary) {
  rtPushMatrix();
  rtRotated(45, 0, 1, 0);
  slab(.5, -.5, Shader("Glass"));
  rtPopMatrix();
  placeAt(-30, square(glowing(1), 100));
  const double r = .050240;
  expectGrey(look(), (1 - r) / (1 + r), 1e-4);
}

TEST_F(Lobes, MetalReflectsByItsComplexIndex) {
  Shader metal("Metal");
  metal.set("n", {.96, .96, .2}).set("k", {6.69, 6.69, 3.912});
  const double expected[][3] = {
      {0, .920984, .952221}, {45, .917204, .950317}, {60, .906746, 0}, {80, .867619, .948525}};
  for (const auto& row : expected) {
    rtPushMatrix();
    rtRotated(row[0], 0, 1, 0);
    const RTid mirror = place(square(metal));
    rtPopMatrix();
    environment(1);
    const Rgba pixel = look();
    expectClose(pixel.r, row[1], 2e-6);
    if (row[2] > 0) expectClose(pixel.b, row[2], 2e-6);
    rtDeleteInstance(mirror);
  }
}

// D13: the eye looks into a corner of 90 / n degrees. Here two mirrors face each other and the sky
// is seen past the edge of the upper one. Each image of it is dimmer by the reflectance.
TEST_F(Lobes, D13EveryImageIsDimmerByTheReflectance) {
  Shader mirror("Mirror");
  environment(1);
  placeAt(0, square(mirror, 1000));
  rtPushMatrix();
  rtTranslated(0, 0, 1);
  rtRotated(180, 1, 0, 0);
  rtTranslated(-10, 0, 0);
  place(square(mirror, 10)); // from x = 0 to 20, seen from below: turned about x
  rtPopMatrix();
  // Downwards at 45 degrees, the ray hits each mirror every 2 units of x.
  rtPushMatrix();
  rtLoadIdentity();
  rtLookAt(-.4, 0, .5, -.9, 0, 0, 0, 1, 0);
  rtOrtho(1e-6);
  rtPopMatrix();
  const Rgba pixel = render();
  expectGrey(pixel, std::pow(.9, 21),
             1e-5); // ten pairs, and the lower mirror once more on the way out
}

TEST_F(Lobes, AMirrorShowsTheSkyTimesItsReflectance) {
  Shader mirror("Mirror");
  mirror.set("reflectance", {.9, .5, .1});
  place(square(mirror));
  environment(2);
  const Rgba pixel = look();
  expectColor(pixel, {1.8, 1, .2});
  EXPECT_EQ(pixel.a, 1);
}

// D15: N boundaries, all orders of reflection: T = (1 - R) / (1 + (N - 1) R)
TEST_F(Lobes, AStackOfPanesHasItsClosedForm) {
  rtQuality(RT_MAX_DEPTH, 200);
  for (int pane = 0; pane < 3; ++pane) slab(2 + pane, 1.5 + pane, Shader("Glass"));
  placeAt(0, square(glowing(1)));
  expectGrey(look(), (1 - R) / (1 + 5 * R), 1e-3);
}

// G1: reflectance and transmittance add up to 1.
TEST_F(Lobes, GlassIsInvisibleInAFurnace) {
  Shader glass("Glass");
  const RTid ball = rtBeginObject(0);
  rtBindShader(glass);
  rtSphere(1);
  rtEndObject();
  rtBindShader(0);
  place(ball);
  environment(1);
  for (double x : {0., .3, .6, .9}) expectGrey(look(x), 1, 2e-3);
}

TEST_F(Lobes, G2AndG4AClosedFurnaceByPathTracing) {
  const double emission = .5, albedo = .5;
  const Shader wall = glowing(emission, albedo);
  const RTid box = rtBeginObject(0);
  rtBindShader(wall);
  rtSphere(30);
  rtEndObject();
  rtBindShader(0);
  place(box);
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  rtQuality(RT_SAMPLES_PER_PIXEL, 64);
  for (int bounces : {0, 1, 2}) { // before Russian roulette starts: every path is the same
    rtQuality(RT_MAX_DEPTH, bounces);
    expectGrey(look(), emission * (1 - std::pow(albedo, bounces + 1)) / (1 - albedo));
  }
  rtQuality(RT_MAX_DEPTH, 60);
  rtQuality(RT_SAMPLES_PER_PIXEL, 4096);
  expectGrey(look(), emission / (1 - albedo), 5e-3);
}

// Radiance of a white surface lit by an area light of radiance 1, over many samples: E / pi.
class AreaLights : public Lobes {
 protected:
  void SetUp() override {
    Lobes::SetUp();
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
    rtQuality(RT_MAX_DEPTH, 1);
    rtQuality(RT_SAMPLES_PER_PIXEL, 65536);
    Shader white("Diffuse");
    white.set("reflectance", {1, 1, 1});
    place(square(white, 100));
  }
  static double lit(double x = 0) { return look(x, 0, .001).g; } // seen from below the light
};

TEST_F(AreaLights, R10ARectangleAboveThePoint) {
  placeAt(1, square(glowing(1), .5), true);
  EXPECT_NEAR(lit(), .75227469 / pi, 2.5e-4); // R7: unit square centred at height 1
}

TEST_F(AreaLights, R10ARectangleOverItsCorner) {
  rtPushMatrix();
  rtTranslated(.5, .5, 0);
  placeAt(1, square(glowing(1), .5), true);
  rtPopMatrix();
  EXPECT_NEAR(lit(), .13853161, 2.5e-4); // a = b = c = 1
}

TEST_F(AreaLights, R10ALargeSquareVeryNear) {
  placeAt(.01, square(glowing(1), 1), true);
  EXPECT_NEAR(lit(), .99991818, 2e-3);
}

TEST_F(AreaLights, R7ATriangle) {
  const RTid object = rtBeginObject(0);
  rtBindShader(glowing(1));
  rtBegin(RT_TRIANGLES);
  rtVertex3f(1, 0, 1);
  rtVertex3f(0, 1, 1);
  rtVertex3f(-1, -1, 1);
  rtEnd();
  rtEndObject();
  rtBindShader(0);
  place(object);
  EXPECT_NEAR(lit(), .94357481 / pi, 2.5e-4);
}

TEST_F(AreaLights, TwoLightsOfUnequalPowerAddUp) {
  placeAt(1, square(glowing(1), .5), true);
  placeAt(2, square(glowing(30), .01), true);
  const double small = 30 * .02 * .02 / 4; // far away: area over squared distance, divided by pi
  EXPECT_NEAR(lit(), .75227469 / pi, 1e-3 + small / pi) << "the nearer one hides the other";
}

TEST_F(AreaLights, R11ALightSeenFromBehindItsCulledBackIsNotThere) {
  Shader lamp = glowing(1);
  const RTid object = rtBeginObject(0);
  rtEnable(RT_CULL_FACE);
  rtBindShader(lamp);
  rtBegin(RT_TRIANGLES);
  rtVertex3f(1, 0, 1);
  rtVertex3f(0, 1, 1);
  rtVertex3f(-1, -1, 1); // faces up
  rtEnd();
  rtEndObject();
  rtBindShader(0);
  place(object);
  EXPECT_EQ(lit(), 0);
}

TEST_F(AreaLights, G8HalfOfTheSky) {
  environment(1);
  const RTid wall = square(Shader("Diffuse").set("reflectance", {0, 0, 0}), 1e4);
  rtPushMatrix();
  rtTranslated(.002, 0, 0);
  rtRotated(90, 0, 1, 0);
  place(wall);
  rtPopMatrix();
  EXPECT_NEAR(lit(), .5, 5e-3);
}

TEST_F(AreaLights, G1AWhitePlaneUnderAWhiteSkyIsWhite) {
  environment(1);
  EXPECT_NEAR(lit(), 1, 1e-3);
}

// Both strategies of multiple importance sampling.
TEST_F(AreaLights, ThePartsThatEitherWayFindsAddUpWhateverTheSize) {
  for (const double half : {.05, .5, 5.}) {
    const RTid lamp = square(glowing(1), half);
    rtPushMatrix();
    rtTranslated(0, 0, 1);
    rtRotated(180, 1, 0, 0);
    const RTid placed = place(lamp);
    rtPopMatrix();
    // Four times the corner of a half x half rectangle at height 1.
    const double s = std::sqrt(1 + half * half),
                 f = 2 / pi * 2 * (half / s) * std::atan(half / s) / 2;
    EXPECT_NEAR(lit(), 2 * f, std::max(2.5e-4, 1e-3 * f)) << half;
    rtDeleteInstance(placed);
  }
}

TEST_F(Lobes, SeveralLightsAddUpInEveryColour) {
  place(square(Shader("Diffuse").set("reflectance", {.8, .6, .4})));
  const double colors[3][3] = {{.1, .2, .3}, {.4, 0, .1}, {0, .3, .2}};
  for (const auto& c : colors)
    rtUseLight(Shader("VRML97DirectionalLight").set("color", {c[0], c[1], c[2]}));
  for (const int transport : {RT_TRANSPORT_DIRECT, RT_TRANSPORT_WHITTED, RT_TRANSPORT_PATH}) {
    rtQuality(RT_TRANSPORT, transport);
    expectColor(look(), {.8 * .5, .6 * .5, .4 * .6});
  }
}

TEST_F(Lobes, DirectTransportFollowsNothing) {
  Shader mirror("Mirror");
  place(square(mirror));
  environment(1);
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_DIRECT);
  expectGrey(look(), 0);
}

} // namespace
} // namespace numeric

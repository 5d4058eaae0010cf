// lighting.cpp: the lighting equation of VRML97 (ISO/IEC 14772-1 clause 4.14) through the C API and
// the renderer: test points V1 to V6, V8, V11 and V12, and irradiance R1 to R3, of the accuracy
// catalogue.
#include "numeric/support.h"

namespace numeric {
namespace {

class Lighting : public Scene {
 protected:
  void SetUp() override {
    Scene::SetUp();
    place(square(Shader("VRML97")));
  }
  static void only(RTid& light, const Shader& shader) {
    if (light) rtRemoveLight(light);
    light = use(shader);
  }
};

TEST_F(Lighting, V1DirectionalFollowsTheCosine) {
  RTid light = 0;
  for (const auto& [angle, expected] :
       {std::pair{0, .8}, {60, .4}, {90, 0.}, {120, 0.}, {180, 0.}}) {
    only(light, tilted(angle));
    expectGrey(look(), expected);
  }
}

TEST_F(Lighting, V2InverseSquareIsNeverAboveOne) {
  RTid light = 0;
  only(light, point({0, 0, 2}, {0, 0, 1}));
  expectGrey(look(), .2);
  only(light, point({0, 0, .5}, {0, 0, 1}));
  expectGrey(look(), .8);
}

TEST_F(Lighting, V3AttenuationOfAllThreeTerms) {
  use(point({0, 0, 3}, {1, 1, 1}));
  expectGrey(look(), .8 / 13);
}

TEST_F(Lighting, AttenuationZeroActsAsOne) {
  use(point({0, 0, 3}, {0, 0, 0}));
  expectGrey(look(), .8);
}

TEST_F(Lighting, V4AmbientPart) {
  RTid light = 0;
  only(light, tilted(0).set("ambientIntensity", {.5}));
  expectGrey(look(), .88);
  only(light, tilted(90).set("ambientIntensity", {.5}));
  expectGrey(look(), .08);
}

TEST_F(Lighting, V6SpotBetweenItsAngles) {
  RTid light = 0;
  for (const auto& [angle, factor] :
       {std::pair{.45, .5}, {.3, 1.}, {.6, 0.}, {0., 1.}, {.62, 0.}}) {
    Shader spot("VRML97SpotLight");
    spot.set("beamWidth", {.3}).set("cutOffAngle", {.6}).set("location", {0, 0, 2});
    spot.set("direction", {std::sin(angle), 0, -std::cos(angle)});
    only(light, spot);
    expectClose(look().r, .8 * factor, 1e-5, .1);
  }
}

TEST_F(Lighting, V6DefaultSpotIsAHardCone) {
  RTid light = 0;
  for (const auto& [angle, expected] : {std::pair{.70, .8}, {.80, 0.}, {.78, .8}, {.79, 0.}}) {
    Shader spot("VRML97SpotLight");
    spot.set("location", {0, 0, 2}).set("direction", {std::sin(angle), 0, -std::cos(angle)});
    only(light, spot);
    expectGrey(look(), expected);
  }
}

TEST_F(Lighting, V8DistanceIsTheLightsOwn) {
  rtPushMatrix();
  rtScaled(2, 2, 2);
  use(point({0, 0, 1}, {0, 0, 1})); // distance 2 in the world, 1 in the light's own space
  rtPopMatrix();
  expectGrey(look(), .8);
}

TEST_F(Lighting, V8ConeAndDistanceUnderNonUniformScale) {
  // Scaled by 3 along z, the point (1, 0, 0) lies at (1, 0, -1) in the light's space: 45 degrees
  // off its axis, at distance sqrt 2.
  Shader spot("VRML97SpotLight");
  spot.set("attenuation", {0, 0, 1})
      .set("beamWidth", {.5})
      .set("cutOffAngle", {1})
      .set("location", {0, 0, 1});
  rtPushMatrix();
  rtScaled(1, 1, 3);
  use(spot);
  rtPopMatrix();
  const double factor = (1 - pi / 4) / .5, cosine = 3 / std::sqrt(10.0);
  expectGrey(look(1), .8 * factor / 2 * cosine);
}

TEST_F(Lighting, V11RadiusInTheLightsOwnUnits) {
  RTid light = 0;
  for (const auto& [d, expected] : {std::pair{4.999, .8}, {5.001, 0.}}) {
    only(light, point({0, 0, d}, {1, 0, 0}).set("radius", {5}));
    expectGrey(look(), expected);
    rtPushMatrix();
    rtScaled(2, 2, 2); // the limit in the world is 10
    only(light, point({0, 0, d}, {1, 0, 0}).set("radius", {5}));
    rtPopMatrix();
    expectGrey(look(), expected);
  }
}

TEST_F(Lighting, V12ManyLightsAddUp) {
  double sum = 0;
  int lights = 0;
  for (const int wanted : {8, 9, 200}) {
    for (; lights < wanted; lights++) {
      const double angle = lights * 0.4;
      use(tilted(angle).set("intensity", {0.25}));
      sum += .25 * .8 * std::cos(angle * pi / 180);
    }
    expectGrey(look(), sum);
  }
}

TEST_F(Lighting, R1PointLightOnAPlane) {
  const double h = 2, intensity = 5;
  use(point({0, 0, h}, {0, 0, 1}).set("intensity", {intensity}));
  for (const double x : {0., .5, 1., 3., 7.}) {
    const double d2 = h * h + x * x;
    expectClose(look(x).r, .8 * intensity * h / std::pow(d2, 1.5), 1e-5, 1e-4);
    expectClose(look(0, -x).r, .8 * intensity * h / std::pow(d2, 1.5), 1e-5, 1e-4);
  }
}

TEST_F(Lighting, R2DirectionalAtEveryAngle) {
  RTid light = 0;
  for (int angle = 0; angle <= 175; angle += 5) {
    only(light, tilted(angle).set("intensity", {3}));
    const double cosine = angle < 90 ? std::cos(angle * pi / 180) : 0;
    expectClose(look().r, .8 * 3 * cosine, 1e-6, 1);
  }
}

TEST_F(Lighting, R3SpotAcrossItsCone) {
  const double h = 2, beam = .3, cut = .9;
  Shader spot("VRML97SpotLight");
  spot.set("attenuation", {0, 0, 1})
      .set("beamWidth", {beam})
      .set("cutOffAngle", {cut})
      .set("location", {0, 0, h});
  use(spot);
  for (const double angle : {0., .29, .3, .31, .6, .89, .899, .901, 1.2}) {
    const double x = h * std::tan(angle), d2 = h * h + x * x;
    const double factor = std::min(1., std::max(0., (cut - angle) / (cut - beam)));
    expectClose(look(x).r, .8 * factor * h / std::pow(d2, 1.5), 1e-5, .01);
  }
}

TEST_F(Lighting, ColourAndIntensityScaleTheDirectPartOnly) {
  use(tilted(0).set("color", {1, .5, .25}).set("intensity", {2}).set("ambientIntensity", {1}));
  expectColor(look(), {1.6 + .16, .8 + .08, .4 + .04});
}

TEST_F(Lighting, LightsBelowTheSurfaceGiveNothing) { // R11
  use(point({0, 0, -2}, {1, 0, 0}));
  use(point({3, 0, 0}, {1, 0, 0})); // edge-on
  use(tilted(0).set("intensity", {0}));
  const Rgba pixel = look();
  EXPECT_EQ(pixel.r, 0);
  EXPECT_EQ(pixel.g, 0);
  EXPECT_EQ(pixel.b, 0);
}

TEST_F(Lighting, ALightInTheSurfaceIsANumber) {
  use(point({0, 0, 0}, {0, 0, 1}));
  EXPECT_TRUE(std::isfinite(look().r));
}

// The half vector is at half the light's angle, because the view is along the normal.
TEST_F(Scene, V5Highlights) {
  const struct {
    double half, shininess, expected;
  } points[] = {{10, .2, .675768}, {10, 1, .140925}, {5, .2, .907010}, {0, 1, 1}};
  for (const auto& p : points) {
    const double exact = std::pow(std::cos(p.half * pi / 180), 128 * p.shininess);
    EXPECT_NEAR(exact, p.expected, 1e-6);
    Shader s("VRML97");
    s.set("diffuseColor", {0, 0, 0})
        .set("specularColor", {1, .5, 0})
        .set("shininess", {p.shininess});
    const RTid instance = place(square(s)), light = use(tilted(2 * p.half));
    expectColor(look(), {exact, exact / 2, 0});
    rtDeleteInstance(instance);
    rtRemoveLight(light);
  }
}

} // namespace
} // namespace numeric

// stock_shaders.cpp: the stock surface shaders in the renderer: white furnaces against closed forms
// (catalogue G1, G2), VRML97 by path tracing, solid patterns, and the output of Debug. Uses the C
// API.
#include <complex>

#include "numeric/support.h"

namespace numeric {
namespace {

class StockShaders : public Scene {
 protected:
  static void whiteSky() {
    Shader sky("VRML97Environment");
    sky.setList("skyColor", {1, 1, 1});
    rtUseEnvironment(sky);
  }
  // Returns the radiance that a plane sends straight up under a white sky: its albedo for that
  // direction.
  static Rgba furnace(RTid shader, int samples = 16384) {
    const RTid plane = place(square(shader));
    whiteSky();
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
    rtQuality(RT_MAX_DEPTH, 4);
    rtQuality(RT_SAMPLES_PER_PIXEL, samples);
    const Rgba pixel = look();
    rtDeleteInstance(plane);
    return pixel;
  }
};

TEST_F(StockShaders, G1WhiteBodiesUnderClearCoatsAreWhite) {
  expectGrey(furnace(Shader("Plastic").set("color", {1, 1, 1})), 1, 1e-3);
  expectGrey(furnace(Shader("Plastic").set("color", {1, 1, 1}).set("index", {2.5})), 1, 1e-3);
  expectGrey(furnace(Shader("CarPaint").set("color", {1, 1, 1}).set("flakes", {0})), 1, 1e-3);
  expectGrey(furnace(Shader("Wood")
                         .set("light", {1, 1, 1})
                         .set("dark", {1, 1, 1})
                         .set("grain", {0})
                         .set("varnish", {1.5})),
             1, 1e-3);
  for (const double roughness : {.01, .1, .4, 1.})
    for (const double index : {1.5, 2.5}) {
      SCOPED_TRACE(roughness);
      expectGrey(furnace(Shader("Plastic")
                             .set("color", {1, 1, 1})
                             .set("roughness", {roughness})
                             .set("index", {index})),
                 1, 5e-4);
    }
}

TEST_F(StockShaders, G1PhongReflectsBothOfItsParts) {
  Shader s("Phong");
  expectGrey(furnace(s.set("diffuseColor", {.3, .3, .3})
                         .set("specularColor", {.4, .4, .4})
                         .set("shininess", {.5})),
             .7, 2e-3);
  expectGrey(furnace(s.set("diffuseColor", {.8, .8, .8}).set("specularColor", {.8, .8, .8})), 1,
             2e-3); // scaled
}

// Returns F D G / 4 for a single reflection at the GGX microfacets of a metal, seen along the
// normal. Smith's shadowing applies to the light direction only.
double roughMetal(double alpha, double n, double k, double angle) {
  const double c = std::cos(angle / 2), s2 = 1 - c * c;
  const double distribution = alpha * alpha / (pi * std::pow(s2 + alpha * alpha * c * c, 2));
  const double shadowing = 2 / (1 + std::sqrt(1 + alpha * alpha * std::pow(std::tan(angle), 2)));
  const std::complex<double> index(n, k), inside = std::sqrt(index * index - s2);
  const double rs = std::norm((c - inside) / (c + inside));
  const double rp = std::norm((index * index * c - inside) / (index * index * c + inside));
  return (rs + rp) / 2 * distribution * shadowing / 4;
}

TEST_F(StockShaders, G1RoughMetalReflectsWhatItsFacetsDo) {
  const double n = .96, k = 6.69;
  for (const double alpha : {.1, .5, 1.}) {
    double sum = 0;
    const int steps = 20000;
    for (int j = 0; j < steps; j++) {
      const double t = (j + .5) * pi / 2 / steps;
      sum += roughMetal(alpha, n, k, t) * std::sin(t) * pi / 2 / steps;
    }
    const Shader metal =
        Shader("Metal").set("n", {n, n, n}).set("k", {k, k, k}).set("roughness", {alpha});
    expectGrey(furnace(metal), 2 * pi * sum, 2e-3);
  }
}

// Light sampling and BSDF sampling are combined by MIS. Their sum must be the integral over the
// lamp.
TEST_F(StockShaders, RoughMetalUnderARectangularLamp) {
  const double n = .96, k = 6.69;
  for (const double alpha : {.1, .3, .8}) {
    const RTid plane = place(square(
        Shader("Metal").set("n", {n, n, n}).set("k", {k, k, k}).set("roughness", {alpha}), 100));
    rtPushMatrix();
    rtTranslated(.5, 0, 1);
    rtRotated(180, 1, 0, 0);
    const RTid lamp = place(
        square(Shader("Diffuse").set("reflectance", {0, 0, 0}).set("emission", {1, 1, 1}), .3));
    rtPopMatrix();
    double expected = 0;
    const int steps = 400;
    for (int i = 0; i < steps; i++)
      for (int j = 0; j < steps; j++) {
        const double x = .2 + .6 * (i + .5) / steps, y = -.3 + .6 * (j + .5) / steps,
                     r2 = x * x + y * y + 1;
        const double cosine = 1 / std::sqrt(r2); // cosine at the lamp
        expected += roughMetal(alpha, n, k, std::acos(cosine)) * cosine / r2 * .36 / steps / steps;
      }
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
    rtQuality(RT_MAX_DEPTH, 1);
    rtQuality(RT_SAMPLES_PER_PIXEL, 16384);
    EXPECT_NEAR(look(0, 0, .001).g, expected, 1e-2 * expected)
        << alpha; // three standard errors for the narrowest lobe
    rtDeleteInstance(plane);
    rtDeleteInstance(lamp);
  }
}

// Both sides of one boundary, with the same sky below.
TEST_F(StockShaders, RoughGlassLosesOnlyWhatFacetsHide) {
  const Rgba pixel = furnace(Shader("RoughGlass").set("index", {1.0001}).set("roughness", {.3}));
  expectGrey(pixel, 1, 5e-3);
}

TEST_F(StockShaders, G2AFurnaceOfGlobalIllumination) {
  const RTid box = rtBeginObject(0);
  rtBindShader(Shader("GlobalIllumination")
                   .set("diffuseColor", {.5, .5, .5})
                   .set("emissiveColor", {.5, .5, .5}));
  rtSphere(30);
  rtEndObject();
  rtBindShader(0);
  place(box);
  rtQuality(RT_MAX_DEPTH, 60);
  rtQuality(RT_SAMPLES_PER_PIXEL, 4096);
  expectGrey(look(), 1, 5e-3);
  EXPECT_EQ(stats().transport.chosen, RTenum(RT_TRANSPORT_PATH)) << "it asks for path tracing";
}

TEST_F(StockShaders, Vrml97AnswersLightsTheSameWayWhenPathsAreTraced) {
  place(square(Shader("VRML97").set("emissiveColor", {.1, .2, .3}).set("ambientIntensity", {0})));
  use(tilted(60));
  const Vec expected{.1 + .4, .2 + .4, .3 + .4};
  expectColor(look(), expected);
  EXPECT_EQ(stats().transport.chosen, RTenum(RT_TRANSPORT_DIRECT))
      << "the standard's surface does not ask for more than lights";
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  expectColor(look(), expected);
}

TEST_F(StockShaders, AVrml97HighlightIsTheStandardsTimesTheCosine) {
  place(square(Shader("VRML97")
                   .set("diffuseColor", {0, 0, 0})
                   .set("specularColor", {.8, .4, .2})
                   .set("shininess", {.1})));
  use(tilted(40));
  const double power = std::pow(std::cos(20 * pi / 180), 12.8), cosine = std::cos(40 * pi / 180);
  expectColor(look(), {.8 * power, .4 * power, .2 * power}, 1e-4);
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  expectColor(look(), {.8 * power * cosine, .4 * power * cosine, .2 * power * cosine}, 1e-4);
}

TEST_F(StockShaders, PatternsBelongToTheObject) {
  Shader cubes("Checker");
  cubes.set("even", {1, 1, 1}).set("odd", {0, 0, 0});
  const RTid board = square(cubes, 4);
  use(tilted(0));
  rtPushMatrix();
  rtTranslated(100.5, 0, 0);
  rtScaled(2, 2, 2);
  place(board);
  rtPopMatrix();
  for (int x = -3; x <= 3; x++)
    for (int y = -3; y <= 3;
         y++) { // cubes of two units each; the board lies just inside the layer below
      const double got = look(100.5 + 2 * (x + .5), 2 * (y + .5)).g;
      EXPECT_EQ(got, (x + y - 1) % 2 == 0 ? 1 : 0) << x << " " << y;
    }
}

TEST_F(StockShaders, DebugTellsWhatTheHostKnows) {
  Shader debug("Debug");
  const RTid board = square(debug, 4);
  rtLoadName(5);
  place(board);
  const auto show = [&](int what) {
    debug.setInt("show", what);
    return look(1.25, .5);
  };
  expectColor(show(9), {1, .5, .5});
  expectColor(show(10), {.5, 1, .5});
  expectColor(show(11), {.25, .5, 0});
  EXPECT_GT(show(6).r, 0);
  EXPECT_EQ(show(8).r, 0);
  debug.set("scale", {40});
  expectGrey(show(7), .5);
}

} // namespace
} // namespace numeric

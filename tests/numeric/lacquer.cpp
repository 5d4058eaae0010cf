// lacquer.cpp: Plastic with transparency, a layer of lacquer, against the equations of Kubelka and
// Munk, integrated here step by step. Uses the C API.
#include <algorithm>

#include "numeric/support.h"

namespace numeric {
namespace {

struct Layer {
  double reflects, passes;
};

// Integrates the fluxes of a layer of optical thickness s whose thick layer reflects c, from its
// bottom, where no light comes from, to its top. Absorption over scattering is (1 - c)^2 / 2c.
Layer layerOf(double c, double s) {
  const double a = 1 + (1 - c) * (1 - c) / (2 * c);
  const int steps = 4000;
  double down = 1, up = 0;
  const auto slope = [a](double d, double u) { return std::pair(a * d - u, d - a * u); };
  for (int i = 0; i < steps; i++) { // the midpoint rule
    const double h = s / steps;
    const auto [d1, u1] = slope(down, up);
    const auto [d2, u2] = slope(down + h / 2 * d1, up + h / 2 * u1);
    down += h * d2;
    up += h * u2;
  }
  return {up / down, 1 / down};
}

// Returns the optical thickness through which the share passes twice.
double thicknessFor(double c, double share) {
  double low = 0, high = 60;
  for (int i = 0; i < 60; i++) {
    const double middle = (low + high) / 2, passes = layerOf(c, middle).passes;
    (passes * passes > share ? low : high) = middle;
  }
  return low;
}

class Lacquers : public Scene {};

// White over white is white. The sheet is one-sided, as those of an export are.
TEST_F(Lacquers, KeepWhatIsLight) {
  Shader sky("VRML97Environment");
  sky.setList("skyColor", {1, 1, 1});
  rtUseEnvironment(sky);
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  rtQuality(RT_SAMPLES_PER_PIXEL, 4096);
  place(square(Shader("Diffuse").set("reflectance", {.9, .9, .9})));
  rtPushMatrix();
  rtTranslated(0, 0, .01);
  rtEnable(RT_CULL_FACE);
  place(square(
      Shader("Plastic").set("color", {.9, .9, .9}).set("index", {1}).set("transparency", {.17})));
  rtDisable(RT_CULL_FACE);
  rtPopMatrix();
  const Rgba seen = look();
  EXPECT_NEAR(seen.g, .9, .01);
}

// A sheet with one side or two shows as much of what is below by every kind of light.
TEST_F(Lacquers, ShowTheSameInEveryLight) {
  constexpr double share = .3, colour = .001, below = .6;
  Shader sky("VRML97Environment");
  sky.setList("skyColor", {1, 1, 1});
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  rtQuality(RT_SAMPLES_PER_PIXEL, 4096);
  place(square(matt(below)));
  RTid sheets[2];
  for (const bool oneSided : {false, true}) {
    if (oneSided) rtEnable(RT_CULL_FACE);
    sheets[oneSided] = placeAt(.01, square(Shader("Plastic")
                                               .set("color", {colour, colour, colour})
                                               .set("index", {1})
                                               .set("transparency", {share})));
    rtDisable(RT_CULL_FACE);
  }
  const auto lookAt = [&](const char* light) {
    const std::string name = light;
    if (name == "sky") rtUseEnvironment(sky);
    const RTid lamp = name == "directional" ? use(tilted(20))
                      : name == "point"     ? use(point({0, 0, 3}, {1, 0, 0}))
                                            : 0;
    const Rgba seen = look();
    if (lamp) rtRemoveLight(lamp);
    rtUseEnvironment(0);
    return seen.g;
  };
  for (const char* light : {"sky", "directional", "point"}) {
    for (const RTid sheet : sheets) rtInstanceVisible(sheet, 0);
    const double without = lookAt(light);
    for (const bool oneSided : {false, true}) {
      SCOPED_TRACE(testing::Message() << light << (oneSided ? ", one side" : ", two sides"));
      rtInstanceVisible(sheets[oneSided], 1);
      const double once = oneSided ? share : std::sqrt(share);
      EXPECT_NEAR(lookAt(light) / without, share + (1 - once) * colour / below, 5e-3);
      rtInstanceVisible(sheets[oneSided], 0);
    }
  }
}

TEST_F(Lacquers, ShowWhatIsBelowByKubelkaAndMunk) {
  for (const double share : {.17, .6})
    for (const std::array<double, 3>& colour :
         {std::array{.08, .2, .14}, std::array{.9, .3, .02}, std::array{.5, .5, .5}}) {
      Shader sky("VRML97Environment");
      sky.setList("skyColor", {1, 1, 1});
      rtUseEnvironment(sky);
      rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
      rtQuality(RT_SAMPLES_PER_PIXEL, 16384);
      rtEnable(RT_CULL_FACE);
      const RTid plane = place(square(Shader("Plastic")
                                          .set("color", {colour[0], colour[1], colour[2]})
                                          .set("index", {1})
                                          .set("transparency", {share})));
      rtDisable(RT_CULL_FACE);
      const Rgba seen = look();
      rtDeleteInstance(plane);
      const double s = thicknessFor(*std::max_element(colour.begin(), colour.end()), share);
      for (size_t k = 0; k < 3; k++) {
        SCOPED_TRACE(testing::Message() << share << " " << k);
        const Layer layer = layerOf(colour[k], s);
        const double passes = layer.passes * layer.passes, all = (1 - passes) * colour[k] + passes;
        EXPECT_LE(layer.reflects, (1 - passes) * colour[k] + 1e-3) << "what is lost downwards";
        if (colour[k] < .25) { EXPECT_NEAR(layer.reflects, (1 - passes) * colour[k], .01); }
        EXPECT_NEAR(double(k == 0 ? seen.r : k == 1 ? seen.g : seen.b), all, 4e-3);
      }
    }
}

} // namespace
} // namespace numeric

// global_light.cpp: interreflection against closed forms: G5, G6, G7 of the accuracy catalogue.
#include "numeric/support.h"

namespace numeric {
namespace {

class GlobalLight : public Scene {
 protected:
  // The six faces of a unit cube around the origin, facing inwards. The first, at -z, has a shader
  // of its own.
  static void cube(RTid first, RTid others) {
    for (int i = 0; i < 6; i++) {
      rtPushMatrix();
      turn(i);
      rtTranslated(0, 0, -.5);
      place(square(i == 0 ? first : others, .5));
      rtPopMatrix();
    }
  }
  static void turn(int face) {
    if (face < 4)
      rtRotated(90 * face, 1, 0, 0);
    else
      rtRotated(face == 4 ? 90 : -90, 0, 1, 0);
  }
};

// Le / (1 - rho). Russian roulette affects all terms but the first.
TEST_F(GlobalLight, G5RouletteDoesNotChangeTheMean) {
  const Shader wall =
      Shader("Diffuse").set("emission", {.05, .05, .05}).set("reflectance", {.95, .95, .95});
  cube(wall, wall);
  rtPushMatrix();
  rtPerspective(90);
  rtPopMatrix();
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  rtQuality(RT_MAX_DEPTH, 10000);
  rtQuality(RT_SAMPLES_PER_PIXEL, 128);
  double sum = 0, square = 0;
  constexpr int seeds = 5;
  for (int seed = 1; seed <= seeds; seed++) {
    rtQuality(RT_SEED, seed);
    const double m = mean(picture(8));
    sum += m;
    square += m * m;
  }
  const double m = sum / seeds,
               error = std::sqrt(std::max(0.0, square / seeds - m * m) / (seeds - 1));
  EXPECT_NEAR(m, 1, 4 * error);
  EXPECT_LT(error, .01);
}

// A path that goes straight on has no choice, so a filter darkens a lamp without adding noise,
// however little it lets through.
TEST_F(GlobalLight, ALampBehindDarkFiltersHasNoNoise) {
  constexpr double transmitted = 1.0 / 64;
  const Shader filter =
      Shader("Glass").set("index", {1}).set("tint", {transmitted, transmitted, transmitted});
  const double radiance = 1 / (transmitted * transmitted);
  const Shader lamp = Shader("Diffuse")
                          .set("emission", {radiance, radiance, radiance})
                          .set("reflectance", {0, 0, 0});
  placeAt(-1, square(filter));
  placeAt(-2, square(filter));
  placeAt(-3, square(lamp));
  rtPerspective(45);
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  rtQuality(RT_SAMPLES_PER_PIXEL, 4);
  for (const float value : picture(8)) EXPECT_NEAR(value, 1, 1e-5);
}

// The sum is exact: the power emitted equals the power absorbed.
TEST_F(GlobalLight, G6RadiosityOfACube) {
  cube(Shader("Diffuse").set("emission", {1, 1, 1}).set("reflectance", {.5, .5, .5}),
       Shader("Diffuse").set("reflectance", {.5, .5, .5}));
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  rtQuality(RT_SAMPLES_PER_PIXEL, 256);
  double sum = 0, face[6];
  for (int i = 0; i < 6; i++) {
    rtPushMatrix();
    turn(i);
    rtTranslated(0, 0, .499);
    rtOrtho(1);
    rtPopMatrix();
    sum += face[i] = mean(picture(8));
  }
  EXPECT_NEAR(sum, 2, 4e-3);
  // From a solver with 16x16 patches per face. With one radiosity per face the values are 1.0909,
  // .1817, .1818.
  EXPECT_NEAR(face[0], 1.1055, .01 * 1.1055);
  EXPECT_NEAR(face[2], .1700, .02 * .1700);
  for (const int side : {1, 3, 4, 5}) EXPECT_NEAR(face[side], .1813, .01 * .1813);
}

TEST_F(GlobalLight, G7ADiffuseSphereWithTheLightAtTheEye) {
  const RTid ball = rtBeginObject(0);
  rtBindShader(Shader("Diffuse").set("reflectance", {1, 1, 1}));
  rtSphere(1);
  rtEndObject();
  rtBindShader(0);
  place(ball);
  use(tilted(0));
  rtPushMatrix();
  rtTranslated(0, 0, 20);
  rtOrtho(2);
  rtPopMatrix();
  rtQuality(RT_SAMPLES_PER_PIXEL, 64);
  EXPECT_NEAR(mean(picture(32)) / (pi / 4), 2. / 3, 1e-3 * 2 / 3); // over the disc
}

} // namespace
} // namespace numeric

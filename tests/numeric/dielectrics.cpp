// dielectrics.cpp: bodies of glass and water, one inside, beside or across another, with absorption
// and dispersion, against closed forms (accuracy catalogue D4, D6, D11, D19). Uses the C API.
#include "numeric/support.h"

namespace numeric {
namespace {

class Dielectrics : public Scene {
 protected:
  void SetUp() override {
    Scene::SetUp();
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_WHITTED);
    rtQuality(RT_MAX_DEPTH, 250);
    rtQualityf(RT_ENERGY_CUT, 1e-7f);
  }
  static Shader glowing(double radiance) {
    Shader s("Diffuse");
    return s.set("reflectance", {0, 0, 0}).set("emission", {radiance, radiance, radiance});
  }
  static Shader glass(double index, int priority = 0) {
    return Shader("Glass").set("index", {index}).setInt("priority", priority);
  }
  static void slab(double top, double bottom, RTid shader) {
    placeAt(top, square(shader));
    placeAt(bottom, square(shader), true);
  }
  static void environment(double radiance) {
    Shader sky("VRML97Environment");
    const float r = float(radiance);
    sky.setList("skyColor", {r, r, r});
    rtUseEnvironment(sky);
  }
};

// Returns the Fresnel reflectance at normal incidence.
double reflectance(double from, double to) { return std::pow((from - to) / (from + to), 2); }
// Returns the transmittance of a stack of plane boundaries, including all reflections between them.
double through(std::initializer_list<double> reflectances) {
  double sum = 0;
  for (const double r : reflectances) sum += r / (1 - r);
  return 1 / (1 + sum);
}

TEST_F(Dielectrics, D4AbsorptionFollowsBeerAndLambert) {
  for (const double length : {1e-6, .5, 1., 2.}) {
    Shader dye = glass(1);
    dye.set("absorption", {1, .5, 0});
    const RTid top = placeAt(length, square(dye)), bottom = placeAt(0, square(dye), true),
               lamp = placeAt(-1, square(glowing(1)));
    expectColor(look(0, 0, 10), {std::exp(-length), std::exp(-length / 2), 1});
    for (const RTid i : {top, bottom, lamp}) rtDeleteInstance(i);
  }
}

TEST_F(Dielectrics, D4FiftyOpticalDepthsAreDark) {
  Shader dye = glass(1);
  slab(50, 0, dye.set("absorption", {1, 1, 1}));
  placeAt(-1, square(glowing(1)));
  const Rgba pixel = look(0, 0, 100);
  EXPECT_GE(pixel.g, 0);
  EXPECT_LT(pixel.g, 1e-6); // paths are cut off: e^-50 would be 1.9e-22
}

class NestedDielectrics : public Dielectrics, public testing::WithParamInterface<bool> {
 protected:
  // A layer of glass on a layer of water with a lamp below. overlap: how far the glass reaches into
  // the water. Made in either order.
  void layers(double overlap, int glassPriority, int waterPriority) {
    const Shader crown = glass(1.5, glassPriority), water = glass(1.33, waterPriority);
    if (GetParam()) slab(1, 0, water);
    slab(2, 1 - overlap, crown);
    if (!GetParam()) slab(1, 0, water);
    placeAt(-1, square(glowing(1)));
  }
};
constexpr double airGlass = .04, glassWater = .003608489, waterAir = .020059312;

TEST_P(NestedDielectrics, D11OverlappedThePriorityDecides) {
  EXPECT_NEAR(reflectance(1.5, 1.33), glassWater, 1e-8);
  EXPECT_NEAR(reflectance(1.33, 1), waterAir, 1e-8);
  layers(.25, 1, 0);
  expectGrey(look(), through({airGlass, glassWater, waterAir}), 2e-5);
}

TEST_P(NestedDielectrics, D11WithWaterFirstTheBoundaryIsTheWaters) {
  layers(.25, 0, 1);
  expectGrey(look(), through({airGlass, glassWater, waterAir}), 2e-5);
}

TEST_P(NestedDielectrics, D11ASharedFaceIsOneBoundary) {
  layers(0, 1, 0);
  expectGrey(look(), through({airGlass, glassWater, waterAir}), 2e-5);
}

TEST_P(NestedDielectrics, D11ASharedFaceHasItsPlaceAtAnyDistance) {
  rtPushMatrix();
  rtTranslated(1234.5, -321.7, 77.3);
  rtRotated(33, 1, 2, 3);
  layers(0, 0, 0);
  rtPopMatrix();
  rtPushMatrix();
  rtLoadIdentity();
  rtTranslated(1234.5, -321.7, 77.3);
  rtRotated(33, 1, 2, 3);
  rtTranslated(.3, .2, 20);
  rtOrtho(1e-6);
  rtPopMatrix();
  expectGrey(render(), through({airGlass, glassWater, waterAir}), 2e-5);
}

// Interference is not simulated; the gap adds two boundaries.
TEST_P(NestedDielectrics, D11AGapIsAir) {
  layers(-1e-3, 1, 0);
  expectGrey(look(), through({airGlass, airGlass, waterAir, waterAir}), 2e-5);
}

TEST_P(NestedDielectrics, D11WaterWithinGlassIsABubbleOfWater) {
  const Shader crown = glass(1.5), water = glass(1.33, 1);
  if (GetParam()) slab(3, 0, crown);
  slab(2, 1, water);
  if (!GetParam()) slab(3, 0, crown);
  placeAt(-1, square(glowing(1)));
  expectGrey(look(), through({airGlass, glassWater, glassWater, airGlass}), 2e-5);
}

TEST_P(NestedDielectrics, D11WhatIsWithinABodyOfHigherPriorityIsNotSeen) {
  Shader crown = glass(1.5, 1), ink = glass(1.33);
  ink.set("absorption", {100, 100, 100});
  if (GetParam()) slab(3, 0, crown);
  slab(2, 1, ink);
  if (!GetParam()) slab(3, 0, crown);
  placeAt(-1, square(glowing(1)));
  expectGrey(look(), through({airGlass, airGlass}), 2e-5);
}

INSTANTIATE_TEST_SUITE_P(EitherOrder, NestedDielectrics, testing::Bool(), [](const auto& info) {
  return info.param ? "WaterMadeFirst" : "GlassMadeFirst";
});

// A slab under a white sky is as white as the sky from every angle, because reflectance and
// transmittance add up to 1.
TEST_F(Dielectrics, D19EverythingIsReflectedOrGoesThrough) {
  environment(1);
  const RTid crown = glass(1.5), face = square(crown, 1e4);
  for (int k = 0; k < 60; k++) {
    rtPushMatrix();
    rtRotated(1.5 * k, 0, 1, 0);
    const RTid top = place(face);
    rtTranslated(0, 0, -1);
    rtRotated(180, 1, 0, 0);
    const RTid bottom = place(face);
    rtPopMatrix();
    SCOPED_TRACE(1.5 * k);
    expectGrey(look(0, 0, 1e4), 1, 1e-5);
    rtDeleteInstance(top);
    rtDeleteInstance(bottom);
  }
}

// A white floor under a clear pane under a white sky is white. Light must not count twice, once
// through shadow rays and once through paths.
TEST_F(Dielectrics, G1LightThroughAPaneCountsOnce) {
  environment(1);
  slab(1, .5, glass(1.5));
  Shader white("Diffuse");
  placeAt(0, square(white.set("reflectance", {1, 1, 1}), 1e3));
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  rtQuality(RT_MAX_DEPTH, 200);
  rtQuality(RT_SAMPLES_PER_PIXEL, 8192);
  // Seen from below the pane, whose edges are ten units away.
  EXPECT_NEAR(look(0, 0, .25).g, 1, .02);
}

// The points where the ray through a prism hits planes far below show its deviation.
class Prism : public Dielectrics {
 protected:
  static constexpr double apex = 60, degree = pi / 180;
  void prism(const Shader& shader, double incidence) {
    const RTid object = rtBeginObject(0);
    rtBindShader(shader);
    const double c = std::cos(apex / 2 * degree), s = std::sin(apex / 2 * degree);
    rtBegin(RT_QUADS);
    for (const double side : {1., -1.}) { // two faces that share an edge on the y axis
      rtNormal3f(float(s), 0, float(side * c));
      for (const auto& corner : {std::array{0., -1.}, {0., 1.}, {10., 1.}, {10., -1.}})
        rtVertex3d(-c * corner[0], 5 * side * corner[1], side * s * corner[0]);
    }
    rtEnd();
    rtEndObject();
    rtBindShader(0);
    rtPushMatrix();
    rtRotated(incidence - apex / 2, 0, 1, 0);
    rtTranslated(4, 0, 0); // the ray along the z axis hits the middle of a face
    place(object);
    rtPopMatrix();
  }
  // Returns the deviation in degrees from the colour's position on two planes. expected: roughly
  // the expected deviation.
  static double deviation(int colour, double expected) {
    double x[2];
    const double depth[2] = {40, 80};
    for (int k = 0; k < 2; k++)
      x[k] = placeAt(depth[k], colour, -(depth[k] - 2) * std::tan(expected * degree));
    return std::atan((x[0] - x[1]) / (depth[1] - depth[0])) / degree;
  }

 private:
  static constexpr double scale = 1024;
  // Returns x at a depth. The Debug shader shows the fraction of each coordinate in a colour
  // channel, so the plane is turned to show x in this channel. The plane is small, so that other
  // light paths miss it.
  static double placeAt(double depth, int colour, double about) {
    Shader ruler("Debug");
    ruler.setInt("show", 11).set("scale", {scale});
    double seen[2];
    for (const bool measure : {true, false}) {
      const RTid object = rtBeginObject(0);
      rtBindShader(measure ? RTid(ruler) : RTid(glowing(1)));
      rtBegin(RT_QUADS);
      for (const auto& corner : {std::array{-1., -1.}, {1., -1.}, {1., 1.}, {-1., 1.}}) {
        double v[3] = {1, 1, 1};
        v[colour] = scale / 2 + about + 6 * corner[0];
        v[(colour + 1) % 3] = 6 * corner[1];
        rtVertex3d(v[0], v[1], v[2]);
      }
      rtEnd();
      rtEndObject();
      rtBindShader(0);
      double m[16] = {}; // this channel's axis along x, the next along y
      m[4 * colour] = m[4 * ((colour + 1) % 3) + 1] = m[4 * ((colour + 2) % 3) + 2] = m[15] = 1;
      rtPushMatrix();
      rtTranslated(-scale / 2, 0, -depth - 1);
      rtMultMatrixd(m);
      const RTid placed = place(object);
      rtPopMatrix();
      const Rgba pixel = look(0, 0, 20);
      seen[measure] = colour == 0 ? pixel.r : colour == 1 ? pixel.g : pixel.b;
      rtDeleteInstance(placed);
    }
    EXPECT_GT(seen[0], .5) << "the ray misses the plane";
    return scale * (seen[1] / seen[0] - .5);
  }
};

// Returns the deviation by a prism of this index for light at this angle of incidence.
double turned(double index, double incidence, double apex = 60) {
  const double degree = pi / 180, inside = std::asin(std::sin(incidence * degree) / index);
  return incidence + std::asin(index * std::sin(apex * degree - inside)) / degree - apex;
}

TEST_F(Prism, D6TurnsLightAsSnellSays) {
  EXPECT_NEAR(turned(1.5, 48.590378), 37.180756, 1e-6);
  EXPECT_NEAR(turned(1.5, 30), 47.095812, 1e-6);
  EXPECT_NEAR(turned(1.5, 60), 38.876770, 1e-6);
  for (const double incidence : {30., 48.590378, 60.}) {
    TearDown();
    SetUp();
    prism(glass(1.5), incidence);
    EXPECT_NEAR(deviation(0, turned(1.5, incidence)), turned(1.5, incidence), 2e-4) << incidence;
  }
}

TEST_F(Prism, D6EachColourGoesItsOwnWay) {
  const double index[3] = {1.5, 1.52, 1.55};
  Shader flint = glass(1.5);
  prism(flint.set("indexByColor", {index[0], index[1], index[2]}), 50);
  for (int k = 0; k < 3; k++)
    EXPECT_NEAR(deviation(k, turned(index[k], 50)), turned(index[k], 50), 2e-4) << k;
}

TEST_F(Prism, D6AnAbbeNumberSpreadsTheColours) { // Cauchy's equation at 611.4, 549.1 and 464.2 nm
  Shader flint = glass(1.62);
  prism(flint.set("abbe", {36}), 55);
  const double b = .62 / (36 * (1 / (.48613 * .48613) - 1 / (.65627 * .65627)));
  const double wavelength[3] = {.6114, .5491, .4642};
  for (int k = 0; k < 3; k++) {
    const double n = 1.62 + b * (1 / (wavelength[k] * wavelength[k]) - 1 / (.58756 * .58756));
    EXPECT_NEAR(deviation(k, turned(n, 55)), turned(n, 55), 2e-4) << n;
  }
}

} // namespace
} // namespace numeric

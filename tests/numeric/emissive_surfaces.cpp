// emissive_surfaces.cpp: quadrics of revolution and aspheres as lamps, against closed forms of
// configuration factors. They are sampled by area, and found by paths as well; both are combined.
#include <functional>

#include "numeric/sensor_scene.h"

namespace numeric {
namespace {

class EmissiveSurfaces : public Sensors {
 protected:
  static constexpr double radiance = 10;
  void SetUp() override {
    Sensors::SetUp();
    rtQuality(RT_MAX_DEPTH, 1);
  }
  static RTid glowing(const std::function<void()>& draw) {
    const RTid object = rtBeginObject(0);
    rtBindShader(matt(0, radiance));
    draw();
    rtEndObject();
    rtBindShader(0);
    return object;
  }
  // Expects the reading of a lamp that a sensor sees under a form factor.
  static void expectFactor(const Reading& got, double factor) {
    expectReading(got, pi * radiance * factor);
    EXPECT_TRUE(got.trusted);
  }
};

// Configuration factor from an element, whose normal goes through one end of a cylinder and is
// perpendicular to its axis, to the outside of the cylinder: E. M. Sparrow, R. D. Cess, "Radiation
// Heat Transfer", 1978; J. R. Howell, "A Catalog of Radiation Heat Transfer Configuration Factors",
// B-31.
double cylinderFactor(double radius, double length, double distance) {
  const double l = length / radius, h = distance / radius, x = (1 + h) * (1 + h) + l * l,
               y = (1 - h) * (1 - h) + l * l;
  return std::atan(l / std::sqrt(h * h - 1)) / (pi * h) +
         l / pi *
             ((x - 2 * h) / (h * std::sqrt(x * y)) *
                  std::atan(std::sqrt(x * (h - 1) / (y * (h + 1)))) -
              std::atan(std::sqrt((h - 1) / (h + 1))) / h);
}

TEST_F(EmissiveSurfaces, ACylinderLightsAsItsConfigurationFactorSays) {
  const double cases[][3] = {{.1, 1, .5}, {.5, 2, .8}, {.02, .6, 2}};
  for (const auto& [radius, half, distance] : cases) {
    const RTid lamp = place(glowing([&] { rtCylinder(radius, -half, half); }));
    expectFactor(read({distance, 0, 0}, {-1, 0, 0}), 2 * cylinderFactor(radius, half, distance));
    rtDeleteInstance(lamp);
  }
}

// Seen from beyond its tip, a cone covers the same directions as its base.
TEST_F(EmissiveSurfaces, AConeLightsAsItsBase) {
  place(glowing([] { rtCone(.8, 0, 0, 1); }));
  expectFactor(read({0, 2.5, 0}, {0, -1, 0}), .64 / (.64 + 2.5 * 2.5));
}

TEST_F(EmissiveSurfaces, ADiscLightsBesideItsAxis) { // R4 and R5
  placeAt(1, glowing([] { rtAsphere(0, 0, 0, nullptr, 0, 1); }));
  for (const auto& [x, factor] : {std::pair{0., .5}, {.5, .43798263}, {1., .27639320}})
    expectFactor(read({x, 0, 0}, up), factor);
}

// The inside of a bowl covers the same directions as its rim.
TEST_F(EmissiveSurfaces, ABowlLightsAsItsRim) {
  constexpr double c = .8, r = .9, h = 1.2;
  placeAt(h + c * r * r / 2, glowing([] { rtAsphere(-c, -1, 0, nullptr, 0, r); }));
  expectFactor(read({0, 0, 0}, up), r * r / (r * r + h * h));
}

TEST_F(EmissiveSurfaces, ASphereAsAQuadric) { // R6
  const std::array<double, 10> unit{1, 1, 1, 0, 0, 0, 0, 0, 0, -1};
  const std::array<double, 3> low{-1, -1, -1}, high{1, 1, 1};
  placeAt(3, glowing([&] { rtQuadric(unit.data(), low.data(), high.data()); }));
  expectFactor(read({0, 0, 0}, up), 1. / 9);
  expectFactor(read({0, 0, 0}, {std::sqrt(.75), 0, .5}), 1. / 18);
}

// Instances that are scaled differently along the axes and mirrored: the same ellipsoid as a sphere
// and as a quadric.
TEST_F(EmissiveSurfaces, InstancesAreSampledWhereTheyAre) {
  const std::array<double, 10> unit{1, 1, 1, 0, 0, 0, 0, 0, 0, -1};
  const std::array<double, 3> low{-1, -1, -1}, high{1, 1, 1};
  const RTid objects[] = {glowing([] { rtSphere(1); }),
                          glowing([&] { rtQuadric(unit.data(), low.data(), high.data()); })};
  const double matrix[16] = {-.5, 0, 0, 0, 0, 1.5, .2, 0, .1, 0, .3, 0, .4, .2, 2, 1};
  Reading readings[2];
  for (int i = 0; i < 2; i++) {
    rtPushMatrix();
    rtLoadMatrixd(matrix);
    const RTid placed = place(objects[i]);
    rtPopMatrix();
    rtInstanceHint(placed, RT_DYNAMIC);
    readings[i] = read({0, 0, 0}, up);
    rtDeleteInstance(placed);
  }
  EXPECT_NEAR(readings[0].value, readings[1].value,
              1.6 * (readings[0].halfWidth + readings[1].halfWidth));
  EXPECT_LT(readings[1].halfWidth, .01 * readings[1].value);
}

// G2: a closed cylinder that glows and reflects has the radiance Le / (1 - rho) everywhere.
TEST_F(EmissiveSurfaces, AClosedFurnaceIsEvenlyBright) {
  rtQuality(RT_MAX_DEPTH, 200);
  rtQuality(RT_SAMPLES_PER_PIXEL, 1024);
  const RTid object = rtBeginObject(0);
  rtBindShader(matt(.5, .5));
  rtCylinder(1, -1, 1);
  for (const double y : {-1., 1.}) {
    rtPushMatrix();
    rtTranslated(0, y, 0);
    rtRotated(90, 1, 0, 0);
    rtAsphere(0, 0, 0, nullptr, 0, 1);
    rtPopMatrix();
  }
  rtEndObject();
  rtBindShader(0);
  place(object);
  expectReading(read({.3, .2, .1}, up), pi, .01);
}

// Light paths start there, too: a mirror below doubles what the lamp's image adds.
TEST_F(EmissiveSurfaces, LightPathsStartThere) {
  rtQuality(RT_MAX_DEPTH, 4);
  rtQuality(RT_SAMPLES_PER_PIXEL, 1024);
  rtPushMatrix();
  rtTranslated(0, 0, 3); // behind the sensors, which look down
  place(glowing([] { rtCylinder(.2, -.5, .5); }));
  rtPopMatrix();
  placeAt(0, square(Shader("Mirror").set("reflectance", {1, 1, 1}), 4));
  const Grid grid{{0, 0, 1}, {.4, 0, 0}, {0, .4, 0}, 2, 2};
  double sums[2] = {}, variance = 0;
  int i = 0;
  for (const int transport : {RT_TRANSPORT_PATH, RT_TRANSPORT_LIGHT}) {
    rtQuality(RT_TRANSPORT, transport);
    for (const Reading& r : readGrid(grid)) {
      sums[i] += r.value;
      variance += r.halfWidth * r.halfWidth;
    }
    i++;
  }
  EXPECT_GT(sums[0], 0);
  EXPECT_NEAR(sums[0], sums[1], 1.6 * std::sqrt(variance) + .002 * sums[0]);
}

// A quadric that is no surface of revolution is found by chance alone: a warning says so, and the
// light is right.
TEST_F(EmissiveSurfaces, OtherQuadricsAreFoundByChance) {
  std::string said;
  rtLogCallback([](int, const char* text, void* user) { *static_cast<std::string*>(user) += text; },
                &said);
  const std::array<double, 10> elliptic{1, 1, 1.0001, 0, 0, 0, 0, 0, 0, -1};
  std::array<double, 10> askew = elliptic;
  askew[3] = 1e-6;
  const std::array<double, 3> low{-1, -1, -1}, high{1, 1, 1};
  placeAt(1.5, glowing([&] { rtQuadric(askew.data(), low.data(), high.data()); }));
  const Reading got = read({0, 0, 0}, up);
  EXPECT_NEAR(got.value, pi * radiance / (1.5 * 1.5), 2 * got.halfWidth + .001 * got.value);
  EXPECT_NE(said.find("by chance"), std::string::npos) << said;
}

} // namespace
} // namespace numeric

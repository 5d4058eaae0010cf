// optics.cpp: directions of rays refracted and reflected by glass and mirrors: D5, D7, D9, D14 of
// the accuracy catalogue. The colour of the target behind shows where the ray hit it: the target's
// corners encode their positions.
#include "numeric/support.h"

namespace numeric {
namespace {

class Optics : public Scene {
 protected:
  static constexpr double half = 8;
  void SetUp() override {
    Scene::SetUp();
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_WHITTED);
    rtQuality(RT_MAX_DEPTH, 2); // two boundaries and the target: excludes internal reflections
  }
  // A target in the plane z that faces up. Red is x / 16 + 1/2 and blue is 1, each times the
  // transmittance.
  static RTid target(double z) {
    const RTid object = rtBeginObject(0);
    Shader plain("VRML97");
    plain.setInt("lit", 0);
    rtBindShader(plain);
    rtBegin(RT_QUADS);
    for (const auto& c : {std::array{-1., -1.}, {1., -1.}, {1., 1.}, {-1., 1.}}) {
      rtColor3f(float(.5 + .5 * c[0]), 0, 1);
      rtVertex3d(half * c[0], half * c[1], 0);
    }
    rtEnd();
    rtEndObject();
    rtBindShader(0);
    return placeAt(z, object);
  }
  // Returns x of the point where the ray down through (x, 0) hits the plane z.
  static double arrives(double x, double z) {
    const RTid placed = target(z);
    const Rgba seen = look(x, 0, 20);
    rtDeleteInstance(placed);
    EXPECT_GT(seen.b, .5);
    return (double(seen.r) / double(seen.b) - .5) * 2 * half;
  }
};

TEST_F(Optics, D5ASlabShiftsAndDoesNotTurn) {
  // Angle, and sideways shift divided by the thickness.
  const double expected[3][2] = {{30, .193814}, {45, .329142}, {60, .512472}};
  const RTid face = square(Shader("Glass"), 6);
  for (const auto& e : expected) {
    RTid faces[2];
    for (int side = 0; side < 2; side++) {
      rtPushMatrix();
      rtRotated(e[0], 0, 1, 0);
      if (side) rtRotated(180, 1, 0, 0);
      rtTranslated(0, 0, .5);
      faces[side] = place(face);
      rtPopMatrix();
    }
    const double near = arrives(0, -6), far = arrives(0, -12);
    EXPECT_NEAR(std::fabs(near), e[1], 2e-5);
    EXPECT_NEAR(far, near, 6e-6); // 1e-6 rad
    for (const RTid f : faces) rtDeleteInstance(f);
  }
}

TEST_F(Optics, D7ABallLensBendsToItsFocus) {
  const RTid ball = rtBeginObject(0);
  rtBindShader(Shader("Glass"));
  rtSphere(1);
  rtEndObject();
  rtBindShader(0);
  place(ball);
  const double expected[4][2] = {{.1, 1.495827}, {.25, 1.473709}, {.5, 1.391573}, {.75, 1.241041}};
  for (const auto& e : expected) {
    const double a = arrives(e[0], -1.1), b = arrives(e[0], -3);
    EXPECT_NEAR(1.1 + 1.9 * a / (a - b), e[1], 5e-5) << e[0];
  }
}

TEST_F(Optics, D9WhatIsInWaterSeemsNearer) {
  place(square(Shader("Glass").set("index", {1.5}), 12));
  const double angle = .5 * pi / 180, depth = 4;
  const RTid placed = target(-depth);
  rtPushMatrix();
  rtLoadIdentity();
  rtRotated(.5, 0, 1, 0);
  rtTranslated(0, 0, 20);
  rtOrtho(1e-6);
  rtPopMatrix();
  const Rgba seen = render();
  // The undeviated ray would hit the surface at x = 0.
  const double x = (double(seen.r) / double(seen.b) - .5) * 2 * half;
  EXPECT_NEAR(std::fabs(x) / (depth * std::tan(angle)), 1 / 1.5, 2e-4);
  rtDeleteInstance(placed);
}

TEST_F(Optics, D14ACornerOfMirrorsSendsBack) {
  const RTid mirror = square(Shader("Mirror").set("reflectance", {1, 1, 1}), 5);
  for (int axis = 0; axis < 3;
       axis++) { // three planes through the origin, facing the positive octant
    rtPushMatrix();
    if (axis == 0) rtRotated(90, 0, 1, 0);
    if (axis == 1) rtRotated(-90, 1, 0, 0);
    place(mirror);
    rtPopMatrix();
  }
  rtQuality(RT_MAX_DEPTH, 5);
  Shader sky("VRML97Environment"); // its colour encodes the angle from the zenith
  sky.setList("skyColor", {0, 0, 1, 1, 0, 1}).setList("skyAngle", {float(pi)});
  rtUseEnvironment(sky);
  for (const Vec& eye : {Vec{3, 4, 5}, Vec{2, 5, 3}, Vec{4, 3, 1.5}}) {
    rtPushMatrix();
    rtLoadIdentity();
    rtLookAt(eye.x, eye.y, eye.z, .4, .3, .5, 0, 1, 0);
    rtPerspective(1e-4);
    rtPopMatrix();
    const Rgba seen = render();
    const double dx = eye.x - .4, dy = eye.y - .3, dz = eye.z - .5;
    EXPECT_NEAR(seen.r, std::acos(dy / std::sqrt(dx * dx + dy * dy + dz * dz)) / pi, 1e-6);
  }
}

} // namespace
} // namespace numeric

// huge.cpp: objects whose sizes do not fit together in single precision: the ground as a huge
// sphere under an eye at human height, and an object so far away that it is invisible and must
// change nothing.
#include <limits>

#include "numeric/support.h"

namespace numeric {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

class Huge : public Scene {
 protected:
  // A sphere that touches the plane y = 0 from below at the origin. squashed: its height is a
  // quarter of its width.
  static RTid ground(double radius, bool squashed, RTid shader) {
    rtPushMatrix();
    rtLoadIdentity();
    rtTranslated(0, squashed ? -radius / 4 : -radius, 0);
    if (squashed) rtScaled(1, .25, 1);
    const RTid object = rtBeginObject(0);
    rtBindShader(shader);
    rtSphere(radius);
    rtEndObject();
    rtBindShader(0);
    const RTid instance = rtInstantiateObject(object);
    rtPopMatrix();
    return instance;
  }
  // Returns where a ray from (x, y, 0) hits the sphere, by the root of the quadratic equation that
  // does not cancel.
  static double meets(double radius, bool squashed, Vec from, Vec d) {
    const long double s = squashed ? 4 : 1, r = static_cast<long double>(radius);
    const long double o[3] = {from.x, s * from.y, from.z},
                      v[3] = {d.x, s * d.y, d.z}; // relative to the point of contact
    const long double a = v[0] * v[0] + v[1] * v[1] + v[2] * v[2],
                      b = o[0] * v[0] + (o[1] + r) * v[1] + o[2] * v[2];
    const long double c = o[0] * o[0] + o[1] * o[1] + o[2] * o[2] + 2 * r * o[1],
                      root = b * b - a * c;
    if (root < 0) return HUGE_VAL;
    const long double q = -(b + (b < 0 ? -sqrtl(root) : sqrtl(root)));
    return static_cast<double>(b < 0 ? c / q : q / a);
  }
};

TEST_F(Huge, TheGroundMayBeASphereOfAnyRadius) {
  const Shader white("VRML97");
  for (const double radius : {1e4, 1e5, 5e7, 1e8, 1e9, 1e10})
    for (const bool squashed : {false, true}) {
      const RTid instance = ground(radius, squashed, white);
      rtRender();
      double worst = 0;
      for (int i = 0; i < 400; i++) {
        const double down = .04 + 1.5 * i / 400, around = .7 * i;
        const RTray ray{{float(.1 * i), 2, 0},
                        0,
                        {float(std::cos(down) * std::cos(around)), float(-std::sin(down)),
                         float(std::cos(down) * std::sin(around))},
                        infinity};
        RThit hit;
        rtCastRays(1, &ray, &hit);
        const double expected =
            meets(radius, squashed, {double(ray.origin[0]), 2, 0},
                  {double(ray.direction[0]), double(ray.direction[1]), double(ray.direction[2])});
        ASSERT_TRUE(std::isfinite(hit.t)) << radius << " " << squashed << " ray " << i;
        worst = std::max(worst, std::fabs(double(hit.t) - expected) / expected);
        uint8_t blocked[2];
        RTray before = ray, beyond = ray;
        before.tfar = hit.t * .99f;
        beyond.tfar = hit.t * 1.01f;
        rtOccludedRays(1, &before, blocked);
        rtOccludedRays(1, &beyond, blocked + 1);
        EXPECT_FALSE(blocked[0]) << radius << " ray " << i;
        EXPECT_TRUE(blocked[1]) << radius << " ray " << i;
        EXPECT_GT(hit.normal[1], .9f);
      }
      EXPECT_LT(worst, 3e-7 + 2e-16 * radius) << radius << " " << squashed;
      rtDeleteInstance(instance);
    }
}

TEST_F(Huge, WhatStandsOnAHugeSphereCastsItsShadow) {
  const Shader white("VRML97");
  use(directional({-1, -1, 0}));
  for (const double radius : {1e5, 1e8, 1e10}) {
    const RTid instance = ground(radius, false, white);
    rtPushMatrix();
    rtLoadIdentity();
    rtTranslated(0, 1, 0); // a wall from the ground to a height of 2, in the plane x = 0
    rtRotated(90, 0, 1, 0);
    const RTid wall = place(square(white, 1));
    rtPopMatrix();
    rtPushMatrix();
    rtLoadIdentity();
    rtTranslated(0, 3, 0);
    rtRotated(-90, 1, 0, 0);
    const auto at = [&](double x) {
      rtPushMatrix();
      rtLoadIdentity();
      rtTranslated(x, 3, .3);
      rtRotated(-90, 1, 0, 0);
      rtOrtho(1e-6);
      rtPopMatrix();
      return render();
    };
    rtPopMatrix();
    expectGrey(at(1), .8 * std::sqrt(.5), 1e-4); // towards the light
    for (const double x : {-.2, -1.0, -1.9}) expectGrey(at(x), 0);
    expectGrey(at(-2.1), .8 * std::sqrt(.5), 1e-4);
    rtDeleteInstance(instance);
    rtDeleteInstance(wall);
  }
}

// A picture of small and large objects, with and without an object extremely far away.
TEST_F(Huge, WhatIsFarAwayChangesNothingElse) {
  const Shader white("VRML97");
  use(tilted(30));
  for (int i = 0; i < 60; i++) { // leaves and balls of .001 to .1
    const double size = .001 * std::pow(100, .5 + .5 * std::sin(2.1 * i));
    rtPushMatrix();
    rtLoadIdentity();
    rtTranslated(.15 * std::sin(1.3 * i), .15 * std::sin(2.9 * i), .2 * std::sin(3.7 * i));
    if (i % 3 == 0) {
      const RTid object = rtBeginObject(0);
      rtBindShader(white);
      rtSphere(float(size / 2));
      rtEndObject();
      rtBindShader(0);
      place(object);
    } else {
      rtRotated(37 * i, 1, .5, .2); // each has its own grey
      place(square(white, size / 2));
    }
    rtPopMatrix();
  }
  rtPushMatrix();
  rtLoadIdentity();
  rtTranslated(0, 0, 1);
  rtPerspective(25);
  rtPopMatrix();
  const std::vector<float> alone = picture(48);
  EXPECT_GT(mean(alone), .02);
  for (const double far : {1e6, 1e12, 1e16, 1e19, 1e20, 1e25}) {
    // The position is part of the object, because an instance so far away would be refused.
    const RTid object = rtBeginObject(0);
    rtTranslated(0, far, 0);
    rtBindShader(white);
    rtSphere(1);
    rtEndObject();
    rtBindShader(0);
    const RTid thing = place(object);
    const std::vector<float> with = picture(48);
    size_t other = 0;
    float worst = 0;
    for (size_t i = 0; i < alone.size(); i++) {
      other += std::fabs(alone[i] - with[i]) > 1e-5f;
      worst = std::max(worst, std::fabs(alone[i] - with[i]));
    }
    EXPECT_EQ(other, 0u) << "of " << alone.size() << " at " << far << ", by " << worst;
    rtDeleteInstance(thing);
  }
}

// A lamp above a floor so large that the ray offset exceeds the distance to the lamp. The library
// warns once and names the distance needed. It does not warn where there is room, nor about a lamp
// that touches the floor.
TEST_F(Huge, ALampTooNearToBeSeenIsWarnedOf) {
  static std::vector<std::string> said;
  said.clear();
  rtLogCallback([](int level, const char* message,
                   void*) { said.emplace_back(std::to_string(level) + message); },
                nullptr);
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  Shader floor("Diffuse"), lamp("Diffuse");
  lamp.set("emission", {1, 1, 1});
  place(square(floor, 100));
  const auto hang = [&](double height) {
    rtPushMatrix();
    rtLoadIdentity();
    rtTranslated(0, 0, height);
    rtRotated(180, 1, 0, 0);
    const RTid instance = place(square(lamp, .01));
    rtPopMatrix();
    look();
    rtDeleteInstance(instance);
  };
  for (const double height : {1.0, .001, 0.0}) hang(height);
  EXPECT_EQ(said.size(), 0u) << (said.empty() ? "" : said[0]);
  for (const double height : {1e-6, 1e-5}) hang(height);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0][0], '2');
  EXPECT_NE(said[0].find("1e-06"), std::string::npos) << said[0];
  rtLogCallback(nullptr, nullptr);
}

} // namespace
} // namespace numeric

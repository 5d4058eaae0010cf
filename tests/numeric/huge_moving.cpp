// huge_moving.cpp: things that move or deform together with something far away or huge. One frame
// of an instance cannot hold both in single precision, so they must not share one.
#include <limits>

#include "numeric/support.h"

namespace numeric {
namespace {

class HugeMoving : public Scene {
 protected:
  void SetUp() override {
    Scene::SetUp();
    white_ = Shader("VRML97");
    use(tilted(30));
    rtPushMatrix();
    rtLoadIdentity();
    rtTranslated(0, 0, 1);
    rtPerspective(25);
    rtPopMatrix();
  }

  // Draws a square about a point in the open object, as a geometry of its own.
  static void drawSquare(Vec at, double half, double turn = 0) {
    static constexpr float corners[] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
    static constexpr uint32_t indices[] = {0, 1, 2, 0, 2, 3};
    rtPushMatrix();
    rtTranslated(at.x, at.y, at.z);
    rtRotated(turn, 1, .5, .2);
    rtScaled(half, half, half);
    rtVertexPointer(3, RT_FLOAT, 0, corners);
    rtDrawElements(RT_TRIANGLES, 6, indices, 4);
    rtPopMatrix();
  }
  static void drawBall(Vec at, double radius) {
    rtPushMatrix();
    rtTranslated(at.x, at.y, at.z);
    rtSphere(float(radius));
    rtPopMatrix();
  }
  // Draws leaves and balls of .001 to .1 around a point.
  static void drawSmallThings(Vec around = {}) {
    for (int i = 0; i < 60; i++) {
      const double half = .0005 * std::pow(100, .5 + .5 * std::sin(2.1 * i));
      const Vec at{around.x + .15 * std::sin(1.3 * i), around.y + .15 * std::sin(2.9 * i),
                   around.z + .2 * std::sin(3.7 * i)};
      if (i % 3 == 0)
        drawBall(at, half);
      else
        drawSquare(at, half, 37 * i);
    }
  }
  // Defines a dynamic object and places it once.
  template <class Draw> RTid define(const Draw& draw, RTid object = 0) {
    const RTid defined = rtBeginObject(object);
    rtBindShader(white_);
    draw();
    rtEndObject();
    rtBindShader(0);
    rtObjectHint(defined, RT_DYNAMIC);
    return defined;
  }
  static void expectSame(const std::vector<float>& a, const std::vector<float>& b, double far) {
    size_t other = 0;
    for (size_t i = 0; i < a.size(); i++) other += std::fabs(a[i] - b[i]) > 1e-4f;
    EXPECT_EQ(other, 0u) << "of " << a.size() << " at " << far;
  }
  RTid white_ = 0;
};

TEST_F(HugeMoving, WhatIsFarAwayInTheSameObjectChangesNothing) {
  const RTid object = define([] { drawSmallThings(); });
  place(object);
  const std::vector<float> alone = picture(48);
  EXPECT_GT(mean(alone), .02);
  for (const double far : {1e6, 6e7, 1e8, 1e12, 1e14}) {
    define(
        [&] {
          drawSmallThings();
          drawBall({0, far, 0}, 1);
          drawSquare({-far, 0, 0}, 1);
        },
        object);
    expectSame(alone, picture(48), far);
  }
}

// The picture is that of a static object, whose frame lies at the eye.
TEST_F(HugeMoving, SmallThingsMayBePartOfAHugeOne) {
  const RTid object = define([] {}), still = rtBeginObject(0);
  rtEndObject();
  for (const double size : {1e6, 1e8, 1e10}) {
    const auto draw = [&] {
      rtBindShader(white_);
      drawSquare({0, 0, -size}, size);
      drawSmallThings();
    };
    rtBeginObject(still);
    draw();
    rtEndObject();
    const RTid instance = place(still);
    const std::vector<float> expected = picture(48);
    EXPECT_GT(mean(expected), .1);
    rtDeleteInstance(instance);
    const RTid moving = place(define(draw, object));
    expectSame(expected, picture(48), size);
    rtDeleteInstance(moving);
  }
}

// The camera is where the small things are, and nothing static says how small things are there.
TEST_F(HugeMoving, SmallThingsMayBeAtBothEnds) {
  constexpr double away = 1 << 27; // where the grid of the origin of render space has a line
  place(define([] { drawSmallThings(); }));
  const std::vector<float> alone = picture(48);
  rtPushMatrix();
  rtLoadIdentity();
  rtTranslated(away, 0, 1);
  rtPerspective(25);
  rtPopMatrix();
  place(define([] {
    drawSmallThings({-away, 0, 0});
    drawSmallThings({away, 0, 0});
  }));
  expectSame(alone, picture(48), away);
}

TEST_F(HugeMoving, OneMeshMayHoldBoth) {
  const auto mesh = [](double far) {
    std::vector<float> points;
    std::vector<uint32_t> indices;
    const auto square = [&](double x, double y, double half) {
      const auto first = uint32_t(points.size() / 3);
      for (const auto& [u, v] : {std::pair{-1., -1.}, {1., -1.}, {1., 1.}, {-1., 1.}})
        points.insert(points.end(), {float(x + half * u), float(y + half * v), 0});
      for (const uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) indices.push_back(first + corner);
    };
    for (int i = 0; i < 9; i++) square(.1 * (i % 3) - .1, .1 * (i / 3) - .1, .04);
    if (far > 0) square(far, far, far / 4);
    rtVertexPointer(3, RT_FLOAT, 0, points.data());
    rtDrawElements(RT_TRIANGLES, indices.size(), indices.data(), points.size() / 3);
  };
  const RTid object = define([&] { mesh(0); });
  place(object);
  const std::vector<float> alone = picture(48);
  EXPECT_GT(mean(alone), .1);
  for (const double far : {1e6, 1e8, 1e12}) {
    define([&] { mesh(far); }, object);
    expectSame(alone, picture(48), far);
  }
}

// A scene is a function of its state: whoever sees only the last definition gets the same picture.
TEST_F(HugeMoving, DefinitionsBeforeDoNotMatter) {
  const auto withFar = [] {
    drawSmallThings();
    drawBall({0, 1e9, 0}, 1e6);
  };
  const RTid object = define([] { drawSmallThings(); });
  const RTid instance = place(object);
  picture(48);
  define(withFar, object);
  const std::vector<float> again = picture(48);
  rtDeleteInstance(instance);
  place(define(withFar));
  EXPECT_EQ(again, picture(48));
}

TEST_F(HugeMoving, QueriesMeetSmallThingsToo) {
  place(define([] {
    drawSquare({0, 0, 0}, .5);
    drawSquare({1e8, 0, 0}, .5);
  }));
  rtRender();
  const RTray ray{{.3f, -.2f, 2}, 0, {0, 0, -1}, std::numeric_limits<float>::infinity()};
  RThit hit;
  rtCastRays(1, &ray, &hit);
  EXPECT_FLOAT_EQ(hit.t, 2);
  uint32_t count = 0;
  rtCountHits(1, &ray, &count);
  EXPECT_EQ(count, 1u);
}

} // namespace
} // namespace numeric

// facets.cpp: D8 of the accuracy catalogue: how far a lens of triangles is off the same lens
// without facets. The colour of a target shows where a ray has met it.
#include <algorithm>

#include "numeric/support.h"

namespace numeric {
namespace {

class Facets : public Scene {
 protected:
  static constexpr double half = 2, behind = -1.5; // the target
  void SetUp() override {
    Scene::SetUp();
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_WHITTED);
    rtQuality(RT_MAX_DEPTH, 2);
    const RTid object = rtBeginObject(0);
    Shader plain("VRML97");
    plain.setInt("lit", 0);
    rtBindShader(plain);
    rtBegin(RT_QUADS);
    for (const auto& c : {std::array{-1., -1.}, {1., -1.}, {1., 1.}, {-1., 1.}}) {
      rtColor3f(float(.5 + .5 * c[0]), float(.5 + .5 * c[1]), 1);
      rtVertex3d(half * c[0], half * c[1], behind);
    }
    rtEnd();
    rtEndObject();
    rtBindShader(0);
    place(object);
  }
  static RTid exactBall() {
    const RTid object = rtBeginObject(0);
    rtBindShader(Shader("Glass"));
    rtSphere(1);
    rtEndObject();
    rtBindShader(0);
    return object;
  }
  // A ball of `rings` times 2 `rings` quadrilaterals, each two triangles, about the z axis.
  static RTid facettedBall(int rings, bool smooth) {
    const RTid object = rtBeginObject(0);
    rtBindShader(Shader("Glass"));
    const auto vertex = [&](int ring, int step) {
      const double polar = pi * ring / rings, around = pi * step / rings;
      const double x = std::sin(polar) * std::cos(around), y = std::sin(polar) * std::sin(around),
                   z = std::cos(polar);
      if (smooth) rtNormal3f(float(x), float(y), float(z));
      rtVertex3d(x, y, z);
    };
    rtBegin(RT_TRIANGLES);
    for (int ring = 0; ring < rings; ring++)
      for (int step = 0; step < 2 * rings; step++) {
        if (ring + 1 < rings)
          for (const auto& [a, b] : {std::pair{0, 0}, {1, 0}, {1, 1}}) vertex(ring + a, step + b);
        if (ring > 0)
          for (const auto& [a, b] : {std::pair{0, 0}, {1, 1}, {0, 1}}) vertex(ring + a, step + b);
      }
    rtEnd();
    rtEndObject();
    rtBindShader(0);
    return object;
  }
  struct Place2 {
    double x, y;
  };
  // Returns where the rays down through places of a ring around the axis meet the target.
  static std::vector<Place2> arrivals(RTid object) {
    const RTid ball = place(object);
    std::vector<Place2> out;
    for (int i = 0; i < 60; i++) {
      const double r = .25 + .004 * i, around = 2.399963 * i; // the golden angle
      const Rgba seen = look(r * std::cos(around), r * std::sin(around), 4);
      EXPECT_GT(seen.b, .5);
      out.push_back({(double(seen.r) / double(seen.b) - .5) * 2 * half,
                     (double(seen.g) / double(seen.b) - .5) * 2 * half});
    }
    rtDeleteInstance(ball);
    return out;
  }
  static double meanDistance(const std::vector<Place2>& a, const std::vector<Place2>& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); i++) sum += std::hypot(a[i].x - b[i].x, a[i].y - b[i].y);
    return sum / double(a.size());
  }
};

// The error of flat facets is that of their normals: it falls with the width of a facet. With
// interpolated normals that of the position is left, which falls with the square of the width.
TEST_F(Facets, D8TheErrorOfAFacettedLensFallsWithItsFacets) {
  const std::vector<Place2> exact = arrivals(exactBall());
  for (const bool smooth : {false, true}) {
    std::vector<double> off;
    for (const int rings : {16, 32, 64, 128}) {
      off.push_back(meanDistance(arrivals(facettedBall(rings, smooth)), exact));
      printf("%s normals, %6d triangles: off by %.6f\n", smooth ? "interpolated" : "flat",
             4 * rings * (rings - 1), off.back());
    }
    const double slope =
        std::log2(off.front() / off.back()) / 3; // over three halvings of the width
    EXPECT_NEAR(slope, smooth ? 2 : 1, .3);
    EXPECT_TRUE(std::is_sorted(off.rbegin(), off.rend()));
    // 32 thousand triangles with flat facets are worse than a thousandth of the radius.
    EXPECT_LT(off.back(), smooth ? 1e-3 : .03);
    EXPECT_GT(off.back(), smooth ? 1e-6 : 1e-3);
  }
}

} // namespace
} // namespace numeric

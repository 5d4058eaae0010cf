// openrt_analytic.cpp: crossings of lines with quadrics and aspheres against exact solutions,
// values against finite differences, and the messages of bad numbers.
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "scene/analytic.h"

namespace openrt {
namespace {

using Kind = edit::Primitive;
using Numbers = std::vector<double>;
using Wide = long double; // 64 bits of mantissa on x86

const Numbers unitSphere{1, 1, 1, 0, 0, 0, 0, 0, 0, -1, -2, -2, -2, 2, 2, 2};

Numbers scaledSphere(double r) {
  return {1, 1, 1, 0, 0, 0, 0, 0, 0, -r * r, -2 * r, -2 * r, -2 * r, 2 * r, 2 * r, 2 * r};
}

TEST(Analytic, CrossesSpheresOfAnyScaleWhereTheExactQuadraticSays) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1), power(-8, 8);
  int met = 0;
  for (int i = 0; i < 100000; i++) {
    const double r = std::pow(10, power(random)),
                 away = r * std::pow(10, 3 * std::fabs(unit(random)));
    const AnalyticSurface surface(Kind::Quadric, scaledSphere(r));
    const Vec3d at = Vec3d{unit(random), unit(random), unit(random)} * (1.2 * r),
                from = Vec3d{unit(random), unit(random), unit(random)} * away, d = at - from;
    // In long double, about the point that was aimed at, so that nothing cancels.
    const Wide dd = Wide(d.x) * d.x + Wide(d.y) * d.y + Wide(d.z) * d.z,
               od = Wide(at.x) * d.x + Wide(at.y) * d.y + Wide(at.z) * d.z,
               oo = Wide(at.x) * at.x + Wide(at.y) * at.y + Wide(at.z) * at.z;
    const Wide square = od * od - dd * (oo - Wide(r) * r);
    if (std::fabs(double(square / (dd * Wide(r) * r))) < 1e-9) continue; // touches
    const auto found = surface.intersect(from, d);
    ASSERT_EQ(found.count, square > 0 ? 2 : 0) << i;
    if (square < 0) continue;
    met++;
    const Wide root = std::sqrt(square);
    for (int k = 0; k < 2; k++) {
      const Wide exact = 1 + (-od + (k ? root : -root)) / dd;
      const double chord = double(root / dd), size = length(from) + r;
      // The rounding of the origin moves the crossing by more where the ray grazes.
      EXPECT_NEAR(found.t[size_t(k)], double(exact),
                  1e-14 * size / double(std::sqrt(dd)) * (1 + r / (chord * double(std::sqrt(dd)))))
          << i << " r " << r << " away " << away;
    }
  }
  EXPECT_GT(met, 30000);
}

TEST(Analytic, CrossesAnyQuadricWithAResidualOfDoublePrecision) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1, 1);
  int met = 0;
  for (int i = 0; i < 100000; i++) {
    Numbers n;
    for (int k = 0; k < 10; k++) n.push_back(unit(random));
    n.insert(n.end(), {-1, -1, -1, 1, 1, 1});
    const AnalyticSurface surface(Kind::Quadric, n);
    const double away = std::pow(10, 6 * std::fabs(unit(random)));
    const Vec3d from = Vec3d{unit(random), unit(random), unit(random)} * away,
                d = Vec3d{unit(random), unit(random), unit(random)} - from;
    const auto found = surface.intersect(from, d);
    ASSERT_LE(found.count, 2);
    if (found.count == 2) { EXPECT_LT(found.t[0], found.t[1]); }
    for (int k = 0; k < found.count; k++) {
      met++;
      const Vec3d p = from + d * found.t[size_t(k)];
      Vec3d gradient;
      const double value = surface.valueAt(p, gradient);
      EXPECT_LE(std::fabs(value), 1e-14 * (10 + away * length(gradient))) << i;
      EXPECT_LE(largest(abs(p)), 1 + 1e-9);
    }
  }
  EXPECT_GT(met, 50000);
}

// Returns the number of sign changes of an asphere's equation between a and b, which are inside its
// aperture of 1.
int changesBetween(const AnalyticSurface& s, const Vec3d& a, const Vec3d& b) {
  int changes = 0;
  constexpr int steps = 4000;
  Vec3d gradient;
  double before = s.valueAt(a, gradient);
  for (int i = 1; i <= steps; i++) {
    const double value = s.valueAt(a + (b - a) * (double(i) / steps), gradient);
    changes += (value > 0) != (before > 0);
    before = value;
  }
  return changes;
}

TEST(Analytic, FindsAllCrossingsOfAWavyAsphere) {
  // It rises and falls several times within its aperture.
  const Numbers n{.3, -.5, 0, 1, 3, -14, 16, -5.2};
  const AnalyticSurface surface(Kind::Asphere, n);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  int most = 0, met = 0;
  for (int i = 0; i < 2000; i++) {
    const double turn = 4 * unit(random);
    const Vec3d a{.999 * std::cos(turn), .999 * std::sin(turn), .6 * unit(random)},
        b{.7 * unit(random), .7 * unit(random), .6 * unit(random)};
    const auto found = surface.intersect(a, b - a);
    int inside = 0;
    for (int k = 0; k < found.count; k++) {
      const Vec3d p = a + (b - a) * found.t[size_t(k)];
      Vec3d gradient;
      EXPECT_NEAR(surface.valueAt(p, gradient), 0, 1e-14 * (1 + length(gradient)));
      EXPECT_TRUE(k == 0 || found.t[size_t(k) - 1] < found.t[size_t(k)]);
      inside += found.t[size_t(k)] >= 0 && found.t[size_t(k)] <= 1;
    }
    // Two crossings within one step of the samples cancel.
    const int sampled = changesBetween(surface, a, b);
    EXPECT_EQ(inside % 2, sampled % 2) << i;
    EXPECT_GE(inside, sampled) << i;
    EXPECT_LE(inside - sampled, 2) << i;
    most = std::max(most, inside);
    met += inside;
  }
  EXPECT_GE(most, 4);
  EXPECT_GT(met, 1000);
}

TEST(Analytic, AConicAsphereIsItsQuadric) {
  // The equation with the square root, at random heights, for every kind of conic.
  for (const double conic : {0.7, 0.0, -0.4, -1.0, -2.25})
    for (const double c : {-.8, -1e-3, .25, .7}) {
      const AnalyticSurface surface(Kind::Asphere, Numbers{c, conic, 0, .9});
      for (int i = 0; i < 50; i++) {
        const double x = .9 * std::cos(i), y = .1 * std::sin(i), u = x * x + y * y;
        const double z = c * u / (1 + std::sqrt(1 - (1 + conic) * c * c * u));
        const auto found = surface.intersect({x, y, 50}, {0, 0, -1});
        ASSERT_EQ(found.count, 1);
        EXPECT_NEAR(50 - found.t[0], z, 1e-14);
      }
    }
}

TEST(Analytic, ALineInTheSurfaceAndOneThatTouchesEndQuickly) {
  const AnalyticSurface flat(Kind::Asphere, Numbers{0, 0, 0, 1});
  EXPECT_EQ(flat.intersect({-5, 0, 0}, {1, 0, 0}).count, 0);
  const AnalyticSurface wavy(Kind::Asphere, Numbers{0, 0, 0, 1, 1, -1});
  EXPECT_LE(wavy.intersect({-5, 0, 0}, {1, 0, 0}).count, 2);
  const AnalyticSurface sphere(Kind::Quadric, unitSphere);
  EXPECT_EQ(sphere.intersect({-5, 1, 0}, {1, 0, 0}).count, 0);
  EXPECT_EQ(sphere.intersect({-5, 1 - 1e-12, 0}, {1, 0, 0}).count, 2);
}

TEST(Analytic, TheApexOfAConeIsMetOnce) {
  const AnalyticSurface cone(Kind::Quadric,
                             Numbers{1, -1, 1, 0, 0, 0, 0, 0, 0, 0, -2, -2, -2, 2, 0, 2});
  const auto down = cone.intersect({0, 5, 0}, {0, -1, 0});
  ASSERT_EQ(down.count, 1);
  EXPECT_EQ(down.t[0], 5);
  EXPECT_EQ(cone.intersect({.1, 5, 0}, {0, -1, 0}).count, 1);
}

TEST(Analytic, LinesThatAreNoLinesCrossNothing) {
  const AnalyticSurface sphere(Kind::Quadric, unitSphere),
      asphere(Kind::Asphere, Numbers{.5, 0, 0, 1, .1});
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = HUGE_VAL;
  for (const AnalyticSurface* s : {&sphere, &asphere})
    for (const double bad : {nan, inf, -inf}) {
      EXPECT_EQ(s->intersect({bad, 0, 0}, {1, 0, 0}).count, 0);
      EXPECT_EQ(s->intersect({0, 0, 0}, {bad, 0, 0}).count, 0);
      EXPECT_EQ(s->intersect({0, 0, 0}, {0, 0, 0}).count, 0);
    }
}

TEST(Analytic, GradientsAndTangentsAreDerivatives) {
  const std::pair<Kind, Numbers> surfaces[] = {
      {Kind::Quadric, {1, 2, .5, .3, -.2, .1, .4, -.1, .2, -1, -2, -2, -2, 2, 2, 2}},
      {Kind::Asphere, {.5, -.7, 0, 1}},
      {Kind::Asphere, {.5, -.7, 0, 1, .2, -.1}}};
  for (const auto& [kind, numbers] : surfaces) {
    const AnalyticSurface s(kind, numbers);
    const auto found = s.intersect({.3, .4, 9}, {.01, -.02, -1});
    ASSERT_GE(found.count, 1);
    const Vec3d p = Vec3d{.3, .4, 9} + Vec3d{.01, -.02, -1} * found.t[0];
    Vec3d gradient, unused;
    s.valueAt(p, gradient);
    for (size_t k = 0; k < 3; k++) {
      Vec3d step;
      step[k] = 1e-5;
      EXPECT_NEAR((s.valueAt(p + step, unused) - s.valueAt(p - step, unused)) / 2e-5, gradient[k],
                  1e-8);
    }
    const auto tangents = s.tangentsAt(p);
    for (int k = 0; k < 2; k++) {
      const Vec3d v = k ? tangents.alongT : tangents.alongS;
      EXPECT_NEAR(dot(v, gradient), 0, 1e-12 * length(v) * length(gradient));
      const auto ahead = s.texCoordAt(p + v * 1e-6), behind = s.texCoordAt(p - v * 1e-6);
      EXPECT_NEAR((ahead[0] - behind[0]) / 2e-6, k ? 0 : 1, 1e-6);
      EXPECT_NEAR((ahead[1] - behind[1]) / 2e-6, k ? 1 : 0, 1e-6);
    }
  }
}

TEST(Analytic, APointNearTheSurfaceSettlesOnIt) {
  const std::pair<Kind, Numbers> surfaces[] = {{Kind::Quadric, unitSphere},
                                               {Kind::Asphere, {.5, -.7, 0, 1}},
                                               {Kind::Asphere, {.5, -.7, 0, 1, .2, -.1}}};
  for (const auto& [kind, numbers] : surfaces) {
    const AnalyticSurface s(kind, numbers);
    for (const Vec3d d : {Vec3d{0, 0, -1}, Vec3d{1, .2, -.1}, Vec3d{1, 0, 1e-9}}) {
      const auto found = s.intersect(Vec3d{.1, .2, .4} - d * 3, d);
      for (int k = 0; k < found.count; k++) {
        const Vec3d exact = Vec3d{.1, .2, .4} - d * 3 + d * found.t[size_t(k)];
        const Vec3d p = s.settle(exact + d * 1e-6, d);
        Vec3d gradient;
        EXPECT_NEAR(s.valueAt(p, gradient), 0, 4e-16 * (1 + length(gradient)));
        EXPECT_LT(length(p - exact), 3e-6);
      }
    }
  }
}

TEST(Analytic, BoundsHoldTheSurface) {
  const AnalyticSurface s(Kind::Asphere, Numbers{-.5, .3, .2, 1, .4, -.6, .2});
  for (int i = 0; i <= 100; i++) {
    const double r = .2 + .8 * i / 100;
    const auto found = s.intersect({r, 0, 9}, {0, 0, -1});
    ASSERT_EQ(found.count, 1) << r;
    EXPECT_GE(9 - found.t[0], s.low().z - 1e-12);
    EXPECT_LE(9 - found.t[0], s.high().z + 1e-12);
  }
}

struct Bad {
  const char* name;
  Kind kind;
  Numbers numbers;
  const char* message;
};
class BadSurface : public testing::TestWithParam<Bad> {};
TEST_P(BadSurface, HasOneClearMessage) {
  const std::string problem = AnalyticSurface::problemOf(GetParam().kind, GetParam().numbers);
  EXPECT_NE(problem.find(GetParam().message), std::string::npos) << problem;
  EXPECT_EQ(AnalyticSurface::make(GetParam().kind, GetParam().numbers), nullptr);
}
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
INSTANTIATE_TEST_SUITE_P(
    Numbers, BadSurface,
    testing::Values(
        Bad{"TooFew", Kind::Quadric, {1, 2, 3}, "ten coefficients"},
        Bad{"NotANumber",
            Kind::Quadric,
            {nan, 1, 1, 0, 0, 0, 0, 0, 0, -1, -1, -1, -1, 1, 1, 1},
            "a coefficient of the quadric is not finite"},
        Bad{"InfiniteBox",
            Kind::Quadric,
            {1, 1, 1, 0, 0, 0, 0, 0, 0, -1, -HUGE_VAL, -1, -1, 1, 1, 1},
            "box"},
        Bad{"EmptyBox",
            Kind::Quadric,
            {1, 1, 1, 0, 0, 0, 0, 0, 0, -1, 1, -1, -1, 1, 1, 1},
            "must be below"},
        Bad{"HugeBox",
            Kind::Quadric,
            {1, 1, 1, 0, 0, 0, 0, 0, 0, -1, -1e13, -1, -1, 1, 1, 1},
            "beyond 1e12"},
        Bad{"OnlyAConstant",
            Kind::Quadric,
            {0, 0, 0, 0, 0, 0, 0, 0, 0, 5, -1, -1, -1, 1, 1, 1},
            "no surface"},
        Bad{"Overflow",
            Kind::Quadric,
            {1e300, 1, 1, 0, 0, 0, 0, 0, 0, 5, -1, -1, -1, 1, 1, 1},
            "overflow"},
        Bad{"Underflow",
            Kind::Quadric,
            {1e-300, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1, -1, -1, 1, 1, 1},
            "vanish"},
        Bad{"NoAperture", Kind::Asphere, {1, 0, 0, 0}, "semi-aperture 0"},
        Bad{"NegativeAperture", Kind::Asphere, {0, 0, 0, -1}, "semi-aperture -1"},
        Bad{"ApertureNotANumber", Kind::Asphere, {0, 0, 0, nan}, "not finite"},
        Bad{"ConicOverflows", Kind::Asphere, {2, -1e308, 0, 1}, "conic constant -1e+308"},
        Bad{"CurvatureOverflows", Kind::Asphere, {1e308, -1, 0, 1}, "a million times deeper"},
        Bad{"InnerBeyondOuter", Kind::Asphere, {0, 0, 2, 1}, "inner radius 2"},
        Bad{"BeyondTheSphere", Kind::Asphere, {.1, 0, 0, 12}, "beyond its edge, which is at 10"},
        Bad{"PolynomialAtTheEdge", Kind::Asphere, {.1, 0, 0, 10, 1e-9}, "must be below 10"},
        Bad{"TooDeep", Kind::Asphere, {.1, -1, 0, 1e9}, "a million times deeper"},
        Bad{"TermsOverflow", Kind::Asphere, {.1, -1, 0, 1, 1e300, 1e308}, "a million times deeper"},
        Bad{"TooManyTerms", Kind::Asphere, Numbers(13, 1.0), "at most 8"},
        Bad{"NumbersOfASphere", Kind::Sphere, {1}, "has numbers of an analytic surface"}),
    [](const auto& info) { return std::string(info.param.name); });

} // namespace
} // namespace openrt

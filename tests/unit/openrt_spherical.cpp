// openrt_spherical.cpp: Tests the sampling of directions towards triangles and ellipsoids: solid
// angles against closed forms, uniformity (chi-square), pdfs that integrate to one, hard cases.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "render/lights/spherical.h"
#include "render/orthonormal_basis.h"
#include "render/wave/sampler.h"

using namespace openrt;

namespace {

constexpr Vec3f origin;

struct Corners {
  std::array<Vec3f, 3> at;
};
const Corners tilted{{{{1, 0, 1}, {0, 1, 1}, {-1, -1, 1}}}};
const Corners octant{{{{1, 0, 0}, {0, 2, 0}, {0, 0, 3}}}};
const Corners half{{{{100, 0, 1e-6f}, {-100, 100, 1e-6f}, {-100, -100, 1e-6f}}}};
const Corners sliver{{{{-5, 0, 1}, {5, 0, 1}, {0, 1e-4f, 1}}}};
const Corners small{{{{1e-3f, 0, 10}, {0, 1e-3f, 10}, {-1e-3f, -1e-3f, 10}}}};

// Projects a direction onto the triangle's plane; returns its barycentric coordinates.
void barycentric(const Corners& t, const Vec3d& d, double w[3]) {
  double m[3][3];
  for (int c = 0; c < 3; c++)
    for (int k = 0; k < 3; k++) m[k][c] = t.at[c][k];
  const auto det = [](double a[3][3]) {
    return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
           a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
           a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
  };
  double sum = 0;
  for (int c = 0; c < 3; c++) {
    double n[3][3];
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) n[i][j] = j == c ? d[i] : m[i][j];
    sum += w[c] = det(n) / det(m);
  }
  for (int c = 0; c < 3; c++) w[c] /= sum;
}

// Checks the chi-square statistic of counts within 4 sigma. Bins with few expected counts are left
// out.
void expectEven(const std::vector<double>& got, const std::vector<double>& expected) {
  double statistic = 0, cells = 0;
  for (size_t i = 0; i < got.size(); i++) {
    if (expected[i] < 5) continue;
    statistic += (got[i] - expected[i]) * (got[i] - expected[i]) / expected[i];
    cells++;
  }
  ASSERT_GT(cells, 8);
  EXPECT_LT(statistic, cells + 4 * std::sqrt(2 * cells));
}

// Counts samples in 6 x 6 bands of two barycentric coordinates and compares with the pdf integrated
// on a fine grid of the plane.
void spread(const Corners& t) {
  const SphericalTriangle s(t.at, origin);
  constexpr int bands = 6, samples = 40000, fine = 240;
  std::vector<double> got(bands * bands), expected(bands * bands);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < samples; i++) {
    Vec3d d;
    double distance, w[3];
    ASSERT_TRUE(s.sample(unit(random), unit(random), d, distance));
    ASSERT_NEAR(dot(d, d), 1, 1e-12);
    barycentric(t, d, w);
    for (double x : w) ASSERT_GT(x, -1e-6);
    for (int k = 0; k < 3; k++) {
      const double place = w[0] * t.at[0][k] + w[1] * t.at[1][k] + w[2] * t.at[2][k];
      ASSERT_NEAR(d[k] * distance, place, 1e-6 * distance);
    }
    const int a = std::min(bands - 1, int(std::max(0.0, w[0]) * bands)),
              b = std::min(bands - 1, int(std::max(0.0, w[1]) * bands));
    got[size_t(a * bands + b)]++;
  }
  double total = 0;
  for (int i = 0; i < fine; i++)
    for (int j = 0; i + j < fine; j++)
      for (int up = 0; up < (i + j + 1 < fine ? 2 : 1); up++) {
        const double w[2] = {(i + (up ? 2 : 1) / 3.0) / fine, (j + (up ? 2 : 1) / 3.0) / fine};
        double p[3], square = 0;
        for (int k = 0; k < 3; k++) {
          p[k] = w[0] * t.at[0][k] + w[1] * t.at[1][k] + (1 - w[0] - w[1]) * t.at[2][k];
          square += p[k] * p[k];
        }
        const double weight =
            1 / (square * std::sqrt(square)); // distance to the plane and area are constant
        total += weight;
        const int a = std::min(bands - 1, int(w[0] * bands)),
                  b = std::min(bands - 1, int(w[1] * bands));
        expected[size_t(a * bands + b)] += weight;
      }
  for (double& e : expected) e *= samples / total;
  expectEven(got, expected);
}

TEST(Spherical, SolidAnglesHaveTheirClosedForms) {
  EXPECT_NEAR(SphericalTriangle(octant.at, origin).solidAngle(), M_PI / 2, 1e-14);
  EXPECT_NEAR(SphericalTriangle(half.at, origin).solidAngle(), 2 * M_PI, 1e-6);
  for (const double s : {1e-3, 1e-5, 1e-7, 1e-9}) { // far away: area over squared distance
    const float e = float(s);
    const std::array<Vec3f, 3> corner{{{-e, -e, 1}, {2 * e, -e, 1}, {-e, 2 * e, 1}}};
    const double area = 4.5 * double(e) * double(e);
    EXPECT_NEAR(SphericalTriangle(corner, origin).solidAngle() / area, 1, 4 * s * s + 1e-12) << s;
  }
  // The eight octants cover the sphere from any point inside.
  const float v[8][3] = {{-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1},
                         {-1, -1, 1},  {1, -1, 1},  {-1, 1, 1},  {1, 1, 1}};
  const int face[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                          {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
  const Vec3f eye{.3f, -.9999f, .7f};
  double sum = 0;
  for (const auto& f : face)
    for (int part = 0; part < 2; part++) {
      const std::array<Vec3f, 3> corner{vectorOf(v[f[0]]), vectorOf(v[f[1 + part]]),
                                        vectorOf(v[f[2 + part]])};
      sum += SphericalTriangle(corner, eye).solidAngle();
    }
  EXPECT_NEAR(sum, 4 * M_PI, 1e-12);
}

TEST(Spherical, R11NothingOfTrianglesSeenEdgeOnOrWithoutArea) {
  const Corners edgeOn{{{{1, 0, 0}, {2, 0, 0}, {1, 1, 0}}}},
      line{{{{0, 0, 1}, {1, 1, 2}, {2, 2, 3}}}}, atCorner{{{{0, 0, 0}, {1, 0, 1}, {0, 1, 1}}}},
      point{{{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}}};
  for (const Corners* corners : {&edgeOn, &line, &atCorner, &point}) {
    const SphericalTriangle t(corners->at, origin);
    Vec3d d;
    double distance;
    EXPECT_EQ(t.solidAngle(), 0);
    EXPECT_FALSE(t.sample(.3, .7, d, distance));
    EXPECT_EQ(t.pdf(corners == &line ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0}), 0);
  }
}

TEST(Spherical, TrianglesAreCoveredEvenly) {
  for (const Corners* t : {&tilted, &octant, &sliver, &small}) spread(*t);
}

// R10: the point lies just below the light.
TEST(Spherical, AHemisphereIsCoveredEvenly) {
  const SphericalTriangle t(half.at, origin);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<double> got(16 * 4), expected(16 * 4, 50000 / 64.0);
  for (int i = 0; i < 50000; i++) {
    Vec3d d;
    double distance;
    if (!t.sample(unit(random), unit(random), d, distance)) continue;
    const int ring = std::min(3, int(d[2] * 4)),
              turn = int((std::atan2(d[1], d[0]) / (2 * M_PI) + .5) * 16) % 16;
    got[size_t(16 * ring + turn)]++;
  }
  expectEven(got, expected);
}

TEST(Spherical, FarTrianglesAreSpreadByArea) {
  for (const float e : {.2f, 1e-3f, 1e-6f, 1e-9f}) {
    const std::array<Vec3f, 3> corner{{{e, 0, 1}, {0, e, 1}, {-e, -e, 1}}};
    const SphericalTriangle t(corner, origin);
    ASSERT_TRUE(t.far() || e > .1f);
    double sum = 0;
    for (uint32_t i = 0; i < 4096; i++) { // the mean of 1 / pdf is the solid angle
      float u, v;
      PairSampler(1, 2, 3)(i, u, v);
      Vec3d d;
      double distance;
      ASSERT_TRUE(t.sample(u, v, d, distance));
      sum += 1 / t.pdf(d) / 4096;
    }
    EXPECT_NEAR(sum / t.solidAngle(), 1, 1e-4) << e;
  }
}

// Compares the noise of the irradiance from a square lamp at one sample, sampled by solid angle and
// by area: below the centre, below a corner, and near.
TEST(Spherical, SolidAnglesAreLessNoisyThanAreas) {
  const double places[3][3] = {
      {0, 0, 1}, {.5, .5, .5}, {0, 0, .1}}; // position of the eye relative to the lamp's centre
  double ratio[3];
  for (int p = 0; p < 3; p++) {
    double sums[2][2] = {};
    for (uint32_t i = 0; i < 1 << 14; i++) {
      const float half = .5f, x = float(-places[p][0]), y = float(-places[p][1]),
                  z = float(places[p][2]);
      const bool second = i & 1;
      const std::array<Vec3f, 3> corner{{{x - half, y - half, z},
                                         {x + half, y + (second ? half : -half), z},
                                         {x + (second ? -half : half), y + half, z}}};
      float u, v;
      PairSampler(5, 6, 7)(i >> 1, u, v);
      const SphericalTriangle t(corner, origin);
      Vec3d d;
      double distance;
      if (t.sample(u, v, d, distance)) {
        const double e = 2 * d[2] / t.pdf(d);
        sums[0][0] += e;
        sums[0][1] += e * e;
      }
      const double root = std::sqrt(double(u)), w[3] = {1 - root, root * (1 - v), root * v};
      double way[3], square = 0;
      for (int k = 0; k < 3; k++) {
        way[k] = w[0] * corner[0][k] + w[1] * corner[1][k] + w[2] * corner[2][k];
        square += way[k] * way[k];
      }
      const double e =
          way[2] * way[2] / (square * square); // area 1 x both cosines over squared distance
      sums[1][0] += e;
      sums[1][1] += e * e;
    }
    double variance[2];
    for (int i = 0; i < 2; i++)
      variance[i] = sums[i][1] / (1 << 14) - std::pow(sums[i][0] / (1 << 14), 2);
    EXPECT_NEAR(sums[0][0] / sums[1][0], 1, 5e-3);
    ratio[p] = variance[1] / variance[0];
    std::printf("variance by area over that by solid angle: %.2f\n", ratio[p]);
  }
  EXPECT_GT(ratio[0], 1);
  EXPECT_GT(ratio[2], 10);
}

// Checks that sampled points lie on the ellipsoid and that the mean of 1 / pdf is the solid angle.
void ellipsoid(const Affine& toRender, const Vec3f& eye, double expectedSolidAngle) {
  const SphericalEllipsoid s(inverseOf(toRender), toRender, eye);
  double sum = 0, longest = 0;
  const int n = 1 << 14;
  for (int i = 0; i < n; i++) {
    float u, v;
    PairSampler(1, 2, 3)(uint32_t(i), u, v);
    Vec3d d;
    double distance;
    if (!s.sample(u, v, d, distance)) continue;
    const Vec3d local = inverseOf(toRender).point(Vec3d(eye) + distance * d);
    longest = std::max(longest, std::fabs(dot(local, local) - 1));
    sum += 1 / s.pdf(d) / n; // estimates the solid angle
  }
  EXPECT_LT(longest, 1e-3);
  EXPECT_NEAR(sum / expectedSolidAngle, 1, 1e-3);
}

TEST(Spherical, SpheresAndEllipsoidsAreCoveredEvenly) {
  const Affine unit{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  const Vec3f at3{0, 0, 3}, far{0, 0, 1e4f};
  ellipsoid(unit, at3, 2 * M_PI * (1 - std::sqrt(8.0) / 3));
  ellipsoid(unit, far, M_PI * 1e-8);
  // A flat ellipsoid seen along its short axis, from far away, has the solid angle of a disc with
  // the tangent cone's radius.
  const Affine flat{{{2, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, .5f, 0}}};
  // Tangent of the cone's half angle: r / sqrt(h^2 - c^2).
  const double tangent = 2 / std::sqrt(9 - .25);
  ellipsoid(flat, at3, 2 * M_PI * (1 - 1 / std::sqrt(1 + tangent * tangent)));
}

TEST(Spherical, InsideASphereThereIsNothingToChoose) {
  const Affine unit{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  const Vec3f inside{.5f, 0, 0}, on{0, 1, 0};
  for (const Vec3f& eye : {inside, on}) {
    const SphericalEllipsoid s(unit, unit, eye);
    const Vec3d any{0, 0, 1};
    Vec3d d;
    double distance;
    EXPECT_TRUE(s.inside());
    EXPECT_FALSE(s.sample(.5, .5, d, distance));
    EXPECT_EQ(s.pdf(any), 0);
  }
}

// Checks that the frame is right-handed and orthonormal everywhere, and continuous except near one
// direction.
template <class T> void checkFrames(double tolerance) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  int jumps = 0;
  for (int i = 0; i < 200000; i++) {
    const auto component = [&] { return normal(random); };
    const Vec3d d = normalize(Vec3d{component(), component(), i % 3 ? component() : 0.0});
    const Vec3d other = d + 1e-3 * Vec3d{component(), component(), component()};
    const Vec3<T> n(d), m(normalize(other));
    Vec3<T> s, t, near, beside;
    basisOf(n, s, t);
    basisOf(m, near, beside);
    for (const T zero : {dot(s, t), dot(s, n), dot(t, n), dot(s, s) - 1, dot(t, t) - 1})
      ASSERT_NEAR(double(zero), 0, tolerance);
    ASSERT_GT(dot(cross(s, t), n), 0.99);
    jumps += dot(s, near) < 0.99;
  }
  EXPECT_LT(jumps, 20) << "of 200,000 pairs that are about a milliradian apart";
}

TEST(Frame, IsRightHandedOrthonormalAndContinuous) {
  checkFrames<double>(1e-13);
  checkFrames<float>(6e-6);
  // Also along the direction where it jumps.
  const double pole[3] = {0.6649982694690716, 0.11246117974981107, -0.7383290490373657};
  for (const double off : {0.0, 1e-12, 1e-7, 1e-5, 1e-3, .05, .1, .15}) {
    const Vec3f n = normalize(Vec3f{float(pole[0] + off), float(pole[1]), float(pole[2])});
    Vec3f s, t;
    basisOf(n, s, t);
    EXPECT_TRUE(isFinite(s) && isFinite(t));
    EXPECT_NEAR(dot(s, n), 0, 3e-6) << off;
    EXPECT_NEAR(dot(t, n), 0, 3e-6) << off;
    EXPECT_NEAR(dot(s, t), 0, 3e-6) << off;
  }
}

} // namespace

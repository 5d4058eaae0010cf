// openrt_vec3.cpp: tests vectors, 3x3 matrices and the maps that use them, against values computed
// by hand or in long double.
#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <sstream>

#include "render/records.h"
#include "render/surface/scatter.h"
#include "render/wave/points.h"

using namespace openrt;

namespace openrt {

// Prints vectors in failures.
template <class T> void PrintTo(const Vec3<T>& v, std::ostream* out) {
  *out << v.x << ' ' << v.y << ' ' << v.z;
}

} // namespace openrt

namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

void expectNear(const Vec3d& a, const Vec3d& b, double tolerance) {
  for (size_t k = 0; k < 3; k++) EXPECT_NEAR(a[k], b[k], tolerance) << "component " << k;
}

TEST(Vec3, ComputesComponentByComponent) {
  const Vec3f a{1, 2, 3}, b{4, 5, -6};
  EXPECT_EQ(a + b, (Vec3f{5, 7, -3}));
  EXPECT_EQ(a - b, (Vec3f{-3, -3, 9}));
  EXPECT_EQ(-b, (Vec3f{-4, -5, 6}));
  EXPECT_EQ(a * b, (Vec3f{4, 10, -18}));
  EXPECT_EQ(2 * a, (Vec3f{2, 4, 6}));
  EXPECT_EQ(a * 2, 2 * a);
  EXPECT_EQ(b / 2, (Vec3f{2, 2.5f, -3}));
  Vec3f sum = a;
  sum += b;
  sum -= a;
  sum *= 3;
  EXPECT_EQ(sum, 3 * b);
  EXPECT_EQ(abs(b), (Vec3f{4, 5, 6}));
  EXPECT_EQ(min(a, b), (Vec3f{1, 2, -6}));
  EXPECT_EQ(max(a, b), (Vec3f{4, 5, 3}));
  EXPECT_EQ(largest(b), 5);
  EXPECT_EQ(smallest(b), -6);
}

TEST(Vec3, MultipliesVectors) {
  const Vec3d a{1, 2, 3}, b{4, 5, -6};
  EXPECT_EQ(dot(a, b), -4);
  EXPECT_EQ(cross(a, b), (Vec3d{-27, 18, -3}));
  EXPECT_EQ(cross(Vec3d{1, 0, 0}, Vec3d{0, 1, 0}), (Vec3d{0, 0, 1}));
  EXPECT_EQ(length(Vec3d{2, 3, 6}), 7);
  EXPECT_EQ(normalize(Vec3d{0, 0, -8}), (Vec3d{0, 0, -1}));
  EXPECT_EQ(normalize(Vec3d()), Vec3d());
  EXPECT_EQ(normalize(Vec3f{nan, 1, 0}), Vec3f());
}

// Pictures are equal byte for byte only while sums run from x to z: (1 + 2^-24) + 2^-24 is 1 in
// float, and 1 + (2^-24 + 2^-24) is not.
TEST(Vec3, SumsRunFromXToZ) {
  const Vec3f ones{1, 1, 1};
  EXPECT_EQ(dot(Vec3f{1, 0x1p-24f, 0x1p-24f}, ones), 1);
  EXPECT_GT(dot(Vec3f{0x1p-24f, 0x1p-24f, 1}, ones), 1);
}

TEST(Vec3, AgreesWithLongDouble) {
  using Long = Vec3<long double>;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> number(-1, 1);
  const auto vector = [&] { return Vec3d{number(random), number(random), number(random)}; };
  for (int i = 0; i < 1000; i++) {
    const Vec3d a = vector(), b = vector();
    const Long exactA(a), exactB(b);
    EXPECT_NEAR(dot(a, b), double(dot(exactA, exactB)), 1e-15);
    expectNear(cross(a, b), Vec3d(cross(exactA, exactB)), 1e-15);
    EXPECT_NEAR(length(a), double(length(exactA)), 1e-15);
    expectNear(normalize(a), Vec3d(normalize(exactA)), 1e-15);
    EXPECT_NEAR(dot(a, cross(a, b)), 0, 1e-15);
  }
}

TEST(Vec3, KnowsNumbersThatAreNotFinite) {
  EXPECT_TRUE(isFinite(Vec3f{1, 2, 3}));
  for (size_t k = 0; k < 3; k++)
    for (const float bad : {infinite, -infinite, nan}) {
      Vec3f v{1, 2, 3};
      v[k] = bad;
      EXPECT_FALSE(isFinite(v)) << k;
    }
  // As with std::min and std::max, the first argument wins against a NaN in the second.
  EXPECT_EQ(min(Vec3f{1, 2, 3}, Vec3f{nan, nan, nan}), (Vec3f{1, 2, 3}));
  EXPECT_EQ(max(Vec3f{1, 2, 3}, Vec3f{nan, nan, nan}), (Vec3f{1, 2, 3}));
}

TEST(Vec3, LoadsAndStores) {
  float x[2] = {1, 2}, y[2] = {3, 4}, z[2] = {5, 6};
  float* const arrays[3] = {x, y, z};
  EXPECT_EQ(load(arrays, 1), (Vec3f{2, 4, 6}));
  store(Vec3f{7, 8, 9}, arrays, 0);
  EXPECT_EQ(load(arrays, 0), (Vec3f{7, 8, 9}));
  EXPECT_EQ(load(arrays, 1), (Vec3f{2, 4, 6}));
  float row[4] = {0, 0, 0, 1};
  store(Vec3f{7, 8, 9}, row);
  EXPECT_EQ(vectorOf(row), (Vec3f{7, 8, 9}));
  EXPECT_EQ(row[3], 1);
  float block[3][4] = {};
  store(Vec3f{7, 8, 9}, block, 2);
  for (size_t k = 0; k < 3; k++) EXPECT_EQ(block[k][2], float(7 + k));
  EXPECT_EQ(Vec3f(Vec3d{0.1, 0.2, 0.3}), (Vec3f{0.1f, 0.2f, 0.3f}));
}

TEST(Rows, MultipliesVectorsInTheirPrecision) {
  const Rows<float> m{{1, 2, 3}, {4, 5, 6}, {7, 8, 10}};
  EXPECT_EQ((m * Vec3f{1, 0, -1}), (Vec3f{-2, -2, -3}));
  EXPECT_EQ(m[1], (Vec3f{4, 5, 6}));
  EXPECT_EQ(m.column(2), (Vec3f{3, 6, 10}));
  const Rows<float> same = Rows<float>::ofColumns({1, 4, 7}, {2, 5, 8}, {3, 6, 10});
  for (size_t k = 0; k < 3; k++) EXPECT_EQ(same[k], m[k]);
  // The sum 1 + 2^-30 exists in double only.
  const Vec3d v{1, 0x1p-30, 0};
  EXPECT_EQ((Rows<float>{{1, 1, 0}, {}, {}} * v).x, 1 + 0x1p-30);
}

// A stretched, turned and moved frame.
const Affine skew{{{2, 1, 0, 10}, {0, 3, 0, 20}, {0, 1, 0.5f, 30}}};

TEST(Affine, MapsPointsAndDirections) {
  const Vec3f p{1, 2, 3};
  EXPECT_EQ(skew.direction(p), (Vec3f{4, 6, 3.5f}));
  EXPECT_EQ(skew.point(p), (Vec3f{14, 26, 33.5f}));
  EXPECT_EQ(skew.pointFromTranslation(p), skew.point(p)); // these sums are exact
  EXPECT_EQ(skew.point(Vec3d(p)), Vec3d(skew.point(p)));
  EXPECT_EQ(skew.transposed(p), (Vec3f{2, 10, 1.5f}));
  EXPECT_EQ(skew.translation(), (Vec3f{10, 20, 30}));
  EXPECT_EQ(determinantOf(skew), 3);
  EXPECT_EQ(squaredNormOf(skew), 4 + 1 + 9 + 1 + 0.25);
  const Vec3f back = inverseOf(skew).point(skew.point(p));
  expectNear(Vec3d(back), Vec3d(p), 1e-5);
}

// A plane x + z = 1 that is stretched by 2 along x has the normal (1/2, 0, 1): the image of its
// normal as a direction, (2, 0, 1), is not at right angles to it.
TEST(Affine, NormalsAreMappedByTheInverseTranspose) {
  const Affine stretch{{{2, 0, 0, 5}, {0, 1, 0, 6}, {0, 0, 1, 7}}};
  EXPECT_EQ(stretch.normal(Vec3f{1, 0, 1}), (Vec3f{0.5f, 0, 1}));
  std::mt19937 random(9);
  std::uniform_real_distribution<double> number(-1, 1);
  const auto vector = [&] { return Vec3d{number(random), number(random), number(random)}; };
  for (const Affine& m : {stretch, skew})
    for (int i = 0; i < 100; i++) {
      const Vec3d a = vector(), b = vector(), n = m.normal(cross(a, b));
      EXPECT_NEAR(dot(n, m.direction(a)), 0, 1e-6);
      EXPECT_NEAR(dot(n, m.direction(b)), 0, 1e-6);
      expectNear(inverseOf(m).transposed(cross(a, b)), n, 0);
    }
}

TEST(Affine, ASingularMapHasNoInverse) {
  const Affine flat{{{1, 0, 0, 1}, {0, 1, 0, 2}, {0, 0, 0, 3}}};
  EXPECT_EQ(determinantOf(flat), 0);
  EXPECT_EQ(inverseOf(flat).point(Vec3f{1, 2, 3}), Vec3f());
  EXPECT_EQ(flat.normal(Vec3f{0, 0, 1}), Vec3f());
}

TEST(Affine, AgreesWithTheMatrixInDouble) {
  Matrix4d m;
  m.m = {2, 0, 0, 0, 1, 3, 1, 0, 0, 0, 0.5, 0, 10, 20, 30, 1};
  const Affine map = Affine::from(m);
  const Vec3d p{0.25, -4, 8};
  EXPECT_EQ(map.point(p), m.point(p));
  EXPECT_EQ(map.direction(p), m.direction(p));
  EXPECT_EQ(map.transposed(p), m.transposed(p));
  for (int k = 0; k < 3; k++) EXPECT_EQ(Vec3d(map.row(k)), m.row(k));
  expectNear(inverseOf(map).point(p), inverse(m).point(p), 1e-5);
}

TEST(Scattering, MirrorsAndRefracts) {
  const Vec3f n{0, 0, 1}, d = normalize(Vec3f{1, 0, -1});
  expectNear(Vec3d(reflectAt(d, n)), Vec3d{std::sqrt(0.5), 0, std::sqrt(0.5)}, 1e-7);
  double behind;
  fresnel(std::sqrt(0.5), 1 / 1.5, behind);
  const Vec3f refracted = refractAt(d, n, 1 / 1.5, std::sqrt(0.5), behind);
  EXPECT_NEAR(refracted.x, std::sqrt(0.5) / 1.5, 1e-6); // Snell's law
  EXPECT_LT(refracted.z, 0);
  EXPECT_NEAR(length(refracted), 1, 1e-6);
}

TEST(OffsetPoint, LeavesTheErrorBoundOnTheSideOfTheNormal) {
  const Vec3f p{1, -2, 0}, n{0, 0.6f, -0.8f}, moved = offsetPoint(p, n, 1e-3f);
  EXPECT_EQ(moved.x, p.x); // no step along this axis
  EXPECT_GT(moved.y, p.y + 0.6e-3f);
  EXPECT_LT(moved.z, -0.8e-3f);
  EXPECT_GT(dot(Vec3d(moved) - Vec3d(p), Vec3d(n)), 1e-3);
}

} // namespace

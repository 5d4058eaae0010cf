// xvrml_matrix.cpp: matrices of nodes against closed forms: Transform, TextureTransform, Billboard,
// field of view.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "geometry/matrix.h"

using namespace xvrml;

namespace {

constexpr double pi = std::numbers::pi;

void expectNear(const Vector& got, const Vector& want, double tolerance = 1e-12) {
  EXPECT_NEAR(got.x, want.x, tolerance);
  EXPECT_NEAR(got.y, want.y, tolerance);
  EXPECT_NEAR(got.z, want.z, tolerance);
}

TEST(Matrix, RotationTurnsCounterClockwiseAboutItsAxis) {
  expectNear(transformPoint(rotation(Vector(0, 0, 2), pi / 2), {1, 0, 5}), {0, 1, 5});
  expectNear(transformPoint(rotation(Vector(1, 0, 0), pi / 2), {0, 1, 0}), {0, 0, 1});
  expectNear(transformPoint(rotation(Vector(0, 3, 0), pi / 2), {0, 0, 1}), {1, 0, 0});
  expectNear(transformPoint(rotation(Vector(1, 1, 1), 2 * pi / 3), {1, 2, 3}), {3, 1, 2});
}

TEST(Matrix, RotationWithoutAnAxisDoesNotTurn) {
  EXPECT_EQ(rotation(Vector(0), 1.0), Matrix());
  EXPECT_EQ(rotation(Vector(0, 0, 1), NAN), Matrix());
}

TEST(Matrix, ComposeLetsTheSecondActFirst) {
  const Matrix m = compose(translation({10, 0, 0}), scaling({2, 2, 2}));
  expectNear(transformPoint(m, {1, 1, 1}), {12, 2, 2});
}

// Clause 6.52 gives the closed form P' = T C R SR S -SR -C P; here it is applied step by step to a
// point.
TEST(Matrix, TransformIsTheStandardsSequence) {
  TransformFields f;
  f.center = {1, -2, 3};
  f.translation = {4, 5, -6};
  f.scale = {2, 0.5f, 3};
  f.rotation = {1, 2, -2, 0.7f};
  f.scaleOrientation = {0, 1, 1, -1.1f};
  const Vector p(0.3, -0.4, 0.9);
  Vector q = p - vector(f.center);
  q = transformPoint(rotation(Vector(0, 1, 1), 1.1f), q);
  q = Vector(q.x * 2, q.y * 0.5, q.z * 3);
  q = transformPoint(rotation(Vector(0, 1, 1), -1.1f), q);
  q = transformPoint(rotation(Vector(1, 2, -2), 0.7f), q);
  q = q + vector(f.center) + vector(f.translation);
  expectNear(transformPoint(transformMatrix(f), p), q);
}

TEST(Matrix, TransformKeepsItsCenterButForTheTranslation) {
  TransformFields f;
  f.center = {3, 4, 5};
  f.scale = {7, 8, 9};
  f.rotation = {0, 1, 0, 1};
  f.translation = {1, 1, 1};
  expectNear(transformPoint(transformMatrix(f), {3, 4, 5}), {4, 5, 6});
}

TEST(Matrix, TransformWithDefaultsIsExactlyTheIdentity) {
  TransformFields f;
  EXPECT_EQ(transformMatrix(f), Matrix());
}

TEST(Matrix, InverseUndoes) {
  TransformFields f;
  f.translation = {1e6f, 2, 3};
  f.scale = {1e-3f, 2, 5};
  f.rotation = {1, 1, 0, 2};
  Matrix inverse;
  const Matrix m = transformMatrix(f);
  ASSERT_TRUE(invert(m, inverse));
  expectNear(transformPoint(inverse, transformPoint(m, {1, 2, 3})), {1, 2, 3}, 1e-6);
  EXPECT_FALSE(invert(scaling({1, 0, 1}), inverse));
  EXPECT_FALSE(invert(scaling({1, INFINITY, 1}), inverse));
}

// Clause 6.49 gives Tc' = -C S R C T Tc: the translation acts first, then +C, and -C last.
TEST(Matrix, TextureTransform) {
  const Matrix scaled = textureMatrix({0.5f, 0.5f}, 0, {2, 4}, {0, 0});
  expectNear(transformPoint(scaled, {-0.5, -0.5, 0}), {-0.5, -0.5, 0});
  expectNear(transformPoint(scaled, {1, 1, 0}), {2.5, 5.5, 0});
  const Matrix all = textureMatrix({0.25f, 0.75f}, float(pi / 2), {3, 2}, {0.5f, -1});
  // By hand for (0.1, 0.2): T (0.6,-0.8), C (0.85,-0.05), R (0.05,0.85), S (0.15,1.7), -C
  // (-0.1,0.95).
  expectNear(transformPoint(all, {0.1f, 0.2f, 0}), {-0.1, 0.95, 0}, 1e-6);
}

TEST(Matrix, BillboardTurnsItsZAxisToTheViewerAboutTheAxis) {
  const Matrix m = billboardMatrix({0, 1, 0}, {5, 3, 0}, {0, 1, 0});
  expectNear(transformDirection(m, {0, 0, 1}), {1, 0, 0});
  expectNear(transformDirection(m, {0, 1, 0}), {0, 1, 0});
  const Matrix skew = billboardMatrix({1, 1, 0}, {2, -3, 4}, {0, 1, 0});
  const Vector axis = Vector(1, 1, 0).normalized(), z = transformDirection(skew, {0, 0, 1});
  EXPECT_NEAR(z.dot(axis.cross(Vector(2, -3, 4))), 0, 1e-12)
      << "z, axis and viewer lie in one plane";
  EXPECT_GT(z.dot(Vector(2, -3, 4) - axis * axis.dot(Vector(2, -3, 4))), 0);
}

TEST(Matrix, BillboardWithAxisZeroFacesTheViewerUpright) {
  const Matrix m = billboardMatrix({0, 0, 0}, {0, 0, -7}, {0, 1, 0});
  expectNear(transformDirection(m, {0, 0, 1}), {0, 0, -1});
  expectNear(transformDirection(m, {0, 1, 0}), {0, 1, 0});
  expectNear(transformDirection(m, {1, 0, 0}), {-1, 0, 0});
}

TEST(Matrix, BillboardOnItsOwnAxisOrPlaceStaysAsItIs) {
  EXPECT_EQ(billboardMatrix({0, 1, 0}, {0, 4, 0}, {0, 1, 0}), Matrix());
  EXPECT_EQ(billboardMatrix({0, 0, 1}, {1, 0, 0}, {0, 1, 0}), Matrix());
  EXPECT_EQ(billboardMatrix({0, 1, 0}, {0, 0, 0}, {0, 1, 0}), Matrix());
}

TEST(Matrix, FieldOfViewIsForTheSmallerSide) {
  EXPECT_DOUBLE_EQ(verticalFieldOfView(0.8, 4.0 / 3), 0.8);
  EXPECT_DOUBLE_EQ(verticalFieldOfView(0.8, 1), 0.8);
  EXPECT_NEAR(std::tan(verticalFieldOfView(0.8, 0.5) / 2) * 0.5, std::tan(0.4), 1e-12);
  EXPECT_NEAR(verticalFieldOfView(0, 1), pi / 4, 1e-12);
  EXPECT_NEAR(verticalFieldOfView(4, 1), pi / 4, 1e-12);
}

TEST(Matrix, TheLargestStretchIsTheLargestSingularValue) {
  EXPECT_EQ(largestStretch(Matrix()), 1);
  EXPECT_EQ(largestStretch(scaling({2, -7, 3})), 7);
  EXPECT_EQ(largestStretch(scaling({0, 0, 0})), 0);
  EXPECT_EQ(largestStretch(translation({5, 6, 7})), 1);
  // The axes of a turned scale have their lengths, up to rounding.
  const Matrix turn = rotation(Vector(1, 2, 3), 0.6);
  EXPECT_NEAR(largestStretch(compose(turn, scaling({2, 3, 4}))), 4, 1e-14);
  // A scale of something turned shears it: the stretch stays, the axes get shorter.
  EXPECT_NEAR(largestStretch(compose(scaling({2, 3, 4}), turn)), 4, 1e-9);
  EXPECT_NEAR(largestStretch(compose(scaling({1, 1e30, 1}), turn)), 1e30, 1e21);
  EXPECT_NEAR(largestStretch(compose(scaling({1, 0, 0}), turn)), 1, 1e-9);
  TransformFields fields;
  fields.scale = {1, 8, 1};
  fields.scaleOrientation = {0, 0, 1, 0.7f};
  EXPECT_NEAR(largestStretch(transformMatrix(fields)), 8, 1e-6);
  // x' = x + y: the golden ratio.
  Matrix shear;
  shear.x[1][0] = 1;
  EXPECT_NEAR(largestStretch(shear), std::numbers::phi, 1e-9);
}

TEST(Matrix, RigidDropsScaleAndKeepsDirections) {
  const Matrix turn = rotation(Vector(1, 2, 3), 0.6);
  const Matrix m = compose(translation({1, 2, 3}), compose(turn, scaling({2, 3, 4})));
  const Matrix r = rigid(m);
  expectNear(transformPoint(r, {0, 0, 0}), {1, 2, 3});
  for (const Vector& v : {Vector(1, 0, 0), Vector(0, 1, 0), Vector(0, 0, 1)})
    expectNear(transformDirection(r, v), transformDirection(turn, v));
  EXPECT_NEAR(determinant(rigid(scaling({1, 0, 1}))), 1, 1e-12);
  EXPECT_NEAR(determinant(rigid(scaling({0, 0, 0}))), 1, 1e-12);
}

} // namespace

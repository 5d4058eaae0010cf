// openrt_api_matrices.cpp: Tests the matrix stack against closed forms, and its errors.
#include <cmath>
#include <limits>

#include "unit/openrt_api_support.h"

namespace {

using namespace openrt::test;

const std::vector<double> identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
constexpr double infinity = std::numeric_limits<double>::infinity(),
                 nan = std::numeric_limits<double>::quiet_NaN();

void expectMatrix(const std::vector<double>& expected, double tolerance = 0) {
  const std::vector<double> m = currentMatrix();
  for (int i = 0; i < 16; i++) EXPECT_NEAR(m[i], expected[i], tolerance) << "element " << i;
}

TEST_F(ApiTest, MatricesStartAtTheIdentity) { expectMatrix(identity); }

TEST_F(ApiTest, TranslateScaleComposeFromTheRight) {
  rtTranslated(1, 2, 3);
  rtScaled(2, 3, 4);
  expectMatrix({2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 1, 2, 3, 1});
  rtTranslatef(1, 1, 1);
  expectMatrix({2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 3, 5, 7, 1});
}

TEST_F(ApiTest, RotationAboutAnAxisOfAnyLength) {
  const double c = std::cos(M_PI / 6), s = std::sin(M_PI / 6);
  rtRotated(30, 0, 0, 5);
  expectMatrix({c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, 1e-15);
  rtLoadIdentity();
  rtRotated(120, 1, 1, 1); // x -> y -> z -> x
  expectMatrix({0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0, 1}, 1e-15);
  rtLoadIdentity();
  rtRotated(30, 0, 0, 1e-200);
  expectMatrix({c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, 1e-15);
}

TEST_F(ApiTest, QuarterTurnsAreExact) {
  for (int i = 0; i < 4; i++) rtRotatef(90, 0, 1, 0);
  expectMatrix(identity);
  rtRotated(-270, 1, 0, 0);
  expectMatrix({1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1});
  rtLoadIdentity();
  rtRotated(360.0 * 12345678, 1, 2, 3);
  expectMatrix(identity);
}

// Applies 1000 nested rotations of 0.36 degrees and scales of 1.001: one full turn, and a scale of
// 1.001^1000.
TEST_F(ApiTest, ALongProductStaysAccurate) {
  for (int i = 0; i < 1000; i++) {
    rtPushMatrix();
    rtRotated(0.36, 0, 1, 0);
    rtScaled(1.001, 1.001, 1.001);
  }
  const double scale = std::pow(1.001, 1000);
  expectMatrix({scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, 1}, 1e-11);
}

TEST_F(ApiTest, PushAndPop) {
  rtPushMatrix();
  rtTranslated(1, 2, 3);
  rtPopMatrix();
  expectMatrix(identity);
  EXPECT_FAILS(RT_STACK_UNDERFLOW, rtPopMatrix());
  expectMatrix(identity);
}

TEST_F(ApiTest, TheStackHoldsAtLeastAThousandAndOverflowsCleanly) {
  int pushed = 0;
  rtTranslated(5, 0, 0);
  while (rtGetError() == RT_NO_ERROR && pushed < 1000000) {
    rtPushMatrix();
    pushed++;
  }
  EXPECT_GE(pushed, 1000);
  EXPECT_LT(pushed, 1000000);
  for (int i = 0; i < pushed - 1; i++) rtPopMatrix(); // the last push failed
  EXPECT_RT_ERROR(RT_NO_ERROR);
  rtPopMatrix();
  EXPECT_RT_ERROR(RT_STACK_UNDERFLOW);
  expectMatrix({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1});
}

TEST_F(ApiTest, LoadAndMultiplyInBothTypes) {
  float f[16];
  double d[16];
  for (int i = 0; i < 16; i++) d[i] = f[i] = static_cast<float>(identity[i]);
  f[12] = 0.1f;
  d[12] = 0.1;
  rtLoadMatrixf(f);
  rtMultMatrixd(d);
  EXPECT_EQ(currentMatrix()[12], double(0.1f) + 0.1);
  rtLoadMatrixd(d);
  rtMultMatrixf(f);
  EXPECT_EQ(currentMatrix()[12], 0.1 + double(0.1f));
}

TEST_F(ApiTest, LookAtIsTheInverseOfGluLookAt) {
  rtLookAt(1, 2, 3, 1, 2, -7, 0, 1, 0); // looks down -z
  expectMatrix({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1}, 1e-15);
  rtLoadIdentity();
  rtLookAt(0, 0, 0, 5, 0, 0, 0, 0, 2); // looks down +x with z up, so right is -y
  expectMatrix({0, -1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 0, 0, 0, 0, 1}, 1e-15);
}

TEST_F(ApiTest, BadMatricesAreErrorsAndChangeNothing) {
  rtTranslated(1, 2, 3);
  const std::vector<double> before = currentMatrix();
  double m[16], projective[16];
  float f[16];
  for (int i = 0; i < 16; i++) {
    m[i] = projective[i] = identity[i];
    f[i] = static_cast<float>(identity[i]);
  }
  m[5] = nan;
  f[5] = std::numeric_limits<float>::infinity();
  projective[11] = -1;
  EXPECT_FAILS(RT_INVALID_VALUE, rtLoadMatrixd(m));
  EXPECT_FAILS(RT_INVALID_VALUE, rtMultMatrixd(m));
  EXPECT_FAILS(RT_INVALID_VALUE, rtLoadMatrixf(f));
  EXPECT_FAILS(RT_INVALID_VALUE, rtMultMatrixf(f));
  EXPECT_FAILS(RT_INVALID_VALUE, rtLoadMatrixd(projective));
  EXPECT_FAILS(RT_INVALID_VALUE, rtLoadMatrixd(nullptr));
  EXPECT_FAILS(RT_INVALID_VALUE, rtMultMatrixf(nullptr));
  EXPECT_FAILS(RT_INVALID_VALUE, rtTranslated(0, infinity, 0));
  EXPECT_FAILS(RT_INVALID_VALUE, rtTranslatef(0, 0, std::nanf("")));
  EXPECT_FAILS(RT_INVALID_VALUE, rtScaled(1, nan, 1));
  EXPECT_FAILS(RT_INVALID_VALUE, rtScalef(1, 1, std::nanf("")));
  EXPECT_FAILS(RT_INVALID_VALUE, rtRotated(nan, 0, 0, 1));
  EXPECT_FAILS(RT_INVALID_VALUE, rtRotatef(10, 0, 0, 0));
  EXPECT_FAILS(RT_INVALID_VALUE, rtLookAt(1, 2, 3, 1, 2, 3, 0, 1, 0));
  EXPECT_FAILS(RT_INVALID_VALUE, rtLookAt(0, 0, 0, 0, 5, 0, 0, 1, 0));
  EXPECT_FAILS(RT_INVALID_VALUE, rtLookAt(0, 0, 0, 0, 5, 0, 0, 0, 0));
  EXPECT_FAILS(RT_INVALID_VALUE, rtLookAt(infinity, 0, 0, 0, 5, 0, 0, 0, 1));
  EXPECT_FAILS(RT_INVALID_VALUE, rtGetMatrixd(nullptr));
  EXPECT_EQ(currentMatrix(), before);
  rtScaled(0, 0, 0); // a flat matrix is allowed; objects drawn under it are invisible
  EXPECT_RT_ERROR(RT_NO_ERROR);
}

TEST_F(ApiTest, AProductBeyondDoubleIsAnError) {
  rtScaled(1e300, 1, 1);
  const std::vector<double> before = currentMatrix();
  EXPECT_FAILS(RT_INVALID_VALUE, rtScaled(1e300, 1, 1));
  EXPECT_EQ(currentMatrix(), before);
}

TEST_F(ApiTest, ADefinitionHasAStackOfItsOwn) {
  rtTranslated(9, 9, 9);
  const std::vector<double> outside = currentMatrix();
  rtBeginObject(0);
  expectMatrix(identity);
  EXPECT_FAILS(RT_STACK_UNDERFLOW, rtPopMatrix());
  rtPushMatrix();
  EXPECT_FAILS(RT_INVALID_OPERATION, rtEndObject());
  rtPopMatrix();
  rtEndObject();
  EXPECT_EQ(currentMatrix(), outside);
}

} // namespace

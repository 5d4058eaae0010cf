// depth.cpp: RT_DEPTH along the axis and along the ray (RT_DEPTH_ALONG) against closed forms: a
// wall across the view, seen by pinholes whose matrix turns or shears the picture, and by parallel
// rays.
#include <cmath>
#include <numbers>

#include "drawing.h"
#include "numeric/support.h"

namespace numeric {
namespace {

using namespace drawing;

constexpr int width = 24, height = 16;
constexpr double away = 8, angle = 50; // how far the wall is; degrees, vertical

class Depth : public testing::Test {
 protected:
  void SetUp() override {
    context_ = contextWith(2);
    ASSERT_NE(context_, nullptr) << (rtGetError(), rtGetErrorMessage());
    at(0, 0, -away, square(colored("Diffuse", "reflectance", {.5, .5, .5}), 100));
  }
  void TearDown() override {
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
    rtDeleteContext(context_);
  }

  // The camera's third axis is sheared by these amounts; its picture stays parallel to the wall.
  static std::vector<float> depthOf(int along, double right, double up, bool parallel = false) {
    const double matrix[16] = {1, 0, 0, 0, 0, 1, 0, 0, right, up, 1, 0, 0, 0, 0, 1};
    rtLoadMatrixd(matrix);
    if (parallel)
      rtOrtho(4);
    else
      rtPerspective(angle);
    rtFrameBuffer(width, height, RT_DEPTH);
    rtQuality(RT_SAMPLES_PER_PIXEL, 1);
    rtQuality(RT_DEPTH_ALONG, along);
    rtRender();
    return readChannel(RT_DEPTH, width, height);
  }

  // Compares with away * f(x, y) for the tangents of the pixels' centres.
  template <class F> static void expectDepth(const std::vector<float>& depth, const F& f) {
    const double half = std::tan(angle / 2 * std::numbers::pi / 180);
    for (int row = 0; row < height; row++)
      for (int column = 0; column < width; column++) {
        const double x = (column + .5 - width / 2.) / (height / 2.) * half,
                     y = (height / 2. - row - .5) / (height / 2.) * half, expected = away * f(x, y);
        EXPECT_NEAR(double(depth[size_t(row * width + column)]), expected, 1e-5 * expected);
      }
  }

  RTcontext context_ = nullptr;
};

TEST_F(Depth, AlongTheAxisIsTheDistanceOfTheWall) {
  for (const double shear : {0.0, .3, -2.0})
    expectDepth(depthOf(RT_DEPTH_ALONG_AXIS, shear, shear / 2), [](double, double) { return 1; });
}

TEST_F(Depth, AlongTheRayIsLongerAside) {
  for (const double shear : {0.0, .3, -2.0})
    expectDepth(depthOf(RT_DEPTH_ALONG_RAY, shear, shear / 2),
                [&](double x, double y) { return std::hypot(1, x - shear, y - shear / 2); });
}

TEST_F(Depth, ParallelRaysBeginAtThePlaneOfTheCamera) {
  for (const int along : {RT_DEPTH_ALONG_AXIS, RT_DEPTH_ALONG_RAY})
    expectDepth(depthOf(along, 0, 0, true), [](double, double) { return 1; });
}

} // namespace
} // namespace numeric

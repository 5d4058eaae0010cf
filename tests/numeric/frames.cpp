// frames.cpp: points on lamps and directions are sampled in a frame built around an axis. Where
// such a frame jumped, a line of the picture had several times the error of the rest. These tests
// check that the error is even.
#include <algorithm>
#include <vector>

#include "numeric/support.h"

namespace numeric {
namespace {

class Frames : public Scene {
 protected:
  static constexpr int edge = 15, seeds = 24, samples = 64;
  void SetUp() override {
    Scene::SetUp();
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
    rtQuality(RT_MAX_DEPTH, 1);
    rtQuality(RT_SAMPLES_PER_PIXEL, samples);
  }
  static RTid ball(const Shader& shader, double radius) {
    const RTid object = rtBeginObject(0);
    rtBindShader(shader);
    rtSphere(float(radius));
    rtEndObject();
    rtBindShader(0);
    return place(object);
  }
  static void camera(Vec from, Vec at, Vec up, double height) {
    rtPushMatrix();
    rtLoadIdentity();
    rtLookAt(from.x, from.y, from.z, at.x, at.y, at.z, up.x, up.y, up.z);
    rtOrtho(height);
    rtPopMatrix();
  }
  // Returns each pixel's standard deviation divided by its mean, from pictures of several seeds.
  static std::vector<double> deviations() {
    std::vector<double> sum(edge * edge), squares(edge * edge), out;
    for (int seed = 1; seed <= seeds; seed++) {
      rtQuality(RT_SEED, seed);
      const std::vector<float> rgba = picture(edge);
      for (size_t i = 0; i < sum.size(); i++) {
        sum[i] += double(rgba[4 * i]);
        squares[i] += std::pow(double(rgba[4 * i]), 2);
      }
    }
    for (size_t i = 0; i < sum.size(); i++) {
      const double mean = sum[i] / seeds;
      EXPECT_GT(mean, 0);
      out.push_back(std::sqrt(std::max(0.0, squares[i] / seeds - mean * mean)) / mean);
    }
    return out;
  }
  // Compares the root mean square of the picture's rows; no row may stand out.
  static void expectEvenRows(const std::vector<double>& deviation) {
    std::vector<double> rows;
    for (int y = 0; y < edge; y++) {
      double square = 0;
      for (int x = 0; x < edge; x++) square += std::pow(deviation[size_t(y * edge + x)], 2);
      rows.push_back(std::sqrt(square / edge));
    }
    std::vector<double> sorted = rows;
    std::sort(sorted.begin(), sorted.end());
    for (int y = 0; y < edge; y++)
      EXPECT_LT(rows[size_t(y)], 1.6 * sorted[edge / 2]) << "row " << y;
  }
};

// A ball beside a wall that contains the z axis: the middle row of the wall is at the ball's z.
TEST_F(Frames, ABallBesideAWall) {
  rtPushMatrix();
  rtRotated(90, 0, 1, 0);
  place(square(matt(.5), 10));
  rtPopMatrix();
  rtPushMatrix();
  rtTranslated(1, -1, 0);
  ball(matt(0, 1), .6);
  rtPopMatrix();
  camera({3, .5, 0}, {0, .5, 0}, {0, 0, 1}, 1);
  expectEvenRows(deviations());
}

// A smooth ball under an environment of varying colour: in the middle row the normals have z = 0.
TEST_F(Frames, ASmoothBallUnderASky) {
  ball(matt(.5), 1);
  Shader sky("VRML97Environment");
  rtUseEnvironment(
      sky.setList("skyColor", {.2f, .2f, .2f, 1, 1, 1, 3, 3, 3}).setList("skyAngle", {1.2f, 2.4f}));
  camera({3, 0, 0}, {0, 0, 0}, {0, 0, 1}, .5);
  expectEvenRows(deviations());
}

// A floor whose normal is horizontal except for rounding. Its frame must not depend on the last
// digit.
TEST_F(Frames, AWallThatIsTurnedByNothing) {
  for (const double turn : {1e-9, -1e-9}) {
    rtPushMatrix();
    rtRotated(90 + turn, 0, 1, 0);
    rtTranslated(0, turn > 0 ? 5 : -5, 0);
    place(square(matt(.5), 5));
    rtPopMatrix();
  }
  Shader sky("VRML97Environment");
  rtUseEnvironment(
      sky.setList("skyColor", {.2f, .2f, .2f, 1, 1, 1, 3, 3, 3}).setList("skyAngle", {1.2f, 2.4f}));
  camera({3, 0, 0}, {0, 0, 0}, {0, 1, 0}, 1); // the walls meet in the middle row
  expectEvenRows(deviations());
}

} // namespace
} // namespace numeric

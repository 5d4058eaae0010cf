// openrt_light_path_picture.cpp: the picture that a trial estimates from few light paths, and the
// weights of errors by it (render/path/light_path_picture.h, pixel_weights.h).
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "render/path/light_path_picture.h"
#include "render/path/pixel_weights.h"

namespace {

using openrt::LightPathFind;
using openrt::LightPathPicture;
using openrt::PixelWeights;

constexpr double width = 60, height = 40;

// Adds finds at random places of a box.
void addFinds(std::vector<LightPathFind>& finds, int n, double x, double y, double w, double h,
              double radiance) {
  std::mt19937 random(uint32_t(finds.size()) + 1);
  const auto unit = [&random] { return double(random() >> 8) * 0x1p-24; };
  for (int i = 0; i < n; i++) {
    const double px = x + w * unit(), py = y + h * unit();
    finds.push_back({px, py, radiance, radiance * radiance, 1});
  }
}

TEST(LightPathPicture, IsBlackWithoutFinds) {
  EXPECT_EQ(LightPathPicture().at(3, 3), 0);
  EXPECT_EQ(LightPathPicture({}, 10, width, height).at(3, 3), 0);
}

// A spot of three pixels has its own radiance, and the dark around it has another.
TEST(LightPathPicture, ShowsASmallSpot) {
  std::vector<LightPathFind> finds;
  addFinds(finds, 2000, 20, 10, 3, 3, 5);
  addFinds(finds, 500, 0, 0, width, height, .1);
  const LightPathPicture picture(finds, 4096, width, height);
  const double spot = 2000 * 5 / (4096 * 9.), around = 500 * .1 / (4096 * width * height);
  EXPECT_NEAR(picture.at(21.5, 11.5), spot, .5 * spot);
  EXPECT_NEAR(picture.at(50, 30), around, .5 * around);
}

TEST(LightPathPicture, HasTheLightOfTheFinds) {
  std::vector<LightPathFind> finds;
  addFinds(finds, 100, 30, 10, 20, 20, 2);
  addFinds(finds, 300, 0, 0, width, height, 1);
  const LightPathPicture picture(finds, 1000, width, height);
  double sum = 0;
  constexpr double step = .1;
  for (double y = step / 2; y < height; y += step)
    for (double x = step / 2; x < width; x += step) sum += picture.at(x, y) * step * step;
  EXPECT_NEAR(sum, (100 * 2 + 300) / 1000., .01);
}

TEST(LightPathPicture, TakesFindsAtOnePlace) {
  for (const double x : {0., 30.5, width}) {
    const std::vector<LightPathFind> finds(100, {x, height / 2, 1, 1, 1});
    EXPECT_GT(LightPathPicture(finds, 100, width, height).at(x, height / 2), 0) << x;
  }
}

// A caustic counts relative to its own light, and not to the dark block beside it.
TEST(PixelWeights, AreThoseOfThePlace) {
  PixelWeights weights;
  weights.add({0, 0, 4, 4}, .01);
  weights.add({40, 20, 44, 24}, .01);
  weights.setLight({});
  EXPECT_DOUBLE_EQ(weights.at(21.5, 11.5), 1e4);
  std::vector<LightPathFind> finds;
  addFinds(finds, 2000, 20, 10, 3, 3, 5);
  weights.setLight({finds, 4096, width, height});
  EXPECT_LT(weights.at(21.5, 11.5), 100);
  EXPECT_DOUBLE_EQ(weights.at(2, 2), weights.ofBlock(0));
}

} // namespace

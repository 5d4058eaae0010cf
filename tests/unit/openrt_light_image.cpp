// openrt_light_image.cpp: the variance of light paths beside a sharp edge of light (light_image.h).
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "render/film/light_image.h"

namespace openrt {
namespace {

// Every path brings the same light. The variance of a pixel is then its light times that of one
// path, on both sides of the edge.
TEST(LightImage, PoolsVariancesRelativeToTheLightBesideASharpEdge) {
  constexpr uint32_t edge = 16;
  constexpr double paths[2] = {400, 8}; // expected in a part: on the left, on the right
  std::mt19937 random(7);
  LightImage image(edge, edge);
  for (uint32_t part = 0; part < LightImage::parts; part++) {
    std::vector<float> light(3 * edge * edge);
    for (uint32_t i = 0; i < edge * edge; i++) {
      std::poisson_distribution<int> count(paths[i % edge >= edge / 2]);
      const auto n = float(count(random));
      for (uint32_t k = 0; k < 3; k++) light[3 * i + k] = n;
    }
    image.add(part, std::move(light));
  }
  std::vector<LightSums> sums;
  image.read(Tile{0, 0, edge, edge}, sums);
  for (const uint32_t column : {0u, 4u, edge / 2 - 1, edge / 2 + 2, edge - 1}) {
    double mean = 0;
    for (uint32_t y = 0; y < edge; y++) mean += sums[y * edge + column].variance[1] / edge;
    const double expected = paths[column >= edge / 2] / LightImage::parts;
    EXPECT_GT(mean, .8 * expected) << column;
    EXPECT_LT(mean, 1.4 * expected) << column;
  }
}

} // namespace
} // namespace openrt

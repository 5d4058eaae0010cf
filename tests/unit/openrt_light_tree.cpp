// openrt_light_tree.cpp: Tests light selection. The selection probabilities sum to 1, match the
// sampling, are roughly proportional to the light that arrives, and are never 0 where light
// arrives.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "render/lights/light_tree.h"

using namespace openrt;

namespace {

constexpr Vec3f everywhere; // as a normal: light counts from both sides

LightBounds pointLight(float x, float y, float z, float intensity) {
  LightBounds b;
  b.low = b.high = {x, y, z};
  b.intensity = intensity;
  return b;
}

// A small square patch with one normal that emits on its front side only.
LightBounds patch(std::mt19937& random, float size) {
  std::uniform_real_distribution<float> unit(-1, 1);
  LightBounds b;
  for (int k = 0; k < 3; k++) {
    const float middle = 4 * unit(random);
    b.low[k] = middle - size;
    b.high[k] = middle + size;
    b.axis[k] = unit(random);
  }
  b.axis = normalize(b.axis);
  b.cosineNormals = 1;
  b.intensity = 1 + unit(random) * .9f;
  return b;
}

double sumOf(const LightTree& tree, size_t lights, const Vec3f& p, const Vec3f& n) {
  double sum = 0;
  for (uint32_t i = 0; i < lights; i++) sum += double(tree.probability(p, n, i));
  return sum;
}

TEST(LightTree, R12EqualLightsAreEquallyLikely) {
  for (const uint32_t n : {1u, 4u, 1000u, 100000u}) {
    const std::vector<LightBounds> lights(n, pointLight(1, 2, 3, 1.0f / float(n)));
    LightTree tree;
    tree.build(lights);
    const Vec3f p, normal{0, 0, 1};
    for (uint32_t i = 0; i < n; i += 1 + n / 7)
      EXPECT_NEAR(double(tree.probability(p, normal, i)) * n, 1, 1e-5) << n;
    EXPECT_LT(tree.depth(), 20u);
    EXPECT_NEAR(sumOf(tree, n, p, normal), 1, 1e-5);
  }
}

TEST(LightTree, ProbabilitiesAddUpAndAreThoseOfTheChoice) {
  std::mt19937 random(1);
  std::vector<LightBounds> lights;
  for (int i = 0; i < 300; i++) lights.push_back(patch(random, .05f));
  lights[17].intensity = 0; // emits nothing
  LightTree tree;
  tree.build(lights);
  for (int place = 0; place < 20; place++) {
    std::uniform_real_distribution<float> unit(-1, 1);
    const Vec3f p{5 * unit(random), 5 * unit(random), 5 * unit(random)};
    const Vec3f normal = place % 2 ? Vec3f{0, 1, 0} : everywhere;
    // The sum may be below 1. If the box of a branch may light the point and none of its lights
    // does, the choice ends without a light.
    EXPECT_LE(sumOf(tree, lights.size(), p, normal), 1 + 1e-5);
    EXPECT_GT(sumOf(tree, lights.size(), p, normal), .3);
    EXPECT_EQ(tree.probability(p, normal, 17), 0);
    const int draws = 20000;
    std::vector<double> count(lights.size());
    for (int i = 0; i < draws; i++) {
      const LightTree::Choice c = tree.choose(p, normal, (i + .5) / draws);
      if (!(c.probability > 0)) continue;
      count[c.light]++;
      ASSERT_FLOAT_EQ(c.probability, tree.probability(p, normal, c.light));
    }
    // The numbers are evenly spaced, so counts are exact except for one at either end.
    for (uint32_t i = 0; i < lights.size(); i++)
      ASSERT_NEAR(count[i], double(tree.probability(p, normal, i)) * draws, 1.01);
  }
}

TEST(LightTree, LightThatArrivesIsNeverImpossible) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (int round = 0; round < 20; round++) {
    std::vector<LightBounds> lights;
    for (int i = 0; i < 60; i++) {
      LightBounds b = patch(random, i % 3 ? .3f : 0.0f);
      if (i % 4 == 0) b.bothSides = true;
      if (i % 5 == 0) b.reach = 3;
      if (i % 7 == 0) { // a spot light
        b.cosineEmission = 1;
        b.cosineNormals = .7f;
      }
      lights.push_back(b);
    }
    LightTree tree;
    tree.build(lights);
    for (int place = 0; place < 200; place++) {
      Vec3f p, n;
      for (int k = 0; k < 3; k++) {
        p[k] = 5 * unit(random);
        n[k] = unit(random);
      }
      n = normalize(n);
      for (uint32_t i = 0; i < lights.size(); i++) { // from a point inside its box
        const LightBounds& b = lights[i];
        double way[3], square = 0, leaving = 0, facing = 0;
        for (int k = 0; k < 3; k++) {
          way[k] = p[k] - (b.low[k] + (b.high[k] - b.low[k]) * (.5 + .5 * double(unit(random))));
          square += way[k] * way[k];
          leaving += way[k] * b.axis[k];
          facing -= way[k] * n[k];
        }
        if (b.bothSides) leaving = std::fabs(leaving);
        const bool lit = b.cosineEmission == 1
                             ? leaving > double(b.cosineNormals) * std::sqrt(square)
                             : leaving > 0;
        if (!lit || facing <= 0 || square > double(b.reach) * b.reach) continue;
        ASSERT_GT(tree.probability(p, n, i), 0) << i;
        ASSERT_GT(tree.probability(p, everywhere, i), 0) << i;
      }
    }
  }
}

TEST(LightTree, TheBrightestAndNearestAreTheLikeliest) {
  std::vector<LightBounds> lights;
  for (int i = 0; i < 1000; i++) lights.push_back(pointLight(float(i), 0, 0, 1));
  LightTree tree;
  tree.build(lights);
  double expected = 0;
  for (int i = 0; i < 1000; i++) expected += 1 / (1 + double(i - 500) * (i - 500));
  const Vec3f p{500, 1, 0};
  // Within a factor of the light that arrives.
  for (const uint32_t i : {500u, 499u, 490u, 600u, 0u}) {
    const double share = 1 / (1 + (double(i) - 500) * (double(i) - 500)) / expected;
    EXPECT_GT(double(tree.probability(p, everywhere, i)), share / 6) << i;
  }
}

TEST(LightTree, NoLightWhereNoneReaches) {
  LightBounds b = pointLight(0, 0, 5, 1);
  b.reach = 4;
  LightTree tree;
  tree.build(std::vector<LightBounds>{b, b});
  const Vec3f p, near{0, 0, 2}, away{0, 0, -1};
  EXPECT_EQ(tree.choose(p, everywhere, .5).probability, 0);
  EXPECT_EQ(tree.choose(near, away, .5).probability, 0);
  EXPECT_NEAR(tree.choose(near, everywhere, .5).probability, .5, 1e-6);
  tree.build({});
  EXPECT_EQ(tree.choose(near, everywhere, .5).probability, 0);
  EXPECT_TRUE(tree.empty());
}

// Each level would split off one light; from some depth on the tree splits in halves.
TEST(LightTree, LightsOfAnyPlaceMakeAShallowTree) {
  std::vector<LightBounds> lights;
  float x = 1e-30f;
  for (int i = 0; i < 200; i++, x *= 2)
    lights.push_back(pointLight(x < 1e30f ? x : 1e30f, 0, 0, 1));
  LightTree tree;
  tree.build(lights);
  EXPECT_LE(tree.depth(), 60u);
  const Vec3f p{0, 0, 1};
  double sum = sumOf(tree, lights.size(), p, everywhere);
  EXPECT_NEAR(sum, 1, 1e-4);
}

TEST(LightTree, SameLightsSameTree) {
  std::mt19937 random(1);
  std::vector<LightBounds> lights;
  for (int i = 0; i < 5000; i++) lights.push_back(patch(random, .01f));
  LightTree a, b;
  a.build(lights);
  b.build(lights);
  const Vec3f p{1, 2, 3};
  for (uint32_t i = 0; i < lights.size(); i += 37)
    ASSERT_EQ(a.probability(p, everywhere, i), b.probability(p, everywhere, i));
}

} // namespace

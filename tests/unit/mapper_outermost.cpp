// mapper_outermost.cpp: Outermost against a comparison of every point in every direction.
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "mapper/outermost.h"

namespace xvrml::mapper {
namespace {

// Returns the first of the points that lie farthest out in each direction, then in its opposite.
std::vector<Vector> farthest(const std::vector<Vector>& points,
                             const Outermost::Directions& directions) {
  std::vector<Vector> first, last;
  for (const Vector& direction : directions) {
    const auto along = [&](const Vector& p) {
      return direction.x * p.x + direction.y * p.y + direction.z * p.z;
    };
    const Vector *least = nullptr, *most = nullptr;
    for (const Vector& p : points) {
      if (!std::isfinite(p.x)) continue;
      if (!least || along(p) < along(*least)) least = &p;
      if (!most || along(p) > along(*most)) most = &p;
    }
    first.push_back(*least);
    last.push_back(*most);
  }
  first.insert(first.end(), last.begin(), last.end());
  return first;
}

TEST(Outermost, FindsThePointsThatLieFarthestOut) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (const double size : {1.0, 1e-30, 1e30})
    for (const size_t count : {size_t(1), size_t(31), size_t(32), size_t(33), size_t(5000)}) {
      std::vector<Vector> points;
      while (points.size() < count) {
        // Groups of points that are near each other, as those of small shapes are.
        const Vector center(normal(random) * 20 + 1000, normal(random) * 20, normal(random) * 20);
        for (int i = 0; i < 24 && points.size() < count; ++i)
          points.push_back((center + Vector(normal(random), normal(random), 0)) * size);
      }
      if (count > 1) points[1].x = std::numeric_limits<double>::quiet_NaN();
      Outermost outermost(Outermost::even());
      for (const Vector& p : points) outermost.add(p);
      EXPECT_EQ(outermost.points(), farthest(points, Outermost::even())) << size << " " << count;
    }
}

TEST(Outermost, HasNoPointsIfNoneWasAdded) {
  Outermost outermost(Outermost::even());
  outermost.add(Vector(std::numeric_limits<double>::infinity(), 0, 0));
  EXPECT_TRUE(outermost.points().empty());
}

} // namespace
} // namespace xvrml::mapper

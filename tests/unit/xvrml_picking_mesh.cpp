// xvrml_picking_mesh.cpp: the hierarchy of a large mesh is built where rays go. The hit of a ray
// depends neither on the rays before it nor on the hierarchy.
#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "xvrml/browser.h"

namespace xvrml {
namespace {

constexpr int triangles = 3000;

using Triangle = std::array<std::array<float, 3>, 3>;
struct Ray {
  double origin[3], direction[3];
};

// Triangles of many sizes, in layers along z; every tenth one equals the one before.
std::vector<Triangle> makeTriangles(uint32_t seed) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return low + (high - low) * double(random() % 10'000) / 9'999;
  };
  std::vector<Triangle> all;
  while (int(all.size()) < triangles) {
    if (all.size() % 10 == 9) all.push_back(all.back());
    const double x = between(-1, 1), y = between(-1, 1), z = double(random() % 4) / 4,
                 size = between(.001, .3);
    Triangle made;
    for (auto& corner : made)
      corner = {float(x + between(-size, size)), float(y + between(-size, size)),
                float(z + between(-size, size) / 8)};
    all.push_back(made);
  }
  return all;
}

// Returns a world with the triangles in Shapes of so many.
std::string worldOf(const std::vector<Triangle>& all, size_t ofShape) {
  std::string text = "#VRML V2.0 utf8\n";
  for (size_t first = 0; first < all.size(); first += ofShape) {
    const size_t end = std::min(all.size(), first + ofShape);
    text += "Shape { geometry IndexedFaceSet { solid FALSE coord Coordinate { point [ ";
    for (size_t i = first; i < end; ++i)
      for (const auto& c : all[i]) text += fmt::format("{} {} {}, ", c[0], c[1], c[2]);
    text += "] } coordIndex [ ";
    for (size_t i = 0; i < 3 * (end - first); i += 3)
      text += fmt::format("{} {} {} -1 ", i, i + 1, i + 2);
    text += "] } }\n";
  }
  return text;
}

std::vector<Ray> makeRays(uint32_t seed, int count) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return low + (high - low) * double(random()) / double(std::mt19937::max());
  };
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i)
    rays.push_back({{between(-1, 1), between(-1, 1), i % 2 ? 3.0 : -3.0},
                    {between(-.3, .3), between(-.3, .3), i % 2 ? -1.0 : 1.0}});
  return rays;
}

struct Found {
  bool any = false;
  std::array<double, 3> point{}, normal{};
  bool operator==(const Found&) const = default;
};

Found pick(Browser& browser, const Ray& ray) {
  PickHit hit;
  Found found;
  found.any = browser.pick(ray.origin, ray.direction, {}, hit);
  if (!found.any) return found;
  found.point = hit.point;
  found.normal = hit.normal;
  return found;
}

TEST(PickMesh, HitsDependNeitherOnOtherRaysNorOnTheHierarchy) {
  const std::vector<Triangle> all = makeTriangles(1);
  const std::vector<Ray> rays = makeRays(2, 400);
  Browser large(loadWorldFromMemory(worldOf(all, all.size()), "large.wrl")),
      other(loadWorldFromMemory(worldOf(all, all.size()), "large.wrl")),
      small(loadWorldFromMemory(worldOf(all, 50), "small.wrl")); // too small for hierarchies
  std::vector<Found> found, backwards;
  int hits = 0;
  for (const Ray& ray : rays) {
    found.push_back(pick(large, ray));
    hits += found.back().any;
    const Found expected = pick(small, ray);
    EXPECT_EQ(found.back().any, expected.any);
    for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(found.back().point[k], expected.point[k], 1e-9);
  }
  for (size_t i = rays.size(); i-- > 0;) backwards.push_back(pick(other, rays[i]));
  std::reverse(backwards.begin(), backwards.end());
  EXPECT_EQ(found, backwards);
  EXPECT_GT(hits, 200);
}

} // namespace
} // namespace xvrml

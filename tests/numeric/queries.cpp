// queries.cpp: all hits of a ray and the nearest surface point, against brute force over all
// triangles in double precision. The triangles are baked, instanced under shear matrices, or
// moving. Also spheres and ellipsoids.
#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <random>

#include "numeric/support.h"
#include "openrt/query.h"

namespace numeric {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec operator*(Vec a, double s) { return {a.x * s, a.y * s, a.z * s}; }
double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec cross(Vec a, Vec b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double length(Vec a) { return std::sqrt(dot(a, a)); }

struct Triangle {
  Vec corner[3];
  uint64_t user;
  uint32_t number;
};

class Queries : public Scene {
 protected:
  std::mt19937 random_{7};
  std::uniform_real_distribution<double> unit_{-1, 1};
  std::vector<Triangle> triangles_;

  Vec any(double size) {
    return {size * unit_(random_), size * unit_(random_), size * unit_(random_)};
  }

  // Adds an object of `count` triangles under a matrix; coordinates are rounded as the API rounds
  // them.
  void add(size_t count, const std::array<double, 16>& m, bool moving, uint64_t user) {
    std::vector<float> points(9 * count);
    for (size_t t = 0; t < count; t++) {
      const Vec middle = any(1);
      for (int c = 0; c < 3; c++) {
        const Vec p = middle + any(0.3);
        points[9 * t + 3 * c] = float(p.x);
        points[9 * t + 3 * c + 1] = float(p.y);
        points[9 * t + 3 * c + 2] = float(p.z);
      }
    }
    const RTid object = rtBeginObject(0);
    rtVertexPointer(3, RT_FLOAT, 0, points.data());
    rtDrawArrays(RT_TRIANGLES, 0, 3 * count);
    rtVertexPointer(3, RT_FLOAT, 0, nullptr);
    rtEndObject();
    const RTid instance = rtInstantiateObject(object);
    rtInstanceMatrix(instance, m.data());
    rtInstanceUserData(instance, user);
    if (moving) rtInstanceHint(instance, RT_DYNAMIC);
    for (size_t t = 0; t < count; t++) {
      Triangle made{{}, user, uint32_t(t)};
      for (int c = 0; c < 3; c++) {
        const float* p = &points[9 * t + 3 * c];
        made.corner[c] = {m[0] * p[0] + m[4] * p[1] + m[8] * p[2] + m[12],
                          m[1] * p[0] + m[5] * p[1] + m[9] * p[2] + m[13],
                          m[2] * p[0] + m[6] * p[1] + m[10] * p[2] + m[14]};
      }
      triangles_.push_back(made);
    }
  }
  void addSome() {
    add(60, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, false, 1);
    add(40, {1, .5, 0, 0, -.5, 2, 0, 0, .3, 0, 1, 0, 2, 1, 0, 1}, false, 2);
    add(40, {.5, 0, 0, 0, 0, 1.5, .2, 0, 0, 0, -1, 0, -2, 0, 1, 1}, true, 3); // mirrored
  }
};

// Returns the distance by bisecting the triangle's parameters: slow and simple.
double distanceTo(const Triangle& t, const Vec& p) {
  double best = 1e30;
  const int steps = 60;
  for (int i = 0; i <= steps; i++)
    for (int j = 0; i + j <= steps; j++) {
      const double u = double(i) / steps, v = double(j) / steps;
      const Vec at = t.corner[0] * (1 - u - v) + t.corner[1] * u + t.corner[2] * v;
      best = std::min(best, length(at - p));
    }
  return best;
}

TEST_F(Queries, AllHitsAreThoseOfEveryTriangle) {
  addSome();
  rtRender();
  std::vector<RTray> rays;
  for (int i = 0; i < 500; i++) {
    const Vec from = any(4), to = any(1.5);
    rays.push_back({{float(from.x), float(from.y), float(from.z)},
                    0,
                    {float(to.x - from.x), float(to.y - from.y), float(to.z - from.z)},
                    infinity});
  }
  std::vector<uint32_t> counts(rays.size());
  rtCountHits(rays.size(), rays.data(), counts.data());
  std::vector<size_t> first{0};
  for (const uint32_t n : counts) first.push_back(first.back() + n);
  std::vector<RThit> all(first.back()), nearest(rays.size());
  rtListHits(rays.size(), rays.data(), first.data(), all.data());
  rtCastRays(rays.size(), rays.data(), nearest.data());
  size_t wrong = 0;
  for (size_t i = 0; i < rays.size(); i++) {
    const Vec o{rays[i].origin[0], rays[i].origin[1], rays[i].origin[2]},
        d{rays[i].direction[0], rays[i].direction[1], rays[i].direction[2]};
    size_t expected = 0;
    for (const Triangle& t : triangles_) {
      const Vec a = t.corner[1] - t.corner[0], b = t.corner[2] - t.corner[0], p = cross(d, b),
                s = o - t.corner[0];
      const double det = dot(a, p), u = dot(s, p) / det, v = dot(d, cross(s, a)) / det,
                   at = dot(b, cross(s, a)) / det;
      expected += u >= 0 && v >= 0 && u + v <= 1 && at >= 0;
    }
    wrong += expected != counts[i];
    for (size_t k = first[i] + 1; k < first[i + 1]; k++) EXPECT_LE(all[k - 1].t, all[k].t);
    if (counts[i] == 0) {
      EXPECT_TRUE(std::isinf(nearest[i].t));
      continue;
    }
    EXPECT_NEAR(all[first[i]].t, nearest[i].t, 1e-5);
    EXPECT_EQ(all[first[i]].userData, nearest[i].userData);
    EXPECT_EQ(all[first[i]].primitive, nearest[i].primitive);
    for (int k = 0; k < 3; k++) EXPECT_NEAR(all[first[i]].normal[k], nearest[i].normal[k], 1e-4);
  }
  EXPECT_GT(all.size(), 100u);
  EXPECT_EQ(wrong, 0u);
}

// Rays along an axis towards a closed sheet of small triangles, with directions of any length.
TEST_F(Queries, ShortDirectionsHitWhatLongOnesHit) {
  constexpr int n = 40;
  std::vector<float> points;
  for (int y = 0; y < n; y++)
    for (int x = 0; x < n; x++)
      for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}})
        for (const double p : {double(x + dx) / n, double(y + dy) / n, 0.1 * ((x + dx) % 3)})
          points.push_back(float(p));
  const RTid object = rtBeginObject(0);
  rtVertexPointer(3, RT_FLOAT, 0, points.data());
  rtDrawArrays(RT_TRIANGLES, 0, points.size() / 3);
  rtVertexPointer(3, RT_FLOAT, 0, nullptr);
  rtEndObject();
  rtInstantiateObject(object);
  rtRender();
  constexpr size_t count = 1000;
  std::vector<RTray> rays(count);
  for (RTray& ray : rays) {
    const Vec at = (any(0.49) + Vec{.5, .5, 0});
    ray = {{float(at.x), float(at.y), 50}, 0, {0, 0, -1}, infinity};
  }
  std::vector<RThit> wanted(count), hits(count);
  rtCastRays(count, rays.data(), wanted.data());
  std::vector<uint8_t> occluded(count);
  for (const float scale : {0x1p-10f, 0x1p-30f, 0x1p-45f, 0x1p-60f, 0x1p-90f, 0x1p-120f}) {
    SCOPED_TRACE(scale);
    for (RTray& ray : rays) ray.direction[2] = -scale;
    rtCastRays(count, rays.data(), hits.data());
    rtOccludedRays(count, rays.data(), occluded.data());
    for (size_t i = 0; i < count; i++) {
      EXPECT_EQ(hits[i].primitive, wanted[i].primitive) << i;
      EXPECT_FLOAT_EQ(hits[i].t * scale, wanted[i].t) << i;
      EXPECT_EQ(occluded[i], 1) << i;
    }
  }
}

TEST_F(Queries, FewerPlacesThanHitsGetTheNearest) {
  add(60, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, false, 1);
  rtRender();
  const RTray rays[] = {{{0, 0, 5}, 0, {.01f, .02f, -1}, infinity},
                        {{9, 9, 9}, 0, {1, 0, 0}, infinity}};
  uint32_t counts[2];
  rtCountHits(2, rays, counts);
  ASSERT_GT(counts[0], 1u);
  EXPECT_EQ(counts[1], 0u);
  const size_t first[] = {0, 1, 3};
  RThit hits[3], nearest;
  rtListHits(2, rays, first, hits);
  rtCastRays(1, rays, &nearest);
  EXPECT_FLOAT_EQ(hits[0].t, nearest.t);
  EXPECT_TRUE(std::isinf(hits[1].t) && std::isinf(hits[2].t));
}

TEST_F(Queries, TheNearestPointIsThatOfEveryTriangle) {
  addSome();
  rtRender();
  std::vector<float> places;
  for (int i = 0; i < 60; i++) {
    const Vec p = any(4);
    places.insert(places.end(), {float(p.x), float(p.y), float(p.z)});
  }
  std::vector<RTclosest> found(60);
  rtClosestPoints(60, places.data(), infinity, found.data());
  for (int i = 0; i < 60; i++) {
    const Vec p{places[3 * i], places[3 * i + 1], places[3 * i + 2]};
    double expected = 1e30;
    for (const Triangle& t : triangles_) expected = std::min(expected, distanceTo(t, p));
    EXPECT_LE(found[i].distance, expected + 1e-5) << i;
    EXPECT_GE(found[i].distance, expected - 0.02) << i;
    const RTclosest& f = found[i];
    const Vec at{f.point[0], f.point[1], f.point[2]}, n{f.normal[0], f.normal[1], f.normal[2]};
    EXPECT_NEAR(length(at - p), f.distance, 1e-5);
    EXPECT_NEAR(length(n), 1, 1e-5);
    for (const Triangle& t : triangles_)
      if (t.user == f.userData && t.number == f.primitive) {
        const Vec on =
            t.corner[0] * (1 - f.u - f.v) + t.corner[1] * double(f.u) + t.corner[2] * double(f.v);
        EXPECT_NEAR(length(on - at), 0, 1e-5);
        EXPECT_NEAR(std::fabs(dot(n, t.corner[1] - t.corner[0])), 0, 1e-4);
      }
  }
  rtClosestPoints(60, places.data(), 0.25f, found.data());
  for (const RTclosest& f : found) EXPECT_TRUE(f.distance <= 0.25f || std::isinf(f.distance));
  const float nowhere[] = {infinity, 0, 0};
  rtClosestPoints(1, nowhere, infinity, found.data());
  EXPECT_TRUE(std::isinf(found[0].distance));
}

TEST_F(Queries, NormalsPointWhereThoseOfRaysPoint) {
  const RTid surface = square(Shader("VRML97"));
  for (const bool moving : {false, true})
    for (const double side : {1.0, -1.0}) {
      const double m[16] = {side, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, moving ? 5.0 : 0.0, 1};
      const RTid instance = place(surface);
      rtInstanceMatrix(instance, m);
      if (moving) rtInstanceHint(instance, RT_DYNAMIC);
      rtRender();
      const float from[] = {.25f, .5f, float(m[14]) + 1};
      const RTray ray{{from[0], from[1], from[2]}, 0, {0, 0, -1}, infinity};
      RThit hit;
      RTclosest found;
      rtCastRays(1, &ray, &hit);
      rtClosestPoints(1, from, infinity, &found);
      EXPECT_FLOAT_EQ(found.distance, 1);
      for (int k = 0; k < 3; k++) EXPECT_NEAR(found.normal[k], hit.normal[k], 1e-6);
      rtDeleteInstance(instance);
    }
}

TEST_F(Queries, WrongArgumentsAreRefusedAndNothingIsMetBeforeACommit) {
  const RTray ray{{0, 0, 5}, 0, {0, 0, -1}, infinity};
  uint32_t count = 7;
  const size_t one[] = {0, 1}, falling[] = {1, 0};
  RThit hit;
  RTclosest closest;
  const float place[] = {0, 0, 0};
  rtCountHits(1, &ray, &count);
  rtListHits(1, &ray, one, &hit);
  rtClosestPoints(1, place, 1, &closest);
  EXPECT_TRUE(count == 0 && std::isinf(hit.t) && std::isinf(closest.distance));
  EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR));
  const std::function<void()> wrong[] = {[&] { rtCountHits(1, nullptr, &count); },
                                         [&] { rtListHits(1, &ray, falling, &hit); },
                                         [&] { rtListHits(1, &ray, one, nullptr); },
                                         [&] { rtClosestPoints(1, place, 0, &closest); },
                                         [&] { rtClosestPoints(1, place, nanf(""), &closest); },
                                         [&] { rtClosestPoints(1, nullptr, 1, &closest); }};
  for (const auto& call : wrong) {
    call();
    EXPECT_EQ(rtGetError(), RTenum(RT_INVALID_VALUE));
  }
  rtCountHits(0, nullptr, nullptr);
  rtListHits(0, nullptr, nullptr, nullptr);
  EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR));
}

TEST_F(Queries, SpheresAndEllipsoids) {
  const RTid ball = rtBeginObject(0);
  rtSphere(1);
  rtEndObject();
  const double stretched[16] = {2, 0, 0, 0, 0, .5, 0, 0, 0, .3, 1, 0, 10, 0, 0, 1};
  rtInstantiateObject(ball);
  rtInstanceMatrix(rtInstantiateObject(ball), stretched);
  rtRender();
  const float places[] = {0, 3, 0, 0, 0, 0, 10, 3, 1, 10, 0, 0, 13, 0.2f, 0};
  RTclosest found[5];
  rtClosestPoints(5, places, infinity, found);
  EXPECT_FLOAT_EQ(found[0].distance, 2);
  EXPECT_FLOAT_EQ(found[0].normal[1], 1);
  EXPECT_FLOAT_EQ(found[1].distance, 1);
  for (int i = 2; i < 5; i++) {
    double best = 1e30;
    for (int a = 0; a <= 400; a++)
      for (int b = 0; b < 800; b++) {
        const double t = pi * a / 400, f = 2 * pi * b / 800;
        const double s[3] = {std::sin(t) * std::cos(f), std::sin(t) * std::sin(f), std::cos(t)};
        Vec at{stretched[0] * s[0] + 10, .5 * s[1] + .3 * s[2], s[2]};
        best =
            std::min(best, length(at - Vec{places[3 * i], places[3 * i + 1], places[3 * i + 2]}));
      }
    EXPECT_NEAR(found[i].distance, best, 1e-3) << i;
  }
  const RTray ray{{0, 0, 5}, 0, {0, 0, -1}, infinity};
  uint32_t count;
  rtCountHits(1, &ray, &count);
  EXPECT_EQ(count, 2u);
}

} // namespace
} // namespace numeric

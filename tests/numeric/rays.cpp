// rays.cpp: numerically hard ray queries: watertight surfaces (N3 of the accuracy catalogue), and
// the checks that keep invalid rays and matrices away from Embree, where they would end the
// process.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>

#include "numeric/support.h"

namespace numeric {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

using Rays = Scene;

// A closed sphere around (offset, offset, offset). Its 39,600 triangles share their vertices.
struct Ball {
  std::vector<double> points;
  std::vector<uint32_t> corners;

  explicit Ball(double offset, double radius = 2) {
    constexpr uint32_t around = 200, rings = 99; // rings between the poles
    const auto add = [&](double x, double y, double z) {
      for (double v : {x, y, z}) points.push_back(offset + radius * v);
    };
    add(0, 1, 0);
    for (uint32_t r = 1; r <= rings; r++)
      for (uint32_t k = 0; k < around; k++) {
        const double a = pi * r / (rings + 1), b = 2 * pi * k / around;
        add(std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b));
      }
    add(0, -1, 0);
    const uint32_t last = 1 + rings * around;
    const auto at = [&](uint32_t ring, uint32_t k) { return 1 + ring * around + k % around; };
    for (uint32_t k = 0; k < around; k++) {
      corners.insert(corners.end(), {0, at(0, k + 1), at(0, k)});
      corners.insert(corners.end(), {last, at(rings - 1, k), at(rings - 1, k + 1)});
      for (uint32_t r = 0; r + 1 < rings; r++) {
        corners.insert(corners.end(), {at(r, k), at(r, k + 1), at(r + 1, k)});
        corners.insert(corners.end(), {at(r + 1, k), at(r, k + 1), at(r + 1, k + 1)});
      }
    }
  }
  size_t vertices() const { return points.size() / 3; }
  void place() const {
    const RTid object = rtBeginObject(0);
    rtVertexPointer(3, RT_DOUBLE, 0, points.data());
    rtDrawElements(RT_TRIANGLES, corners.size(), corners.data(), vertices());
    rtVertexPointer(3, RT_DOUBLE, 0, nullptr);
    rtEndObject();
    rtInstantiateObject(object);
  }
};

size_t misses(const std::vector<RTray>& rays) {
  std::vector<RThit> hits(rays.size());
  rtCastRays(rays.size(), rays.data(), hits.data());
  size_t count = 0;
  for (const RThit& h : hits) count += !std::isfinite(h.t);
  return count;
}

class Watertight : public Scene, public testing::WithParamInterface<double> {
 protected:
  // Returns a point within half a unit of the centre.
  Vec inside() {
    const double offset = GetParam();
    return {offset + place_(random_), offset + place_(random_), offset + place_(random_)};
  }
  static RTray ray(Vec from, Vec direction) {
    return {{float(from.x), float(from.y), float(from.z)},
            0,
            {float(direction.x), float(direction.y), float(direction.z)},
            infinity};
  }
  std::mt19937 random_{12345};
  std::uniform_real_distribution<double> place_{-.5, .5};
  std::normal_distribution<double> direction_;
};

TEST_P(Watertight, NoRandomRayLeavesAClosedBall) { // N3
  Ball(GetParam()).place();
  rtRender();
  EXPECT_EQ(stats().scene.triangles, 39600u);
  std::vector<RTray> rays;
  for (int i = 0; i < 200000; i++)
    rays.push_back(ray(inside(), {direction_(random_), direction_(random_), direction_(random_)}));
  EXPECT_EQ(misses(rays), 0u);
}

// Rays aimed exactly at vertices and edges. Embree's robust mode alone lets up to 1.4 % through at
// vertices (accuracy catalogue A3).
TEST_P(Watertight, NoRayAimedAtVerticesLeaves) {
  const Ball ball(GetParam());
  ball.place();
  rtRender();
  std::vector<RTray> atVertices, atEdges;
  const auto vertex = [&](uint32_t k) {
    // Rounded to float, as the scene stores it.
    return Vec{float(ball.points[3 * k]), float(ball.points[3 * k + 1]),
               float(ball.points[3 * k + 2])};
  };
  const auto aimed = [](Vec from, Vec to) {
    from = {float(from.x), float(from.y), float(from.z)};
    return ray(from, {to.x - from.x, to.y - from.y, to.z - from.z});
  };
  std::uniform_int_distribution<uint32_t> pick(0, uint32_t(ball.corners.size() / 3 - 1));
  for (int i = 0; i < 100000; i++) {
    const uint32_t t = 3 * pick(random_);
    const Vec a = vertex(ball.corners[t]), b = vertex(ball.corners[t + 1]);
    atVertices.push_back(aimed(inside(), a));
    const double s = .5 + place_(random_);
    atEdges.push_back(
        aimed(inside(), {a.x + s * (b.x - a.x), a.y + s * (b.y - a.y), a.z + s * (b.z - a.z)}));
  }
  for (const std::vector<RTray>* rays : {&atVertices, &atEdges}) {
    EXPECT_EQ(misses(*rays), 0u);
    std::vector<uint8_t> occluded(rays->size());
    rtOccludedRays(rays->size(), rays->data(), occluded.data());
    EXPECT_EQ(std::count(occluded.begin(), occluded.end(), 1), ptrdiff_t(rays->size()));
    std::vector<uint32_t> counts(rays->size());
    rtCountHits(rays->size(), rays->data(), counts.data());
    const auto even =
        std::count_if(counts.begin(), counts.end(), [](uint32_t n) { return n % 2 == 0; });
    EXPECT_EQ(even, 0);
  }
}

// Rays side by side are traced in packets. Their answers are those of the same rays in any order,
// but for the last digits of few: Embree computes them in another way for rays that are alone.
TEST_P(Watertight, BundlesHaveTheAnswersOfSingleRays) {
  const double offset = GetParam();
  Ball(offset).place();
  Ball(offset, .25).place();
  rtRender();
  constexpr int size = 256;
  std::vector<RTray> rays;
  for (int y = 0; y < size; y++) // a pinhole
    for (int x = 0; x < size; x++)
      rays.push_back(ray({offset + .1, offset + .2, offset + .9},
                         {(x - size / 2) / 256., (y - size / 2) / 256., -1}));
  for (int y = 0; y < size; y++) // a grid, parallel to an axis and partly in the planes of faces
    for (int x = 0; x < size; x++)
      rays.push_back(ray({offset + (x - size / 2) / 64., offset + (y - size / 2) / 64., offset + 3},
                         {0, 0, -1}));
  for (int y = 0; y < size; y++) // scan lines
    for (int x = 0; x < size; x++) {
      const double a = 2 * pi * x / size, b = pi * (y - size / 2) / size;
      rays.push_back(ray({offset - .5, offset + .5, offset},
                         {std::cos(a) * std::cos(b), std::sin(b), std::sin(a) * std::cos(b)}));
    }
  std::vector<size_t> order(rays.size());
  for (size_t i = 0; i < order.size(); i++) order[i] = i;
  std::shuffle(order.begin(), order.end(), random_);
  std::vector<RTray> mixed;
  for (const size_t i : order) mixed.push_back(rays[i]);
  std::vector<RThit> hits(rays.size()), mixedHits(rays.size());
  rtCastRays(rays.size(), rays.data(), hits.data());
  rtCastRays(mixed.size(), mixed.data(), mixedHits.data());
  std::vector<uint8_t> blocked(rays.size()), mixedBlocked(rays.size());
  rtOccludedRays(rays.size(), rays.data(), blocked.data());
  rtOccludedRays(mixed.size(), mixed.data(), mixedBlocked.data());
  size_t otherwise = 0; // rays whose numbers differ at all
  for (size_t i = 0; i < order.size(); i++) {
    const RThit &a = hits[order[i]], &b = mixedHits[i];
    SCOPED_TRACE(order[i]);
    ASSERT_EQ(a.primitive, b.primitive);
    ASSERT_EQ(a.instance, b.instance);
    ASSERT_EQ(blocked[order[i]], mixedBlocked[i]);
    if (a.t == b.t && a.u == b.u && a.v == b.v && std::equal(a.normal, a.normal + 3, b.normal))
      continue;
    otherwise++;
    for (int k = 0; k < 3; k++) ASSERT_NEAR(a.normal[k], b.normal[k], 1e-5);
    ASSERT_NEAR(a.t, b.t, 4e-7 * a.t);
    ASSERT_NEAR(a.u, b.u, 2e-6);
    ASSERT_NEAR(a.v, b.v, 2e-6);
  }
  EXPECT_LE(otherwise, order.size() / 10000);
}

INSTANTIATE_TEST_SUITE_P(Offsets, Watertight, testing::Values(0.0, 1e3, 148376.0),
                         [](const auto& info) { return std::to_string(int(info.param)); });

TEST_F(Rays, HitsCarryWhatIsAsked) {
  const RTid object = rtBeginObject(0);
  rtLoadName(7);
  rtBegin(RT_TRIANGLES);
  rtVertex3f(0, 0, 0);
  rtVertex3f(1, 0, 0);
  rtVertex3f(0, 1, 0);
  rtEnd();
  rtEndObject();
  rtTranslated(10, 20, 30);
  rtScaled(2, 2, 2);
  const RTid instance = place(object);
  rtInstanceUserData(instance, 0x123456789abcull);
  rtRender();
  const RTray rays[2] = {{{10.5f, 21, 35}, 0, {0, 0, -2}, infinity},
                         {{10.5f, 21, 35}, 0, {0, 0, 2}, infinity}};
  RThit hits[2];
  rtCastRays(2, rays, hits);
  expectClose(hits[0].t, 2.5);
  EXPECT_NEAR(hits[0].u, .25, 1e-6);
  EXPECT_NEAR(hits[0].v, .5, 1e-6);
  EXPECT_NEAR(hits[0].normal[2], 1, 1e-6);
  EXPECT_EQ(hits[0].instance, instance);
  EXPECT_EQ(hits[0].name, 7u);
  EXPECT_EQ(hits[0].primitive, 0u);
  EXPECT_EQ(hits[0].userData, 0x123456789abcull);
  EXPECT_TRUE(std::isinf(hits[1].t));
  EXPECT_EQ(hits[1].instance, 0u);
}

TEST_F(Rays, SegmentsEndWhereTheySay) {
  place(square(Shader("VRML97")));
  rtRender();
  const auto down = [](float from, float tnear, float tfar) {
    return RTray{{0.1f, 0.2f, from}, tnear, {0, 0, -1}, tfar};
  };
  const RTray rays[4] = {down(5, 0, 4.99f), down(5, 0, 5.01f), down(5, 5.01f, 9),
                         down(5, 4.99f, 9)};
  RThit hits[4];
  uint8_t occluded[4];
  rtCastRays(4, rays, hits);
  rtOccludedRays(4, rays, occluded);
  const bool expected[4] = {false, true, false, true};
  for (int i = 0; i < 4; i++) {
    EXPECT_EQ(std::isfinite(hits[i].t), expected[i]) << i;
    EXPECT_EQ(occluded[i] != 0, expected[i]) << i;
  }
}

std::vector<RTray> hostileRays() {
  std::vector<RTray> rays;
  const RTray good{{0, 0, 5}, 0, {0, 0, -1}, infinity};
  for (const float bad : {nan, infinity, -infinity, 1e30f, -3e38f, 1.9e18f}) {
    for (int c = 0; c < 3; c++) {
      rays.push_back(good);
      rays.back().origin[c] = bad;
    }
    if (std::isfinite(bad)) continue;
    for (int c = 0; c < 3; c++) {
      rays.push_back(good);
      rays.back().direction[c] = bad;
    }
  }
  for (const float bad : {nan, infinity, -infinity, -1.0f}) {
    rays.push_back(good);
    rays.back().tnear = bad;
  }
  for (const float bad : {nan, -infinity, -1.0f}) {
    rays.push_back(good);
    rays.back().tfar = bad;
  }
  rays.push_back(good);
  rays.back().direction[2] = 0; // the zero vector
  return rays;
}

TEST_F(Rays, HostileRaysHitNothingAndAreCounted) {
  place(square(Shader("VRML97")));
  rtRender();
  const std::vector<RTray> rays = hostileRays();
  std::vector<RThit> hits(rays.size());
  std::vector<uint8_t> occluded(rays.size(), 1);
  const uint64_t before = stats().rejected.rays;
  rtCastRays(rays.size(), rays.data(), hits.data());
  rtOccludedRays(rays.size(), rays.data(), occluded.data());
  for (size_t i = 0; i < rays.size(); i++) {
    EXPECT_TRUE(std::isinf(hits[i].t)) << i;
    EXPECT_EQ(occluded[i], 0) << i;
  }
  EXPECT_EQ(stats().rejected.rays - before, 2 * rays.size());
  const RTray good{{0, 0, 5}, 0, {0, 0, -1}, infinity};
  RThit hit;
  rtCastRays(1, &good, &hit);
  expectClose(hit.t, 5);
}

// Embree asserts that no coordinate of a ray exceeds 1.8e18. In the frame of a small instance the
// coordinates are larger than those of the ray that was checked.
TEST_F(Rays, SmallInstancesMeetNoRayThatIsTooLargeForThem) {
  place(square(Shader("VRML97")));
  const RTid small = square(Shader("VRML97"));
  for (const double size : {1e-3, 1e-9, 1e-14}) {
    for (const Vec& at : {Vec{0, 0, 1}, Vec{0, 0, 1e9}, Vec{0, 0, 5e16}}) {
      SCOPED_TRACE(testing::Message() << size << " at " << at.z);
      rtPushMatrix();
      rtTranslated(at.x, at.y, at.z);
      rtScaled(size, size, size);
      const RTid instance = place(small);
      rtPopMatrix();
      rtInstanceHint(instance, RT_DYNAMIC);
      rtRender();
      std::vector<RTray> rays;
      for (const float length : {1.0f, 1e6f, 1e17f})
        for (const float from : {5.0f, 1e9f, 1e15f, 9e16f, 9e17f})
          rays.push_back({{0, 0, from}, 0, {0, 0, -length}, infinity});
      std::vector<RThit> hits(rays.size());
      std::vector<uint8_t> occluded(rays.size());
      rtCastRays(rays.size(), rays.data(), hits.data());
      rtOccludedRays(rays.size(), rays.data(), occluded.data());
      EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR));
      EXPECT_LE(hits[0].t, 5) << "what is near is seen";
      EXPECT_EQ(occluded[0], 1);
      rtDeleteInstance(instance);
    }
  }
}

TEST_F(Rays, MatricesThatAreNotFiniteAreRefused) {
  const RTid instance = place(square(Shader("VRML97")));
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    for (int k = 0; k < 16; k++) {
      double m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
      m[k] = bad;
      rtInstanceMatrix(instance, m);
      EXPECT_EQ(rtGetError(), RTenum(RT_INVALID_VALUE)) << k;
    }
  use(tilted(0));
  expectGrey(look(), .8); // the picture has not changed
}

TEST_F(Rays, SingularInstancesDrawNothing) {
  use(tilted(0));
  const RTid plane = square(Shader("VRML97"));
  const Vec scales[] = {{0, 1, 1},     {1, 1, 0},         {0, 0, 0}, {1e-20, 1e-20, 1e-20},
                        {1, 1e-20, 1}, {1e30, 1e30, 1e30}};
  for (const Vec& s : scales) {
    SCOPED_TRACE(testing::Message() << s.x << ' ' << s.y << ' ' << s.z);
    rtPushMatrix();
    rtScaled(s.x, s.y, s.z);
    const RTid instance = place(plane);
    rtPopMatrix();
    const Rgba pixel = look();
    EXPECT_EQ(pixel.r, 0);
    EXPECT_EQ(pixel.a, 0);
    EXPECT_EQ(stats().rejected.instances, 1u);
    rtDeleteInstance(instance);
  }
  place(plane);
  expectGrey(look(), .8);
}

TEST_F(Rays, SingularMatricesInsideObjectsDrawNothing) {
  use(tilted(0));
  const RTid plane = square(Shader("VRML97"));
  for (const double s : {0., 1e-20}) {
    const RTid outer = rtBeginObject(0);
    rtScaled(1, s, 1);
    rtInstantiateObject(plane);
    rtEndObject();
    const RTid instance = place(outer);
    EXPECT_EQ(look().a, 0);
    rtDeleteInstance(instance);
  }
}

TEST_F(Rays, FarAwayThingsNeitherShowNorHarm) {
  use(tilted(0));
  const RTid plane = square(Shader("VRML97"));
  for (const double far : {1e7, 1e12, 1e18, 1e19, 1e30, 1e37, 1e200, 1e308}) {
    rtPushMatrix();
    rtTranslated(far, far, -far);
    const RTid instance = place(plane);
    rtPopMatrix();
    rtGetError(); // a matrix that does not fit in floats may be refused
    EXPECT_EQ(look().a, 0) << far;
    if (instance) rtDeleteInstance(instance);
  }
  place(plane);
  expectGrey(look(), .8);
}

TEST_F(Rays, CamerasInOddPlacesMakePictures) {
  use(tilted(0));
  place(square(Shader("VRML97")));
  for (const double z : {1e7, 1e15, 1e18, 1e19, 1e30, 1e300}) {
    rtPushMatrix();
    rtLoadIdentity();
    rtTranslated(0, 0, z);
    rtOrtho(1);
    rtPopMatrix();
    rtGetError();
    EXPECT_TRUE(std::isfinite(render().r)) << z;
  }
  rtPushMatrix();
  rtScaled(0, 0, 0); // a singular camera matrix
  rtOrtho(1);
  rtPopMatrix();
  rtGetError();
  EXPECT_TRUE(std::isfinite(render().r));
  EXPECT_TRUE(std::isfinite(look().r));
}

TEST_F(Rays, LightsUnderSingularMatricesAreHarmless) {
  place(square(Shader("VRML97")));
  rtPushMatrix();
  rtScaled(0, 0, 0);
  use(tilted(0));
  use(point({0, 0, 1}, {1, 0, 0}));
  rtPopMatrix();
  rtGetError();
  EXPECT_TRUE(std::isfinite(look().r));
}

TEST_F(Rays, OneThingFarAwayLeavesTheOthersAlone) {
  use(tilted(0));
  const RTid plane = square(Shader("VRML97"));
  place(plane);
  for (const double far : {1e6, 1e9, 1e12, 1e15, 1e17}) {
    rtPushMatrix();
    rtTranslated(0, -far, 0);
    const RTid instance = place(plane);
    rtPopMatrix();
    expectGrey(look(3, 4), .8);
    rtDeleteInstance(instance);
  }
  for (const double far : {1e9, 1e15, 1e18, 1e19, 1e30, 1e38}) {
    const RTid object = rtBeginObject(0);
    rtBegin(RT_TRIANGLES);
    rtVertex3d(0, -far, 0);
    rtVertex3d(1, -far, 0);
    rtVertex3d(0, -far, far);
    rtEnd();
    rtEndObject();
    const RTid instance = place(object);
    expectGrey(look(3, 4), .8);
    rtDeleteInstance(instance);
  }
}

TEST_F(Rays, DegenerateTrianglesAreDropped) {
  const RTid object = rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  rtVertex3d(-1, -1, 0);
  rtVertex3d(1, -1, 0);
  rtVertex3d(0, 1, 0);
  for (int k = 0; k < 3; k++) rtVertex3f(1, 2, 3); // a point
  rtVertex3f(0, 0, 5);                             // and a line
  rtVertex3f(1, 0, 5);
  rtVertex3f(2, 0, 5);
  rtEnd();
  rtEndObject();
  place(object);
  use(tilted(0));
  expectGrey(look(0, -.5), .8);
  EXPECT_EQ(stats().rejected.primitives, 2u);
  EXPECT_EQ(stats().scene.triangles, 1u);
}

} // namespace
} // namespace numeric

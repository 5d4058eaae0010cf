// double_queries.cpp: ray queries in double precision through the C API. Crossings with quadrics
// and aspheres are within their bounds. Queries of both precisions after moves, new definitions,
// hidden, new and deleted bodies are those of a scene that is made anew, byte for byte.
// tests/python/test_double_rays.py compares triangles and spheres with rational arithmetic.
#include <cstring>
#include <limits>
#include <map>
#include <random>

#include "numeric/support.h"
#include "openrt/query.h"

namespace numeric {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
using Matrix = std::array<double, 16>;

class DoubleQueries : public Scene {
 protected:
  void SetUp() override {
    Scene::SetUp();
    rtOrtho(1); // rtRender, which commits, needs a camera
  }
  std::mt19937 random_{3};
  std::uniform_real_distribution<double> unit_{-1, 1};
  Vec any(double size) {
    return {size * unit_(random_), size * unit_(random_), size * unit_(random_)};
  }
  RTrayd rayTo(const Vec& from, const Vec& to) {
    return {{from.x, from.y, from.z}, 0, {to.x - from.x, to.y - from.y, to.z - from.z}, infinity};
  }
  static void draw(void (*shape)(), const Matrix& m) {
    const RTid object = rtBeginObject(0);
    shape();
    rtEndObject();
    rtInstanceMatrix(rtInstantiateObject(object), m.data());
    rtRender();
  }
  // Casts rays and checks that the sign of `value`, the equation of the surface at a point of the
  // ray, differs on both sides of every answer. Computes in long double.
  template <class Value> void expectBounded(const std::vector<RTrayd>& rays, const Value& value) {
    std::vector<RThitd> hits(rays.size());
    rtCastRaysd(rays.size(), rays.data(), hits.data());
    size_t met = 0;
    for (size_t i = 0; i < rays.size(); i++) {
      const RThitd& hit = hits[i];
      if (std::isinf(hit.t)) continue;
      met++;
      ASSERT_LE(hit.tError, 1e-9 * hit.t) << i;
      const auto at = [&](long double t) {
        return value(rays[i].origin[0] + t * rays[i].direction[0],
                     rays[i].origin[1] + t * rays[i].direction[1],
                     rays[i].origin[2] + t * rays[i].direction[2]);
      };
      const long double before = at(hit.t - hit.tError), behind = at(hit.t + hit.tError);
      EXPECT_TRUE(before * behind <= 0) << i << ": " << before << ", " << behind;
      for (int k = 0; k < 3; k++)
        EXPECT_NEAR(hit.position[k], rays[i].origin[k] + hit.t * rays[i].direction[k],
                    hit.positionError + 1e-15);
    }
    EXPECT_GT(met, rays.size() / 4);
  }
};

TEST_F(DoubleQueries, CrossingsWithQuadricsAreWithinTheirBounds) {
  const Matrix m = {1, .5, 0, 0, -.5, 2, 0, 0, .25, 0, 1, 0, 1e4, 1, 0, 1};
  draw(
      [] {
        const double c[10] = {1, 2, -1, 0, 0, 0, 0, 0, 0, -1}, low[3] = {-3, -3, -2},
                     high[3] = {3, 3, 2};
        rtQuadric(c, low, high);
      },
      m);
  std::vector<RTrayd> rays;
  for (int i = 0; i < 2000; i++) {
    const Vec from = any(9), to = any(1);
    rays.push_back(rayTo({from.x + 1e4, from.y, from.z}, {to.x + 1e4, to.y + 1, to.z}));
  }
  // x = p - .5 q + .25 z, y = .5 p + 2 q in the frame's p and q.
  expectBounded(rays, [](long double x, long double y, long double z) {
    const long double a = x - 1e4L - .25L * z, b = y - 1, p = (2 * a + .5L * b) / 2.25L,
                      q = (b - .5L * p) / 2;
    return p * p + 2 * q * q - z * z - 1;
  });
}

TEST_F(DoubleQueries, CrossingsWithAspheresAreWithinTheirBounds) {
  static constexpr double c = -.75, k = .25, a4 = .02, a6 = -.01;
  draw(
      [] {
        const double terms[2] = {a4, a6};
        rtAsphere(c, k, 2, terms, 0, 1);
      },
      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 100, 1});
  std::vector<RTrayd> rays;
  for (int i = 0; i < 2000; i++) {
    const Vec to = any(.6);
    rays.push_back(rayTo({2 * unit_(random_), 2 * unit_(random_), 104}, {to.x, to.y, 99.5}));
  }
  expectBounded(rays, [](long double x, long double y, long double z) {
    const long double u = x * x + y * y;
    return z - 100 - c * u / (1 + std::sqrt(1 - (1 + (long double)(k)) * c * c * u)) - a4 * u * u -
           a6 * u * u * u;
  });
}

TEST_F(DoubleQueries, PositionsFarAwayHaveTheDigitsOfTheirVertices) {
  const RTid object = rtBeginObject(0);
  rtBegin(RT_TRIANGLES);
  rtVertex3d(0, 0, 0);
  rtVertex3d(1, 0, 0);
  rtVertex3d(0, 1, 0);
  rtEnd();
  rtEndObject();
  rtInstantiateObject(object);
  rtRender();
  const RTrayd ray{{.25, .125, 1e15}, 0, {0, 0, -1e-3}, infinity};
  RThitd hit;
  rtCastRaysd(1, &ray, &hit);
  EXPECT_EQ(hit.t, 1e18);
  EXPECT_EQ(hit.u, .25);
  EXPECT_EQ(hit.v, .125);
  EXPECT_NEAR(hit.position[2], 0, hit.positionError);
  EXPECT_LE(hit.positionError, 1e-14);
  EXPECT_EQ(hit.normal[2], 1);
}

// A scene that changes, and what it shows: enough to make the same scene in another context.
class Bodies {
 public:
  struct Body {
    RTid object = 0, instance = 0;
    std::vector<float> points;
    Matrix matrix;
    bool visible = true;
  };
  std::map<uint64_t, Body> all;

  static void define(RTid object, const std::vector<float>& points) {
    rtBeginObject(object);
    if (points.empty()) {
      rtSphere(.75f);
    } else {
      rtVertexPointer(3, RT_FLOAT, 0, points.data());
      rtDrawArrays(RT_TRIANGLES, 0, points.size() / 3);
      rtVertexPointer(3, RT_FLOAT, 0, nullptr);
    }
    rtEndObject();
  }
  // Things that move are rounded to float otherwise than those at rest, so all are dynamic from the
  // start.
  static void place(uint64_t number, Body& body) {
    if (!body.object) rtGenObjects(1, &body.object);
    rtObjectHint(body.object, RT_DYNAMIC);
    define(body.object, body.points);
    body.instance = rtInstantiateObject(body.object);
    rtInstanceHint(body.instance, RT_DYNAMIC);
    rtInstanceMatrix(body.instance, body.matrix.data());
    rtInstanceVisible(body.instance, body.visible);
    rtInstanceUserData(body.instance, number);
  }
};

// Holds what all queries say, without ids of instances.
struct Answers {
  std::vector<uint32_t> counts, countsd;
  std::vector<RThit> first;
  std::vector<RThitd> firstd;
  explicit Answers(const std::vector<RTray>& rays, const std::vector<RTrayd>& raysd)
      : counts(rays.size()), countsd(rays.size()), first(rays.size()), firstd(rays.size()) {
    rtCountHits(rays.size(), rays.data(), counts.data());
    rtCountHitsd(rays.size(), raysd.data(), countsd.data());
    std::vector<size_t> places(rays.size() + 1);
    for (size_t i = 0; i < rays.size(); i++) places[i + 1] = i + 1;
    rtListHits(rays.size(), rays.data(), places.data(), first.data());
    rtCastRaysd(rays.size(), raysd.data(), firstd.data());
    for (RThit& hit : first) hit.instance = 0;
    for (RThitd& hit : firstd) hit.instance = 0;
  }
  void expectSame(const Answers& other) const {
    EXPECT_EQ(counts, other.counts);
    EXPECT_EQ(countsd, other.countsd);
    for (size_t i = 0; i < first.size(); i++) {
      EXPECT_EQ(first[i].t, other.first[i].t);
      EXPECT_EQ(first[i].userData, other.first[i].userData);
      EXPECT_EQ(std::memcmp(&firstd[i], &other.firstd[i], sizeof(RThitd)), 0);
    }
  }
};

TEST_F(DoubleQueries, QueriesAfterChangesAreThoseOfANewScene) {
  Bodies bodies;
  const auto shape = [&](size_t triangles) {
    std::vector<float> points;
    for (size_t t = 0; t < triangles; t++) {
      const Vec middle = any(1);
      for (int c = 0; c < 3; c++)
        for (const double x : {middle.x, middle.y, middle.z})
          points.push_back(float(x + .4 * unit_(random_)));
    }
    return points;
  };
  const auto matrix = [&] {
    const Vec x = any(1), y = any(1), z = any(1), t = any(6);
    return Matrix{x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, t.x, t.y, t.z, 1};
  };
  uint64_t next = 0;
  const auto add = [&](bool sphere) {
    Bodies::Body& body = bodies.all[next];
    body.points = sphere ? std::vector<float>() : shape(next % 3 ? 40 : 6);
    body.matrix = matrix();
    Bodies::place(next++, body);
  };
  for (int i = 0; i < 24; i++) add(i % 8 == 0);
  std::vector<RTray> rays;
  std::vector<RTrayd> raysd;
  for (int i = 0; i < 400; i++) {
    const RTrayd ray = rayTo(any(12), any(5));
    rays.push_back({{float(ray.origin[0]), float(ray.origin[1]), float(ray.origin[2])},
                    0,
                    {float(ray.direction[0]), float(ray.direction[1]), float(ray.direction[2])},
                    std::numeric_limits<float>::infinity()});
    raysd.push_back(ray);
  }
  const auto some = [&]() -> Bodies::Body& {
    return std::next(bodies.all.begin(), long(random_() % bodies.all.size()))->second;
  };
  size_t crossings = 0;
  for (int step = 0; step < 24; step++) {
    SCOPED_TRACE(step);
    for (int i = 0; i < 4; i++) {
      Bodies::Body& body = some();
      body.matrix = matrix();
      rtInstanceMatrix(body.instance, body.matrix.data());
    }
    if (step % 3 == 1) {
      Bodies::Body& body = some();
      if (!body.points.empty()) Bodies::define(body.object, body.points = shape(40));
    }
    if (step % 4 == 2) {
      Bodies::Body& body = some();
      body.visible = !body.visible;
      rtInstanceVisible(body.instance, body.visible);
    }
    if (step % 6 == 3) add(false);
    if (step % 6 == 5) {
      const auto gone = bodies.all.begin();
      rtDeleteObject(gone->second.object);
      bodies.all.erase(gone);
    }
    rtRender();
    if (step % 5 == 4) continue; // a change that no query sees
    const Answers here(rays, raysd);
    const RTcontext before = rtGetCurrent(), other = rtNewContext("threads=1");
    ASSERT_NE(other, nullptr);
    rtQuality(RT_SAMPLES_PER_PIXEL, 1);
    rtFrameBuffer(1, 1, RT_RGBA);
    rtOrtho(1);
    for (auto [number, body] : bodies.all) {
      body.object = 0;
      Bodies::place(number, body);
    }
    rtRender();
    here.expectSame(Answers(rays, raysd));
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
    rtDeleteContext(other);
    rtMakeCurrent(before);
    for (const uint32_t count : here.counts) crossings += count;
  }
  EXPECT_GT(crossings, 1000u);
}

} // namespace
} // namespace numeric

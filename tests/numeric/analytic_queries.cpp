// analytic_queries.cpp: ray queries on quadrics and aspheres, baked, instanced, mirrored and
// moving, against exact solutions; lenses whose rims leave no gap; light that leaves a surface does
// not meet it again; motion; texture coordinates.
#include <limits>
#include <map>
#include <random>

#include "numeric/support.h"
#include "openrt/query.h"

namespace numeric {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
using Matrix = std::array<double, 16>;

const Matrix matrices[] = {
    {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
    {1, .5, 0, 0, -.5, 2, 0, 0, .3, 0, 1, 0, 2, 1, 0, 1},
    {.5, 0, 0, 0, 0, 1.5, .2, 0, 0, 0, -1, 0, -2, 0, 1, 1},        // mirrored
    {0, 100, 0, 0, -100, 0, 0, 0, 0, 0, 100, 0, 300, -500, 0, 1}}; // turned and scaled

Vec pointBy(const Matrix& m, Vec p) {
  return {m[0] * p.x + m[4] * p.y + m[8] * p.z + m[12],
          m[1] * p.x + m[5] * p.y + m[9] * p.z + m[13],
          m[2] * p.x + m[6] * p.y + m[10] * p.z + m[14]};
}
RTray rayFrom(Vec from, Vec to) {
  return {{float(from.x), float(from.y), float(from.z)},
          0,
          {float(to.x - from.x), float(to.y - from.y), float(to.z - from.z)},
          infinity};
}

class AnalyticQueries : public Scene {
 protected:
  void SetUp() override {
    Scene::SetUp();
    rtOrtho(1); // rtRender, which commits, needs a camera
  }
  std::mt19937 random_{11};
  std::uniform_real_distribution<double> unit_{-1, 1};
  Vec any(double size) {
    return {size * unit_(random_), size * unit_(random_), size * unit_(random_)};
  }
  static void unitSphere() {
    const double c[10] = {1, 1, 1, 0, 0, 0, 0, 0, 0, -1}, low[3] = {-1, -1, -1},
                 high[3] = {1, 1, 1};
    rtQuadric(c, low, high);
  }
  // A lens of index-free surfaces: two aspheres and the cylinder between their rims.
  static constexpr double radius = 1.25, rim = 1, thick = .4;
  static double sag(double r) {
    return r * r / radius / (1 + std::sqrt(1 - r * r / radius / radius));
  }
  static void lens() {
    rtPushMatrix();
    rtTranslated(0, 0, thick / 2 + sag(rim));
    const double terms[2] = {.02, -.01};
    rtAsphere(-1 / radius, 0, 0, nullptr, 0, rim); // falls by sag(rim) to the rim
    rtPopMatrix();
    rtPushMatrix();
    rtTranslated(0, 0, -thick / 2 - .01);
    rtEnable(RT_CW_FRONT);
    rtAsphere(0, 0, 2, terms, 0, rim); // rises by .01 to the rim
    rtDisable(RT_CW_FRONT);
    rtPopMatrix();
    const double c[10] = {1, 1, 0, 0, 0, 0, 0, 0, 0, -rim * rim}, low[3] = {-2, -2, -thick / 2},
                 high[3] = {2, 2, thick / 2};
    rtQuadric(c, low, high);
  }
  static RTid instance(void (*draw)(), const Matrix& m, bool moving) {
    const RTid object = rtBeginObject(0);
    draw();
    rtEndObject();
    const RTid placed = rtInstantiateObject(object);
    rtInstanceMatrix(placed, m.data());
    if (moving) rtInstanceHint(placed, RT_DYNAMIC);
    return placed;
  }
};

TEST_F(AnalyticQueries, RaysMeetASphereWhereItIsUnderEveryMatrix) {
  for (const bool moving : {false, true})
    for (const Matrix& m : matrices) {
      const RTid placed = instance(unitSphere, m, moving);
      rtRender();
      std::vector<RTray> rays;
      std::vector<Vec> from, to;
      for (int i = 0; i < 5000; i++) {
        from.push_back(any(4));
        to.push_back(any(.9));
        rays.push_back(rayFrom(pointBy(m, from.back()), pointBy(m, to.back())));
      }
      std::vector<RThit> hits(rays.size());
      std::vector<uint8_t> blocked(rays.size());
      std::vector<uint32_t> counts(rays.size());
      rtCastRays(rays.size(), rays.data(), hits.data());
      rtOccludedRays(rays.size(), rays.data(), blocked.data());
      rtCountHits(rays.size(), rays.data(), counts.data());
      for (size_t i = 0; i < rays.size(); i++) {
        // In the sphere's frame: |a + t d|^2 = 1.
        const Vec a = from[i], d{to[i].x - a.x, to[i].y - a.y, to[i].z - a.z};
        const double dd = d.x * d.x + d.y * d.y + d.z * d.z, ad = a.x * d.x + a.y * d.y + a.z * d.z,
                     aa = a.x * a.x + a.y * a.y + a.z * a.z, square = ad * ad - dd * (aa - 1);
        const double near = (-ad - std::sqrt(square)) / dd, far = (-ad + std::sqrt(square)) / dd;
        if (square < 1e-3 * dd || std::fabs(near) < 1e-3 || std::fabs(far) < 1e-3) continue;
        const double first = near > 0 ? near : far;
        ASSERT_EQ(std::isfinite(hits[i].t), first > 0) << i;
        EXPECT_EQ(blocked[i], first > 0 ? 1 : 0);
        EXPECT_EQ(counts[i], uint32_t(near > 0) + uint32_t(far > 0));
        if (first > 0) { EXPECT_NEAR(double(hits[i].t), first, 2e-5) << i; }
      }
      rtDeleteInstance(placed);
    }
}

TEST_F(AnalyticQueries, NoRayLeavesALensAtItsRim) {
  for (const bool moving : {false, true}) {
    const RTid placed = instance(lens, matrices[0], moving);
    rtRender();
    std::vector<RTray> inside, through;
    for (int i = 0; i < 100000; i++) {
      const Vec from = {.5 * unit_(random_), .5 * unit_(random_), .15 * unit_(random_)};
      const double turn = pi * unit_(random_), z = (i & 1 ? .5 : -.5) * thick;
      const Vec edge{rim * std::cos(turn), rim * std::sin(turn), z};
      inside.push_back(rayFrom(from, i % 4 < 2 ? edge : any(3)));
      const Vec to = any(.6);
      through.push_back(rayFrom({4 * unit_(random_), 4 * unit_(random_), 5}, to));
    }
    std::vector<RThit> hits(inside.size());
    std::vector<uint32_t> counts(through.size());
    rtCastRays(inside.size(), inside.data(), hits.data());
    size_t leaks = 0, odd = 0;
    for (const RThit& hit : hits) leaks += !std::isfinite(hit.t);
    rtCountHits(through.size(), through.data(), counts.data());
    for (const uint32_t count : counts) odd += count % 2;
    EXPECT_EQ(leaks, 0u);
    EXPECT_EQ(odd, 0u);
    rtDeleteInstance(placed);
  }
}

// Numbers that are exact in float, so that the ends of the rays lie on the surface.
TEST_F(AnalyticQueries, ACrossingCountsAtTheEndOfARayAndNotAtItsStart) {
  for (const bool moving : {false, true}) {
    const RTid placed = instance(unitSphere, matrices[0], moving);
    rtRender();
    struct Case {
      float tnear, tfar;
      uint32_t count;
      float first;
    };
    for (const Case& c : {Case{0, infinity, 2, 2}, Case{2, infinity, 1, 4}, Case{0, 2, 1, 2},
                          Case{2, 4, 1, 4}, Case{4, 9, 0, infinity}, Case{0, 1.75f, 0, infinity},
                          Case{3, 4, 1, 4}, Case{3, 3.75f, 0, infinity}}) {
      const RTray ray = {{3, 0, 0}, c.tnear, {-1, 0, 0}, c.tfar};
      RThit hit, all[3];
      uint32_t count;
      uint8_t blocked;
      const size_t first[2] = {0, 3};
      rtCastRays(1, &ray, &hit);
      rtOccludedRays(1, &ray, &blocked);
      rtCountHits(1, &ray, &count);
      rtListHits(1, &ray, first, all);
      EXPECT_EQ(count, c.count) << c.tnear << " " << c.tfar;
      EXPECT_EQ(blocked, c.count > 0) << c.tnear << " " << c.tfar;
      EXPECT_EQ(hit.t, c.first) << c.tnear << " " << c.tfar;
      EXPECT_EQ(all[0].t, c.first) << c.tnear << " " << c.tfar;
      if (c.count > 0) { EXPECT_EQ(hit.normal[0], c.first == 2 ? 1 : -1); }
    }
    rtDeleteInstance(placed);
  }
}

// Bodies beside each other, under one matrix each, of one surface or of three: a ray that comes
// from outside leaves each as often as it enters it, and the list begins with what the nearest hit
// is.
TEST_F(AnalyticQueries, ListsHoldEveryCrossingOfManyBodiesOnce) {
  for (const bool moving : {false, true}) {
    std::vector<RTid> placed;
    for (int i = 0; i < 12; i++) {
      Matrix m = matrices[i % 3];
      m[12] += 5 * (i - 6);
      placed.push_back(instance(i % 2 ? lens : unitSphere, m, moving));
    }
    rtRender();
    constexpr size_t most = 40;
    std::vector<RTray> rays;
    std::vector<size_t> first{0};
    for (int i = 0; i < 20000; i++) {
      const Vec from = {40 * unit_(random_), 3 * unit_(random_), 9};
      rays.push_back(rayFrom(from, {30 * unit_(random_), .8 * unit_(random_), unit_(random_)}));
      first.push_back(first.back() + most);
    }
    std::vector<RThit> nearest(rays.size()), all(first.back());
    std::vector<uint32_t> counts(rays.size());
    rtCastRays(rays.size(), rays.data(), nearest.data());
    rtCountHits(rays.size(), rays.data(), counts.data());
    rtListHits(rays.size(), rays.data(), first.data(), all.data());
    size_t met = 0, different = 0;
    for (size_t i = 0; i < rays.size(); i++) {
      std::map<RTid, int> crossings;
      size_t count = 0;
      for (size_t k = first[i]; k < first[i + 1] && std::isfinite(all[k].t); k++, count++)
        crossings[all[k].instance]++;
      ASSERT_EQ(count, counts[i]);
      for (const auto& [body, number] : crossings) EXPECT_EQ(number % 2, 0) << i;
      met += count > 0;
      // Embree gets the ray in floats, so one that grazes a body may pass it.
      different += std::isfinite(nearest[i].t) != (count > 0) ||
                   (count > 0 && std::fabs(nearest[i].t - all[first[i]].t) > 1e-4f);
    }
    EXPECT_GT(met, 4000u);
    EXPECT_LE(different, 3u);
    for (const RTid body : placed) rtDeleteInstance(body);
  }
}

// An object with so many triangles that its copies share one acceleration structure, whose matrices
// are floats: the three surfaces of a lens get the same one, so rays at its rims find no gap.
TEST_F(AnalyticQueries, CopiesOfALargeObjectHaveNoGapAtTheirRims) {
  const RTid object = rtBeginObject(0);
  lens();
  rtBegin(RT_TRIANGLES); // on the far side of the lens, out of the way
  for (int i = 0; i < 30000; i++) {
    const double x = i % 100, y = i / 100, z = -500;
    rtVertex3d(x, y, z);
    rtVertex3d(x + 1, y, z);
    rtVertex3d(x, y + 1, z);
  }
  rtEnd();
  rtEndObject();
  std::vector<RTid> placed;
  for (int i = 0; i < 3; i++) {
    placed.push_back(rtInstantiateObject(object));
    Matrix m = {.8, .6, 0, 0, -.6, .8, 0, 0, 0, 0, 1, 0, 5. * i, .7, .3, 1};
    rtInstanceMatrix(placed.back(), m.data());
  }
  rtRender();
  std::vector<RTray> rays;
  for (int i = 0; i < 100000; i++) {
    const double turn = pi * unit_(random_), x = .7 * std::cos(turn), y = .7 * std::sin(turn);
    const Vec middle{5. * (i % 3), .7, .3 + .15 * unit_(random_)};
    const double z = .3 + (i & 1 ? .5 : -.5) * thick, wide = rim / .7;
    rays.push_back(rayFrom({middle.x + x * .3, middle.y - y * .3, middle.z},
                           {5. * (i % 3) + wide * x, .7 + wide * y, z}));
    rays.back().tfar = 2;
  }
  std::vector<uint32_t> counts(rays.size());
  std::vector<RThit> hits(rays.size());
  rtCountHits(rays.size(), rays.data(), counts.data());
  rtCastRays(rays.size(), rays.data(), hits.data());
  size_t none = 0, leaks = 0;
  for (size_t i = 0; i < rays.size(); i++) {
    none += counts[i] == 0;
    leaks += !std::isfinite(hits[i].t);
  }
  EXPECT_EQ(none, 0u);
  EXPECT_EQ(leaks, 0u);
  for (const RTid one : placed) rtDeleteInstance(one);
}

TEST_F(AnalyticQueries, TheFrontFacesOutwardsAndNormalsAreUnit) {
  for (const Matrix& m : matrices) {
    const RTid placed = instance(lens, m, false);
    rtRender();
    for (int i = 0; i < 300; i++) {
      const Vec from = pointBy(m, any(4)), inside = pointBy(m, {.1, .1, 0});
      const RTray ray = rayFrom(from, inside);
      const size_t first[2] = {0, 4};
      RThit hits[4];
      rtListHits(1, &ray, first, hits);
      for (int k = 0; k < 4; k++) {
        if (!std::isfinite(hits[k].t)) break;
        const float* n = hits[k].normal;
        EXPECT_NEAR(double(std::hypot(n[0], n[1], n[2])), 1, 1e-6);
        const double along = double(n[0]) * ray.direction[0] + double(n[1]) * ray.direction[1] +
                             double(n[2]) * ray.direction[2];
        EXPECT_EQ(along < 0, hits[k].t < 1) << "the point (.1 .1 0) at t = 1 is inside";
      }
    }
    rtDeleteInstance(placed);
  }
}

// Rays that start on the surface, as the renderer spawns them, do not meet it again: a white matt
// ball in a white sky is as bright as the sky.
TEST_F(AnalyticQueries, AMattBodyInAWhiteSkyIsInvisible) {
  Shader sky("VRML97Environment");
  sky.setList("skyColor", {1, 1, 1});
  rtUseEnvironment(sky);
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  rtQuality(RT_SAMPLES_PER_PIXEL, 16);
  Shader white("Diffuse");
  white.set("reflectance", {1, 1, 1});
  for (const double scale : {1e-3, 1., 1e4})
    for (const bool moving : {false, true}) {
      const RTid object = rtBeginObject(0);
      rtBindShader(white);
      unitSphere();
      rtEndObject();
      rtBindShader(0);
      rtPushMatrix();
      rtScaled(scale, scale, scale);
      const RTid placed = place(object);
      if (moving) rtInstanceHint(placed, RT_DYNAMIC);
      rtLookAt(0, 0, 4, 0, 0, 0, 0, 1, 0);
      rtPerspective(40);
      rtPopMatrix();
      const auto rgba = picture(24);
      EXPECT_NEAR(mean(rgba), 1, 1e-5) << scale << moving;
      rtDeleteInstance(placed);
    }
}

TEST_F(AnalyticQueries, MotionIsThatOfTheSurfacesFrame) {
  const RTid placed = instance(lens, matrices[0], true);
  rtPushMatrix();
  rtLoadIdentity();
  rtTranslated(.2, .1, 20);
  rtOrtho(1e-6);
  rtPopMatrix();
  rtFrameBuffer(1, 1, RT_RGBA | RT_MOTION);
  rtRender();
  Matrix moved = matrices[0];
  moved[12] = .25;
  moved[14] = -.5;
  rtInstanceMatrix(placed, moved.data());
  rtRender();
  float motion[3];
  rtReadPixels(RT_MOTION, motion, 3);
  EXPECT_NEAR(double(motion[0]), .25, 1e-6);
  EXPECT_NEAR(double(motion[1]), 0, 1e-6);
  EXPECT_NEAR(double(motion[2]), -.5, 1e-6);
}

TEST_F(AnalyticQueries, AConeAndACylinderAreThePartOfTheirRadii) {
  const RTid placed = instance(
      [] {
        rtCone(2, 1, -1, 3);
        rtLoadName(7);
        rtCylinder(.5, -2, 2);
        rtLoadName(0);
      },
      matrices[0], false);
  rtRender();
  for (const double y : {-1.9, -.9, 0., 1.5, 2.9}) {
    const RTray ray = rayFrom({10, y, 0}, {9, y, 0});
    const size_t first[2] = {0, 6};
    RThit hits[6];
    rtListHits(1, &ray, first, hits);
    int at = 0;
    const bool cone = y > -1, cylinder = y < 2;
    const double wide = 2 - (y + 1) / 4;
    if (cone) {
      EXPECT_NEAR(double(hits[at].t), 10 - wide, 1e-6);
      EXPECT_EQ(hits[at++].name, 0u);
    }
    if (cylinder) {
      EXPECT_NEAR(double(hits[at].t), 9.5, 1e-6);
      EXPECT_EQ(hits[at++].name, 7u);
      EXPECT_NEAR(double(hits[at++].t), 10.5, 1e-6);
    }
    if (cone) { EXPECT_NEAR(double(hits[at++].t), 10 + wide, 1e-6); }
    EXPECT_TRUE(at == 6 || !std::isfinite(hits[at].t));
  }
  rtDeleteInstance(placed);
}

TEST_F(AnalyticQueries, RaysOfAnyScaleMeetTheExactQuadratic) {
  // The answer of a query is a float, and its ray is made of floats: the exact solution is computed
  // in long double from these.
  for (const double scale : {1e-6, 1e-2, 1e3, 1e7}) {
    Matrix m = matrices[0];
    m[0] = m[5] = m[10] = scale;
    const RTid placed = instance(unitSphere, m, false);
    rtRender();
    std::vector<RTray> rays;
    for (int i = 0; i < 25000; i++) {
      const Vec a = any(scale * std::pow(10, std::fabs(2 * unit_(random_)))), b = any(1.2 * scale);
      rays.push_back(rayFrom(a, b));
    }
    std::vector<RThit> hits(rays.size());
    rtCastRays(rays.size(), rays.data(), hits.data());
    size_t compared = 0;
    for (size_t i = 0; i < rays.size(); i++) {
      using Wide = long double;
      const float *o = rays[i].origin, *d = rays[i].direction;
      Wide dd = 0, od = 0, oo = 0;
      for (int k = 0; k < 3; k++) {
        dd += Wide(d[k]) * d[k];
        od += Wide(o[k]) * d[k];
        oo += Wide(o[k]) * o[k];
      }
      const Wide square = od * od - dd * (oo - Wide(scale) * scale);
      const double chord = double(square / (dd * Wide(scale) * scale));
      if (std::fabs(chord) < 1e-4) continue; // grazes: a rounding of the origin decides
      Wide t = square > 0 ? (-od - std::sqrt(square)) / dd : Wide(-1);
      if (square > 0 && t < 0) t = (-od + std::sqrt(square)) / dd;
      if (std::fabs(double(t)) < 1e-4) continue;
      ASSERT_EQ(std::isfinite(hits[i].t), t > 0) << scale << " " << i;
      if (!(t > 0)) continue;
      compared++;
      EXPECT_NEAR(double(hits[i].t) / double(t), 1, 1e-5) << scale << " " << i;
    }
    EXPECT_GT(compared, 10000u);
    rtDeleteInstance(placed);
  }
}

// An answer that left the surface out would be wrong without a word.
TEST_F(AnalyticQueries, ClosestPointsAreRefused) {
  const RTid object = rtBeginObject(0);
  unitSphere();
  rtEndObject();
  const RTid placed = place(object);
  rtRender();
  const float point[3] = {2, 0, 0};
  RTclosest found{};
  rtClosestPoints(1, point, infinity, &found);
  EXPECT_EQ(rtGetError(), RTenum(RT_INVALID_OPERATION));
  EXPECT_NE(std::string(rtGetErrorMessage()).find("quadric"), std::string::npos)
      << rtGetErrorMessage();
  rtDeleteInstance(placed);
  rtRender();
  rtClosestPoints(1, point, infinity, &found);
  EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR));
  EXPECT_TRUE(std::isinf(found.distance)) << "the scene is empty";
}

} // namespace
} // namespace numeric

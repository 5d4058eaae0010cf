// camera_projection.cpp: for every stock camera, `project` inverts `generate`. Its weight must be
// as openrts.h defines it: pixels covered per unit of area at the point, for a surface that faces
// the eye. The weight is checked by finite differences of the projection.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "abi/fake_host.h"
#include "shading/registry.h"

namespace openrt::test {
namespace {

const RtsClass& camera(const char* name) {
  static const ShaderRegistry registry(shaderFolders(""));
  return registry.find(name, "");
}

struct Point {
  double x, y, z;
};
Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Point operator*(Point a, double s) { return {a.x * s, a.y * s, a.z * s}; }
Point cross(Point a, Point b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double length(Point a) { return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }

const float size[2] = {320, 200};
const float lens[2] = {0.3f, 0.8f}; // sample on the lens, for cameras that have one

struct LensHost : FakeHost {
  LensHost() {
    random = [](RtsBatch*, uint32_t, float* const square[2]) {
      for (int k = 0; k < 2; k++)
        for (int i = 0; i < RTS_LANES; i++) square[k][i] = lens[k];
    };
  }
};

struct Projected {
  double x, y, weight;
  Point toEye;
  int parallel;
};

Projected project(const RtsClass& c, const ParamBlock& p, Point at) {
  LensHost host;
  Lanes in[5] = {Lanes(1, float(at.x)), Lanes(1, float(at.y)), Lanes(1, float(at.z)),
                 Lanes(1, lens[0]), Lanes(1, lens[1])};
  const float* const local[3] = {in[0].data(), in[1].data(), in[2].data()};
  const float* const square[2] = {in[3].data(), in[4].data()};
  Lanes lanes[6] = {Lanes(1, -7.f), Lanes(1, -7.f), Lanes(1, -7.f),
                    Lanes(1, -7.f), Lanes(1, -7.f), Lanes(1, -7.f)};
  RtsProjection out{};
  for (size_t k = 0; k < 2; k++) out.xy[k] = lanes[k].data();
  for (size_t k = 0; k < 3; k++) out.toEye[k] = lanes[2 + k].data();
  out.weight = lanes[5].data();
  out.parallel = 9;
  c.project(&host, host.batch(), p.get(), 1, local, square, size, &out);
  return {
      lanes[0][0], lanes[1][0], lanes[5][0], {lanes[2][0], lanes[3][0], lanes[4][0]}, out.parallel};
}

void generate(const RtsClass& c, const ParamBlock& p, double x, double y, Point& origin,
              Point& direction) {
  LensHost host;
  Lanes in[2] = {Lanes(1, float(x)), Lanes(1, float(y))};
  const float* const xy[2] = {in[0].data(), in[1].data()};
  Lanes lanes[6];
  RtsRays rays{};
  for (size_t k = 0; k < 3; k++) {
    lanes[k] = lanes[3 + k] = Lanes(1, 9.0f);
    rays.origin[k] = lanes[k].data();
    rays.direction[k] = lanes[3 + k].data();
  }
  c.generate(&host, host.batch(), p.get(), 1, xy, size, &rays);
  origin = {lanes[0][0], lanes[1][0], lanes[2][0]};
  direction = {lanes[3][0], lanes[4][0], lanes[5][0]};
}

struct Case {
  const char* name;
  const char* number; // a parameter to set
  float value;
};
const Case cases[] = {{"PerspectiveCamera", "fovy", 70.0f},   {"PerspectiveCamera", "fovy", 3.0f},
                      {"OrthographicCamera", "height", 7.0f}, {"ThinLens", "radius", 0.2f},
                      {"ThinLens", "radius", 0.0f},           {"Panorama", "vertical", 170.0f}};
const double pixels[][2] = {{160, 100}, {0.5, 0.5}, {319.5, 199.5}, {20.25, 170.5}, {300.75, 31}};

ParamBlock parameters(const Case& c) {
  ParamBlock p(camera(c.name));
  p.set(c.number, {c.value});
  return p;
}

TEST(CameraProjection, UndoesGenerate) {
  for (const Case& c : cases) {
    const RtsClass& kind = camera(c.name);
    const ParamBlock p = parameters(c);
    ASSERT_NE(kind.project, nullptr) << c.name;
    for (const auto& [x, y] : pixels)
      for (const double t : {0.01, 1.0, 6.5, 3000.0}) {
        Point o{}, d{};
        generate(kind, p, x, y, o, d);
        const Projected at = project(kind, p, o + d * t);
        EXPECT_NEAR(at.x, x, 2e-4 * size[0]) << c.name << " " << t;
        EXPECT_NEAR(at.y, y, 2e-4 * size[1]) << c.name << " " << t;
        EXPECT_GT(at.weight, 0) << c.name;
        const double far = at.parallel ? 1 : t; // towards the point where the ray started
        EXPECT_NEAR(length(at.toEye + d * far), 0, 2e-6 * (far + length(o))) << c.name;
      }
  }
}

// Projects a small square that faces the eye by central differences, and divides its pixels by its
// area.
TEST(CameraProjection, WeightIsPixelsPerUnitOfAreaThatFacesTheEye) {
  for (const Case& c : cases) {
    const RtsClass& kind = camera(c.name);
    const ParamBlock p = parameters(c);
    for (const auto& [x, y] : pixels)
      for (const double t : {0.7, 40.0}) {
        Point o{}, d{};
        generate(kind, p, std::min(std::max(x, 10.0), 310.0), std::min(std::max(y, 10.0), 190.0), o,
                 d);
        const Point at = o + d * t;
        const Projected here = project(kind, p, at);
        const Point eye = here.toEye * (1 / length(here.toEye));
        const Point side = cross(eye, std::fabs(eye.x) < 0.7 ? Point{1, 0, 0} : Point{0, 1, 0});
        const Point u = side * (1 / length(side)), v = cross(eye, u);
        const double step = 3 / std::sqrt(here.weight); // a step of 3 pixels
        const Projected a = project(kind, p, at + u * step), b = project(kind, p, at + u * -step);
        const Projected e = project(kind, p, at + v * step), f = project(kind, p, at + v * -step);
        const double area =
            std::fabs((a.x - b.x) * (e.y - f.y) - (a.y - b.y) * (e.x - f.x)) / (4 * step * step);
        EXPECT_NEAR(area, here.weight, 4e-3 * here.weight)
            << c.name << " pixel " << x << " " << y << " distance " << t;
      }
  }
}

TEST(CameraProjection, NothingOutsideThePictureOrBehind) {
  for (const Case& c : cases) {
    const RtsClass& kind = camera(c.name);
    const ParamBlock p = parameters(c);
    if (std::string(c.name) == "Panorama") { // a panorama has nothing behind it
      EXPECT_GT(project(kind, p, {0.01, 0, 1}).weight, 0);
      EXPECT_EQ(project(kind, p, {0, 1, 0}).weight, 0);
      EXPECT_EQ(project(kind, p, {0, 0, 0}).weight, 0);
      EXPECT_EQ(project(kind, p, {NAN, 0, 1}).weight, 0);
      continue;
    }
    for (const Point at : {Point{0, 0, 1}, Point{0, 0, 0}, Point{1e6, 0, -1}, Point{0, -1e6, -1},
                           Point{NAN, 0, -1}, Point{0, INFINITY, -1}, Point{0, 0, -INFINITY}})
      EXPECT_EQ(project(kind, p, at).weight, 0)
          << c.name << " " << at.x << " " << at.y << " " << at.z;
  }
}

TEST(CameraProjection, PointsBesideThePictureHavePlacesThere) {
  const RtsClass& kind = camera("PerspectiveCamera");
  ParamBlock p(kind);
  p.set("fovy", {90}); // 100 pixels for a unit of the plane z = -1
  const Projected beside = project(kind, p, {3, -2, -1});
  EXPECT_EQ(beside.weight, 0);
  EXPECT_NEAR(beside.x, 160 + 300, 1e-3);
  EXPECT_NEAR(beside.y, 100 + 200, 1e-3);
  const Projected behind = project(kind, p, {3, -2, 1}); // on the same line through the eye
  EXPECT_EQ(behind.weight, 0);
  EXPECT_NEAR(behind.x, 160 - 300, 1e-3);
  EXPECT_NEAR(behind.y, 100 - 200, 1e-3);
  EXPECT_EQ(project(kind, p, {1e9, 0, -1}).x, 0) << "too far to have a place";
}

// Rays through a lens meet in the plane of focus and cover the aperture evenly.
TEST(Lens, RaysMeetInThePlaneInFocus) {
  ParamBlock p(camera("ThinLens"));
  p.set("focus", {4.0f});
  for (const float radius : {0.0f, 0.1f, 1.5f}) {
    p.set("radius", {radius});
    Point o{}, d{}, pinhole{}, straight{};
    generate(camera("ThinLens"), p, 70, 20, o, d);
    generate(camera("PerspectiveCamera"), ParamBlock(camera("PerspectiveCamera")), 70, 20, pinhole,
             straight);
    const Point meets = o + d * (4 / -d.z), expected = straight * (4 / -straight.z);
    EXPECT_NEAR(meets.x, expected.x, 2e-6);
    EXPECT_NEAR(meets.y, expected.y, 2e-6);
    EXPECT_LE(length(o), radius * 1.000001);
    EXPECT_EQ(length(o) > 0, radius > 0);
  }
}

TEST(Lens, PolygonsAreFilledEvenly) {
  struct GridHost : FakeHost {
    GridHost() {
      random = [](RtsBatch*, uint32_t, float* const square[2]) {
        for (int i = 0; i < 4096; i++) {
          square[0][i] = (static_cast<float>(i % 64) + 0.5f) / 64;
          square[1][i] = (static_cast<float>(i / 64) + 0.5f) / 64;
        }
      };
    }
  };
  for (const int blades : {0, 3, 5, 8}) {
    GridHost host;
    ParamBlock p(camera("ThinLens"));
    p.set("radius", {2.0f});
    p.setInt("blades", blades);
    Lanes in[2] = {Lanes(4096, 160.0f), Lanes(4096, 100.0f)};
    const float* const xy[2] = {in[0].data(), in[1].data()};
    std::vector<Lanes> lanes(6);
    RtsRays rays{};
    for (size_t k = 0; k < 3; k++) {
      lanes[k] = lanes[3 + k] = Lanes(4096);
      rays.origin[k] = lanes[k].data();
      rays.direction[k] = lanes[3 + k].data();
    }
    camera("ThinLens").generate(&host, host.batch(), p.get(), 4096, xy, size, &rays);
    // Second moments about the centre of a disk and of a regular polygon with n corners, radius 2.
    const double expected = blades == 0 ? 2.0 : 4 * (2 + std::cos(2 * M_PI / blades)) / 6;
    double sum = 0, middle = 0;
    for (size_t i = 0; i < 4096; i++) {
      sum += std::pow(rays.origin[0][i], 2) + std::pow(rays.origin[1][i], 2);
      middle += static_cast<double>(rays.origin[0][i]);
    }
    EXPECT_NEAR(sum / 4096, expected, 0.01 * expected) << blades;
    EXPECT_NEAR(middle / 4096, 0, 0.02) << blades;
  }
}

TEST(Panorama, AxesAndEdges) {
  const ParamBlock p(camera("Panorama"));
  Point o{}, d{};
  const struct {
    double x, y;
    Point direction;
  } looks[] = {{160, 100, {0, 0, -1}},
               {240, 100, {1, 0, 0}},
               {80, 100, {-1, 0, 0}},
               {160, 0, {0, 1, 0}},
               {0, 100, {0, 0, 1}}};
  for (const auto& look : looks) {
    generate(camera("Panorama"), p, look.x, look.y, o, d);
    EXPECT_NEAR(length(d + look.direction * -1), 0, 1e-6) << look.x;
    EXPECT_EQ(length(o), 0);
  }
}

} // namespace
} // namespace openrt::test

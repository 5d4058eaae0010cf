// mapper_thick.cpp: Tests points that are drawn as balls and lines that are drawn as rods
// (OpenRTMapper::setThickness, geometry/thick.h), against their equations.
#include <cmath>
#include <limits>

#include "geometry/mesh.h"
#include "openrt/query.h"
#include "unit/mapper_fixture.h"

namespace xvrml::test {
namespace {

constexpr const char* pointsAndLine =
    "Shape { geometry PointSet { coord Coordinate { point [ 0 0 0, 4 0 0 ] } "
    "color Color { color [ 1 0 0, 0 1 0 ] } } }\n"
    "Shape { geometry IndexedLineSet { coord Coordinate { point [ 0 5 0, 3 9 0 ] } "
    "coordIndex [ 0 1 -1 ] } }\n";

Mesh thickMesh(const std::string& geometry, std::unique_ptr<World>& world,
               const Limits& limits = {}, Diagnostics* diagnostics = nullptr) {
  world = loadWorldFromMemory("#VRML V2.0 utf8\nShape { geometry " + geometry + " }\n", "t.wrl");
  auto& shape = static_cast<nodes::Shape&>(*world->scope.roots.at(0));
  return buildMesh(*shape.geometry,
                   {.limits = &limits, .diagnostics = diagnostics, .pointSize = 2, .lineWidth = 1});
}

TEST(Thick, BallsStandAroundTheirPoints) {
  std::unique_ptr<World> world;
  const Mesh mesh = thickMesh("PointSet { coord Coordinate { point [ 0 0 0, 10 0 0 ] } "
                              "color Color { color [ 1 0 0, 0 1 0 ] } }",
                              world);
  ASSERT_EQ(mesh.kind, Mesh::Kind::triangles);
  ASSERT_EQ(mesh.normals.size(), mesh.points.size());
  ASSERT_EQ(mesh.colors.size(), mesh.points.size());
  double volume = 0;
  for (size_t i = 0; i < mesh.points.size(); i++) {
    const bool second = mesh.points[i].x > 5;
    const Vector from = vector(mesh.points[i]) - Vector(second ? 10 : 0, 0, 0);
    EXPECT_NEAR(from.length(), 1, 1e-6);
    EXPECT_NEAR(from.dot(vector(mesh.normals[i])), 1, 1e-6) << "normals lead outwards";
    EXPECT_EQ(mesh.colors[i].g, second ? 1 : 0);
  }
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    volume += vector(mesh.points[mesh.indices[i]])
                  .cross(vector(mesh.points[mesh.indices[i + 1]]))
                  .dot(vector(mesh.points[mesh.indices[i + 2]])) /
              6;
  EXPECT_NEAR(volume, 2 * 4 * M_PI / 3, .25) << "closed, and counter-clockwise from outside";
}

TEST(Thick, RodsStandAroundTheirLines) {
  std::unique_ptr<World> world;
  const Mesh mesh = thickMesh("IndexedLineSet { coord Coordinate { point [ 0 0 0, 3 4 0, 9 9 9 ] } "
                              "coordIndex [ 0 1 -1 ] }",
                              world);
  ASSERT_EQ(mesh.kind, Mesh::Kind::triangles);
  for (size_t i = 0; i < mesh.points.size(); i++) {
    const Vector middle = vector(mesh.points[i]) - .5 * vector(mesh.normals[i]);
    EXPECT_LT(std::min(middle.length(), (middle - Vector(3, 4, 0)).length()), 1e-6)
        << "the surface is half of the width away from an end";
  }
}

TEST(Thick, TooManyTrianglesStayThin) {
  Limits limits;
  limits.triangles = 500; // a ball has 528
  Diagnostics diagnostics;
  std::unique_ptr<World> world;
  const Mesh mesh =
      thickMesh("PointSet { coord Coordinate { point [ 0 0 0 ] } }", world, limits, &diagnostics);
  EXPECT_EQ(mesh.kind, Mesh::Kind::points);
  ASSERT_EQ(diagnostics.list().size(), 1u);
  EXPECT_NE(diagnostics.list()[0].message.find("stay thin"), std::string::npos)
      << diagnostics.list()[0].message;
}

class MapThick : public MapRunning {
 protected:
  void open(double points, double lines) {
    mapper_.reset();
    engine_.reset();
    world_ = loadWorldFromMemory(std::string("#VRML V2.0 utf8\n") + pointsAndLine, "test.wrl");
    mapper_ = std::make_unique<OpenRTMapper>(*world_, MapOptions());
    mapper_->setThickness(points, lines);
    mapper_->map(mapper_->viewpointCamera(0));
    rtFrameBuffer(1, 1, RT_RGBA);
    rtRender();
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
  }
  static double meets(double x, double y, double z, double dx, double dy, double dz) {
    const RTray ray{{float(x), float(y), float(z)},
                    0,
                    {float(dx), float(dy), float(dz)},
                    std::numeric_limits<float>::infinity()};
    RThit hit;
    rtCastRays(1, &ray, &hit);
    return double(hit.t);
  }
};

TEST_F(MapThick, RaysMeetBallsAndRods) {
  open(1, 0);
  EXPECT_NEAR(meets(0, 0, 10, 0, 0, -1), 9.5, .01);
  EXPECT_NEAR(meets(4, 0, 10, 0, 0, -1), 9.5, .01);
  EXPECT_FALSE(std::isfinite(meets(4, .6, 10, 0, 0, -1)));
  open(0, .5);
  EXPECT_NEAR(meets(1.5, 7, 10, 0, 0, -1), 9.75, .01) << "the middle of the line";
  EXPECT_NEAR(meets(-10, 5, 0, 1, 0, 0), 9.75, .06) << "its round end";
}

} // namespace
} // namespace xvrml::test

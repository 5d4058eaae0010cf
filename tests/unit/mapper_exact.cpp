// mapper_exact.cpp: Tests surfaces without facets in worlds: ORTQuadric, ORTAsphere, and Cylinder
// and Cone with OpenRTMapper::setExactShapes. Rays tell facets from true surfaces.
#include <cmath>
#include <limits>

#include "openrt/query.h"
#include "unit/mapper_fixture.h"

namespace xvrml::test {
namespace {

class MapExact : public MapRunning {
 protected:
  void open(const std::string& body, bool exact = false) {
    mapper_.reset();
    engine_.reset();
    world_ = loadWorldFromMemory("#VRML V2.0 utf8\n" + body, "test.wrl");
    mapper_ = std::make_unique<OpenRTMapper>(*world_, MapOptions());
    mapper_->setExactShapes(exact);
    mapper_->map(mapper_->viewpointCamera(0));
    rtFrameBuffer(1, 1, RT_RGBA);
    rtRender();
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
  }
  // Returns the distance at which a ray from the point along the direction meets something.
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

// Between two of 64 sides a prism is thinner than the cylinder by a thousandth of the radius.
constexpr double between = .049; // half the angle of a side, in radians
const double across = std::cos(between), along = std::sin(between);

TEST_F(MapExact, CylinderAndConeKeepTheirFacetsUnlessAskedFor) {
  const char* world = "Shape { geometry Cylinder { } } "
                      "Transform { translation 10 0 0 children Shape { geometry Cone { } } }";
  open(world);
  EXPECT_GT(meets(5 * across, 0, 5 * along, -across, 0, -along), 4.001);
  open(world, true);
  for (const double turn : {0., .049, 1., 2.5, 4.}) {
    const double c = std::cos(turn), s = std::sin(turn);
    EXPECT_NEAR(meets(5 * c, .3, 5 * s, -c, 0, -s), 4, 1e-6);
    EXPECT_NEAR(meets(10 + 3 * c, 0, 3 * s, -c, 0, -s), 2.5, 2e-6);
  }
  EXPECT_NEAR(meets(.3, 5, .2, 0, -1, 0), 4, 1e-6) << "the top";
  EXPECT_NEAR(meets(.3, -5, .2, 0, 1, 0), 4, 1e-6) << "the bottom";
  EXPECT_NEAR(meets(10, -5, .9, 0, 1, 0), 4, 1e-6) << "the bottom of the cone";
  EXPECT_NEAR(meets(10, 5, 0, 0, -1, 0), 4, 1e-6) << "the apex";
}

TEST_F(MapExact, NodesAreTheirEquations) {
  open("Transform { translation 0 0 2 children Shape { geometry ORTAsphere { radius 4 conic -1 "
       "terms .01 semiAperture 2 } } }\n"
       "Transform { translation 10 0 0 children Shape { geometry ORTQuadric { coefficients [ 1 .25 "
       "1 0 0 0 0 0 0 -1 ] low -2 -2 -2 high 2 2 2 } } }");
  for (const double r : {0., .5, 1.3, 1.99})
    EXPECT_NEAR(meets(r, 0, 9, 0, 0, -1), 7 - r * r / 8 - .01 * std::pow(r, 4), 2e-6);
  EXPECT_TRUE(std::isinf(meets(2.01, 0, 9, 0, 0, -1)));
  EXPECT_NEAR(meets(10.5, 9, 0, 0, -1, 0), 9 - 2 * std::sqrt(.75), 2e-6);
  for (const Diagnostic& d : world_->diagnostics.list()) ADD_FAILURE() << d.text();
}

TEST_F(MapExact, ASurfaceBeyondItsEdgeIsNamedWithItsPlace) {
  open("Shape { geometry Box { } }\nShape { geometry ORTAsphere { radius 1 semiAperture 2 } }");
  ASSERT_EQ(world_->diagnostics.list().size(), 1u);
  const std::string text = world_->diagnostics.list()[0].text();
  EXPECT_NE(text.find("beyond its edge, which is at 1"), text.npos) << text;
  EXPECT_NE(text.find(":3:"), text.npos) << text;
}

} // namespace
} // namespace xvrml::test

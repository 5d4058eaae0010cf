// mapper_fit.cpp: Tests cameras that are placed so that they see all of a world.
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "openrt/openrt.h"
#include "xvrml/browser.h"
#include "xvrml/mapper.h"

using namespace xvrml;

namespace {

class MapFit : public testing::Test {
 protected:
  void SetUp() override {
    context_ = rtNewContext("threads=1");
    ASSERT_NE(context_, nullptr) << (rtGetError(), rtGetErrorMessage());
  }
  void TearDown() override {
    mapper_.reset();
    rtDeleteContext(context_);
  }

  OpenRTMapper& load(const std::string& body, double aspect = 4.0 / 3) {
    mapper_.reset();
    world_ = loadWorldFromMemory((body.starts_with("#X3D") ? "" : "#VRML V2.0 utf8\n") + body,
                                 "test.wrl");
    MapOptions options;
    options.aspect = aspect;
    mapper_ = std::make_unique<OpenRTMapper>(*world_, options);
    return *mapper_;
  }

  RTcontext context_ = nullptr;
  std::unique_ptr<World> world_;
  std::unique_ptr<OpenRTMapper> mapper_;
};

TEST_F(MapFit, AFittedCameraSeesEveryCorner) {
  for (const double aspect : {0.4, 1.0, 3.0}) {
    OpenRTMapper& mapper =
        load("Viewpoint { position 3 4 9 orientation 1 2 0.5 0.7 }\n"
             "Transform { translation 100 -20 3 children Shape { geometry Box { size 8 1 30 } } }",
             aspect);
    const CameraSettings c = mapper.fitCamera(0.6);
    EXPECT_EQ(c.fovy, 0.6);
    const Bounds b = mapper.bounds();
    double widest = 0;
    for (int corner = 0; corner < 8; ++corner) {
      double v[3], local[3];
      for (int i = 0; i < 3; ++i)
        v[i] = (corner & (1 << i) ? b.maximum[i] : b.minimum[i]) - c.matrix[12 + i];
      for (int i = 0; i < 3; ++i)
        local[i] = v[0] * c.matrix[4 * i] + v[1] * c.matrix[4 * i + 1] + v[2] * c.matrix[4 * i + 2];
      ASSERT_LT(local[2], 0) << "in front of the camera";
      const double y = std::abs(local[1]) / -local[2] / std::tan(0.3),
                   x = std::abs(local[0]) / -local[2] / std::tan(0.3) / aspect;
      EXPECT_LT(std::max(x, y), 1);
      widest = std::max({widest, x, y});
    }
    EXPECT_GT(widest, 0.85) << "and no farther away than it must";
  }
}

// The lines of sight touch a sphere at its outline; the corners of its box are farther out.
TEST_F(MapFit, AFittedCameraIsAsNearAsTheShapesAllow) {
  constexpr double view[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const double slope = std::tan(0.4) / 1.1, expected = 2 * std::sqrt(1 + 1 / (slope * slope));
  const std::string place = "Transform { translation 100 -20 3 ";
  for (const std::string& shapes :
       {place + "children Shape { geometry Sphere { radius 2 } } }",
        place + "scale 2 .5 1 children Transform { scale .5 2 1 children Shape { geometry Sphere { "
                "radius 2 } } } }"}) {
    OpenRTMapper& mapper = load(shapes, 1);
    CameraSettings c = mapper.cameraAround(view, 0.8, 1);
    EXPECT_NEAR(c.matrix[12], 100, 0.02);
    EXPECT_NEAR(c.matrix[13], -20, 0.02);
    EXPECT_NEAR(c.matrix[14], 3 + expected, 0.05 * expected);
    EXPECT_LT(c.matrix[14], 3 + 2 + 2 / slope) << "the camera that sees the box";
    EXPECT_TRUE(mapper.seesAll(c, 1));
    EXPECT_TRUE(mapper.seesAll(c, 2));
    EXPECT_FALSE(mapper.seesAll(c, 0.5));
    c.matrix[14] -= 0.2 * expected;
    EXPECT_FALSE(mapper.seesAll(c, 1));
    c.matrix[14] = 3 - expected;
    EXPECT_FALSE(mapper.seesAll(c, 1)) << "it looks away";
  }
}

// Looks along -x + -z, so that nothing is along an axis.
constexpr double aslant[16] = {std::numbers::sqrt2 / 2, 0, -std::numbers::sqrt2 / 2, 0, 0, 1, 0, 0,
                               std::numbers::sqrt2 / 2, 0, std::numbers::sqrt2 / 2,  0, 0, 0, 0, 1};

// Returns how far the spheres at these centres reach, in halves of the picture: 1 is its edge.
double reachInPicture(const CameraSettings& c, double aspect, double radius,
                      const std::vector<std::array<double, 3>>& centers) {
  const double tanY = std::tan(c.fovy / 2), slopes[2] = {tanY * aspect, tanY};
  double most = 0;
  for (const auto& center : centers) {
    double local[3] = {};
    for (size_t i = 0; i < 3; ++i)
      for (size_t k = 0; k < 3; ++k)
        local[i] += (center[k] - c.matrix[12 + k]) * c.matrix[4 * i + k];
    const double ahead = -local[2];
    EXPECT_GT(ahead, radius) << "in front of the camera";
    for (int axis = 0; axis < 2; ++axis) {
      // the lines of sight that touch the sphere
      const double aside = std::atan2(std::abs(local[axis]), ahead),
                   half = std::asin(radius / std::hypot(local[axis], ahead));
      most = std::max(most, aside + half < std::numbers::pi / 2
                                ? std::tan(aside + half) / slopes[axis]
                                : std::numeric_limits<double>::infinity());
    }
  }
  return most;
}

TEST_F(MapFit, AFittedCameraOfAWideFieldCutsNothing) {
  std::string cloud;
  std::vector<std::array<double, 3>> centers;
  for (int i = 0; i < 12; ++i) {
    centers.push_back({9 * std::sin(3.1 * i), 4 * std::sin(1.7 * i + 1), 6 * std::cos(2.3 * i)});
    cloud += "Transform { translation " + std::to_string(centers.back()[0]) + " " +
             std::to_string(centers.back()[1]) + " " + std::to_string(centers.back()[2]) +
             " children Shape { geometry Sphere { radius .5 } } }\n";
  }
  for (const double fovy : {1.0, 2.0, 2.4, 2.6, 2.8, 3.0, 3.1})
    for (const double aspect : {0.5, 1.0, 1.6}) {
      const CameraSettings ball = load("Transform { translation 5 6 7 children Shape { geometry "
                                       "Sphere { radius 2 } } }")
                                      .cameraAround(aslant, fovy, aspect);
      EXPECT_LE(reachInPicture(ball, aspect, 2, {{5, 6, 7}}), 1) << fovy << " " << aspect;
      const CameraSettings balls = load(cloud).cameraAround(aslant, fovy, aspect);
      const double reach = reachInPicture(balls, aspect, .5, centers);
      EXPECT_LE(reach, 1) << fovy << " " << aspect;
      EXPECT_GT(reach, fovy < 1.5 ? 0.85 : 0) << fovy << " " << aspect;
    }
}

// A fit sees what will be drawn: a Billboard turns towards the camera that is placed, and an LOD
// shows the level for its distance.
TEST_F(MapFit, AFittedCameraSeesBillboardsAndLevelsAsTheyWillBe) {
  for (const std::string& world :
       {std::string("Billboard { children Shape { geometry Box { size 20 1 .1 } } }"),
        std::string("LOD { range [ 4 ] level [ Shape { geometry Sphere { } } "
                    "Shape { geometry Box { size 30 30 30 } } ] }"),
        std::string("LOD { range [ 4 ] level [ Shape { geometry Sphere { radius 9 } } "
                    "Shape { geometry Sphere { radius .1 } } ] }"),
        // the levels alternate: one is fitted nearer than the range, the other farther
        std::string("LOD { range [ 20 ] level [ Shape { geometry Box { size 20 20 20 } } "
                    "Shape { geometry Box { } } ] }")}) {
    OpenRTMapper& mapper = load(world, 1);
    const CameraSettings straight = mapper.viewpointCamera(0);
    for (const double* view : {aslant, straight.matrix}) {
      const CameraSettings c = mapper.cameraAround(view, 0.8, 1);
      mapper.map(c);
      EXPECT_TRUE(mapper.seesAll(c, 1)) << world;
      EXPECT_EQ(mapper.cameraAround(view, 0.8, 1).fovy, 0.8);
    }
  }
  OpenRTMapper& far = load("LOD { range [ 4 ] level [ Shape { geometry Sphere { radius 9 } } "
                           "Shape { geometry Sphere { radius .1 } } ] }",
                           1);
  CameraSettings c = far.cameraAround(aslant, 0.8, 1);
  EXPECT_LT(std::hypot(c.matrix[12], c.matrix[14]), 30) << "as near as what is drawn allows";
}

TEST_F(MapFit, AViewpointWithViewAllStandsWhereARunningWorldPutsIt) {
  for (const std::string kind :
       {"Viewpoint { orientation 0 1 0 1.1 viewAll TRUE fieldOfView 1.2 }",
        "OrthoViewpoint { position 1 2 3 viewAll TRUE fieldOfView [ 0 0 1 2 ] }"})
    for (const double aspect : {0.6, 1.5}) {
      const std::string text = "#X3D V3.2 utf8\nPROFILE Interchange\n" + kind +
                               "Transform { translation 5 6 7 children Shape { geometry Box { size "
                               "1 2 9 } } }";
      const CameraSettings mapped = load(text, aspect).viewpointCamera(0);
      const Browser browser(loadWorldFromMemory(text, "test.wrl"));
      const CameraSettings seen = browser.camera(aspect);
      for (int i = 0; i < 16; ++i)
        EXPECT_NEAR(mapped.matrix[i], seen.matrix[i], 1e-5) << kind << " " << i;
      EXPECT_NEAR(mapped.fovy, seen.fovy, 1e-6);
      EXPECT_NEAR(mapped.height, seen.height, 1e-5);
    }
}

TEST_F(MapFit, AParallelCameraIsFittedToo) {
  constexpr double view[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  OpenRTMapper& mapper = load("Transform { rotation 0 0 1 0.78539816 children Shape { geometry "
                              "Cylinder { radius 1 height 4 } } }");
  CameraSettings c = mapper.cameraAround(view, 0, 1);
  EXPECT_NEAR(c.height, 1.1 * 6 / std::sqrt(2.0), 0.01);
  EXPECT_TRUE(mapper.seesAll(c, 1));
  c.height *= 0.8;
  EXPECT_FALSE(mapper.seesAll(c, 1));
  EXPECT_TRUE(std::isfinite(load("").cameraAround(view, 0.8, 1).matrix[14])) << "nothing is drawn";
}

} // namespace

// mapper_world.cpp: Tests how the mapper maps worlds, seen through its results and the engine:
// viewpoints, bounds, names, sharing, levels of detail.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "openrt/openrt.h"
#include "xvrml/mapper.h"

using namespace xvrml;

namespace {

class MapWorld : public testing::Test {
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
    world_ = loadWorldFromMemory("#VRML V2.0 utf8\n" + body, "test.wrl");
    MapOptions options;
    options.aspect = aspect;
    mapper_ = std::make_unique<OpenRTMapper>(*world_, options);
    return *mapper_;
  }
  MapStats map(const std::string& body) {
    OpenRTMapper& mapper = load(body);
    mapper.map(mapper.viewpointCamera(0));
    return mapper.stats();
  }
  RTstats engine() {
    rtFrameBuffer(1, 1, RT_RGBA);
    rtRender();
    RTstats stats{};
    stats.size = sizeof stats;
    rtGetStats(&stats);
    return stats;
  }
  void expectNoMessages() {
    for (const Diagnostic& d : world_->diagnostics.list()) ADD_FAILURE() << d.text();
  }

  RTcontext context_ = nullptr;
  std::unique_ptr<World> world_;
  std::unique_ptr<OpenRTMapper> mapper_;
};

std::string repeat(const std::string& text, int times) {
  std::string result;
  for (int i = 0; i < times; ++i) result += text;
  return result;
}

// Returns an ElevationGrid of 2 n^2 triangles.
std::string grid(int n) {
  return "ElevationGrid { xDimension " + std::to_string(n + 1) + " zDimension " +
         std::to_string(n + 1) + " height [" + repeat("0 ", (n + 1) * (n + 1)) + "] }";
}

TEST_F(MapWorld, AnEmptyWorldHasTheStandardsDefaults) {
  OpenRTMapper& mapper = load("");
  EXPECT_TRUE(mapper.viewpoints().empty());
  EXPECT_EQ(mapper.boundViewpoint(), -1);
  EXPECT_TRUE(mapper.bounds().empty);
  const CameraSettings camera = mapper.viewpointCamera(0);
  EXPECT_DOUBLE_EQ(camera.matrix[14], 10);
  EXPECT_NEAR(camera.fovy, std::numbers::pi / 4, 1e-6);
  mapper.map(camera);
  EXPECT_EQ(mapper.stats().lights, 1u) << "the headlight";
  EXPECT_EQ(engine().scene.triangles, 0u);
  expectNoMessages();
}

TEST_F(MapWorld, ViewpointsStandInTheOrderOfTheFileWithTheirPlaces) {
  OpenRTMapper& mapper =
      load("Group { children [ DEF A Viewpoint { description \"first\" position 1 2 3 } ] }\n"
           "PROTO P [] { Transform { translation 5 0 0 children DEF Inner Viewpoint { position 0 0 "
           "1 } } }\n"
           "P { }\n"
           "Transform { translation 0 7 0 scale 2 2 2 rotation 0 1 0 1.5707963 children DEF C "
           "Viewpoint { fieldOfView 1 } }");
  ASSERT_EQ(mapper.viewpoints().size(), 3u);
  EXPECT_EQ(mapper.viewpoints()[0].name, "A");
  EXPECT_EQ(mapper.viewpoints()[0].description, "first");
  EXPECT_EQ(mapper.viewpoints()[1].matrix[12], 5);
  EXPECT_EQ(mapper.boundViewpoint(), 0);
  const CameraSettings c = mapper.viewpointCamera(2);
  EXPECT_NEAR(c.matrix[12], 20, 1e-5) << "position scaled by 2, then turned to +x";
  EXPECT_NEAR(c.matrix[13], 7, 1e-9);
  EXPECT_NEAR(std::hypot(c.matrix[8], c.matrix[9], c.matrix[10]), 1, 1e-12)
      << "scale does not distort the view";
  EXPECT_NEAR(c.fovy, 1, 1e-6);
}

TEST_F(MapWorld, FieldOfViewIsForTheSmallerSide) {
  const CameraSettings c = load("Viewpoint { fieldOfView 0.8 }", 0.5).viewpointCamera(0);
  EXPECT_NEAR(std::tan(c.fovy / 2) * 0.5, std::tan(0.4), 1e-6);
}

TEST_F(MapWorld, ASphereAroundAShearedSphereHoldsAllOfIt) {
  // An ellipsoid with half-axes of 1, 4 and 1. Its turned axes are shorter than 3.
  OpenRTMapper& mapper =
      load("Transform { scale 1 4 1 children Transform { rotation 0 0 1 0.7853982 children "
           "Shape { geometry Sphere { } } } }");
  EXPECT_NEAR(mapper.bounds().maximum[1], 4, 1e-6);
  EXPECT_NEAR(mapper.boundingSphere().radius, 4, 1e-6);
  EXPECT_NEAR(load("Transform { scale 1 8 1 scaleOrientation 0 0 1 0.7 children Shape { geometry "
                   "Sphere { } } }")
                  .boundingSphere()
                  .radius,
              8, 1e-6);
}

TEST_F(MapWorld, BoundsAreThoseOfTheShapes) {
  const Bounds b =
      load(
          "Transform { translation 10 0 0 scale 1 2 1 children [ Shape { geometry Sphere { radius "
          "3 } } ] }\n"
          "Transform { rotation 0 0 1 0.78539816 children Shape { geometry Box { size 2 2 2 } } }\n"
          "Switch { whichChoice -1 choice Shape { geometry Box { size 100 100 100 } } }")
          .bounds();
  ASSERT_FALSE(b.empty);
  EXPECT_NEAR(b.minimum[0], -std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(b.maximum[0], 13, 1e-6);
  EXPECT_NEAR(b.maximum[1], 6, 1e-6);
  EXPECT_NEAR(b.maximum[2], 3, 1e-6);
}

TEST_F(MapWorld, NamesComeFromTheNearestGroup) {
  OpenRTMapper& mapper = load("DEF Car Group { children [ Shape { geometry Box {} } DEF Wheel "
                              "Shape { geometry Sphere {} } ] }\n"
                              "Shape { geometry Cone {} }");
  mapper.map(mapper.viewpointCamera(0));
  const std::vector<std::string>& names = mapper.names();
  EXPECT_EQ(names[0], "");
  for (const char* name : {"Car", "Wheel", "Shape"})
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
  expectNoMessages();
}

TEST_F(MapWorld, StaticGeometryIsOneObject) {
  const MapStats s = map(repeat("Transform { translation 1 0 0 children Shape { appearance "
                                "Appearance { material Material { } } geometry Box { } } }\n",
                                50));
  EXPECT_EQ(s.shapes, 50u);
  EXPECT_EQ(s.triangles, 600u);
  EXPECT_EQ(s.objects, 1u);
  EXPECT_EQ(s.instances, 1u);
  EXPECT_EQ(engine().scene.triangles, 600u);
  expectNoMessages();
}

TEST_F(MapWorld, AGroupUsedOftenIsOneObjectWithInstances) {
  const MapStats s = map("DEF Tree Group { children [ Shape { geometry " + grid(20) + " } ] }\n" +
                         repeat("Transform { translation 1 0 0 children USE Tree }\n", 9));
  EXPECT_EQ(s.triangles, 8000u);
  EXPECT_EQ(s.objects, 2u);
  EXPECT_EQ(s.instances, 11u) << "ten trees and the world";
  const RTstats e = engine();
  EXPECT_EQ(e.scene.uniqueTriangles, 800u);
  EXPECT_EQ(e.scene.triangles, 8000u);
}

TEST_F(MapWorld, GeometryUsedByManyShapesIsStoredOnce) {
  map("Shape { appearance Appearance { material Material { } } geometry DEF G " + grid(40) +
      " }\n" + repeat("Transform { translation 1 0 0 children Shape { geometry USE G } }\n", 3));
  const RTstats e = engine();
  EXPECT_EQ(e.scene.uniqueTriangles, 3200u);
  EXPECT_EQ(e.scene.triangles, 12800u);
}

TEST_F(MapWorld, SmallThingsUsedOftenAreMerged) {
  const MapStats s =
      map("DEF B Shape { geometry Box { } }\n" + repeat("Transform { children USE B }\n", 20));
  EXPECT_EQ(s.objects, 1u);
  EXPECT_EQ(s.triangles, 21 * 12u);
}

TEST_F(MapWorld, AGroupWithAScopedLightIsNeverShared) {
  const MapStats s =
      map("DEF Lit Group { children [ DirectionalLight { } Shape { geometry " + grid(40) +
          " } ] }\n" + repeat("Transform { translation 1 0 0 children USE Lit }\n", 3));
  EXPECT_EQ(s.lights, 5u) << "one a place, and the headlight";
  EXPECT_EQ(s.objects, 5u) << "one a place, and the world";
  const RTstats e = engine();
  EXPECT_EQ(e.scene.lights, 5u);
  EXPECT_EQ(e.scene.triangles, 12800u);
}

TEST_F(MapWorld, LightsThatAreOffAreNotThere) {
  const MapStats s = map("PointLight { on FALSE } SpotLight { } DirectionalLight { on FALSE } "
                         "NavigationInfo { headlight FALSE }");
  EXPECT_EQ(s.lights, 1u);
  EXPECT_EQ(engine().scene.lights, 1u);
}

// 2^30 spheres: shared subtrees stay shared, counts are exact or saturate, nothing is expanded.
TEST_F(MapWorld, DoublingChainsAreNotExpanded) {
  std::string body = "DEF G0 Shape { geometry " + grid(1) + " }\n";
  for (int i = 1; i <= 23; ++i)
    body += "DEF G" + std::to_string(i) + " Group { children [ USE G" + std::to_string(i - 1) +
            " Transform { translation " + std::to_string(1 << i) + " 0 0 children USE G" +
            std::to_string(i - 1) + " } ] }\n";
  body = "Switch { whichChoice 0 choice [ Group { } ] }\n" + body;
  LoadOptions options;
  options.limits.expandedNodes = uint64_t(1) << 40;
  world_ = loadWorldFromMemory("#VRML V2.0 utf8\n" + body, "test.wrl", options);
  mapper_ = std::make_unique<OpenRTMapper>(*world_, MapOptions());
  mapper_->map(mapper_->viewpointCamera(0));
  const MapStats s = mapper_->stats();
  EXPECT_EQ(s.triangles, 2 * ((uint64_t(1) << 24) - 1));
  EXPECT_LT(s.objects, 40u);
  EXPECT_NEAR(mapper_->bounds().maximum[0], (1 << 24) - 1, 4);
}

TEST_F(MapWorld, DeepNestingIsSafe) {
  const int depth = 20000;
  LoadOptions options;
  const std::string shallow = repeat("Transform { translation 0 0 1 children ", 490) +
                              "Shape { geometry Box { } }" + repeat("} ", 490);
  world_ = loadWorldFromMemory("#VRML V2.0 utf8\n" + shallow, "test.wrl", options);
  mapper_ = std::make_unique<OpenRTMapper>(*world_, MapOptions());
  EXPECT_NEAR(mapper_->bounds().maximum[2], 491, 1e-6);
  // Deeper than a file may be: each group refers to the one before by name.
  std::string chain = "Switch { whichChoice -1 choice [ DEF N0 Shape { geometry Box { } }\n";
  for (int i = 1; i <= depth; ++i)
    chain += "DEF N" + std::to_string(i) + " Transform { translation 0 0 1 children USE N" +
             std::to_string(i - 1) + " }\n";
  chain += "] }\nUSE N" + std::to_string(depth) + "\n";
  options.limits.expandedNodes = uint64_t(1) << 40;
  mapper_.reset();
  world_ = loadWorldFromMemory("#VRML V2.0 utf8\n" + chain, "test.wrl", options);
  mapper_ = std::make_unique<OpenRTMapper>(*world_, MapOptions());
  mapper_->map(mapper_->viewpointCamera(0));
  EXPECT_NEAR(mapper_->bounds().maximum[2], depth + 1, 1e-6);
  EXPECT_EQ(engine().scene.triangles, 12u);
}

TEST_F(MapWorld, LevelsOfDetailFollowTheCamera) {
  OpenRTMapper& mapper =
      load("LOD { range [ 5, 20 ] level [ Shape { geometry " + grid(4) + " } Shape { geometry " +
           grid(2) + " } Shape { geometry Box { } } ] }");
  CameraSettings camera = mapper.viewpointCamera(0);
  const std::pair<double, uint64_t> wanted[] = {{3, 32}, {5, 8}, {10, 8}, {30, 12}, {4.9, 32}};
  for (const auto& [distance, triangles] : wanted) {
    camera.matrix[14] = distance;
    mapper.map(camera);
    EXPECT_EQ(engine().scene.triangles, triangles) << distance;
  }
  expectNoMessages();
}

TEST_F(MapWorld, LevelsAreMeasuredInTheirOwnSystem) {
  OpenRTMapper& mapper = load("Transform { scale 10 10 10 children LOD { center 0 0 1 range [ 1.5 "
                              "] level [ Shape { geometry " +
                              grid(2) + " } Shape { geometry Box { } } ] } }");
  CameraSettings camera = mapper.viewpointCamera(0);
  camera.matrix[14] = 20; // distance 1 in local units
  mapper.map(camera);
  EXPECT_EQ(engine().scene.triangles, 8u);
  camera.matrix[14] = 30; // distance 2 in local units
  mapper.map(camera);
  EXPECT_EQ(engine().scene.triangles, 12u);
}

TEST_F(MapWorld, LightsOfLevelsThatAreNotDrawnAreOff) {
  OpenRTMapper& mapper =
      load("NavigationInfo { headlight FALSE } LOD { range 5 level [ Group { children [ PointLight "
           "{ } ] } Group { children [ Shape { geometry Box { } } ] } ] }");
  CameraSettings camera = mapper.viewpointCamera(0);
  mapper.map(camera);
  EXPECT_EQ(engine().scene.lights, 0u);
  camera.matrix[14] = 1;
  mapper.map(camera);
  EXPECT_EQ(engine().scene.lights, 1u);
  camera.matrix[14] = 10;
  mapper.map(camera);
  EXPECT_EQ(engine().scene.lights, 0u);
}

TEST_F(MapWorld, MappingAgainKeepsWhatIsThere) {
  OpenRTMapper& mapper =
      load("Billboard { children Shape { geometry Box { } } } DirectionalLight { }\n"
           "Group { children [ DirectionalLight { } Shape { geometry Sphere { } } ] }");
  CameraSettings camera = mapper.viewpointCamera(0);
  mapper.map(camera);
  const RTstats first = engine();
  for (int i = 0; i < 5; ++i) {
    camera.matrix[12] = i;
    mapper.map(camera);
  }
  const RTstats last = engine();
  EXPECT_EQ(first.scene.objects, last.scene.objects);
  EXPECT_EQ(first.scene.instances, last.scene.instances);
  EXPECT_EQ(first.scene.lights, last.scene.lights);
  EXPECT_EQ(last.scene.lights, 3u);
  expectNoMessages();
}

TEST_F(MapWorld, HeadlightByOption) {
  load("NavigationInfo { headlight FALSE }");
  MapOptions options;
  options.headlight = MapOptions::Headlight::on;
  OpenRTMapper lit(*world_, options);
  lit.map(lit.viewpointCamera(0));
  EXPECT_EQ(lit.stats().lights, 1u);
}

TEST_F(MapWorld, AMissingTextureIsSaidOnceWithItsPlace) {
  map("Shape { appearance DEF A Appearance { material Material { } texture ImageTexture { url [ "
      "\"no.png\", \"nor.jpg\" ] } } geometry Box { } }\nShape { appearance USE A geometry Sphere "
      "{ } }");
  ASSERT_EQ(world_->diagnostics.warnings(), 1u);
  EXPECT_EQ(world_->diagnostics.list()[0].line, 2u);
  EXPECT_NE(world_->diagnostics.list()[0].message.find("no.png"), std::string::npos);
}

TEST_F(MapWorld, ABadShaderIsAnErrorWithItsPlace) {
  map("Shape { appearance ORTAppearance { shader\n ORTShader { name \"Nothing\" file "
      "\"nosuchshader\" } } geometry Box { } }");
  ASSERT_EQ(world_->diagnostics.errors(), 1u);
  EXPECT_EQ(world_->diagnostics.list()[0].line, 3u);
  EXPECT_EQ(engine().scene.triangles, 12u) << "the shape is there all the same";
}

TEST_F(MapWorld, ShaderOptionsAreParametersOfTheClass) {
  map("Shape { appearance ORTAppearance { shader ORTShader { name \"VRML97\" options [ \"color "
      "diffuseColor 1 0 0\", \"1i lit 1\", \"1f nonsense 1\" ] } } geometry Box { } }");
  ASSERT_EQ(world_->diagnostics.errors(), 1u);
  EXPECT_NE(world_->diagnostics.list()[0].message.find("nonsense"), std::string::npos);
}

TEST_F(MapWorld, HostileNumbersDoNotHarm) {
  map("Transform { scale 0 0 0 children Shape { geometry Box { } } }\n"
      "Transform { scale 1e-20 1e-20 1e-20 children Shape { geometry Sphere { } } }\n"
      "Transform { scale 1e30 1e30 1e30 children [ DirectionalLight { } Shape { geometry Sphere { "
      "radius 1e30 } } ] }\n"
      "Transform { scale 0 0 0 children [ Viewpoint { } Fog { visibilityRange 10 } Billboard { "
      "children Shape { geometry Box { } } } LOD { range 3 level [ Shape { geometry Box { } } ] } "
      "PointLight { } ] }\n"
      "PointLight { attenuation 0 0 0 radius 0 } SpotLight { direction 0 0 0 beamWidth 3 "
      "cutOffAngle 0 }");
  engine();
  const CameraSettings c = mapper_->viewpointCamera(0);
  for (const double v : c.matrix) EXPECT_TRUE(std::isfinite(v));
}

} // namespace

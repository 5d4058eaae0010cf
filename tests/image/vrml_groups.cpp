// vrml_groups.cpp: groups, scopes, views and names, from VRML text to the ray tracer: the pixel
// straight ahead of a camera.
#include <cmath>
#include <filesystem>
#include <fstream>

#include "image/vrml_scene.h"

using namespace xvrml;
using namespace xvrml::test;

namespace {

std::string moved(double x, const std::string& what) {
  return "Transform { translation " + std::to_string(x) + " 0 0 children [ " + what + " ] }\n";
}
const std::string plain = square(material()), sun = "DirectionalLight { }\n";

// Returns the red component seen from a distance of 10 in front of x.
float redAt(Scene& scene, double x) { return scene.render(Scene::at(x, 0, 10, 1e-5))[0].r; }

TEST(VrmlGroups, DirectionalLightShinesOnItsGroupOnly) {
  Scene scene(dark + "Group { children [ " + sun + moved(-3, plain) + " ] }\n" + moved(3, plain));
  EXPECT_NEAR(redAt(scene, -3), 0.8, 1e-5);
  EXPECT_NEAR(redAt(scene, 3), 0, 1e-6);
  scene.expectNoMessages();
}

TEST(VrmlGroups, DirectionalLightAtTheTopShinesOnEverything) {
  Scene scene(dark + moved(-3, plain) + sun + moved(3, "Group { children [ " + plain + " ] }"));
  EXPECT_NEAR(redAt(scene, -3), 0.8, 1e-5);
  EXPECT_NEAR(redAt(scene, 3), 0.8, 1e-5);
}

TEST(VrmlGroups, ScopesNest) {
  Scene scene(
      dark + "Transform { translation 0 1 0 children [ Transform { translation 0 -1 0 children [ " +
      sun + moved(-3, plain) + "Group { children [ " + sun + moved(0, plain) + " ] } ] } ] }\n" +
      moved(3, plain));
  EXPECT_NEAR(redAt(scene, -3), 0.8, 1e-5);
  EXPECT_NEAR(redAt(scene, 0), 1.6, 1e-5);
  EXPECT_NEAR(redAt(scene, 3), 0, 1e-6);
}

TEST(VrmlGroups, AScopedLightReachesInstancesOfSharedGroups) {
  const std::string grid = "Shape { appearance " + material() +
                           " geometry ElevationGrid { xDimension 41 zDimension 41 xSpacing 0.05 "
                           "zSpacing 0.05 height [ " +
                           [] {
                             std::string zeros;
                             for (int i = 0; i < 41 * 41; ++i) zeros += "0 ";
                             return zeros;
                           }() +
                           "] } }";
  // The grid faces +y and is turned to face the camera.
  const std::string tree =
      "Transform { rotation 1 0 0 1.5707963 children Transform { translation -1 0 -1 children " +
      grid + " } }";
  Scene scene(dark + "Group { children [ " + sun + moved(-3, "DEF T " + tree) + moved(0, "USE T") +
              " ] }\n" + moved(3, "USE T"));
  EXPECT_NEAR(redAt(scene, -3.01), 0.8, 1e-5);
  EXPECT_NEAR(redAt(scene, 0.01), 0.8, 1e-5);
  EXPECT_NEAR(redAt(scene, 3.01), 0, 1e-6);
  EXPECT_LT(scene.mapper->stats().objects, 4u);
}

TEST(VrmlGroups, AUsedGroupTakesItsLightAlong) {
  Scene scene(dark +
              moved(-3, "DEF L Group { children [ DirectionalLight { direction 0 1 -1 } " + plain +
                            " ] }") +
              "Transform { translation 3 0 0 rotation 0 0 1 1 children USE L }\n" +
              moved(0, plain));
  EXPECT_NEAR(redAt(scene, -3), 0.8 / std::sqrt(2.0), 1e-5);
  EXPECT_NEAR(redAt(scene, 3), 0.8 / std::sqrt(2.0), 1e-5);
  EXPECT_NEAR(redAt(scene, 0), 0, 1e-6);
}

TEST(VrmlGroups, PointAndSpotLightsAreNotScoped) {
  Scene scene(dark +
              "Group { children [ PointLight { location 3 0 2 } ] }\nGroup { children SpotLight { "
              "location -3 0 2 } }\n" +
              moved(-3, plain) + moved(3, plain));
  EXPECT_NEAR(redAt(scene, 3), 0.8, 0.3) << "and a little from the spot, if it reached";
  EXPECT_GT(redAt(scene, -3), 0.8);
}

TEST(VrmlGroups, SwitchIsAScopeOfItsOwn) {
  Scene scene(dark + "Switch { whichChoice 0 choice [ " + sun + " ] }\n" + plain);
  EXPECT_NEAR(redAt(scene, 0), 0, 1e-6);
}

TEST(VrmlGroups, AnInlineIsAScopeAndItsBindablesAreNotBoundFirst) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "vrml_inline_scope";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "part.wrl")
      << "#VRML V2.0 utf8\n"
      << sun << "Viewpoint { position 9 9 9 }\nBackground { skyColor 1 0 0 }\n"
      << moved(-3, plain);
  std::ofstream(folder / "whole.wrl") << "#VRML V2.0 utf8\n"
                                      << dark << "Inline { url \"part.wrl\" }\n"
                                      << moved(3, plain) << "DEF Mine Viewpoint { }\n";
  Scene scene("");
  scene.mapper.reset();
  scene.world = loadWorld((folder / "whole.wrl").string());
  MapOptions options;
  options.linearColor = false;
  scene.mapper = std::make_unique<OpenRTMapper>(*scene.world, options);
  ASSERT_EQ(scene.mapper->viewpoints().size(), 2u);
  EXPECT_EQ(scene.mapper->boundViewpoint(), 1);
  EXPECT_NEAR(redAt(scene, -3), 0.8, 1e-5);
  EXPECT_NEAR(redAt(scene, 3), 0, 1e-6);
  EXPECT_NEAR(redAt(scene, 30), 0, 1e-6) << "the Inline's Background is not bound";
  std::filesystem::remove_all(folder);
}

TEST(VrmlGroups, HeadlightFollowsTheCamera) {
  SceneOptions options;
  Scene scene(plain, options);
  EXPECT_NEAR(redAt(scene, 0), 0.8, 1e-5);
  CameraSettings camera = Scene::at(10, 0, 10, 1e-5); // looks at the origin at 45 degrees
  const double c = std::sqrt(0.5);
  const double axes[] = {c, 0, -c, 0, 0, 1, 0, 0, c, 0, c, 0};
  std::copy(axes, axes + 12, camera.matrix);
  EXPECT_NEAR(scene.render(camera)[0].r, 0.8 * c, 1e-5);
  options.headlight = MapOptions::Headlight::off;
  EXPECT_NEAR(ahead(plain, 10, options).r, 0, 1e-6);
}

TEST(VrmlGroups, BillboardsTurnToEveryCamera) {
  Scene scene("Transform { translation 5 0 0 rotation 0 1 0 2 children Billboard { axisOfRotation "
              "0 0 0 children " +
              plain + " } }");
  const double angles[] = {0, 1, 2.5, 4};
  for (const double angle : angles) {
    const double s = std::sin(angle), c = std::cos(angle);
    CameraSettings camera = Scene::at(5 + 10 * s, 0, 10 * c, 1e-5);
    const double axes[] = {c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0};
    std::copy(axes, axes + 12, camera.matrix);
    EXPECT_NEAR(scene.render(camera)[0].r, 0.8, 1e-5) << angle;
  }
}

TEST(VrmlGroups, ViewpointsSeeFromTheirPlace) {
  Scene scene("Transform { translation 50 0 0 rotation 0 1 0 1.5707963 scale 3 3 3 children [ "
              "Viewpoint { position 0 0 2 fieldOfView 0.1 } " +
              square(material("emissiveColor 0.5 0 0 diffuseColor 0 0 0")) + " ] }");
  EXPECT_NEAR(scene.render()[0].r, 0.5, 1e-6);
}

TEST(VrmlGroups, BackgroundTurnsWithItsParentsButDoesNotMove) {
  const std::string sky = "Background { skyColor [ 1 0 0, 0 1 0, 0 0 1 ] skyAngle [ 1.0, 2.0 ] "
                          "groundColor [ 0 1 1, 1 1 0 ] groundAngle 0.5 }";
  Scene upright(sky);
  CameraSettings up = Scene::at(0, 0, 0, 1e-5);
  const double toZenith[] = {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0};
  std::copy(toZenith, toZenith + 12, up.matrix);
  EXPECT_NEAR(upright.render(up)[0].r, 1, 1e-6);
  const Pixel horizon = upright.render(Scene::at(0, 0, 0, 1e-5))[0];
  EXPECT_NEAR(horizon.g, 2 - 1.5707963, 1e-5);
  EXPECT_NEAR(horizon.b, 1.5707963 - 1, 1e-5);
  Scene turned("Transform { translation 1 2 3 scale 9 9 9 rotation 1 0 0 -1.5707963 children " +
               sky + " }");
  EXPECT_NEAR(turned.render(Scene::at(0, 0, 0, 1e-5))[0].r, 1, 1e-5) << "the zenith lies along -z";
}

TEST(VrmlGroups, NamesOfSharedThings) {
  std::string heights;
  for (int i = 0; i < 50 * 50; ++i) heights += "0 ";
  const std::string turn = "Transform { rotation 1 0 0 1.5707963 children Transform { translation "
                           "-1.01 0 -1.02 children ";
  const std::string grid =
      "ElevationGrid { xDimension 50 zDimension 50 xSpacing 0.05 zSpacing 0.05 height [ " +
      heights + "] }";
  SceneOptions options;
  options.channels = RT_RGBA | RT_NAME;
  Scene scene(moved(-3, "DEF First " + turn + "Shape { geometry DEF G " + grid + " } } }") +
                  moved(0, "DEF Second " + turn + "Shape { geometry USE G } } }") +
                  moved(3, "DEF Third Group { children USE First }") +
                  moved(6, turn + "DEF Leaf Shape { geometry USE G } } }") +
                  moved(9, square("NULL")),
              options);
  const auto nameAt = [&](double x) {
    redAt(scene, x);
    return scene.mapper->names().at(size_t(scene.channel(RT_NAME, 1)[0]));
  };
  EXPECT_EQ(nameAt(-3), "First");
  EXPECT_EQ(nameAt(0), "Second");
  EXPECT_EQ(nameAt(3), "First") << "the nearest";
  EXPECT_EQ(nameAt(6), "Leaf");
  EXPECT_EQ(nameAt(9), "Shape");
  EXPECT_EQ(nameAt(20), "");
}

TEST(VrmlGroups, SolidFacesAndWinding) {
  const auto seen = [](const std::string& more, const std::string& transform = "") {
    return ahead("Transform { " + transform + " children " + square(material(), more) + " }").r >
           0.5;
  };
  EXPECT_TRUE(seen(""));
  EXPECT_FALSE(seen("ccw FALSE"));
  EXPECT_TRUE(seen("ccw FALSE solid FALSE"));
  EXPECT_FALSE(seen("", "rotation 0 1 0 3.14159265"));
  EXPECT_TRUE(seen("solid FALSE", "rotation 0 1 0 3.14159265"));
  Scene mirrored("Transform { scale -1 1 1 children " + plain +
                 " }"); // out of the field's range: reported, and drawn
  EXPECT_NEAR(redAt(mirrored, 0), 0.8, 1e-5) << "a mirrored front is a front";
  EXPECT_EQ(mirrored.world->diagnostics.warnings(), 1u);
}

// A shared group looks like one that is written out, also under a mirroring transform.
TEST(VrmlGroups, InstancesLookLikeCopies) {
  std::string heights;
  for (int i = 1; i < 60 * 60; ++i)
    heights += std::to_string(0.1 * std::sin(i % 60 * 0.3) * std::cos(i / 60 * 0.2)) + " ";
  // An invisible number at the end makes the meshes differ, because equal meshes would be shared.
  int made = 0;
  const auto grid = [&](const std::string& name) {
    return "DEF " + name +
           " Transform { rotation 1 0.1 0 1.4 translation -1.5 -0.2 0 children Shape { "
           "appearance " +
           material("specularColor 1 1 1") +
           " geometry ElevationGrid { xDimension 60 zDimension 60 xSpacing 0.05 zSpacing 0.05 "
           "creaseAngle 1 height [ " +
           heights + std::to_string(1e-5 * ++made) + "] } } }\n";
  };
  const auto world = [&](bool shared) {
    std::string body = dark + "PointLight { location 3 4 6 }\n" + grid("A");
    for (const char* field :
         {"translation 3 0 0", "translation -3 0 0 rotation 0 0 1 2",
          "scale -1 1 1 translation 0 -3 0", "scale 1 -0.5 2 translation 0 3 0"})
      body += std::string("Transform { ") + field + " children " + (shared ? "USE A" : grid("B")) +
              " }\n";
    return body;
  };
  SceneOptions options;
  options.width = 64;
  options.height = 48;
  Scene shared(world(true), options), copied(world(false), options);
  const CameraSettings camera = Scene::at(0, 0, 12, 0.8);
  const std::vector<Pixel> a = shared.render(camera), b = copied.render(camera);
  EXPECT_EQ(shared.mapper->stats().objects, 2u);
  EXPECT_EQ(copied.mapper->stats().objects, 1u);
  size_t different = 0, lit = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    lit += a[i].r > 0.1f;
    different += std::abs(a[i].r - b[i].r) > 1e-3f;
  }
  EXPECT_GT(lit, a.size() / 8);
  EXPECT_LE(different, a.size() / 100)
      << "but for a few pixels at edges and in the shadows of edges";
}

TEST(VrmlGroups, SpheresAreTexturedFromTheBackCounterClockwise) {
  const std::string ball =
      dark + "Shape { appearance Appearance { texture PixelTexture { image 4 1 3 0xFF0000 0x00FF00 "
             "0x0000FF 0xFFFFFF } } geometry Sphere { radius 2 } }";
  Scene scene(ball);
  const auto at = [&](double x) { return scene.render(Scene::at(x, 0, 10, 1e-5))[0]; };
  const Pixel left = at(-2 * std::sin(0.7853982)), right = at(2 * std::sin(0.7853982));
  EXPECT_NEAR(left.g, 1, 1e-3) << "s = 0.375, the second quarter";
  EXPECT_NEAR(right.b, 1, 1e-3) << "s = 0.625, the third quarter";
}

TEST(VrmlGroups, TextureTransformMovesThePicture) {
  const auto look = [](const std::string& transform) {
    return ahead(square("Appearance { texture PixelTexture { image 4 1 3 0xFF0000 0x00FF00 "
                        "0x0000FF 0xFFFFFF } textureTransform TextureTransform { " +
                            transform + " } }",
                        "", 1));
  };
  // The centre of the square has s = 0.5, between the second and third texel.
  EXPECT_NEAR(look("translation -0.125 0").g, 1, 1e-3);
  EXPECT_NEAR(look("translation 0.125 0").b, 1, 1e-3);
  EXPECT_NEAR(look("scale 0.25 1").r, 1, 1e-3);
  EXPECT_NEAR(look("rotation 3.14159265 translation -0.125 0").b, 1, 1e-3)
      << "s = -0.375 repeats at 0.625";
}

} // namespace

// mapper_cube_maps.cpp: Tests cube maps as the texture of a surface (ISO/IEC 19775-1 clause 34), by
// the pixel of one ray along -z that meets a square turned about the y axis: the direction of the
// look-up, what it is combined with, mirrors of GeneratedCubeMapTexture, and events.
#include <array>
#include <cmath>

#include "unit/mapper_fixture.h"

namespace xvrml::test {
namespace {

class MapCubeMaps : public MapRunning {
 protected:
  void loadX3d(const std::string& body) {
    mapper_.reset();
    engine_.reset();
    world_ = loadWorldFromMemory(
        "#X3D V4.0 utf8\nPROFILE Full\nNavigationInfo { headlight FALSE }\n" + body, "test.x3dv");
    engine_ = std::make_unique<Engine>(world_->diagnostics, makeInteraction);
    engine_->adoptScope(world_->scope, true);
    MapOptions options;
    options.linearColor = false; // numbers as written
    mapper_ = std::make_unique<OpenRTMapper>(*world_, options);
  }
  std::array<float, 4> seen() {
    frame();
    std::array<float, 4> rgba{};
    rtReadPixels(RT_RGBA, rgba.data(), rgba.size());
    return rgba;
  }
  void expectSeen(std::array<float, 3> expected, const std::string& what) {
    const std::array<float, 4> rgba = seen();
    for (size_t c = 0; c < 3; c++) EXPECT_NEAR(rgba[c], expected[c], 2e-3f) << what << ", " << c;
  }
  void silent() {
    for (const Diagnostic& d : world_->diagnostics.list()) ADD_FAILURE() << d.text();
  }
  size_t messages() { return world_->diagnostics.list().size(); }
  static std::string texel(const std::string& hex, int components = 3) {
    return "PixelTexture { image 1 1 " + std::to_string(components) + " 0x" + hex + " }";
  }
  static std::string cube() {
    return "DEF C ComposedCubeMapTexture { front DEF F " + texel("FF0000") + " back " +
           texel("00FF00") + " left " + texel("0000FF") + " right " + texel("FFFF00") + " top " +
           texel("FF00FF") + " bottom " + texel("00FFFF") + " }";
  }
  // Textures that events put into the world.
  static constexpr const char* spares =
      "Switch { children [ Shape { appearance Appearance { texture DEF FLAT PixelTexture { image 1 "
      "1 3 0x8040FF } } } Shape { appearance Appearance { texture DEF MIRROR "
      "GeneratedCubeMapTexture { } } } ] }\n";
  static constexpr std::array<float, 3> front{1, 0, 0}, back{0, 1, 0}, right{1, 1, 0},
      black{0, 0, 0};
  static std::string square(double degrees, const std::string& appearance,
                            const std::string& mode = "", const std::string& more = "") {
    const std::string generator =
        mode.empty() ? "" : "texCoord DEF T TextureCoordinateGenerator { mode \"" + mode + "\" }";
    return "Viewpoint { position .3 .1 50 fieldOfView .01 }\nTransform { rotation 0 1 0 " +
           std::to_string(degrees * 3.14159265358979 / 180) +
           " children Shape { appearance DEF A Appearance { " + appearance +
           " } geometry DEF G IndexedFaceSet { solid FALSE coord Coordinate { point [ -9 -9 0, 9 "
           "-9 0, 9 9 0, -9 9 0 ] } coordIndex [ 0 1 2 3 -1 ] " +
           generator + more + " } } }\n";
  }
};

// A normal turned by an angle reflects the ray into twice the angle from +z.
TEST_F(MapCubeMaps, DirectionsFollowTheMode) {
  for (const char* mode :
       {"", "CAMERASPACEREFLECTIONVECTOR", "WORLDSPACEREFLECTIONVECTOR", "SPHERE", "COORD"}) {
    for (const auto& [degrees, color] :
         {std::pair{0, back}, std::pair{20, back}, std::pair{30, right}, std::pair{60, right},
          std::pair{70, front}, std::pair{85, front}}) {
      loadX3d(square(degrees, "texture " + cube(), mode));
      expectSeen(color, std::string(mode) + " at " + std::to_string(degrees));
      silent();
    }
  }
  for (const char* mode : {"CAMERASPACENORMAL", "WORLDSPACENORMAL"})
    for (const auto& [degrees, color] :
         {std::pair{0, back}, std::pair{30, back}, std::pair{60, right}, std::pair{85, right}}) {
      loadX3d(square(degrees, "texture " + cube(), mode));
      expectSeen(color, std::string(mode) + " at " + std::to_string(degrees));
      silent();
    }
}

TEST_F(MapCubeMaps, TheLayerIsLitAndMultiplied) {
  const std::string lamp = "DirectionalLight { direction 0 0 -1 }\n";
  loadX3d(lamp + square(0, "material Material { diffuseColor .5 .25 1 } texture " + cube()));
  expectSeen({0, .25f, 0}, "texture");
  loadX3d(lamp + square(60, "material Material { diffuseColor .5 .25 1 diffuseTexture " + cube() +
                                " } texture " + texel("FFFFFF")));
  expectSeen({.25f, .125f, 0}, "diffuseTexture, at a cosine of one half");
  loadX3d("Background { skyColor 1 1 1 }\n" +
          square(0, "texture ComposedCubeMapTexture { back " + texel("00FF0040", 4) + " }"));
  expectSeen({.749f, 1, .749f}, "alpha");
  loadX3d(square(70, "texture ComposedCubeMapTexture { back " + texel("00FF00") + " }"));
  expectSeen({1, 1, 1}, "a face without a picture");
  silent();
}

TEST_F(MapCubeMaps, NormalTexturesBendTheReflection) {
  // The normal (.5, 0, .866) on a square that faces the viewer.
  loadX3d("DirectionalLight { direction -.5 0 -.866 }\n" +
          square(0,
                 "material Material { diffuseColor 1 1 1 normalTexture " + texel("C080EE") +
                     " } texture " + cube(),
                 "", "texCoord TextureCoordinate { point [ 0 0, 1 0, 1 1, 0 1 ] }"));
  const auto rgba = seen();
  EXPECT_NEAR(rgba[0], 1, .02f);
  EXPECT_NEAR(rgba[1], 1, .02f);
  EXPECT_NEAR(rgba[2], 0, .02f);
  silent();
}

TEST_F(MapCubeMaps, EventsChangeModePicturesAndTexture) {
  loadX3d(spares + square(30, "texture " + cube(), "WORLDSPACENORMAL"));
  const NodeRef first(&node("C"));
  expectSeen(back, "by the normal");
  send("T", "mode", std::string("WORLDSPACEREFLECTIONVECTOR"));
  expectSeen(right, "by the reflected ray");
  send("T", "mode", std::string("CAMERASPACENORMAL"));
  expectSeen(back, "by the normal again");
  send("C", "back", NodeRef(&node("F")));
  expectSeen(front, "another face");
  send("A", "texture", NodeRef(&node("FLAT")));
  expectSeen({128 / 255.0f, 64 / 255.0f, 1}, "a flat picture");
  send("A", "texture", first);
  expectSeen(front, "the cube map again");
  send("A", "texture", NodeRef());
  expectSeen({1, 1, 1}, "no texture");
  silent();
}

TEST_F(MapCubeMaps, AGeneratedCubeMapIsAMirror) {
  const std::string sky = "Background { skyColor .2 .4 .8 }\n";
  const std::string generated = "DEF M GeneratedCubeMapTexture { update \"ALWAYS\" }";
  loadX3d(sky + square(30, "texture " + generated));
  expectSeen({.2f, .4f, .8f}, "unlit");
  // Light is not diffused. It is the mirror that the material's colour tints.
  loadX3d(sky + "DirectionalLight { direction 0 0 -1 ambientIntensity 1 }\n" +
          square(30, "material Material { diffuseColor .5 1 .25 emissiveColor .1 0 0 } texture " +
                         generated));
  expectSeen({.2f, .4f, .2f}, "tinted");
  loadX3d(sky + square(30, "material Material { diffuseColor .5 1 .25 diffuseTexture " + generated +
                               " }"));
  expectSeen({.1f, .4f, .2f}, "diffuseTexture");
  // A red wall stands to the right, where the reflected ray goes.
  loadX3d(sky + spares +
          "Transform { translation 30 0 15 children Shape { appearance Appearance { material "
          "Material { diffuseColor 0 0 0 emissiveColor 1 0 0 } } geometry Box { size 1 40 40 } } "
          "}\n" +
          square(30, "texture " + generated));
  expectSeen({1, 0, 0}, "a wall");
  send("A", "texture", NodeRef(&node("FLAT")));
  expectSeen({128 / 255.0f, 64 / 255.0f, 1}, "a flat picture");
  send("A", "texture", NodeRef(&node("MIRROR")));
  expectSeen({1, 0, 0}, "a mirror again");
  silent();
}

TEST_F(MapCubeMaps, TwoMirrorsEnd) {
  loadX3d("Background { skyColor .2 .4 .8 }\n" + square(0, "texture GeneratedCubeMapTexture { }") +
          "Transform { translation 0 0 60 children Shape { appearance Appearance { texture "
          "GeneratedCubeMapTexture { } } geometry Box { size 90 90 1 } } }\n");
  for (const float c : seen()) EXPECT_TRUE(std::isfinite(c));
  silent();
}

TEST_F(MapCubeMaps, OtherPlacesAreOneWarning) {
  const std::string pictures[] = {
      "texture MultiTexture { texture [ " + texel("FFFFFF") + ", " + cube() + " ] }",
      "material PhysicalMaterial { } texture " + cube(),
      "material UnlitMaterial { emissiveTexture " + cube() + " }",
      "material Material { emissiveTexture GeneratedCubeMapTexture { } }",
      "material Material { } backMaterial Material { diffuseTexture " + cube() + " }"};
  for (const std::string& appearance : pictures) {
    loadX3d(square(0, appearance));
    seen();
    ASSERT_EQ(messages(), 1u) << appearance;
    EXPECT_NE(world_->diagnostics.list()[0].text().find("CubeMapTexture: a cube map is drawn as"),
              std::string::npos)
        << world_->diagnostics.list()[0].text();
  }
}

TEST_F(MapCubeMaps, HostileCubeMaps) {
  const std::string worlds[] = {
      square(0, "texture ComposedCubeMapTexture { }"),
      square(0, "texture ImageCubeMapTexture { }"),
      square(0, "texture DEF X ComposedCubeMapTexture { back DEF Y ComposedCubeMapTexture { } }"),
      square(90, "texture " + cube()),
      square(0, "texture " + cube(), "",
             " normal Normal { vector [ 0 0 0, 0 0 0, 0 0 0, 0 0 0 ] }"),
      square(0, "texture " + cube(), "",
             " normal Normal { vector [ 1e38 0 0, -1e38 1 0, 0 -1e-38 0, 1 0 -1 ] }"),
      square(0, "texture " + cube(), "FOO")};
  for (const std::string& body : worlds) {
    loadX3d(body);
    for (const float c : seen()) EXPECT_TRUE(std::isfinite(c)) << body;
  }
}

} // namespace
} // namespace xvrml::test

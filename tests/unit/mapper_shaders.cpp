// mapper_shaders.cpp: Tests shader plug-ins used by a world: ORTAppearance with texture, ORTLight,
// ORTViewpoint, ORTBackground, and the effect of changing them. Pictures of one ray show which
// shader was called.
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "unit/mapper_fixture.h"

namespace xvrml::test {
namespace {

class MapShaders : public MapRunning {
 protected:
  // Returns the pixel in the middle of the bound view; one sample.
  std::array<float, 4> seen() {
    mapper_->update(engine_->takeChanges());
    mapper_->map(mapper_->viewpointCamera(0));
    rtFrameBuffer(1, 1, RT_RGBA);
    rtQuality(RT_SAMPLES_PER_PIXEL, 1);
    rtRender();
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
    std::array<float, 4> rgba{};
    rtReadPixels(RT_RGBA, rgba.data(), rgba.size());
    return rgba;
  }
  void silent() {
    for (const Diagnostic& d : world_->diagnostics.list()) ADD_FAILURE() << d.text();
  }
  static constexpr const char* dark = "NavigationInfo { headlight FALSE }\n";
  static inline const std::string lit = std::string(dark) + "DirectionalLight { }\n";
  // Returns a square that fills the view.
  static std::string square(const std::string& appearance) {
    return "Shape { appearance " + appearance +
           " geometry IndexedFaceSet { coord Coordinate { point [ -9 -9 0, 9 -9 0, 9 9 0, -9 9 0 ] "
           "} coordIndex [ 0 1 2 3 -1 ] } }\n";
  }
};

TEST_F(MapShaders, AnAppearancesTextureGoesToTheShader) {
  const std::string picture = "texture PixelTexture { image 1 1 3 0xff0000 } ";
  load(dark + std::string("DirectionalLight { direction 0 0 -1 }\n") +
       square("DEF A ORTAppearance { " + picture +
              " shader DEF S ORTShader { name \"Diffuse\" file \"diffuse\" options \"color "
              "reflectance 1 1 1\" } }") +
       "Transform { translation 0 0 -5 children " + square("ORTAppearance { shader USE S }") +
       " }");
  const auto rgba = seen();
  EXPECT_GT(rgba[0], 0.1f);
  EXPECT_EQ(rgba[1], 0);
  silent();
  node("A").set(*node("A").type().find("texture"),
                NodeRef()); // without the texture the shader is white again
  send("A", "set_texture", NodeRef());
  EXPECT_GT(seen()[1], 0.1f);
}

TEST_F(MapShaders, AMaterialGoesToAShaderThatKnowsIt) {
  load(dark + square("ORTAppearance { material Material { emissiveColor 0 1 0 } shader ORTShader { "
                     "name \"VRML97\" } }"));
  EXPECT_FLOAT_EQ(seen()[1], 1);
  load(dark + square("ORTAppearance { material Material { emissiveColor 0 1 0 } shader ORTShader { "
                     "name \"VRML97\" options \"color emissiveColor 0 0 2.5\" } }"));
  EXPECT_FLOAT_EQ(seen()[1], 0) << "options have the last word";
  EXPECT_FLOAT_EQ(seen()[2], 2.5f) << "and are not limited to 1";
  silent();
}

TEST_F(MapShaders, DiffuseColorIsWhatAShaderCallsColor) {
  load(dark + std::string("DirectionalLight { }") +
       square("ORTAppearance { material DEF M Material { diffuseColor 0 1 0 } shader DEF S "
              "ORTShader { name \"Plastic\" file \"plastic\" options \"1f index 1\" } }"));
  EXPECT_FLOAT_EQ(seen()[0], 0);
  EXPECT_FLOAT_EQ(seen()[1], 1);
  send("M", "set_diffuseColor", Color{1, 0, 0});
  EXPECT_FLOAT_EQ(seen()[0], 1);
  EXPECT_FLOAT_EQ(seen()[1], 0);
  send("S", "set_options", MFString{"1f index 1", "color color 0 0 .5"});
  EXPECT_FLOAT_EQ(seen()[0], 0) << "options have the last word";
  EXPECT_FLOAT_EQ(seen()[2], 0.5f);
  silent();
}

TEST_F(MapShaders, AShaderShowsTheColourOfAnyMaterial) {
  for (const char* material :
       {"Material { diffuseColor 0 1 0 }", "TwoSidedMaterial { diffuseColor 0 1 0 }",
        "PhysicalMaterial { baseColor 0 1 0 }", "UnlitMaterial { emissiveColor 0 1 0 }"}) {
    for (const char* shader : {"name \"Plastic\" file \"plastic\" options \"1f index 1\"",
                               "name \"Diffuse\" file \"diffuse\"", "name \"Phong\" file \"phong\"",
                               "name \"Physical\" file \"physical\""}) {
      SCOPED_TRACE(std::string(material) + " " + shader);
      loadX3d(lit + square("ORTAppearance { material " + std::string(material) +
                           " shader ORTShader { " + shader + " } }"));
      const auto rgba = seen();
      EXPECT_EQ(rgba[0], rgba[2]) << "but for highlights";
      EXPECT_GT(rgba[1], rgba[0] + .15f);
    }
  }
}

TEST_F(MapShaders, AShaderShowsTheOwnPictureOfAMaterial) {
  const std::string picture = "PixelTexture { image 1 1 3 0x00ff00 }";
  for (const std::string& material :
       {"Material { diffuseColor 1 1 1 diffuseTexture " + picture + " }",
        "PhysicalMaterial { baseTexture " + picture + " }"}) {
    loadX3d(lit + square("ORTAppearance { material " + material +
                         " shader ORTShader { name \"Diffuse\" file \"diffuse\" } }"));
    const auto rgba = seen();
    EXPECT_EQ(rgba[0], 0) << material;
    EXPECT_GT(rgba[1], .3f) << material;
  }
}

TEST_F(MapShaders, LightsByShader) {
  load(dark + square("Appearance { material Material { diffuseColor 1 1 1 } }") +
       "Transform { translation 0 0 4 children DEF L ORTLight { shader DEF S ORTShader { name "
       "\"VRML97PointLight\" options \"color color 0 2 0\" } } }");
  EXPECT_FLOAT_EQ(seen()[1], 2);
  send("S", "set_options", MFString{"color color 0 3 0"});
  EXPECT_FLOAT_EQ(seen()[1], 3);
  send("S", "set_name",
       std::string("VRML97DirectionalLight")); // another class whose direction is along -z
  EXPECT_FLOAT_EQ(seen()[1], 3);
  send("L", "set_on", false);
  EXPECT_FLOAT_EQ(seen()[1], 0);
  silent();
}

TEST_F(MapShaders, ALightOfAnotherKindIsAnError) {
  load(dark + square("Appearance { material Material { } }") +
       "ORTLight { shader ORTShader { name \"VRML97\" } }");
  ASSERT_EQ(world_->diagnostics.errors(), 1u);
  EXPECT_NE(world_->diagnostics.list()[0].message.find("VRML97 is not a light"), std::string::npos);
}

TEST_F(MapShaders, BackgroundsByShader) {
  load(dark +
       std::string("DEF B ORTBackground { shader DEF S ORTShader { name \"VRML97Environment\" "
                   "options \"floats skyColor .5 0 4\" } }\nDEF O Background { skyColor 0 1 0 }"));
  EXPECT_FLOAT_EQ(seen()[2], 4);
  send("S", "set_options", MFString{"floats skyColor 0 0 7"});
  EXPECT_FLOAT_EQ(seen()[2], 7);
  BoundNodes bound;
  bound.background = &node("O");
  mapper_->bind(bound);
  EXPECT_FLOAT_EQ(seen()[1], 1);
  EXPECT_FLOAT_EQ(seen()[2], 0);
  bound.background = &node("B");
  mapper_->bind(bound);
  EXPECT_FLOAT_EQ(seen()[2], 7);
  silent();
}

TEST_F(MapShaders, ViewpointsByShader) {
  const std::string sky = "Background { skyColor [ 0 0 1, 1 0 0 ] skyAngle 3.1 }\n";
  load(dark + sky +
       "DEF V ORTViewpoint { position 0 0 3 orientation 1 0 0 1.5707963 description \"up\" shader "
       "DEF S ORTShader { name \"OrthographicCamera\" } }");
  EXPECT_EQ(mapper_->viewpoints().size(), 1u);
  EXPECT_EQ(mapper_->viewpoints()[0].description, "up");
  EXPECT_GT(seen()[2], 0.99f) << "along +y";
  send("S", "set_name", std::string("Panorama"));
  seen();
  send("V", "set_shader", NodeRef()); // now without a shader, as a Viewpoint
  EXPECT_GT(seen()[2], 0.9f);
  silent();
}

TEST_F(MapShaders, TheAngleOfViewIsTheViewpoints) {
  const auto width =
      [&](const std::string& view) { // returns the pixel in the middle of the picture's right edge
        load(dark + std::string("Background { skyColor [ 0 0 1, 1 0 0 ] skyAngle 1.5707963 }\n") +
             view);
        mapper_->map(mapper_->viewpointCamera(0));
        rtFrameBuffer(2, 2, RT_RGBA);
        rtRender();
        std::array<float, 16> rgba{};
        rtReadPixels(RT_RGBA, rgba.data(), rgba.size());
        silent();
        return rgba;
      };
  EXPECT_EQ(width("Viewpoint { fieldOfView 1 }"),
            width("ORTViewpoint { fieldOfView 1 shader ORTShader { name \"ThinLens\" options \"1f "
                  "focus 5\" } }"));
  EXPECT_EQ(width("Viewpoint { fieldOfView 0.5235988 }"),
            width("ORTViewpoint { fieldOfView 1 shader ORTShader { name \"ThinLens\" options \"1f "
                  "fovy 30\" } }"));
}

TEST_F(MapShaders, FilesAreReadByTheWorldsOwnRules) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("map_shaders_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "lamp.ies") << "IESNA:LM-63-1995\nTILT=NONE\n";
  std::ofstream(folder / "bytes.ies", std::ios::binary) << std::string("a\0b", 3);
  const auto messages = [&](const std::string& url) {
    world_ = loadWorldFromMemory("#VRML V2.0 utf8\nORTLight { shader ORTShader { name "
                                 "\"VRML97PointLight\" options \"file name '" +
                                     url + "'\" } }",
                                 (folder / "world.wrl").string());
    mapper_ = std::make_unique<OpenRTMapper>(*world_, MapOptions());
    mapper_->map(mapper_->viewpointCamera(0));
    std::string all;
    for (const Diagnostic& d : world_->diagnostics.list()) all += d.message + "\n";
    mapper_.reset();
    return all;
  };
  EXPECT_NE(messages("/etc/passwd").find("absolute"), std::string::npos);
  EXPECT_NE(messages("http://example.org/lamp.ies").find("not fetched"), std::string::npos);
  EXPECT_NE(messages("none.ies").find("none.ies"), std::string::npos);
  EXPECT_NE(messages("bytes.ies").find("not a text"), std::string::npos);
  EXPECT_NE(messages("lamp.ies").find("name"), std::string::npos)
      << "it was read; a VRML97PointLight has no such parameter";
  EXPECT_EQ(messages("lamp.ies").find("lamp.ies"), std::string::npos);
  std::filesystem::remove_all(folder);
}

} // namespace
} // namespace xvrml::test

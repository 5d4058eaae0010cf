// mapper_shader_fields.cpp: Tests that a field that an ORTShader declares gives the picture of the
// option with the same value, that routes change it as a parameter alone, and what is said of
// fields that a class does not have.
#include <filesystem>
#include <fstream>

#include <unistd.h>

#include "unit/mapper_fixture.h"

namespace xvrml::test {
namespace {

class MapShaderFields : public MapRunning {
 protected:
  std::vector<float> picture() {
    mapper_->update(engine_->takeChanges());
    mapper_->map(mapper_->viewpointCamera(0));
    rtFrameBuffer(16, 16, RT_RGBA);
    rtQuality(RT_SAMPLES_PER_PIXEL, 2);
    rtRender();
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
    std::vector<float> rgba(16 * 16 * 4);
    rtReadPixels(RT_RGBA, rgba.data(), rgba.size());
    return rgba;
  }
  std::vector<float> pictureOf(const std::string& body) {
    load(body);
    return picture();
  }
  // Returns a ball of the class before a sky.
  static std::string ball(const std::string& shader) {
    return "NavigationInfo { headlight FALSE }\nDirectionalLight { direction -1 -1 -1 }\n"
           "Viewpoint { position 0 0 4 }\n"
           "Background { skyColor [ 0 0 1, 1 1 0, 1 0 0 ] skyAngle [ 1.2, 2 ] }\n"
           "Shape { appearance ORTAppearance { shader DEF S ORTShader { " +
           shader + " } } geometry Sphere { } }\n";
  }
  std::string messages() const {
    std::string all;
    for (const Diagnostic& d : world_->diagnostics.list()) all += d.text() + "\n";
    return all;
  }
  // Loads a world and returns what is said of its shader.
  std::string said(const std::string& shader) {
    load(ball(shader));
    return messages();
  }
};

TEST_F(MapShaderFields, AFieldIsWorthAnOption) {
  const auto same = [&](const std::string& name, const std::string& options,
                        const std::string& fields) {
    SCOPED_TRACE(fields);
    const auto wanted = pictureOf(ball(name + "options [ " + options + " ]"));
    EXPECT_EQ(pictureOf(ball(name + fields)), wanted);
    EXPECT_EQ(messages(), "");
    EXPECT_NE(pictureOf(ball(name)), wanted) << "the parameters have an effect";
  };
  const std::string glass = "name \"Glass\" file \"glass\" ";
  same(glass, "\"1f index 1.25\"", "exposedField SFFloat index 1.25");
  same(glass, "\"1f index 1.25 color absorption .5 1 2\"",
       "field SFFloat index 1.25 field SFColor absorption .5 1 2");
  same(glass, "\"3f absorption .5 1 2\"", "field SFVec3f absorption .5 1 2");
  same("name \"Checker\" file \"checker\" ", "\"3f size .5 .5 .5\"", "field SFVec3f size .5 .5 .5");
  same("name \"Diffuse\" file \"diffuse\" ", "\"color reflectance .1 .2 .9\"",
       "field SFColor reflectance .1 .2 .9");
}

TEST_F(MapShaderFields, TheFieldCountsIfBothAreGiven) {
  const std::string glass = "name \"Glass\" file \"glass\" ";
  const auto wanted = pictureOf(ball(glass + "options \"1f index 1.25\""));
  EXPECT_EQ(pictureOf(ball(glass + "options \"1f index 1.7\" field SFFloat index 1.25")), wanted);
  EXPECT_NE(messages().find("warning: ORTShader Glass, field index: an option sets this parameter, "
                            "too; the field counts"),
            std::string::npos)
      << messages();
}

TEST_F(MapShaderFields, ARouteGivesThePictureOfOtherOptions) {
  const std::string glass = "name \"Glass\" file \"glass\" ";
  load(ball(glass + "options \"1f index 1.25\""));
  picture();
  send("S", "set_options", MFString{"1f index 1.5"});
  const auto wanted = picture();
  load(ball(glass + "exposedField SFFloat index 1.25") +
       "DEF I ScalarInterpolator { key [ 0, 1 ] keyValue [ 1.25, 1.75 ] }\n"
       "ROUTE I.value_changed TO S.set_index\n");
  const auto before = picture();
  send("S", "set_index", 1.5f);
  EXPECT_EQ(picture(), wanted);
  EXPECT_NE(before, wanted);
  send("S", "set_index", 1.75f);
  const Cost changed = cost();
  EXPECT_GT(changed.parameters, 0u);
  EXPECT_EQ(changed, (Cost{.parameters = changed.parameters})) << "nothing is built again";
  EXPECT_EQ(messages(), "");
}

TEST_F(MapShaderFields, LightsCamerasAndSkiesHaveThem) {
  const std::string rest = "NavigationInfo { headlight FALSE }\nShape { appearance Appearance { "
                           "material Material { } } geometry Box { } }\n";
  const auto same = [&](const std::string& node, const std::string& option,
                        const std::string& field) {
    const auto wanted = pictureOf(rest + node + "options \"" + option + "\" } }");
    EXPECT_EQ(pictureOf(rest + node + field + " } }"), wanted) << field;
    EXPECT_EQ(messages(), "");
    EXPECT_NE(pictureOf(rest + node + " } }"), wanted) << field;
  };
  same("ORTLight { shader ORTShader { name \"VRML97DirectionalLight\" ", "color color 0 2 0",
       "field SFColor color 0 2 0");
  same("PointLight { location 0 0 5 } ORTViewpoint { position 0 0 6 shader ORTShader { name "
       "\"ThinLens\" ",
       "1f radius .5 1f focus 2", "field SFFloat radius .5 field SFFloat focus 2");
  same("ORTBackground { shader ORTShader { name \"VRML97Environment\" ", "floats skyColor .5 0 4",
       "field MFFloat skyColor [ .5 0 4 ]");
}

TEST_F(MapShaderFields, PicturesAreNodesOrUrls) {
  const std::string diffuse = "name \"Diffuse\" file \"diffuse\" ";
  const std::string pixels = "PixelTexture { image 1 1 3 0xff0000 }";
  const auto plain = pictureOf(ball(diffuse));
  load(ball(diffuse + "exposedField SFNode texture DEF P " + pixels));
  const auto red = picture();
  EXPECT_NE(red, plain);
  EXPECT_EQ(messages(), "");
  send("P", "set_image", Image{1, 1, 3, {0, 255, 0}});
  EXPECT_NE(picture(), red);
  send("S", "set_texture", NodeRef());
  EXPECT_EQ(picture(), plain);
  EXPECT_EQ(messages(), "");
  load(ball(diffuse + "exposedField MFString texture [ \"none.png\" ]"));
  EXPECT_NE(messages().find("none.png"), std::string::npos);
}

TEST_F(MapShaderFields, TextsAreStringsOrFiles) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("map_fields_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "spot.ies")
      << "IESNA:LM-63-1995\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0\n1 1 10\n0 20 90\n0\n900 500 0\n";
  const auto lit = [&](const std::string& shader) {
    mapper_.reset();
    engine_.reset();
    world_ = loadWorldFromMemory(
        "#VRML V2.0 utf8\nNavigationInfo { headlight FALSE }\nShape { appearance Appearance { "
        "material Material { } } geometry Box { } }\nTransform { translation 0 0 4 children "
        "ORTLight { shader ORTShader { name \"Luminaire\" file \"luminaire\" "
        "field SFVec3f direction 0 0 -1 " +
            shader + " } } }",
        (folder / "w.wrl").string());
    engine_ = std::make_unique<Engine>(world_->diagnostics, makeInteraction);
    engine_->adoptScope(world_->scope, true);
    mapper_ = std::make_unique<OpenRTMapper>(*world_, MapOptions());
    return picture();
  };
  const auto wanted = lit("options \"file profile spot.ies\"");
  EXPECT_EQ(lit("field MFString profile \"spot.ies\""), wanted);
  EXPECT_EQ(messages(), "");
  EXPECT_EQ(lit("field MFString profile [ \"none.ies\" \"spot.ies\" ]"), wanted);
  EXPECT_EQ(messages(), "") << "the first that can be read counts";
  std::filesystem::remove_all(folder);
}

TEST_F(MapShaderFields, WhatAClassDoesNotHaveIsSaidOnceWithItsPlace) {
  const std::string glass = "name \"Glass\" file \"glass\" ";
  std::string all = said(glass + "field SFFloat indx 1.5");
  EXPECT_NE(all.find("error: ORTShader Glass, field indx: the class has no parameter of this name; "
                     "did you mean 'index'?"),
            std::string::npos)
      << all;
  EXPECT_NE(all.find("test.wrl:6:101: error"), std::string::npos) << all;
  all = said(glass + "field SFColor index 1 1 1");
  EXPECT_NE(all.find("field index: this parameter of Glass is declared as SFFloat or SFDouble, not "
                     "as SFColor"),
            std::string::npos)
      << all;
  all = said(glass + "field SFFloat absorption 1");
  EXPECT_NE(all.find("SFColor, SFVec3f or SFVec3d, not as SFFloat"), std::string::npos) << all;
  all = said(glass + "exposedField SFFloat index -5");
  EXPECT_NE(all.find("ORTShader Glass, field index: "), std::string::npos) << all;
  EXPECT_NE(all.find("outside"), std::string::npos) << all;
  // The other fields count, and a change does not say it again.
  load(ball(glass + "field SFFloat indx 1.5 exposedField SFFloat index 1.25"));
  picture();
  const size_t before = world_->diagnostics.list().size();
  send("S", "set_index", 1.5f);
  const auto other = picture();
  EXPECT_EQ(world_->diagnostics.list().size(), before);
  EXPECT_EQ(pictureOf(ball(glass + "options \"1f index 1.5\"")), other);
}

TEST_F(MapShaderFields, AClassThatIsNotThereIsSaidWithoutItsFields) {
  const std::string all = said("name \"Glas\" field SFFloat index 1.5");
  EXPECT_NE(all.find("Glas"), std::string::npos);
  EXPECT_EQ(all.find("field index"), std::string::npos) << all;
}

} // namespace
} // namespace xvrml::test

// mapper_shared_shaders.cpp: Tests that equal appearances of a large world share the shader that an
// ORTShader makes for them, until one of them changes.
#include <tuple>

#include "unit/mapper_fixture.h"

namespace xvrml::test {
namespace {

constexpr const char* none = "NavigationInfo { headlight FALSE }\n";

class MapSharedShaders : public MapRunning {
 protected:
  static std::string at(int x, const std::string& material, const std::string& shader) {
    return "Transform { translation " + std::to_string(x) +
           " 0 -10 children Shape { appearance ORTAppearance { material " + material + " shader " +
           shader + " } geometry Box { size 40 40 1 } } }\n";
  }
  // Returns the radiance of the boxes on the left and on the right.
  std::tuple<float, float, float, float> leftAndRight() {
    mapper_->update(engine_->takeChanges());
    mapper_->map(mapper_->viewpointCamera(0));
    rtFrameBuffer(3, 1, RT_RGBA);
    rtRender();
    EXPECT_EQ(rtGetError(), RTenum(RT_NO_ERROR)) << rtGetErrorMessage();
    float p[12] = {};
    rtReadPixels(RT_RGBA, p, 12);
    return {p[0], p[1], p[8], p[9]};
  }
};

using Seen = std::tuple<float, float, float, float>;

TEST_F(MapSharedShaders, OneThatChangesBecomesSeparate) {
  const std::string shader = "DEF S ORTShader { name \"VRML97\" }";
  load(none + at(900, "Material { }", shader) + repeat(at(1000, "Material { }", "USE S"), 400) +
       at(-25, "DEF A Material { emissiveColor 1 1 1 }", "USE S") +
       at(25, "DEF B Material { emissiveColor 1 1 1 }", "USE S"));
  EXPECT_EQ(leftAndRight(), Seen(1, 1, 1, 1));
  send("A", "set_emissiveColor", Color{1, 0, 0});
  EXPECT_EQ(leftAndRight(), Seen(1, 0, 1, 1));
  send("A", "set_emissiveColor", Color{0, 1, 0});
  EXPECT_EQ(leftAndRight(), Seen(0, 1, 1, 1));
  send("B", "set_emissiveColor", Color{1, 0, 0});
  EXPECT_EQ(leftAndRight(), Seen(0, 1, 1, 0));
  send("S", "set_options", MFString{"color emissiveColor 0 2 0"});
  EXPECT_EQ(leftAndRight(), Seen(0, 2, 0, 2)) << "options have the last word, for all";
}

TEST_F(MapSharedShaders, AChangeOfTheShaderReachesAllThatShareIt) {
  load(none + at(-25, "Material { }", "DEF S ORTShader { name \"VRML97\" }") +
       repeat(at(1000, "Material { }", "USE S"), 400) + at(25, "Material { }", "USE S") +
       at(25, "Material { }", "USE S"));
  EXPECT_EQ(leftAndRight(), Seen(0, 0, 0, 0));
  send("S", "set_options", MFString{"color emissiveColor 0 2 0"});
  EXPECT_EQ(leftAndRight(), Seen(0, 2, 0, 2));
  send("S", "set_name", std::string("no such class"));
  mapper_->update(engine_->takeChanges());
  mapper_->map(mapper_->viewpointCamera(0));
  while (rtGetError() != RT_NO_ERROR) {}
  send("S", "set_name", std::string("VRML97"));
  EXPECT_EQ(leftAndRight(), Seen(0, 2, 0, 2));
}

TEST_F(MapSharedShaders, AChangedOptionSetsParametersOfTheSharedShader) {
  const std::string shader =
      "DEF S ORTShader { name \"Diffuse\" file \"diffuse\" options \"color reflectance 1 1 1\" }";
  load(none + at(900, "Material { }", shader) + repeat(at(1000, "Material { }", "USE S"), 1000));
  send("S", "set_options", MFString{"color reflectance .1 .2 .3"});
  const Cost changed = cost();
  EXPECT_EQ(changed, (Cost{.parameters = changed.parameters})) << "no shape is defined again";
  EXPECT_GT(changed.parameters, 0u);
}

} // namespace
} // namespace xvrml::test

// vrml_vertex_alpha.cpp: the opacities of a ColorRGBA in pictures (ISO/IEC 19775-1 clause 11.4.3):
// they stand in place of the material's transparency, and are interpolated over a face.
#include "image/vrml_scene.h"

using namespace xvrml::test;

namespace {

const SceneOptions x3d{.header = "#X3D V3.3 utf8\nPROFILE Full"};
const std::string sky = dark + "Background { skyColor 0 0 1 }\n";

// Returns a square with these colours, from the lower left corner on.
std::string colored(const std::string& appearance, const std::string& colors,
                    const std::string& type = "ColorRGBA") {
  return "Shape { appearance " + appearance + " geometry QuadSet { color " + type + " { color [ " +
         colors + " ] } coord Coordinate { point [ -1 -1 0, 1 -1 0, 1 1 0, -1 1 0 ] } } }\n";
}
std::string four(const std::string& color) {
  return color + ", " + color + ", " + color + ", " + color;
}

void expectColor(const Pixel& p, double r, double g, double b) {
  EXPECT_NEAR(p.r, r, 1e-5);
  EXPECT_NEAR(p.g, g, 1e-5);
  EXPECT_NEAR(p.b, b, 1e-5);
}

TEST(VrmlVertexAlpha, UnlitColoursBlendWithWhatIsBehind) {
  expectColor(ahead(sky + colored("Appearance { }", four("1 0 0 0.25")), 10, x3d), .25, 0, .75);
  expectColor(ahead(sky + colored("Appearance { }", four("1 0 0 0")), 10, x3d), 0, 0, 1);
  expectColor(ahead(sky + colored("Appearance { }", four("1 0 0 1")), 10, x3d), 1, 0, 0);
}

TEST(VrmlVertexAlpha, TheyReplaceTheTransparencyOfTheMaterial) {
  const std::string half = material("transparency 0.5");
  const std::string light = "DirectionalLight { }\n";
  expectColor(ahead(sky + light + colored(half, four("1 0 0 1")), 10, x3d), 1, 0, 0);
  expectColor(ahead(sky + light + colored(half, four("1 0 0 0.25")), 10, x3d), .25, 0, .75);
  expectColor(ahead(sky + light + colored(half, four("1 0 0"), "Color"), 10, x3d), .5, 0, .5);
}

// The appearance of a ColorRGBA is also used by a Color.
TEST(VrmlVertexAlpha, OtherShapesKeepTheTransparency) {
  const std::string shapes =
      sky + "DirectionalLight { }\nTransform { translation 0 0 -1 children " +
      colored("DEF A " + material("transparency 0.5"), four("0 1 0"), "Color") + " }\n" +
      colored("USE A", four("1 0 0 0.5"));
  // The front square takes half of the light of the one behind it.
  expectColor(ahead(shapes, 10, x3d), .5, .125, .25);
}

TEST(VrmlVertexAlpha, TheyAreInterpolated) {
  const std::string fading = sky + colored("Appearance { }", "1 0 0 0, 1 0 0 1, 1 0 0 1, 1 0 0 0");
  Scene scene(fading, x3d);
  for (const double x : {-.8, -.3, .3, .8}) {
    const double alpha = (x + 1) / 2;
    expectColor(scene.render(Scene::at(x, .1, 10, 1e-5))[0], alpha, 0, 1 - alpha);
  }
}

TEST(VrmlVertexAlpha, PhysicalMaterialsUseThem) {
  const std::string unlit = "Appearance { material UnlitMaterial { emissiveColor 1 1 1 "
                            "transparency 0.5 } }";
  expectColor(ahead(sky + colored(unlit, four("1 0 0 0.25")), 10,
                    {.header = "#X3D V4.0 utf8\nPROFILE Full"}),
              .25, 0, .75);
}

// Lines and points have the transparency of their material (ISO/IEC 19775-1 12.4.4), unless a
// ColorRGBA gives them opacities of their own.
TEST(VrmlVertexAlpha, LinesAreAsTransparentAsTheirMaterial) {
  const auto line = [](const std::string& color) {
    return "Shape { appearance Appearance { material DEF M Material { emissiveColor 1 0 0 "
           "transparency 0.75 } lineProperties LineProperties { linewidthScaleFactor 9 } } "
           "geometry LineSet { vertexCount 2 " +
           color + " coord Coordinate { point [ -1 0 0, 1 0 0 ] } } }\n";
  };
  const std::string green = "color Color { color [ 0 1 0, 0 1 0 ] }";
  const std::string opaque = "color ColorRGBA { color [ 0 1 0 1, 0 1 0 1 ] }";
  Scene scene(sky + line(""), x3d);
  expectColor(scene.render(Scene::at(0, 0, 10, .01))[0], .25, 0, .75);
  expectColor(Scene(sky + line(green), x3d).render(Scene::at(0, 0, 10, .01))[0], 0, .25, .75);
  expectColor(Scene(sky + line(opaque), x3d).render(Scene::at(0, 0, 10, .01))[0], 0, 1, 0);
}

// A ray meets a line or a point once, also where lines of one list join.
TEST(VrmlVertexAlpha, LinesAndPointsCoverWhatIsBehindOnce) {
  const auto shape = [](const std::string& geometry) {
    return "Shape { appearance Appearance { material Material { emissiveColor 1 0 0 transparency "
           "0.5 } lineProperties LineProperties { linewidthScaleFactor 9 } pointProperties "
           "PointProperties { pointSizeScaleFactor 9 pointSizeMaxValue 9 } } geometry " +
           geometry + " }\n";
  };
  std::string dense; // pieces of less than a pixel
  for (int i = -50; i <= 50; ++i) dense += std::to_string(i * .02) + " 0 0, ";
  for (const std::string& geometry :
       {std::string(
            "LineSet { vertexCount 3 coord Coordinate { point [ -1 0 0, 0 0 0, 1 0 0 ] } }"),
        std::string("IndexedLineSet { coordIndex [ 0 1 2 -1 ] coord Coordinate { point [ -1 0 0, 0 "
                    "0 0, 1 0.3 0 ] } }"),
        std::string("PointSet { coord Coordinate { point [ 0 0 0 ] } }"),
        "LineSet { vertexCount 101 coord Coordinate { point [ " + dense + "] } }"})
    expectColor(Scene(sky + shape(geometry), x3d).render(Scene::at(0, 0, 10, .01))[0], .5, 0, .5);
  // Lines of two shapes, one behind the other.
  const std::string line = "LineSet { vertexCount 2 coord Coordinate { point [ -1 0 0, 1 0 0 ] } }";
  const std::string behind = "Transform { translation 0 0 -1 children " + shape(line) + " }\n";
  expectColor(Scene(sky + shape(line) + behind, x3d).render(Scene::at(0, 0, 10, .01))[0], .75, 0,
              .25);
}

// A ray to the lamp passes a square of this opacity.
TEST(VrmlVertexAlpha, ShadowsAreAsDense) {
  const std::string scene = dark + "PointLight { location 0 0 5 attenuation 1 0 0 }\n" +
                            colored(material("diffuseColor 1 1 1"), four("1 1 1 1")) +
                            "Transform { translation 0 0 2 scale 0.1 0.1 1 children " +
                            colored("Appearance { }", four("0 0 0 0.25")) + " }\n";
  Scene rendered(scene, x3d);
  const xvrml::CameraSettings camera = Scene::at(0, 0, 1, 1e-5); // between the squares
  expectColor(rendered.render(camera)[0], .75, .75, .75);
}

} // namespace

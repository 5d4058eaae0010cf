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

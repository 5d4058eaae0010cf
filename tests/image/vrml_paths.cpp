// vrml_paths.cpp: VRML97 worlds under path tracing. Shapes with an emissiveColor are area lights
// however the mapper groups them; light reflects between surfaces; VRML's own lights have the same
// effect as without path tracing.
#include <cmath>

#include "image/vrml_scene.h"

using namespace xvrml::test;

namespace {

// Returns the mean of a picture with a narrow view along -z from (0 0 z).
double seen(const std::string& body, double z, int transport, int samples = 1024,
            double fovy = 1e-5) {
  SceneOptions options;
  options.samples = samples;
  Scene scene(dark + body, options);
  rtQuality(RT_TRANSPORT, transport);
  const Pixel p = scene.render(Scene::at(0, 0, z, fovy))[0];
  scene.expectNoMessages();
  EXPECT_NEAR(p.r, p.b, 0.02);
  return (p.r + p.g + p.b) / 3;
}

// Shapes at height 1 above the square that face it. Their backs are invisible from above.
std::string lamp(const std::string& shape) {
  return "Transform { translation 0 0 1 rotation 1 0 0 3.14159265 children " + shape + " }\n";
}
const std::string glow = material("diffuseColor 0 0 0 emissiveColor 1 1 1");

// Returns the form factor of a square with half an edge of h to a point 1 below its centre.
double factor(double h) {
  const double s = std::sqrt(1 + h * h);
  return 4 / M_PI * (h / s) * std::atan(h / s);
}

TEST(VrmlPaths, EmissiveShapesLightOthers) {
  for (const double half : {0.2, 2.0})
    EXPECT_NEAR(seen(square(material()) + lamp(square(glow, "", half)), 10, RT_TRANSPORT_PATH),
                0.8 * factor(half), 0.02 * factor(half))
        << half;
}

TEST(VrmlPaths, HoweverTheyAreGrouped) {
  const double expected = 0.8 * factor(0.5);
  const std::string shape = square(glow, "", 0.5), floor = square(material());
  const std::string grouped[] = {
      "ORTInstance { children " + shape + " }",
      "ORTStatic { children " + shape + " }",
      "DEF G Group { children " + shape +
          " } Transform { translation 1000 0 0 children USE G } Transform { translation -1000 0 0 "
          "children USE G }",
      "Transform { scale .25 .25 1 children " + square(glow, "", 2) + " }",
      "LOD { level [ " + shape + " ] }",
  };
  for (const std::string& group : grouped) {
    const std::string children =
        group.find(" Transform") == group.npos ? group : "[ " + group + " ]";
    EXPECT_NEAR(seen(floor + lamp(children), 10, RT_TRANSPORT_PATH), expected, 0.02 * expected)
        << group;
  }
}

TEST(VrmlPaths, AnAppearanceThatTwoShapesShareGlowsInBoth) {
  const std::string two = lamp("[ DEF L " + square("DEF A " + glow, "", 0.5) + " ]") +
                          "Transform { translation 0 0 1 rotation 1 0 0 3.14159265 children " +
                          square("USE A", "", 0.5) + " }";
  EXPECT_NEAR(seen(square(material()) + two, 10, RT_TRANSPORT_PATH), 0.8 * factor(0.5), 0.02)
      << "one behind the other";
}

TEST(VrmlPaths, AFurnaceIsEvenlyBright) { // emission .5, reflectance .5
  const std::string walls =
      "Shape { appearance " + material("diffuseColor .5 .5 .5 emissiveColor .5 .5 .5") +
      " geometry IndexedFaceSet { solid FALSE coord Coordinate { point [ -4 -4 4, 4 -4 4, 4 4 4, "
      "-4 4 4, -4 -4 -4, 4 -4 -4, 4 4 -4, -4 4 -4 ] } coordIndex [ 0 1 2 3 -1 5 4 7 6 -1 1 5 6 2 "
      "-1 4 0 3 7 -1 3 2 6 7 -1 4 5 1 0 -1 ] } }\n";
  const std::string ball = "Transform { translation .3 .2 -1 children Shape { appearance " +
                           material("diffuseColor .5 .5 .5 emissiveColor .5 .5 .5") +
                           " geometry Sphere { radius .8 } } }\n";
  EXPECT_NEAR(seen(walls + ball, 2, RT_TRANSPORT_PATH, 1024, 1.2), 1, 0.01);
}

TEST(VrmlPaths, LightsOfVrmlDoWhatTheyDoWithout) {
  for (const std::string light :
       {"PointLight { location 1 0 2 attenuation 0 0 .5 }", "DirectionalLight { direction 1 0 -1 }",
        "SpotLight { location 0 1 3 direction 0 -1 -3 beamWidth .3 cutOffAngle .6 }"}) {
    const std::string body = light + "\n" + square(material("diffuseColor .6 .6 .6"));
    EXPECT_NEAR(seen(body, 10, RT_TRANSPORT_PATH, 16), seen(body, 10, RT_TRANSPORT_DIRECT, 16),
                1e-4)
        << light;
  }
}

// The standard requires this.
TEST(VrmlPaths, WithoutBeingAskedForAWorldIsLitByItsLightsAlone) {
  EXPECT_EQ(seen(square(material()) + lamp(square(glow)), 10, RT_TRANSPORT_AUTO, 1), 0);
}

} // namespace

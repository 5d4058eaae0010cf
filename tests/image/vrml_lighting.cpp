// vrml_lighting.cpp: the closed forms of the VRML97 lighting model (ISO/IEC 14772-1 clause 4.14),
// from VRML text: V1 to V12. Deterministic, with a relative tolerance of 1e-5.
#include <cmath>
#include <sstream>

#include "image/vrml_scene.h"

using namespace xvrml::test;

namespace {

void expectGrey(const Pixel& p, double want) {
  const double tolerance = 1e-5 * std::max(std::abs(want), 0.1);
  EXPECT_NEAR(p.r, want, tolerance);
  EXPECT_NEAR(p.g, want, tolerance);
  EXPECT_NEAR(p.b, want, tolerance);
}

std::string number(double v) {
  std::ostringstream text;
  text.precision(9);
  text << v;
  return text.str();
}

// Returns a light whose direction has an angle to the square's normal.
std::string sun(double angle, const std::string& more = "") {
  return "DirectionalLight { direction " + number(std::sin(angle)) + " 0 " +
         number(-std::cos(angle)) + " " + more + " }\n";
}

std::string lamp(double distance, const std::string& more) {
  return "PointLight { location 0 0 " + number(distance) + " " + more + " }\n";
}

constexpr double degree = 0.017453292519943295;
const std::string plain = square(material());

TEST(VrmlLighting, V1Directional) {
  expectGrey(ahead(dark + sun(0) + plain), 0.8);
  expectGrey(ahead(dark + sun(60 * degree) + plain), 0.4);
  expectGrey(ahead(dark + sun(90.0001 * degree) + plain), 0);
  expectGrey(ahead(dark + sun(120 * degree) + plain), 0);
}

TEST(VrmlLighting, V2PointQuadraticAttenuation) {
  expectGrey(ahead(dark + lamp(2, "attenuation 0 0 1") + plain), 0.2);
  expectGrey(ahead(dark + lamp(0.5, "attenuation 0 0 1") + plain), 0.8);
  expectGrey(ahead(dark + lamp(2, "attenuation 0 0 0") + plain), 0.8);
}

TEST(VrmlLighting, V3PointFullAttenuation) {
  expectGrey(ahead(dark + lamp(3, "attenuation 1 1 1") + plain), 0.8 / 13);
}

TEST(VrmlLighting, V4Ambient) {
  expectGrey(ahead(dark + sun(0, "ambientIntensity 0.5") + plain), 0.88);
  expectGrey(ahead(dark + sun(90.0001 * degree, "ambientIntensity 0.5") + plain), 0.08);
}

TEST(VrmlLighting, V5Specular) {
  const auto shiny = [](const std::string& more) {
    return square(material("diffuseColor 0 0 0 specularColor 1 1 1 " + more));
  };
  expectGrey(ahead(dark + sun(20 * degree) + shiny("")), std::pow(std::cos(10 * degree), 25.6));
  expectGrey(ahead(dark + sun(20 * degree) + shiny("shininess 1")), 0.140925);
  expectGrey(ahead(dark + sun(10 * degree) + shiny("")), 0.907010);
}

TEST(VrmlLighting, V6Spot) {
  const auto spot = [](double angle, const std::string& more) {
    return dark + "SpotLight { location 0 0 2 direction " + number(std::sin(angle)) + " 0 " +
           number(-std::cos(angle)) + " " + more + " }\n" + plain;
  };
  expectGrey(ahead(spot(0.45, "beamWidth 0.3 cutOffAngle 0.6")), 0.4);
  expectGrey(ahead(spot(0.3, "beamWidth 0.3 cutOffAngle 0.6")), 0.8);
  expectGrey(ahead(spot(0.6, "beamWidth 0.3 cutOffAngle 0.6")), 0);
  expectGrey(ahead(spot(0.70, "")), 0.8);
  expectGrey(ahead(spot(0.80, "")), 0);
}

TEST(VrmlLighting, V7Fog) {
  const std::string lit = dark + sun(0) + plain;
  const std::string linear = "Fog { visibilityRange 10 }\n",
                    exponential = "Fog { visibilityRange 10 fogType \"EXPONENTIAL\" }\n";
  expectGrey(ahead(linear + lit, 4), 0.88);
  expectGrey(ahead(exponential + lit, 4), 0.897317);
  for (const std::string& fog : {linear, exponential})
    for (const double z : {10.0, 11.0}) expectGrey(ahead(fog + lit, z), 1);
  expectGrey(ahead(exponential + lit, 9.9), 1);
  expectGrey(ahead("Fog { visibilityRange 0 color 1 0 0 }\n" + lit, 4), 0.8);
  expectGrey(ahead("Transform { scale 2 2 2 children Fog { visibilityRange 5 } }\n" + lit, 4),
             0.88);
  const Pixel red = ahead("Fog { visibilityRange 10 color 1 0 0 }\n" + lit, 4);
  EXPECT_NEAR(red.r, 0.88, 1e-5);
  EXPECT_NEAR(red.g, 0.48, 1e-5);
}

TEST(VrmlLighting, V8DistancesAreLocal) {
  expectGrey(ahead(dark + "Transform { scale 2 2 2 children [ " + lamp(1, "attenuation 0 0 1") +
                   plain + " ] }"),
             0.8);
  expectGrey(ahead(dark + "Transform { scale 2 2 2 children [ " + lamp(2, "attenuation 0 0 1") +
                   plain + " ] }"),
             0.2);
}

TEST(VrmlLighting, V9Textures) {
  const auto textured = [](const std::string& image, const std::string& geometry = "") {
    return dark + sun(0) +
           square("Appearance { material Material { } texture PixelTexture { image " + image +
                      " } }",
                  geometry);
  };
  const std::string red = "color Color { color [ 1 0 0 ] } colorIndex [ 0 ] colorPerVertex FALSE";
  for (const Pixel& rgb :
       {ahead(textured("1 1 3 0x8040FF")), ahead(textured("1 1 3 0x8040FF", red))}) {
    EXPECT_NEAR(rgb.r, 128 / 255.0, 1e-5);
    EXPECT_NEAR(rgb.g, 64 / 255.0, 1e-5);
    EXPECT_NEAR(rgb.b, 1, 1e-5);
  }
  expectGrey(ahead(textured("1 1 1 0x80")), 0.8 * 128 / 255);
  const Pixel grey = ahead(textured("1 1 1 0x80", red));
  EXPECT_NEAR(grey.r, 128 / 255.0, 1e-5);
  EXPECT_NEAR(grey.g, 0, 1e-6);
}

TEST(VrmlLighting, V9AlphaReplacesTransparency) {
  const auto over = [](const std::string& image) {
    return dark + "Background { skyColor 1 1 1 }\n" + sun(0) +
           square(
               "Appearance { material Material { transparency 0.9 } texture PixelTexture { image " +
               image + " } }");
  };
  expectGrey(ahead(over("1 1 2 0xFF33")), 0.8 * 0.2 + 0.8);
  expectGrey(ahead(over("1 1 4 0xFFFFFF66")), 0.4 + 0.6);
  expectGrey(ahead(over("1 1 3 0x000000")), 0.9);
}

TEST(VrmlLighting, V10Transparency) {
  expectGrey(ahead(dark + "Background { skyColor 1 1 1 }\n" + sun(0) +
                   square(material("transparency 0.3"))),
             0.7 * 0.8 + 0.3);
  expectGrey(ahead(dark + "Transform { translation 0 0 -1 children " + square("Appearance { }") +
                   " }\n" + square(material("transparency 0.3 emissiveColor 0.5 0.5 0.5"))),
             0.7 * 0.5 + 0.3);
}

TEST(VrmlLighting, V11Radius) {
  expectGrey(ahead(dark + lamp(4.999, "radius 5") + plain), 0.8);
  expectGrey(ahead(dark + lamp(5.001, "radius 5") + plain), 0);
  expectGrey(
      ahead(dark + "Transform { scale 2 2 2 children " + lamp(4.999, "radius 5") + " }\n" + plain,
            20),
      0.8);
  expectGrey(
      ahead(dark + "Transform { scale 2 2 2 children " + lamp(5.001, "radius 5") + " }\n" + plain,
            20),
      0);
}

TEST(VrmlLighting, V12ManyLights) {
  std::string lights;
  for (int i = 0; i < 200; ++i) lights += sun(0, "intensity 0.01");
  expectGrey(ahead(dark + lights + plain), 1.6);
  lights.clear();
  double sum = 0;
  for (int i = 0; i < 9; ++i) {
    lights += lamp(2 + i, "attenuation 0 1 0");
    sum += 0.8 / (2 + i);
  }
  expectGrey(ahead(dark + lights + plain), sum);
}

TEST(VrmlLighting, UnlitWithoutMaterial) {
  expectGrey(ahead(dark + square("NULL")), 1);
  expectGrey(ahead(dark + square("Appearance { }")), 1);
  const Pixel color = ahead(
      dark + square("NULL",
                    "color Color { color [ 0.2 0.4 0.6 ] } colorIndex [ 0 ] colorPerVertex FALSE"));
  EXPECT_NEAR(color.g, 0.4, 1e-6);
  const Pixel texture =
      ahead(dark + square("Appearance { texture PixelTexture { image 1 1 3 0x336699 } }"));
  EXPECT_NEAR(texture.b, 0.6, 1e-6);
}

TEST(VrmlLighting, LinesAndPointsShowEmissiveColorAndNoLight) {
  // The camera is close, so a pixel is tiny and the line covers its centre.
  const auto thick = [](const std::string& appearance, const std::string& more) {
    return dark + sun(0) + "Shape { appearance " + appearance +
           " geometry IndexedLineSet { coord Coordinate { point [ -1 0 0, 1 0 0 ] } coordIndex [ 0 "
           "1 ] " +
           more + " } }";
  };
  SceneOptions options;
  const std::string emissive = material("emissiveColor 0.1 0.2 0.3 diffuseColor 1 1 1");
  EXPECT_NEAR(ahead(thick(emissive, ""), 10, options).g, 0.2, 1e-6);
  EXPECT_NEAR(ahead(thick("NULL", ""), 10, options).g, 1, 1e-6);
  EXPECT_NEAR(
      ahead(thick(emissive, "color Color { color [ 0.4 0.5 0.6, 0.4 0.5 0.6 ] }"), 10, options).g,
      0.5, 1e-6);
}

TEST(VrmlLighting, LinearColoursDecodeWhatTheAuthorSaw) {
  SceneOptions linear;
  linear.linearColor = true;
  const double decoded = std::pow((0.8 + 0.055) / 1.055, 2.4),
               half = std::pow((0.5 + 0.055) / 1.055, 2.4);
  expectGrey(ahead(dark + sun(0) + plain, 10, linear), decoded);
  expectGrey(ahead(dark + sun(0, "color 0.5 0.5 0.5") + plain, 10, linear), decoded * half);
  expectGrey(ahead(dark + square(material("emissiveColor 0.5 0.5 0.5")), 10, linear), half);
  expectGrey(ahead(dark + "Background { skyColor 0.5 0.5 0.5 }", 10, linear), half);
  expectGrey(
      ahead(
          dark +
              square("NULL",
                     "color Color { color [ 0.5 0.5 0.5 ] } colorIndex [ 0 ] colorPerVertex FALSE"),
          10, linear),
      half);
  expectGrey(ahead(dark + "Fog { visibilityRange 4 color 0.5 0.5 0.5 }" + plain, 5, linear), half);
  const double texel = std::pow((128 / 255.0 + 0.055) / 1.055, 2.4);
  expectGrey(ahead(dark + square("Appearance { texture PixelTexture { image 1 1 3 0x808080 } }"),
                   10, linear),
             texel);
}

// Table 4.6: a colour texture replaces diffuseColor, a grey one multiplies it. X3D's rule always
// multiplies; files of X3D follow it without being asked.
TEST(VrmlLighting, ColourTexturesReplaceOrMultiply) {
  std::string header = "#VRML V2.0 utf8";
  const auto look = [&](const char* image, const char* colors, bool multiplies) {
    SceneOptions options;
    options.header = header;
    options.multiplyTextures = multiplies;
    return ahead(dark + "DirectionalLight { }" +
                     square(std::string("Appearance { material Material { diffuseColor 0.5 0.25 1 "
                                        "} texture PixelTexture { image ") +
                                image + " } }",
                            colors),
                 10, options);
  };
  const auto expect = [](const Pixel& p, float r, float g, float b) {
    EXPECT_NEAR(p.r, r, 1e-4);
    EXPECT_NEAR(p.g, g, 1e-4);
    EXPECT_NEAR(p.b, b, 1e-4);
  };
  expect(look("1 1 3 0xFF6633", "", false), 1, 0.4f, 0.2f);
  expect(look("1 1 3 0xFF6633", "", true), 0.5f, 0.1f, 0.2f);
  expect(look("1 1 4 0xFF6633FF", "", true), 0.5f, 0.1f, 0.2f);
  for (const bool multiplies : {false, true})
    expect(look("1 1 1 0x66", "", multiplies), 0.2f, 0.1f, 0.4f);
  const char* own = "color Color { color [ 1 0.5 0 ] } colorPerVertex FALSE";
  expect(look("1 1 3 0xFF6633", own, false), 1, 0.4f, 0.2f);
  expect(look("1 1 3 0xFF6633", own, true), 1, 0.2f, 0);
  header = "#X3D V3.3 utf8";
  expect(look("1 1 3 0xFF6633", "", false), 0.5f, 0.1f, 0.2f);
}

} // namespace

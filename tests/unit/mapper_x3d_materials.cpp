// mapper_x3d_materials.cpp: Tests what X3D adds to materials and textures, by the pixel of one ray
// that meets a square: modes of MultiTexture, pictures of a Material, backs, texture properties,
// generated coordinates, and events that change them.
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "unit/mapper_fixture.h"

namespace xvrml::test {
namespace {

class MapX3dMaterials : public MapRunning {
 protected:
  void loadX3d(const std::string& body, bool linearColor = false) {
    mapper_.reset();
    engine_.reset();
    world_ = loadWorldFromMemory("#X3D V4.0 utf8\nPROFILE Full\n" + body, "test.x3dv");
    engine_ = std::make_unique<Engine>(world_->diagnostics, makeInteraction);
    engine_->adoptScope(world_->scope, true);
    MapOptions options;
    options.linearColor = linearColor; // false: numbers as written
    mapper_ = std::make_unique<OpenRTMapper>(*world_, options);
  }
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
  void expectSeen(float r, float g, float b, const std::string& what) {
    const std::array<float, 4> rgba = seen();
    const float expected[3] = {r, g, b};
    for (size_t c = 0; c < 3; c++) EXPECT_NEAR(rgba[c], expected[c], 2e-3f) << what << ", " << c;
  }
  size_t messages() { return world_->diagnostics.list().size(); }
  void silent() {
    for (const Diagnostic& d : world_->diagnostics.list()) ADD_FAILURE() << d.text();
  }
  static constexpr const char* dark = "NavigationInfo { headlight FALSE }\n";
  // A light along the view that makes a lit surface as bright as its diffuse colour.
  static constexpr const char* lamp =
      "NavigationInfo { headlight FALSE } DirectionalLight { direction 0 0 -1 }\n";
  // The view is a little beside the middle, so that no ray meets the edge of two triangles.
  static std::string square(const std::string& appearance, const std::string& more = "") {
    return "Viewpoint { position .3 .1 10 }\nShape { appearance DEF A Appearance { " + appearance +
           " } geometry DEF G IndexedFaceSet { coord Coordinate { point [ -9 -9 0, 9 -9 0, 9 9 0, "
           "-9 9 0 ] } coordIndex [ 0 1 2 3 -1 ] " +
           more + " } }\n";
  }
  // Coordinates by which one place of a picture is seen everywhere.
  static std::string seenAt(float s, float t) {
    const std::string place = std::to_string(s) + " " + std::to_string(t) + ", ";
    return "texCoord TextureCoordinate { point [ " + repeat(place, 4) + " ] }";
  }
  // A picture of one pixel.
  static std::string texel(const std::string& hex, int components = 3) {
    return "PixelTexture { image 1 1 " + std::to_string(components) + " 0x" + hex + " }";
  }
};

// A is (.8, .4, .2), B is (.6, .2, 0) with alpha .4 where it matters.
struct ModeCase {
  const char* mode;
  float r, g, b;
};

TEST_F(MapX3dMaterials, ModesFollowTheTable) {
  const ModeCase cases[] = {
      {"MODULATE", .48f, .08f, 0},
      {"REPLACE", .6f, .2f, 0},
      {"MODULATE2X", .96f, .16f, 0},
      {"MODULATE4X", 1, .32f, 0},
      {"ADD", 1, .6f, .2f},
      {"ADDSIGNED", .9f, .1f, 0},
      {"ADDSIGNED2X", 1, .2f, 0},
      {"SUBTRACT", 0, 0, 0},
      {"ADDSMOOTH", .92f, .52f, .2f},
      {"BLENDDIFFUSEALPHA", .6f, .2f, 0},
      {"BLENDFACTORALPHA", .75f, .35f, .15f},
      {"BLENDCURRENTALPHA", .6f, .2f, 0},
      {"SELECTARG1", .6f, .2f, 0},
      {"SELECTARG2", .8f, .4f, .2f},
      {"OFF", .8f, .4f, .2f},
      {"MODULATEALPHA_ADDCOLOR", 1, .6f, .2f},
      {"MODULATEINVALPHA_ADDCOLOR", .6f, .2f, 0},
      {"MODULATEINVCOLOR_ADDALPHA", 1, 1, 1},
      // 4 (.3 x .1 - .1 x -.3 ...): products of the halves' distances
      {"DOTPRODUCT3", .84f, .84f, .84f},
  };
  for (const ModeCase& c : cases) {
    loadX3d(dark +
            square("texture MultiTexture { alpha .25 mode [ \"REPLACE\", \"" + std::string(c.mode) +
                   "\" ] texture [ " + texel("CC6633") + ", " + texel("993300") + " ] }"));
    expectSeen(c.r, c.g, c.b, c.mode);
    silent();
  }
}

TEST_F(MapX3dMaterials, AlphaHasItsOwnModeSourceAndFunction) {
  const std::string begin = dark + std::string("Background { skyColor 0 0 0 }\n");
  // Alpha .4 of the picture replaces that of the surface.
  loadX3d(begin + square("texture MultiTexture { mode \"MODULATE,REPLACE\" texture " +
                         texel("FFFFFF66", 4) + " }"));
  expectSeen(.4f, .4f, .4f, "alpha of the picture");
  loadX3d(begin + square("texture MultiTexture { mode \"MODULATE / SELECTARG2\" texture " +
                         texel("FFFFFF66", 4) + " }"));
  expectSeen(1, 1, 1, "alpha as before");
  loadX3d(begin + square("texture MultiTexture { source \"FACTOR\" color 0 .5 1 texture " +
                         texel("CC6633") + " }"));
  expectSeen(0, .2f, .2f, "FACTOR");
  loadX3d(begin + square("texture MultiTexture { source \"FACTOR\" mode \"SELECTARG2\" function "
                         "\"ALPHAREPLICATE\" color 0 0 1 alpha .5 texture " +
                         texel("CC6633") + " }"));
  expectSeen(.25f, .25f, .25f, "ALPHAREPLICATE of FACTOR, half of it through");
  loadX3d(begin + square("texture MultiTexture { function \"COMPLEMENT\" texture " +
                         texel("CC6633") + " }"));
  expectSeen(.2f, .6f, .8f, "COMPLEMENT");
  loadX3d(begin + square("texture MultiTexture { mode \"BLENDTEXTUREALPHA,SELECTARG2\" texture " +
                         texel("CC663366", 4) + " }"));
  expectSeen(.92f, .76f, .68f, "BLENDTEXTUREALPHA");
  silent();
}

TEST_F(MapX3dMaterials, LayersChangeTheDiffuseColour) {
  loadX3d(lamp +
          square("material Material { diffuseColor .5 .5 1 } texture MultiTexture { texture [ " +
                 texel("CC6633") + ", " + texel("FF8000") + " ] }"));
  expectSeen(.4f, .2f * 128 / 255, 0, "product");
  loadX3d(lamp + square("material Material { diffuseColor .5 .5 1 } texture MultiTexture { mode "
                        "[ \"REPLACE\", \"MODULATE\" ] source [ \"\", \"DIFFUSE\" ] texture [ " +
                        texel("00FF00") + ", " + texel("CC6633") + " ] }"));
  expectSeen(.4f, .2f, .2f, "DIFFUSE");
  silent();
}

TEST_F(MapX3dMaterials, WrongMultiTexturesWarn) {
  loadX3d(
      dark +
      square("texture MultiTexture { mode [ \"FOO\", \"MODULATE,BAR\" ] source \"X\" texture [ " +
             texel("CC6633") + ", MultiTexture { }, NULL ] }"));
  expectSeen(.8f, .4f, .2f, "wrong names");
  EXPECT_GE(messages(), 3u);
  loadX3d(dark + square("texture MultiTexture { }"));
  expectSeen(1, 1, 1, "empty");
  loadX3d(dark +
          square("texture MultiTexture { alpha 1e38 color 1 1 1 texture [ " + texel("CC6633") +
                 " ] } textureTransform MultiTextureTransform { textureTransform [ "
                 "TextureTransform { scale 1e38 1e38 } TextureTransform { } NULL ] }"));
  seen();
}

TEST_F(MapX3dMaterials, EachPictureHasItsTransform) {
  const std::string two = "PixelTexture { image 2 1 3 0xFF0000 0x0000FF }";
  const std::string point =
      "texCoord TextureCoordinate { point [ .25 .5, .25 .5, .25 .5, .25 .5 ] }";
  loadX3d(dark + square("texture MultiTexture { mode [ \"REPLACE\", \"ADD\" ] texture [ " + two +
                            ", " + two +
                            " ] } textureTransform MultiTextureTransform { textureTransform [ "
                            "TextureTransform { }, TextureTransform { translation .5 0 } ] }",
                        point));
  expectSeen(1, 0, 1, "both halves");
  loadX3d(dark +
          square("texture MultiTexture { mode [ \"REPLACE\", \"ADD\" ] texture [ " + two + ", " +
                     two + " ] } textureTransform TextureTransform { translation .5 0 }",
                 point));
  expectSeen(1, 0, 1, "a TextureTransform moves the first picture");
  silent();
}

TEST_F(MapX3dMaterials, PicturesMultiplyTheTermsOfAMaterial) {
  loadX3d(lamp + square("material Material { diffuseColor .5 1 1 diffuseTexture " +
                        texel("CC6633") + " }"));
  expectSeen(.4f, .4f, .2f, "diffuseTexture");
  loadX3d(lamp + square("material Material { diffuseColor .5 1 1 diffuseTexture " +
                        texel("CC6633") + " } texture " + texel("000000")));
  expectSeen(.4f, .4f, .2f, "diffuseTexture before the appearance's texture");
  loadX3d(dark + square("material Material { emissiveColor .5 1 1 emissiveTexture " +
                        texel("CC6633") + " }"));
  expectSeen(.4f, .4f, .2f, "emissiveTexture");
  loadX3d(lamp + square("material Material { diffuseColor 0 0 0 specularColor 1 .5 1 shininess 1 "
                        "shininessTexture PixelTexture { image 1 1 2 0xFF00 } specularTexture " +
                        texel("CC6633") + " }"));
  expectSeen(.8f, .2f, .2f, "specularTexture; exponent 0");
  loadX3d("NavigationInfo { headlight FALSE } DirectionalLight { direction 0 0 -1 intensity 0 "
          "ambientIntensity 1 }" +
          square("material Material { diffuseColor 1 1 1 ambientIntensity .5 ambientTexture " +
                 texel("CC6633") + " }"));
  const auto rgba = seen();
  EXPECT_NEAR(rgba[1], rgba[0] / 2, 1e-3f) << "ambientTexture";
  silent();
}

TEST_F(MapX3dMaterials, NormalTextureBendsTheNormal) {
  // The normal (0, .6, .8): the cosine to a light along the view is .8.
  const std::string point = "texCoord TextureCoordinate { point [ 0 0, 1 0, 1 1, 0 1 ] }";
  loadX3d(lamp +
          square("material Material { diffuseColor 1 1 1 normalTexture " + texel("80CCE6") + " }",
                 point));
  const auto rgba = seen();
  EXPECT_NEAR(rgba[0], .8f, .01f);
  // Without x and y the normal is that of the face.
  loadX3d(lamp + square("material Material { diffuseColor 1 1 1 normalScale 0 normalTexture " +
                            texel("80CCE6") + " }",
                        point));
  expectSeen(1, 1, 1, "normalScale 0");
  silent();
}

TEST_F(MapX3dMaterials, AlphaModesOfAMaterial) {
  const std::string picture =
      "material Material { emissiveColor 1 1 1 diffuseColor 0 0 0 diffuseTexture " +
      texel("FFFFFF66", 4) + " }";
  loadX3d(dark + square(picture));
  expectSeen(.4f, .4f, .4f, "AUTO");
  loadX3d(dark + square(picture + " alphaMode \"OPAQUE\""));
  expectSeen(1, 1, 1, "OPAQUE");
  loadX3d(dark + square(picture + " alphaMode \"MASK\""));
  expectSeen(0, 0, 0, "MASK below the cutoff");
  loadX3d(dark + square(picture + " alphaMode \"MASK\" alphaCutoff .3"));
  expectSeen(1, 1, 1, "MASK above the cutoff");
  silent();
}

TEST_F(MapX3dMaterials, TheBackHasItsOwnMaterial) {
  const std::string materials = "material Material { emissiveColor 1 0 0 } backMaterial Material { "
                                "emissiveColor 0 .5 0 transparency .5 }";
  loadX3d(dark + square(materials, "solid FALSE"));
  expectSeen(1, 0, 0, "front");
  loadX3d(dark + square(materials, "solid FALSE ccw FALSE"));
  expectSeen(0, .25f, 0, "back");
  const std::string both =
      "material TwoSidedMaterial { emissiveColor 1 0 0 backEmissiveColor 0 .5 0 "
      "diffuseColor 0 0 0 separateBackColor ";
  loadX3d(dark + square(both + "TRUE }", "solid FALSE ccw FALSE"));
  expectSeen(0, .5f, 0, "separate back");
  loadX3d(dark + square(both + "FALSE }", "solid FALSE ccw FALSE"));
  expectSeen(1, 0, 0, "the same on both sides");
  silent();
  loadX3d(dark + square("material UnlitMaterial { } backMaterial Material { }", "solid FALSE"));
  expectSeen(1, 1, 1, "kinds of material differ");
  EXPECT_EQ(messages(), 1u);
}

TEST_F(MapX3dMaterials, TexturePropertiesChangeSampling) {
  const auto world = [](const std::string& properties, const std::string& s) {
    return dark +
           square("texture PixelTexture { image 2 1 3 0xFF0000 0x0000FF textureProperties DEF P "
                  "TextureProperties { " +
                      properties + " } }",
                  "texCoord TextureCoordinate { point [ " + s + " .5, " + s + " .5, " + s +
                      " .5, " + s + " .5 ] }");
  };
  loadX3d(world("magnificationFilter \"NEAREST_PIXEL\"", ".45"));
  expectSeen(1, 0, 0, "nearest");
  loadX3d(world("boundaryModeS \"CLAMP\"", "-.25"));
  expectSeen(1, 0, 0, "clamp");
  loadX3d(world("boundaryModeS \"REPEAT\"", "-.25"));
  expectSeen(0, 0, 1, "repeat");
  silent();
  send("P", "boundaryModeS", std::string("CLAMP_TO_EDGE"));
  expectSeen(1, 0, 0, "changed to clamp");
  loadX3d(world("boundaryModeS \"FOO\" magnificationFilter \"BAR\"", "-.25"));
  expectSeen(0, 0, 1, "wrong names");
  EXPECT_EQ(messages(), 2u);
}

// Returns a picture of a red and a blue pixel with these properties, seen at one place.
std::string redAndBlue(const std::string& properties, const std::string& picture) {
  return picture + " textureProperties DEF P TextureProperties { " + properties + " } }";
}
const std::string pixels = "texture PixelTexture { image 2 1 3 0xFF0000 0x0000FF",
                  file = "texture ImageTexture { url "
                         "\"data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAA"
                         "DUlEQVR4nGP4zwAE/wEHAAH/4iOeWQAAAABJRU5ErkJggg==\"";

TEST_F(MapX3dMaterials, PicturesAreMirrored) {
  for (const std::string& picture : {pixels, file})
    for (const auto& [s, red] : {std::pair(-.25f, true),
                                 {.25f, true},
                                 {.75f, false},
                                 {1.25f, false},
                                 {1.75f, true},
                                 {2.25f, true},
                                 {-1.75f, true},
                                 {-1.25f, false}}) {
      loadX3d(dark +
              square(redAndBlue("boundaryModeS \"MIRRORED_REPEAT\"", picture), seenAt(s, 0)));
      expectSeen(red ? 1 : 0, 0, red ? 0 : 1, std::to_string(s));
      silent();
    }
  const std::string column = "texture PixelTexture { image 1 2 3 0xFF0000 0x0000FF";
  loadX3d(dark + square(redAndBlue("boundaryModeT \"MIRRORED_REPEAT\"", column), seenAt(0, -.25f)));
  expectSeen(1, 0, 0, "t");
  silent();
}

TEST_F(MapX3dMaterials, ABorderHasItsColor) {
  const std::string border = "borderColor .25 .5 .75 .2 boundaryModeS \"CLAMP_TO_BOUNDARY\" ";
  for (const std::string& picture : {pixels, file}) {
    loadX3d(dark + square(redAndBlue(border, picture), seenAt(-.5f, 7)));
    expectSeen(.25f, .5f, .75f, "beyond the edge");
    loadX3d(dark + square(redAndBlue(border, picture), seenAt(0, 7)));
    expectSeen(.625f, .25f, .375f, "at the edge: half of both");
    loadX3d(dark + square(redAndBlue(border + "magnificationFilter \"NEAREST_PIXEL\"", picture),
                          seenAt(1.001f, 7)));
    expectSeen(.25f, .5f, .75f, "not filtered");
    // As all colours of a world: (.5 + .055) / 1.055 to the power of 2.4, and so on.
    loadX3d(dark + square(redAndBlue(border, picture), seenAt(-.5f, 7)), true);
    expectSeen(.0509f, .2140f, .5225f, "linear");
    silent();
  }
  loadX3d(dark +
          square(redAndBlue("boundaryModeT \"CLAMP_TO_BOUNDARY\"", pixels), seenAt(.25f, 2)));
  expectSeen(0, 0, 0, "the default");
  loadX3d(dark +
          square(redAndBlue("boundaryModeT \"CLAMP_TO_EDGE\" " + border, pixels), seenAt(.25f, 2)));
  expectSeen(1, 0, 0, "each axis has its mode");
  silent();
}

TEST_F(MapX3dMaterials, ABorderIsAsTransparentAsItSays) {
  const std::string sky = dark + std::string("Background { skyColor 0 1 0 }\n"),
                    border = "boundaryModeS \"CLAMP_TO_BOUNDARY\" borderColor 1 0 0 ";
  const auto with = [](const std::string& image) {
    return "texture PixelTexture { image " + image;
  };
  loadX3d(sky + square(redAndBlue(border + ".25", with("1 1 4 0xFFFFFFFF")), seenAt(3, 0)));
  expectSeen(.25f, .75f, 0, "four components");
  loadX3d(sky + square(redAndBlue(border + "0", with("1 1 2 0xFFFF")), seenAt(3, 0)));
  expectSeen(0, 1, 0, "grey and alpha");
  loadX3d(sky + square(redAndBlue(border + "0", with("1 1 3 0xFFFFFF")), seenAt(3, 0)));
  expectSeen(1, 0, 0, "pictures without alpha are opaque");
  silent();
}

TEST_F(MapX3dMaterials, EventsChangeABorder) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const std::string& picture : {pixels, file}) {
    loadX3d(dark +
            square(redAndBlue("boundaryModeS \"CLAMP_TO_BOUNDARY\"", picture), seenAt(-.25f, 0)));
    expectSeen(0, 0, 0, "the default");
    for (int i = 0; i < 20; ++i) {
      send("P", "borderColor", ColorRGBA{.25f, .5f, float(i) / 20, 1});
      const uint64_t loaded = cost().textures;
      EXPECT_EQ(loaded, picture == file ? 0u : 1u) << "files are not read again";
      expectSeen(.25f, .5f, float(i) / 20, "borderColor");
    }
    send("P", "borderColor", ColorRGBA{2, nan, -1, 0});
    expectSeen(1, 0, 0, "numbers that are none or out of range");
    send("P", "boundaryModeS", std::string("REPEAT"));
    expectSeen(0, 0, 1, "REPEAT");
    send("P", "boundaryModeS", std::string("MIRRORED_REPEAT"));
    expectSeen(1, 0, 0, "MIRRORED_REPEAT");
    send("P", "borderColor", ColorRGBA{0, 1, 0, 1});
    expectSeen(1, 0, 0, "a colour that is not shown");
    send("P", "boundaryModeS", std::string("CLAMP_TO_BOUNDARY"));
    expectSeen(0, 1, 0, "CLAMP_TO_BOUNDARY");
  }
}

TEST_F(MapX3dMaterials, OneFileHasABorderForEachNode) {
  const std::string border = "boundaryModeS \"CLAMP_TO_BOUNDARY\" borderColor 0 0 0 1";
  loadX3d(dark + square(redAndBlue(border, file), seenAt(-.5f, 0)) +
          "Transform { translation 99 0 0 children Shape { appearance Appearance { texture DEF U " +
          file.substr(file.find("ImageTexture")) + " textureProperties DEF Q TextureProperties { " +
          border + " } } } geometry Box { } } }");
  expectSeen(0, 0, 0, "as loaded");
  send("Q", "borderColor", ColorRGBA{1, 1, 1, 1});
  expectSeen(0, 0, 0, "that of the other node");
  send("P", "borderColor", ColorRGBA{1, 1, 1, 1});
  expectSeen(1, 1, 1, "both have it");
  send("Q", "borderColor", ColorRGBA{1, 0, 0, 1});
  send("P", "borderColor", ColorRGBA{0, 1, 0, 1});
  expectSeen(0, 1, 0, "each has its own");
  silent();
}

TEST_F(MapX3dMaterials, CoordinatesAreGenerated) {
  const std::string two = "texture PixelTexture { image 2 1 3 0xFF0000 0x0000FF textureProperties "
                          "TextureProperties { magnificationFilter \"NEAREST_PIXEL\" } }";
  // The ray meets the square at x = .3, which is in the first half of the picture.
  loadX3d(dark + square(two, "texCoord TextureCoordinateGenerator { mode \"COORD\" }"));
  expectSeen(1, 0, 0, "COORD");
  // The normal's x is 0, so s is .5.
  loadX3d(dark + square(two, "texCoord TextureCoordinateGenerator { mode \"SPHERE-LOCAL\" }"));
  expectSeen(0, 0, 1, "SPHERE-LOCAL");
  silent();
  loadX3d(dark +
          square(two, "texCoord TextureCoordinateGenerator { mode \"NOISE\" parameter [ 1e38 -1e38 "
                      "3 ] }"));
  seen();
  silent();
  // The camera looks along -z, so its frame has the axes of the world.
  loadX3d(dark + square(two, "texCoord TextureCoordinateGenerator { mode \"SPHERE\" }"));
  expectSeen(0, 0, 1, "SPHERE");
  silent();
  for (const char* mode : {"NOISE-EYE", "FOO"}) {
    loadX3d(dark + square(two, "texCoord TextureCoordinateGenerator { mode \"" + std::string(mode) +
                                   "\" }"));
    seen();
    EXPECT_EQ(messages(), 1u) << mode;
  }
}

TEST_F(MapX3dMaterials, UnfilledFacesAreNotDrawn) {
  loadX3d(dark +
          square("material Material { emissiveColor 1 1 1 } fillProperties DEF F FillProperties "
                 "{ filled FALSE hatched FALSE }"));
  expectSeen(0, 0, 0, "not filled");
  send("F", "filled", true);
  expectSeen(1, 1, 1, "filled again");
  silent();
}

TEST_F(MapX3dMaterials, LinesHaveAWidth) {
  const auto world = [](const std::string& properties) {
    return dark +
           std::string("Viewpoint { position 0 .4 10 } Shape { appearance Appearance { material "
                       "Material { emissiveColor 1 1 1 } lineProperties DEF L LineProperties { ") +
           properties +
           " } } geometry IndexedLineSet { coord Coordinate { point [ -9 0 0, 9 0 0 ] } coordIndex "
           "[ "
           "0 1 -1 ] } }";
  };
  const auto bright = [&](const std::string& properties) {
    loadX3d(world(properties));
    mapper_->update(engine_->takeChanges());
    mapper_->map(mapper_->viewpointCamera(0));
    rtFrameBuffer(100, 100, RT_RGBA);
    rtQuality(RT_SAMPLES_PER_PIXEL, 4);
    rtRender();
    std::vector<float> rgba(40000);
    rtReadPixels(RT_RGBA, rgba.data(), rgba.size());
    float sum = 0;
    for (size_t y = 0; y < 100; y++) sum += rgba[4 * (100 * y + 50)];
    return sum;
  };
  EXPECT_NEAR(bright(""), 1, .3f);
  EXPECT_NEAR(bright("linewidthScaleFactor 10"), 10, .6f);
  EXPECT_NEAR(bright("linewidthScaleFactor 10 applied FALSE"), 1, .3f);
  silent();
  EXPECT_NEAR(bright("linewidthScaleFactor -1e38 linetype 6"), 1, .3f);
  EXPECT_EQ(messages(), 1u);
}

TEST_F(MapX3dMaterials, EventsChangeLayersAndSides) {
  loadX3d(dark + square("texture DEF M MultiTexture { mode [ \"REPLACE\", \"ADD\" ] texture [ " +
                        texel("CC6633") + ", " + texel("330000") + " ] }"));
  expectSeen(1, .4f, .2f, "ADD");
  send("M", "mode", MFString{"REPLACE", "MODULATE"});
  expectSeen(.16f, 0, 0, "MODULATE");
  send("M", "mode", MFString{});
  expectSeen(.16f, 0, 0, "no modes");
  loadX3d(dark + square("material DEF M Material { emissiveColor 1 0 0 emissiveTexture " +
                        texel("CC6633") + " }"));
  expectSeen(.8f, 0, 0, "with a picture");
  send("M", "emissiveTexture", NodeRef());
  expectSeen(1, 0, 0, "without it");
  silent();
}

} // namespace
} // namespace xvrml::test

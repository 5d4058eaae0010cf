// mapper_volumes.cpp: Tests textures in space (ISO/IEC 19775-1 clause 33) by the pixel of one ray
// that meets a square: places in the volume, transforms, default coordinates, repetition,
// MultiTexture, events and damaged nodes.
#include <array>
#include <cmath>

#include "unit/mapper_fixture.h"

namespace xvrml::test {
namespace {

class MapVolumes : public MapRunning {
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
  void expectSeen(std::array<double, 3> expected, const std::string& what) {
    const std::array<float, 4> rgba = seen();
    for (size_t c = 0; c < 3; c++) EXPECT_NEAR(rgba[c], expected[c], 3e-3) << what << ", " << c;
  }
  void silent() {
    for (const Diagnostic& d : world_->diagnostics.list()) ADD_FAILURE() << d.text();
  }
  std::string said() {
    seen();
    std::string all;
    for (const Diagnostic& d : world_->diagnostics.list()) all += d.text() + "\n";
    return all;
  }
  void expectSaid(const std::string& part) {
    const std::string all = said();
    EXPECT_NE(all.find(part), all.npos) << all;
  }
  // A volume of 2 x 2 x 2 pixels whose red is s, whose green is t and whose blue is r, 0 or 1.
  static std::string cube(const std::string& more = "") {
    return "DEF T PixelTexture3D { image [ 3 2 2 2, 0x000000 0xFF0000, 0x00FF00 0xFFFF00, 0x0000FF "
           "0xFF00FF, 0x00FFFF 0xFFFFFF ] " +
           more + " }";
  }
  static std::string square(const std::string& appearance, const std::string& texCoord) {
    return "Viewpoint { position .3 .1 10 fieldOfView .01 }\nShape { appearance DEF A Appearance "
           "{ " +
           appearance +
           " } geometry DEF G IndexedFaceSet { coord Coordinate { point [ -9 -9 0, 9 -9 0, 9 9 0, "
           "-9 9 0 ] } coordIndex [ 0 1 2 3 -1 ] " +
           texCoord + " } }\n";
  }
  static std::string at(const std::string& place, const std::string& type = "3D") {
    return "texCoord DEF C TextureCoordinate" + type + " { point [ " + repeat(place + ", ", 4) +
           " ] }";
  }
  // The colour at a place of the cube without repetition: a ramp between the centres of texels.
  static double ramp(double x) { return std::clamp(2 * x - .5, 0.0, 1.0); }
};

TEST_F(MapVolumes, PlacesOfTheVolume) {
  for (const auto& [s, t, r] : {std::array{.25, .25, .25},
                                {.75, .25, .25},
                                {.25, .75, .25},
                                {.25, .25, .75},
                                {.5, .4, .6},
                                {.1, .9, 2.0},
                                {-3.0, .3, .7}}) {
    loadX3d(square("texture " + cube(),
                   at(std::to_string(s) + " " + std::to_string(t) + " " + std::to_string(r))));
    expectSeen({ramp(s), ramp(t), ramp(r)}, std::to_string(s) + " " + std::to_string(r));
    silent();
  }
}

// (1, 3, 1, 4) is the place (1/4, 3/4, 1/4). With q of 1 and 3 at two ends, half of the way is s =
// (0 + 3) / (1 + 3).
TEST_F(MapVolumes, HomogeneousCoordinates) {
  loadX3d(square("texture " + cube(), at("1 3 1 4", "4D")));
  expectSeen({0, 1, 0}, "divided by q");
  loadX3d(
      "Viewpoint { position 0 .1 10 fieldOfView .01 }\nShape { appearance Appearance { texture " +
      cube() +
      " } geometry IndexedFaceSet { coord Coordinate { point [ -9 -9 0, 9 -9 0, 9 9 0, -9 9 0 ] "
      "} coordIndex [ 0 1 2 3 -1 ] texCoord TextureCoordinate4D { point [ 0 0 0 1, 1.8 0 0 3, "
      "1.8 0 0 3, 0 0 0 1 ] } } }");
  expectSeen({ramp(.45), 0, 0}, "divided at the hit");
  loadX3d(square("texture " + cube(), at("1 1 1 0", "4D")));
  seen(); // the place is at infinity
  silent();
}

TEST_F(MapVolumes, CoordinatesOfOtherKinds) {
  loadX3d(square("texture " + cube(),
                 "texCoord TextureCoordinate { point [ " + repeat(".75 .25, ", 4) + " ] }"));
  expectSeen({1, 0, 0}, "two numbers: r is 0");
  loadX3d(square("texture PixelTexture { image 2 1 3 0xFF0000 0x0000FF }", at(".75 .5 9")));
  expectSeen({0, 0, 1}, "a picture ignores r");
  loadX3d(square("texture PixelTexture { image 2 1 3 0xFF0000 0x0000FF }", at("3 2 9 4", "4D")));
  expectSeen({0, 0, 1}, "a picture divides by q");
  loadX3d(square("texture " + cube() +
                     " textureTransform TextureTransform3D { scale .1 .1 .1 "
                     "translation 3 2 .5 }",
                 "texCoord TextureCoordinateGenerator { mode \"COORD\" }"));
  // The ray meets the square at about (.3, .1, 0).
  expectSeen({ramp(.33), ramp(.21), ramp(.05)}, "COORD");
  silent();
}

// The bounding box is the volume, with r from the front to the back.
TEST_F(MapVolumes, DefaultCoordinatesAreTheBoundingBox) {
  const std::string look = "Shape { appearance Appearance { texture " + cube() + " } geometry ";
  const std::string view = "Viewpoint { position .3 .1 10 fieldOfView .01 }\n";
  loadX3d(view + look + "Box { } }");
  expectSeen({ramp(.65), ramp(.55), 0}, "the front of a box");
  loadX3d("Viewpoint { position .3 .1 -10 orientation 0 1 0 3.1415926 fieldOfView .01 }\n" + look +
          "Box { } }");
  expectSeen({ramp(.65), ramp(.55), 1}, "its back");
  loadX3d(view + look + "Sphere { } }");
  expectSeen({ramp(.65), ramp(.55), ramp((1 - std::sqrt(1 - .1)) / 2)}, "a sphere");
  loadX3d(view + look + "Cylinder { } }");
  expectSeen({ramp(.65), ramp(.55), ramp((1 - std::sqrt(1 - .09)) / 2)}, "a cylinder");
  loadX3d(square("texture " + cube(), ""));
  expectSeen({ramp(9.3 / 18), ramp(9.1 / 18), 0}, "a flat IndexedFaceSet");
  silent();
}

TEST_F(MapVolumes, Transforms) {
  const std::string place = at(".25 .25 .75");
  const auto with = [&](const std::string& transform) {
    loadX3d(square("texture " + cube() + " textureTransform DEF M " + transform, place));
  };
  with("TextureTransform3D { translation .5 0 0 }");
  expectSeen({1, 0, 1}, "translation");
  with("TextureTransform3D { scale 3 1 1 }");
  expectSeen({1, 0, 1}, "scale");
  with("TextureTransform3D { center -.5 -.5 -.5 rotation 0 0 1 1.5707963 }");
  expectSeen({1, 0, 1}, "rotation about r: (-.25, -.25) becomes (.25, -.25)");
  with("TextureTransform3D { center -.5 -.5 -.5 scale 1 1 -1 }");
  expectSeen({0, 0, 0}, "scale about the center");
  with("TextureTransformMatrix3D { matrix 1 0 0 0 0 1 0 0 0 0 1 0 .5 .5 -.5 1 }");
  expectSeen({1, 1, 0}, "the last row moves");
  with("TextureTransformMatrix3D { matrix 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 3 }");
  expectSeen({0, 0, 0}, "the last column divides");
  with("MultiTextureTransform { textureTransform [ TextureTransform3D { translation 0 .5 0 } ] }");
  expectSeen({0, 1, 1}, "of a MultiTextureTransform");
  with("TextureTransform { translation .5 .5 }");
  expectSeen({1, 1, 1}, "of two numbers");
  silent();
}

TEST_F(MapVolumes, RepetitionAndProperties) {
  loadX3d(square("texture " + cube("repeatR TRUE"), at(".25 7.25 7.25")));
  expectSeen({0, 1, 0}, "r repeats, t goes on");
  loadX3d(square("texture " + cube("textureProperties TextureProperties { boundaryModeS "
                                   "\"CLAMP_TO_EDGE\" boundaryModeR \"MIRRORED_REPEAT\" "
                                   "magnificationFilter \"NEAREST_PIXEL\" }"),
                 at("9 .6 1.1")));
  expectSeen({1, 1, 1}, "properties");
  loadX3d(square("texture " + cube("textureProperties TextureProperties { boundaryModeR "
                                   "\"CLAMP_TO_BOUNDARY\" borderColor .2 .4 .6 1 }"),
                 at(".25 .25 5")));
  expectSeen({.2, .4, .6}, "border");
  silent();
}

TEST_F(MapVolumes, MaterialsAndLayers) {
  const std::string place = at(".75 .25 .75");
  loadX3d("DirectionalLight { direction 0 0 -1 }\n" +
          square("material Material { diffuseColor .5 1 .5 } texture " + cube(), place));
  expectSeen({.5, 0, .5}, "it multiplies the colour of X3D's Material");
  loadX3d(
      "DirectionalLight { direction 0 0 -1 }\n" +
      square("material Material { diffuseColor .5 1 .5 diffuseTexture " + cube() + " }", place));
  expectSeen({.5, 0, .5}, "diffuseTexture");
  loadX3d(square("texture MultiTexture { mode [ \"REPLACE\", \"MODULATE\" ] texture [ " + cube() +
                     ", PixelTexture { image 1 1 3 0x804020 } ] }",
                 place));
  expectSeen({128. / 255, 0, 32. / 255}, "beside a picture");
  loadX3d(square("texture MultiTexture { mode [ \"REPLACE\", \"ADD\" ] texture [ " + cube() +
                     ", USE T ] } textureTransform MultiTextureTransform { textureTransform [ "
                     "TextureTransform3D { }, TextureTransform3D { translation 0 .5 0 } ] }",
                 place));
  expectSeen({1, 1, 1}, "each layer has its transform");
  silent();
  loadX3d(square("material Material { emissiveTexture " + cube() + " }", place));
  expectSaid("a volume is drawn as the texture of an Appearance");
}

// A PhysicalMaterial looks as with a picture of the same colour, magenta here.
TEST_F(MapVolumes, PhysicalAndUnlitMaterials) {
  const std::string place = at(".75 .25 .75"), light = "DirectionalLight { direction 0 0 -1 }\n",
                    magenta = "PixelTexture { image 1 1 3 0xFF00FF }";
  for (const char* field : {"} texture ", "baseTexture "}) {
    const auto look = [&](const std::string& texture) {
      const bool own = field[0] == 'b';
      loadX3d(light +
              square("material PhysicalMaterial { baseColor .8 .6 .4 metallic 0 roughness .7 " +
                         std::string(field) + texture + (own ? " }" : ""),
                     place));
      return seen();
    };
    const std::array<float, 4> expected = look(magenta);
    EXPECT_GT(expected[0], expected[1] + .1f) << field;
    const std::array<float, 4> rgba = look(cube());
    for (size_t c = 0; c < 3; c++) EXPECT_NEAR(rgba[c], expected[c], 1e-3) << field << c;
    silent();
  }
  loadX3d(square("material UnlitMaterial { emissiveTexture " + cube() + " }", place));
  expectSeen({1, 0, 1}, "an UnlitMaterial");
  loadX3d(square("material UnlitMaterial { emissiveColor .5 1 .5 } texture " + cube() +
                     " textureTransform DEF M TextureTransform3D { }",
                 at("1.5 .5 1.5 2", "4D")));
  expectSeen({.5, 0, .5}, "four numbers");
  send("M", "set_translation", SFVec3f{0, .5f, 0});
  expectSeen({.5, 1, .5}, "another transform");
  silent();
  loadX3d(square("material PhysicalMaterial { normalTexture " + cube() + " }", place));
  expectSaid("a volume is drawn as the texture of an Appearance");
  loadX3d(
      square("material UnlitMaterial { } texture MultiTexture { texture " + cube() + " }", place));
  expectSaid("a volume is drawn as the texture of an Appearance");
}

TEST_F(MapVolumes, Composed) {
  const std::string red = "PixelTexture { image 1 1 3 0xFF0000 }",
                    grey = "PixelTexture { image 1 1 1 0x80 }";
  loadX3d(
      square("texture ComposedTexture3D { texture [ " + red + ", " + grey + " ] }", at("0 0 .25")));
  expectSeen({1, 0, 0}, "first slice");
  loadX3d(
      square("texture ComposedTexture3D { texture [ " + red + ", " + grey + " ] }", at("0 0 .5")));
  expectSeen({(1 + 128. / 255) / 2, 64. / 255, 64. / 255}, "between");
  silent();
  loadX3d(square("texture ComposedTexture3D { texture [ " + red +
                     ", PixelTexture { image 2 1 1 1 2 } ] }",
                 at("0 0 0")));
  expectSaid("texture 1 has 2 x 1 pixels, expected 1 x 1");
  loadX3d(
      square("texture ComposedTexture3D { texture [ " + red + ", " + cube() + " ] }", at("0 0 0")));
  expectSaid("texture 1: PixelTexture3D has no picture of its own");
  loadX3d(square("texture ComposedTexture3D { }", at("0 0 0")));
  expectSeen({1, 1, 1}, "without slices there is no texture");
}

TEST_F(MapVolumes, DamagedVolumesAreLeftOut) {
  for (const char* image : {"1 2 2 2 0 0 0", "5 1 1 1 0", "-1 1 1 1 0", "1 65537 1 1 0",
                            "1 1 1 2147483647 0", "3 2147483647 2147483647 2147483647"}) {
    loadX3d(square("texture PixelTexture3D { image [ " + std::string(image) + " ] }", at("0 0 0")));
    expectSeen({1, 1, 1}, image);
    expectSaid("PixelTexture3D: no picture: image");
  }
  for (const char* image : {"", "1 2", "0 0 0 0", "1 0 1 1"}) {
    loadX3d(square("texture PixelTexture3D { image [ " + std::string(image) + " ] }", at("0 0 0")));
    expectSeen({1, 1, 1}, image);
    silent();
  }
  loadX3d(square("texture ImageTexture3D { url \"nowhere.nrrd\" }", at("0 0 0")));
  expectSaid("ImageTexture3D: no picture: ");
  loadX3d(square("texture " + cube(), at("1e38 -1e38 1e38")));
  seen();
  loadX3d(square("texture " + cube() +
                     " textureTransform TextureTransform3D { scale 1e38 1e38 1e38 "
                     "translation 1e38 0 0 }",
                 at("1 1 1")));
  seen();
}

TEST_F(MapVolumes, EventsChangePixelsPlacesAndTransforms) {
  loadX3d(square("texture " + cube() + " textureTransform DEF M TextureTransform3D { }",
                 at(".25 .25 .25")));
  expectSeen({0, 0, 0}, "at first");
  send("M", "set_translation", SFVec3f{.5f, 0, 0});
  expectSeen({1, 0, 0}, "another transform");
  send("T", "set_image", MFInt32{3, 2, 1, 1, 0, 0x4080c0});
  expectSeen({64. / 255, 128. / 255, 192. / 255}, "other pixels");
  send("C", "set_point", MFVec3f(4, Vec3f{-.25f, 0, 0}));
  expectSeen({0, 0, 0}, "other coordinates");
  send("T", "set_image", MFInt32{});
  expectSeen({1, 1, 1}, "no pixels");
  silent();
}

TEST_F(MapVolumes, EventsChangeWhatIsBeyondTheLastSlice) {
  loadX3d(square("texture " + cube("textureProperties DEF P TextureProperties { boundaryModeR "
                                   "\"CLAMP_TO_EDGE\" }"),
                 at(".25 .25 1.25")));
  expectSeen({0, 0, 1}, "the last slice");
  send("P", "set_boundaryModeR", std::string("REPEAT"));
  expectSeen({0, 0, 0}, "the first slice again");
  silent();
}

TEST_F(MapVolumes, EventsPutAVolumeInPlaceOfAPicture) {
  loadX3d(
      "Switch { children Shape { appearance Appearance { texture " + cube() +
      " } } }\nViewpoint { position .3 .1 10 fieldOfView .01 }\nShape { appearance DEF A "
      "Appearance { texture DEF F PixelTexture { image 1 1 3 0x8040FF } } geometry Box { } }\n");
  expectSeen({128. / 255, 64. / 255, 1}, "a picture");
  send("A", "set_texture", SFNode(&node("T")));
  expectSeen({ramp(.65), ramp(.55), 0}, "a volume");
  send("A", "set_texture", SFNode(&node("F")));
  expectSeen({128. / 255, 64. / 255, 1}, "the picture again");
  silent();
}

TEST_F(MapVolumes, EventsChangeASlice) {
  loadX3d(
      square("texture ComposedTexture3D { texture [ DEF S PixelTexture { image 1 1 3 0xFF0000 } ] "
             "}",
             at("0 0 0")));
  expectSeen({1, 0, 0}, "at first");
  send("S", "set_image", SFImage{1, 1, 3, {0, 255, 0}});
  expectSeen({0, 1, 0}, "the slice is another");
  silent();
}

// Many shapes share a mesh, which is an object of its own then; the shader of each instance has the
// coordinates.
TEST_F(MapVolumes, InstancesOfOneMesh) {
  const auto load = [&](int count, const std::string& first, const std::string& others) {
    std::string shapes = "Viewpoint { position .3 .1 60 fieldOfView .002 }\n";
    for (int i = 0; i < count; i++)
      shapes += "Transform { translation 0 0 " + std::to_string(-i) +
                " children Shape { appearance "
                "Appearance { " +
                (i == 0 ? first + " texture " + cube() : others + " texture USE T") +
                " textureTransform TextureTransform3D { translation " + std::to_string(i) +
                " 0 0 } } geometry " + (i == 0 ? "DEF B Sphere { radius 2 }" : "USE B") + " } }\n";
    loadX3d(shapes);
  };
  const double front = (2 - std::sqrt(4 - .1)) / 4;
  const std::string unlit = "material UnlitMaterial { }";
  load(40, "", "");
  expectSeen({ramp(2.3 / 4), ramp(2.1 / 4), ramp(front)}, "the first of 40");
  load(3, unlit, unlit); // each triangle is an emitter
  expectSeen({ramp(2.3 / 4), ramp(2.1 / 4), ramp(front)}, "the first of three");
  silent();
  load(3, unlit, "");
  expectSeen({ramp(2.3 / 4), ramp(2.1 / 4), ramp(front)}, "materials of both kinds");
  expectSaid("here only the first slice is seen");
}

// A plane that cuts a shape keeps the coordinates of what is left.
TEST_F(MapVolumes, ClipPlanesKeepPlaces) {
  loadX3d(
      "Viewpoint { position .3 .1 10 fieldOfView .01 }\nGroup { children [ ClipPlane { plane 0 0 "
      "-1 .5 } Shape { appearance Appearance { texture " +
      cube() + " } geometry Box { solid FALSE } } ] }\n");
  expectSeen({ramp(.65), ramp(.55), 1}, "the inside of the back of a box without its front");
  silent();
}

} // namespace
} // namespace xvrml::test

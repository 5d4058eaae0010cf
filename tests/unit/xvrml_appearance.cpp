// xvrml_appearance.cpp: appearances resolved for renderers: parts, values of materials, layers of
// textures, parameters of shaders, and pictures.
#include <gtest/gtest.h>

#include "xvrml/appearance.h"
#include "xvrml/browser.h"

namespace {

using namespace xvrml;

std::unique_ptr<World> worldOf(const std::string& text, const std::string& name = "test",
                               const char* head = "#VRML V2.0 utf8\n") {
  auto world = loadWorldFromMemory(head + text, name);
  for (const Diagnostic& d : world->diagnostics.list())
    if (d.severity == Severity::error) ADD_FAILURE() << d.text();
  return world;
}

AppearanceParts partsOf(const World& world) {
  return resolveAppearance(nodeCast<nodes::Shape>(world.scope.roots.back())->appearance.get());
}

TEST(Appearance, HasItsPartsAlsoThroughPrototypes) {
  const auto world =
      worldOf("PROTO Red [ ] { Material { diffuseColor 1 0 0 } } "
              "PROTO Look [ ] { Appearance { material Red { } texture PixelTexture { } "
              "textureTransform TextureTransform { scale 2 2 } } } Shape { appearance Look { } }");
  const AppearanceParts parts = partsOf(*world);
  EXPECT_EQ(parts.appearance, parts.plain);
  ASSERT_TRUE(nodeCast<nodes::Material>(parts.material));
  EXPECT_EQ(materialValues(parts.material).color, (Color{1, 0, 0}));
  EXPECT_TRUE(nodeCast<nodes::PixelTexture>(parts.texture));
  EXPECT_TRUE(nodeCast<nodes::TextureTransform>(parts.textureTransform));
  EXPECT_FALSE(parts.shader || parts.backMaterial);
  EXPECT_FALSE(parts.texturesMultiply());
}

TEST(Appearance, OfNothingIsEmpty) {
  const AppearanceParts parts = resolveAppearance(nullptr);
  EXPECT_FALSE(parts.appearance || parts.material || parts.texture || parts.texturesMultiply());
  const MaterialValues values = materialValues(parts.material);
  EXPECT_EQ(values.model, MaterialValues::Model::none);
  EXPECT_EQ(values.lineColor, (Color{1, 1, 1}));
  EXPECT_TRUE(textureLayers(parts).empty());
  EXPECT_FALSE(backValues(parts));
}

TEST(Appearance, MaterialsOfX3dHaveTheSameNames) {
  const auto world = worldOf(
      "Shape { appearance Appearance { material PhysicalMaterial { baseColor 0 1 0 metallic .25 "
      "baseTexture DEF Own PixelTexture { } } texture PixelTexture { } } }",
      "test", "#X3D V4.0 utf8\nPROFILE Full\n");
  const AppearanceParts parts = partsOf(*world);
  EXPECT_TRUE(parts.texturesMultiply());
  const MaterialValues values = materialValues(parts.material);
  EXPECT_EQ(values.model, MaterialValues::Model::physical);
  EXPECT_EQ(values.color, (Color{0, 1, 0}));
  EXPECT_EQ(values.metallic, .25f);
  EXPECT_EQ(values.colorTexture, world->scope.names.at("Own").get());
  EXPECT_EQ(colorTexture(parts), values.colorTexture);
  const auto unlit =
      worldOf("Shape { appearance Appearance { material UnlitMaterial { emissiveColor 1 0 1 } } }");
  const MaterialValues flat = materialValues(partsOf(*unlit).material);
  EXPECT_EQ(flat.model, MaterialValues::Model::unlit);
  EXPECT_EQ(flat.color, (Color{1, 0, 1}));
  EXPECT_EQ(flat.lineColor, (Color{1, 0, 1}));
  EXPECT_EQ(flat.emissiveColor, (Color{0, 0, 0}));
}

TEST(Appearance, BacksDifferIfTheFileSaysSo) {
  const auto values = [](const std::string& appearance) {
    const auto world = worldOf("Shape { appearance Appearance { " + appearance + " } }");
    return backValues(partsOf(*world));
  };
  EXPECT_FALSE(values("material Material { }"));
  EXPECT_FALSE(values("material TwoSidedMaterial { backDiffuseColor 0 0 1 }"));
  EXPECT_FALSE(values("material UnlitMaterial { } backMaterial Material { }"));
  const Color blue{0, 0, 1};
  EXPECT_EQ(
      values("material TwoSidedMaterial { separateBackColor TRUE backDiffuseColor 0 0 1 }")->color,
      blue);
  EXPECT_EQ(values("material Material { } backMaterial Material { diffuseColor 0 0 1 }")->color,
            blue);
}

TEST(Appearance, LayersHaveTheirTransforms) {
  const auto world =
      worldOf("Shape { appearance Appearance { material Material { diffuseTexture MultiTexture { "
              "mode [ \"ADD\" ] texture [ PixelTexture { } PixelTexture { } PixelTexture { } ] } } "
              "textureTransform MultiTextureTransform { textureTransform [ TextureTransform { "
              "translation 1 0 } TextureTransform { translation 2 0 } ] } } }");
  const std::vector<TextureLayer> layers = textureLayers(partsOf(*world));
  ASSERT_EQ(layers.size(), 3u);
  EXPECT_EQ(layers[0].mode, "ADD");
  EXPECT_EQ(layers[1].mode, "");
  EXPECT_EQ(layers[0].transform[12], 1);
  EXPECT_EQ(layers[1].transform[12], 2);
  EXPECT_EQ(layers[2].transform[12], 0);
}

TEST(Appearance, ShadersHaveOptionsAndFields) {
  const auto world =
      worldOf("Shape { appearance ORTAppearance { shader ORTShader { name \"Metal\" file \"metal\" "
              "options [ \"1f roughness .5 color tint 1 0 0\" \"1f\" ] field SFFloat roughness .25 "
              "field MFString pictures [ \"a.png\" \"b.png\" ] field SFNode none NULL } } }");
  const AppearanceParts parts = partsOf(*world);
  ASSERT_TRUE(parts.shader);
  EXPECT_EQ(parts.plain, nullptr);
  EXPECT_EQ(parts.shader->name, "Metal");
  const std::vector<ShaderOption> options = shaderOptions(*parts.shader);
  ASSERT_EQ(options.size(), 3u);
  EXPECT_EQ(options[0].name, "tint");
  EXPECT_EQ(options[1].name, "roughness");
  EXPECT_EQ(options[1].numbers, std::vector<float>{.25f});
  EXPECT_EQ(options[2].type, ShaderOption::Type::file);
  EXPECT_EQ(options[2].text, "a.png");
  EXPECT_EQ(options[2].otherUrls, MFString{"b.png"});
}

// A GIF of one red pixel.
constexpr const char* gif =
    "data:image/gif;base64,R0lGODdhAQABAIAAAP8AAAAAACwAAAAAAQABAAACAkQBADs=";

const Node& textureIn(const World& world) { return *partsOf(world).texture; }

TEST(TexturePicture, IsDecodedAndHasTheBytesOfItsFile) {
  const auto world = worldOf(std::string("Shape { appearance Appearance { texture ImageTexture { "
                                         "url [ \"missing.png\" \"") +
                             gif + "\" ] } } }");
  const TexturePicture picture = texturePicture(textureIn(*world), *world);
  EXPECT_EQ(picture.error, "");
  EXPECT_EQ(picture.type, "image/gif");
  EXPECT_EQ(picture.path, gif);
  EXPECT_EQ(picture.file.size(), 35u);
  EXPECT_EQ(picture.image.width, 1);
  EXPECT_EQ(picture.image.pixels.at(0), 255);
  const TexturePicture bytes = texturePicture(textureIn(*world), *world, Decode::no);
  EXPECT_EQ(bytes.file, picture.file);
  EXPECT_EQ(bytes.image.components, 0);
}

TEST(TexturePicture, OfPixelsIsThese) {
  const auto world = worldOf("Shape { appearance Appearance { texture PixelTexture { "
                             "image 2 1 1 0x10 0x20 } } }");
  const TexturePicture picture = texturePicture(textureIn(*world), *world);
  EXPECT_EQ(picture.image.pixels, (std::vector<uint8_t>{0x10, 0x20}));
  EXPECT_TRUE(picture.file.empty() && picture.type.empty());
}

TEST(TexturePicture, SaysWhyThereIsNone) {
  const auto missing =
      worldOf("Shape { appearance Appearance { texture ImageTexture { url \"missing.png\" } } }");
  EXPECT_NE(texturePicture(textureIn(*missing), *missing).error.find("missing.png"),
            std::string::npos);
  const auto film =
      worldOf("Shape { appearance Appearance { texture MovieTexture { url \"x.gif\" } } }");
  EXPECT_NE(texturePicture(textureIn(*film), *film).error, "");
  const auto text = worldOf("Shape { appearance Appearance { texture ImageTexture { url "
                            "\"data:text/plain,hello\" } } }");
  for (const Decode decode : {Decode::yes, Decode::no})
    EXPECT_NE(texturePicture(textureIn(*text), *text, decode).error.find("not a PNG"),
              std::string::npos);
  const auto none = worldOf("Shape { appearance Appearance { texture ImageTexture { } } }");
  EXPECT_EQ(texturePicture(textureIn(*none), *none).error, "");
}

TEST(TexturePicture, BeginsWithTheUrlThatIsWanted) {
  const auto world =
      worldOf(std::string("Shape { appearance Appearance { texture ImageTexture { url [ "
                          "\"missing.png\" \"") +
              gif + "\" \"other.png\" ] } } }");
  const TexturePicture first = texturePicture(textureIn(*world), *world, Decode::no);
  EXPECT_EQ(first.url, 1u);
  EXPECT_EQ(first.error, "");
  const TexturePicture behind = texturePicture(textureIn(*world), *world, Decode::no, 2);
  EXPECT_TRUE(behind.file.empty());
  EXPECT_NE(behind.error.find("other.png"), std::string::npos) << behind.error;
  EXPECT_EQ(texturePicture(textureIn(*world), *world, Decode::no, 3).error, "");
}

TEST(TexturePicture, ObeysTheLimitsOfTheWorld) {
  auto world =
      worldOf(std::string("Shape { appearance Appearance { texture ImageTexture { url \"") + gif +
              "\" } } }");
  world->options.limits.imagePixels = 0;
  EXPECT_NE(texturePicture(textureIn(*world), *world).error.find("imagePixels"), std::string::npos);
}

} // namespace

// appearance.h: the appearance of a Shape with its references resolved: prototype instances are
// followed, and what VRML97 and X3D 4 say in different nodes is in one place. The pointers belong
// to the world's nodes and are valid until a node changes. [the thread that owns the world]
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "xvrml/nodes.h"
#include "xvrml/radiance.h"
#include "xvrml/world.h"

namespace xvrml {

// The nodes of an Appearance or ORTAppearance, as renderedNode() returns them. All are null for a
// Shape without an appearance.
struct AppearanceParts {
  Node* appearance = nullptr;               // Appearance or ORTAppearance
  const nodes::Appearance* plain = nullptr; // the appearance, if it is an Appearance
  Node* material = nullptr;                 // Material, or one of X3D 4; null: unlit
  nodes::Material* backMaterial = nullptr;  // both material and backMaterial are Materials
  Node* texture = nullptr;                  // the appearance's texture, also a MultiTexture
  Node* textureTransform = nullptr;         // also a MultiTextureTransform
  nodes::ORTShader* shader = nullptr;       // the shader of an ORTAppearance

  // Returns whether a colour texture multiplies the material's colour, as in X3D and VRML 1.0. In
  // VRML97 it replaces the colour, and a grey one multiplies.
  bool texturesMultiply() const;
};
// Returns the parts of the value of Shape.appearance, which may be null or a prototype instance.
AppearanceParts resolveAppearance(Node* appearance);

// The values of a material of any type under one name each. Colours are numbers of the file,
// between 0 and 1; pictures show them with the sRGB curve. Textures are rendered nodes or null.
struct MaterialValues {
  // The lighting model: none without a material (the shape is white, or has the colours of its
  // vertices or texture, whatever the lights), phong for Material and TwoSidedMaterial (ISO/IEC
  // 14772-1 4.14), physical for PhysicalMaterial, unlit for UnlitMaterial.
  enum class Model : uint8_t { none, phong, physical, unlit } model = Model::none;
  Color color{1, 1, 1};     // diffuseColor, baseColor, or the emissiveColor of an UnlitMaterial
  Color emissiveColor;      // black for an UnlitMaterial, whose colour is `color`
  Color lineColor{1, 1, 1}; // the colour of lines and points: emissiveColor of any material
  Color specularColor;      // phong
  float ambientIntensity = 0, shininess = 0; // phong; the exponent is 128 times shininess
  float metallic = 0, roughness = 1;         // physical
  float transparency = 0;                    // 0: opaque, 1: invisible
  float normalScale = 1;                     // length of what normalTexture adds to the normal
  Node* colorTexture = nullptr;              // the material's own, not that of the appearance
  Node* emissiveTexture = nullptr;
  Node* specularTexture = nullptr;
  Node* ambientTexture = nullptr;
  Node* shininessTexture = nullptr;
  Node* normalTexture = nullptr;
  Node* metallicRoughnessTexture = nullptr; // roughness in green, metallic in blue
  Node* occlusionTexture = nullptr;
  std::string_view
      mapping; // the first that a Material's fields name, such as diffuseTextureMapping
};
// Returns the values of a material, which may be null or a prototype instance. Those of a
// TwoSidedMaterial are the ones of its front.
MaterialValues materialValues(Node* material);
// Returns whether the intensity of a light is its irradiance at surfaces of the material, as
// docs/worlds.md has it: a PhysicalMaterial, or a Material that stands for a surface of a glTF
// file.
bool takesIrradiance(const Node* material);
// Returns the values of the back of faces if it differs from the front: those of backMaterial or of
// the back of a TwoSidedMaterial.
std::optional<MaterialValues> backValues(const AppearanceParts& parts);

// Returns the texture that gives a surface its colour: the material's own, else that of the
// appearance. It may be a MultiTexture or a cube map; null: there is none.
Node* colorTexture(const AppearanceParts& parts);

// Returns the transform of the first picture, or null: a TextureTransform, TextureTransform3D or
// TextureTransformMatrix3D. It is the node itself, or of the parts of a MultiTextureTransform the
// one with this mapping, else the first.
const Node* firstTransform(Node* textureTransform, std::string_view mapping = {});
// The same for the layer `layer` of a MultiTexture. Layers after the first have a transform only in
// a MultiTextureTransform that is long enough.
const Node* layerTransform(Node* textureTransform, size_t layer, std::string_view mapping = {});

// One picture of a surface, and how it lies on it.
struct TextureLayer {
  Node* texture = nullptr; // ImageTexture, PixelTexture, MovieTexture, a cube map or a 3D texture
  // Column-major matrix that maps (s, t, r, q) of the geometry to coordinates of the picture.
  double transform[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  std::string mode, source, function; // words of a MultiTexture; empty: its defaults
};
// Returns the pictures that give a surface its colour: none, one, or the layers of a MultiTexture
// in their order. The material's own picture stands in place of that of the appearance.
std::vector<TextureLayer> textureLayers(const AppearanceParts& parts);

// A parameter that an ORTShader sets.
struct ShaderOption {
  enum class Type : uint8_t {
    integer,
    floats,  // 1, 2, 3, 4 or 16 numbers
    boolean, // `integer` is 0 or 1
    color,
    text,
    texture, // `text` and `otherUrls` are the URLs of a picture, tried in turn
    list,    // any number of numbers
    file,    // `text` and `otherUrls` are the URLs of a text, tried in turn
    node     // `picture` is a texture node
  } type = Type::floats;
  std::string name;
  std::vector<float> numbers;
  int integer = 0;
  std::string text;
  MFString otherUrls;
  NodeRef picture;
  const FieldInfo* field = nullptr; // not null: the node declares the parameter as a field
  // Where the values stand of a parameter that no field declares: in bytes of an element of
  // `options`.
  size_t element = 0, begin = 0, end = 0;
};
// Returns the parameters of a shader in order: those of its options, then the fields that it
// declares. A field takes the place of an option of the same name. Without the shader's class it is
// not known what a list of strings leads to; its type is `file`. Options that cannot be read are
// left out.
std::vector<ShaderOption> shaderOptions(const nodes::ORTShader& shader);
// Returns the parameter that a declared field of a shader sets; none for an empty list of URLs and
// NULL. The type of a list of strings is `file`.
std::optional<ShaderOption> declaredOption(const nodes::ORTShader& shader, const FieldInfo& field);

// More than any shader has parameters. An option takes twenty times the memory of its text.
inline constexpr size_t maximumShaderOptions = 10'000;
// Returns the valid options in order; `errors` receives one sentence per invalid option.
// Types: 1i 1f 2f 3f 4f 16f bool color string texture file floats.
// A string or URL ends at the next blank or comma, or is enclosed in 'single quotes'. It is an
// error if the rest of a word follows the comma. A list of floats ends at the first word that is
// not a number.
std::vector<ShaderOption> parseShaderOptions(const MFString& options,
                                             std::vector<std::string>& errors);

// The picture of a texture node.
struct TexturePicture {
  Image image;               // decoded, rows from the bottom up; components 0: none
  RadianceImage radiance;    // in place of `image` for a file of radiances (.hdr, .exr, .pfm)
  std::vector<uint8_t> file; // the bytes of the file; empty: the picture comes from no file
  std::string path;          // the file, or the data: URL
  // "image/png", "image/jpeg", "image/gif", "image/webp", "image/bmp", "image/x-tga",
  // "image/vnd.radiance", "image/x-exr" or "image/x-portable-floatmap"; empty: the picture comes
  // from no file.
  std::string type;
  std::string error; // why there is no picture; empty: there is one, or the node names none
  size_t url = 0;    // the place of the file in the node's list of URLs
  bool tooManyPixels = false; // why there is no picture: it has more than the limit imagePixels
};
enum class Decode : uint8_t { yes, no };
// Returns the picture of an ImageTexture, a PixelTexture, or the frame that a MovieTexture of a
// running world shows now. world: its limits hold, and its file is the base of the URLs of nodes in
// no file. Decode::no reads a file without decoding it; `image` is then empty. The file is that of
// the first URL, from `url` on, that can be used.
TexturePicture texturePicture(const Node& texture, const World& world, Decode decode = Decode::yes,
                              size_t url = 0);
// Decodes the file of a picture that was read with Decode::no. Reads at most limits.imagePixels
// pixels; otherwise `error` says what is wrong. Needs no world. [any thread]
void decodeTexture(TexturePicture& picture, const Limits& limits);

} // namespace xvrml

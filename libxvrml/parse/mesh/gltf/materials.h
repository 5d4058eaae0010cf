// materials.h: the materials and pictures of a glTF file (glTF 2.0, 3.8 and 3.9) as Appearance
// nodes with Material, PhysicalMaterial or UnlitMaterial, and clear bodies as ORTAppearance nodes.
// [the thread that loads]
#pragma once

#include <map>
#include <string>
#include <vector>

#include "parse/mesh/gltf/accessors.h"
#include "parse/mesh/gltf/material_extensions.h"
#include "parse/mesh/node_stream.h"

namespace xvrml::gltf {

// Texture coordinates that a material uses: a set of the primitive (TEXCOORD_n), transformed
// (KHR_texture_transform).
struct TexCoordUse {
  size_t set = 0;
  double offset[2] = {0, 0}, scale[2] = {1, 1}, rotation = 0;
  bool operator==(const TexCoordUse&) const = default;
};

// Returns the sRGB code of a linear colour, 0 to 1. Colours of glTF are linear numbers, those of
// nodes are sRGB.
Color encoded(const Color& linear);

class Materials {
 public:
  Materials(const MeshFile& file, NodeStream& nodes, const Item& root, Accessors& accessors);

  size_t size() const { return materials_.size(); }
  bool isDoubleSided(std::optional<size_t> material) const;
  Color baseColor(std::optional<size_t> material) const;
  // Returns the alpha of the base colour, or nothing where the material ignores alpha.
  std::optional<float> baseAlpha(std::optional<size_t> material) const;
  // Returns the texture coordinates that a material's pictures use, each once.
  std::vector<TexCoordUse> texCoords(std::optional<size_t> material) const;
  // Returns the name that joins a picture to its texture coordinates, if a material has several.
  static std::string mappingName(size_t texCoordUse);

  // Write the field `appearance` of the open Shape. Lines and points without normals are not lit,
  // as the specification recommends (3.7.2.1).
  void writeSurface(std::optional<size_t> material);
  void writeUnlit(std::optional<size_t> material);

 private:
  struct Picture {
    std::string_view field; // a field of the material node
    Item texture;           // the textureInfo; may be none
  };
  std::vector<TexCoordUse> texCoordsOf(const Item& material) const;
  std::vector<Picture> picturesOf(const Item& material) const;
  bool isUnlit(const Item& material) const;
  void writeAppearance(const Item& material);
  void writeClearBody(const Item& material, const ClearBody& body);
  void writePhysical(const Item& material);
  void writeMatt(const Item& material);
  void writeLit(const Item& material);
  std::string_view fieldOf(const Item& material, const Picture& picture) const;
  // The sink has the nodes of X3D 4.0.
  bool hasPhysical() const;
  Color baseColor(const Item& material) const;
  void writePhong(const Item& material);
  void writeFlat(const Item& material);
  void writePictures(const Item& material, std::initializer_list<std::string_view> fields);
  void writePicture(const Item& material, const Picture& picture);
  std::string urlOf(const Item& texture);
  void writeSampler(const Item& texture);
  void writeAlpha(const Item& material);
  float transparencyOf(const Item& material) const;
  Color emissionOf(const Item& material);
  void warnOfExtensions(const Item& material);

  const MeshFile& file_;
  NodeStream& nodes_;
  Accessors& accessors_;
  std::vector<Item> materials_, textures_, images_, samplers_;
  std::vector<std::string_view> surfaces_;         // DEF names of Appearances; empty: not written
  std::map<std::string, std::string_view> shared_; // DEF names of ImageTextures, by what they show
  std::map<std::string, bool> warned_;             // extensions
};

} // namespace xvrml::gltf

// materials.h: Surfaces as glTF materials, with textures, samplers and images. [one thread]
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "libpicture/export/gltf/document.h"
#include "libpicture/export/pictures.h"
#include "libpicture/export/surface.h"

namespace picture::gltf {

// KHR_texture_transform: scale acts first, then rotation, then offset. Texture coordinates are u v
// with the origin at the upper left.
struct TextureTransform {
  float offset[2] = {0, 0}, rotation = 0, scale[2] = {1, 1};
};
// Returns the transform of a picture whose s t are transformed as in SurfacePicture::transform;
// nothing if the matrix has shear, which the extension cannot say.
std::optional<TextureTransform> textureTransformOf(const std::array<float, 6>& transform);

// Returns the object of a material, without its pictures. Adds the names of the extensions that it
// has to the document. thickness: of the body, in the coordinates of its mesh.
Json materialOf(const Surface& surface, bool doubleSided, float thickness, Document& document);

// A material, and what its vertices need.
struct MaterialUse {
  std::optional<size_t> material; // none: the surface cannot be drawn
  bool textured = false, showsVertexColors = false;
  std::array<float, 6> bakedTransform{1, 0, 0, 1, 0, 0}; // applied to texture coordinates
};

// Writes materials when they are first used.
class Materials {
 public:
  Materials(Document& document, const Pictures& pictures, Surfaces& surfaces)
      : document_(document), pictures_(pictures), surfaces_(surfaces) {}
  MaterialUse use(const xvrml::AppearanceParts& parts, VertexColors colors, bool lines,
                  bool doubleSided, float thickness);
  // Writes the images. uriOf(file): the URI of a picture; empty: the picture is in the buffer.
  template <class UriOf> void writeImages(const UriOf& uriOf);

 private:
  struct Key {
    const xvrml::Node* appearance;
    VertexColors colors;
    bool lines, doubleSided;
    auto operator<=>(const Key&) const = default;
  };
  MaterialUse write(const Surface& surface, bool doubleSided, float thickness);
  Json textureOf(const SurfacePicture& picture);
  size_t samplerOf(const xvrml::Node& texture);

  Document& document_;
  const Pictures& pictures_;
  Surfaces& surfaces_;
  std::map<Key, MaterialUse> known_;
  std::map<std::pair<size_t, size_t>, size_t> textures_; // by picture and sampler
  std::map<std::string, size_t> samplers_;               // by their text
};

template <class UriOf> void Materials::writeImages(const UriOf& uriOf) {
  for (size_t i = 0; i < pictures_.files().size(); ++i) {
    const PictureFile& file = pictures_.files()[i];
    const char* type = file.isPng ? "image/png" : "image/jpeg";
    if (const std::string uri = uriOf(i); !uri.empty())
      document_.add("images", {{"uri", uri}});
    else
      document_.add("images", {{"bufferView", document_.addBytes(file.bytes)}, {"mimeType", type}});
  }
}

} // namespace picture::gltf

// volumes.h: the volumes of a world (textures in space, ISO/IEC 19775-1 clause 33) as OpenRT
// textures. Made on first use. [the mapper's thread]
#pragma once

#include <string>
#include <unordered_map>

#include "image/volume.h"
#include "mapper/shading/textures.h"
#include "xvrml/nodes.h"

namespace xvrml::mapper {

// Returns whether a texture (or null) is a volume.
bool isVolume(Node* texture);

class Volumes {
 public:
  Volumes(World& world, Textures& textures) : world_(world), textures_(textures) {}
  // Returns the texture of a ComposedTexture3D, ImageTexture3D or PixelTexture3D; 0 if it has no
  // pixels or cannot be loaded (reported once).
  RTid of(Node& node);
  // Notes that fields of the node have changed: it is a volume, one of its slices, or its
  // TextureProperties. Returns whether a volume is concerned.
  bool changed(const Node& node);
  void clear(); // deletes everything

 private:
  struct Entry {
    NodeRef node;
    RTid id = 0;
    bool stale = true;
  };
  Volume read(const Node& node);
  Volume readFile(const nodes::ImageTexture3D& node);
  Volume stackOf(const nodes::ComposedTexture3D& node);
  RTid make(const Node& node);

  World& world_;
  Textures& textures_;
  std::unordered_map<const Node*, Entry> entries_;
};

} // namespace xvrml::mapper

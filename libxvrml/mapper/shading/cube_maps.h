// cube_maps.h: the cube maps of a world (ISO/IEC 19775-1 clause 34) as OpenRT textures: six faces,
// or one picture of the whole sphere. Made on first use. [the mapper's thread]
#pragma once

#include <unordered_map>
#include <unordered_set>

#include "image/cube_faces.h"
#include "mapper/shading/textures.h"
#include "xvrml/nodes.h"

namespace xvrml::mapper {

struct CubeMap {
  RTid faces[cubeFaces] = {}; // in the order of CubeFace; 0: the face has no picture
  RTid sphere = 0;            // a picture of all longitudes and latitudes instead
};

// Returns whether a texture (or null) is a cube map.
bool isCubeMap(Node* texture);

class CubeMaps {
 public:
  CubeMaps(World& world, Textures& textures) : world_(world), textures_(textures) {}
  // Returns the pictures of a node (or null). It has none if they cannot be loaded or the node has
  // no pictures of its own; both are reported once.
  CubeMap of(Node* node);
  // Notes that fields of the node have changed.
  void changed(const Node& node);
  void clear(); // deletes everything

 private:
  struct Entry {
    NodeRef node;
    CubeMap map;
    bool stale = false;
  };
  CubeMap composed(const nodes::ComposedCubeMapTexture& node);
  CubeMap read(const nodes::ImageCubeMapTexture& node);
  CubeMap decode(const std::string& path);
  void drop(CubeMap& map);

  World& world_;
  Textures& textures_;
  std::unordered_map<const Node*, Entry> files_; // nodes that own their pictures
  std::unordered_set<const Node*> refused_;      // other nodes, which have been reported
};

// Sets the parameters of the class X3DMaterial for the first layer of a surface: a cube map that is
// looked up by a direction, or for a GeneratedCubeMapTexture a mirror. Returns whether the texture
// (or null) is a cube map. byNormal: the direction is the normal, not the reflected ray.
bool setCubeLayer(ShaderSetup& shader, Node* texture, CubeMaps& cubes, bool byNormal);

} // namespace xvrml::mapper

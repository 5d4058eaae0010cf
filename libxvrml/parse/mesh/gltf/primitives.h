// primitives.h: the meshes of a glTF file (glTF 2.0, 3.7.2) as Shapes. [the thread that loads]
#pragma once

#include <map>
#include <string>
#include <vector>

#include "parse/mesh/gltf/materials.h"
#include "parse/mesh/gltf/skins.h"

namespace xvrml::gltf {

// How a node changes the mesh that it shows: its weights of morph targets, and its skin.
struct Deformation {
  std::vector<double> weights;
  Skins* skins = nullptr; // null: it has no skin
  size_t node = 0, skin = 0;
};

class Primitives {
 public:
  Primitives(const MeshFile& file, NodeStream& nodes, const Item& root, Accessors& accessors,
             Materials& materials);

  size_t size() const { return meshes_.size(); }
  const Item& mesh(size_t number) const { return meshes_[number]; }
  // Adds the vertices of a mesh with a skin to its figure.
  void addTo(const Deformation& deformation, size_t mesh);
  // Writes the Shapes of a mesh into the open list of nodes; a mesh that stands there already is
  // USEd. A mesh with a skin uses the vertices of its figure.
  void write(size_t mesh, const Deformation& deformation);
  // The DEF names of the Coordinate nodes of a mesh that was written with morph targets, with what
  // moves them.
  struct Morph {
    std::string_view coordinate;
    std::vector<Vec3f> base;
    std::vector<std::vector<Vec3f>> targets; // displacements
  };
  // Returns the morphs of the mesh that was written last with `keepMorphs`.
  std::vector<Morph> takeMorphs() { return std::move(morphs_); }
  void keepMorphs(bool keep) { keepMorphs_ = keep; }

 private:
  void writePrimitive(const Item& primitive, const Deformation& deformation, Skins::Part* part);
  MFVec3f readVectors(const Item& attributes, std::string_view name, size_t count);
  bool readVertices(const Item& primitive, Vertices& vertices);
  void readColors(const Item& attributes, Vertices& vertices);
  void morph(const Item& primitive, const std::vector<double>& weights, Vertices& vertices);
  MFInt32 faceIndex(const std::vector<uint32_t>& index, uint64_t mode, uint64_t& bad,
                    size_t points) const;
  void writeGeometry(const Item& primitive, Vertices&& vertices, const Deformation& deformation,
                     const Skins::Part* part);
  bool readIndices(const Item& primitive, uint64_t mode, size_t count, MFInt32& coordIndex);
  std::string keyOf(const Item& attributes, std::string_view name, bool own) const;
  void writeVertices(const Item& attributes, Vertices& vertices, bool own);
  void writeColors(const Item& attributes, Vertices&& vertices, bool own);
  bool writeTexCoords(const Item& attributes, std::optional<size_t> material, size_t count);
  template <class T> void writeShared(std::string_view field, std::string_view type,
                                      std::string_view values, const std::string& key, T&& data);

  const MeshFile& file_;
  NodeStream& nodes_;
  Accessors& accessors_;
  Materials& materials_;
  Scratch scratch_; // memory for the primitive that is being written
  std::vector<Item> meshes_;
  std::vector<std::string_view> written_;          // DEF names of meshes
  std::map<std::string, std::string_view> shared_; // DEF names of nodes that hold arrays
  bool keepMorphs_ = false;
  std::vector<Morph> morphs_;
};

} // namespace xvrml::gltf

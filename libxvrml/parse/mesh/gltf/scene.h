// scene.h: the nodes of a glTF file (glTF 2.0, 3.5) as Transforms with what they hold: meshes,
// cameras, lights, skins. [the thread that loads]
#pragma once

#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include <Imath/ImathMatrix.h>

#include "parse/mesh/gltf/primitives.h"

namespace xvrml::gltf {

class Scene {
 public:
  Scene(const MeshFile& file, NodeStream& nodes, const Item& root, Accessors& accessors);

  // Writes the scenes: the default one, or a Switch of all.
  void write();

  // For the animations.
  size_t size() const { return nodes_.size(); }
  // DEF name of a node's Transform; empty: it is in no scene.
  std::string_view defOf(size_t node) const { return defs_[node]; }
  const std::vector<Primitives::Morph>* morphsOf(size_t node) const;

 private:
  void findParents();
  void findAnimated(const Item& root);
  std::vector<size_t> rootsOf(const Item& scene) const;
  void writeRoots(const std::vector<size_t>& roots);
  void writeNode(size_t node, uint64_t depth);
  void writePlace(const Item& node);
  void writeMesh(size_t node);
  void writeLight(size_t node);
  void findSkinned(const std::vector<size_t>& roots);
  void writeFigure(const std::vector<size_t>& roots);
  void writeSkinned();
  Deformation deformationOf(size_t node);
  std::vector<double> weightsOf(const Item& node) const;
  Imath::M44d matrixOf(const Item& node) const;
  const Imath::M44d& worldMatrix(size_t node);

  const MeshFile& file_;
  NodeStream& out_;
  Scratch scratch_;
  Materials materials_;
  Primitives primitives_;
  std::vector<Item> nodes_, scenes_, cameras_, lights_;
  Skins skins_;
  std::optional<size_t> scene_;
  std::vector<std::vector<size_t>> children_;
  std::vector<size_t> parents_; // size(): none
  std::vector<std::string_view> defs_;
  std::vector<bool> hasMorphAnimation_, hasScaleAnimation_, inThisScene_;
  struct Skinned {
    std::optional<size_t> mesh;
    size_t skin;
  };
  std::map<size_t, Skinned> skinned_; // nodes of this scene that have a skin
  std::map<size_t, std::vector<Primitives::Morph>> morphs_;
  std::unordered_map<size_t, Imath::M44d> worlds_; // matrices of lights and what is above
};

// A size of 0 along one axis makes a figure flat. A Transform has no such scale (ISO/IEC 14772-1
// 6.52), so one that is this part of the largest size stands for it.
constexpr double flatness = 1e-6;

// The lights of KHR_lights_punctual and the cameras, into the open list of nodes. They look along
// -z of the node that holds them. world: the node's matrix.
void writeLight(NodeStream& out, const Item& light, const Imath::M44d& world);
void writeCamera(NodeStream& out, const Item& camera);

// Returns the angle and axis of a quaternion x y z w; no rotation if it has no length.
Rotation rotationOf(double x, double y, double z, double w);

// Writes the animations as TimeSensors, interpolators and routes, after the scenes.
void writeAnimations(const MeshFile& file, NodeStream& out, const Item& root, Accessors& accessors,
                     const Scene& scene);

} // namespace xvrml::gltf

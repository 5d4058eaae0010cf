// skins.h: the skins of a glTF scene (glTF 2.0, 3.7.3) as one figure of H-Anim. The vertices of all
// skinned primitives stand in one Coordinate. Below a node that is a joint stands one HAnimJoint
// for each skin, whose own matrix is the inverse bind matrix, so that it moves vertices as glTF
// does. [the thread that loads]
#pragma once

#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <Imath/ImathMatrix.h>

#include "parse/mesh/gltf/accessors.h"
#include "parse/mesh/node_stream.h"

namespace xvrml::gltf {

// The arrays of a primitive that has been read.
struct Vertices {
  MFVec3f points, normals;
  MFColor colors;
  MFFloat alphas; // empty: opaque
};

// Writes the fields of a Transform for any matrix. The matrix is one of row vectors.
void writeMatrix(NodeStream& out, const Imath::M44d& matrix);

class Skins {
 public:
  // nodes: number of nodes of the file.
  Skins(const MeshFile& file, const Item& root, Accessors& accessors, size_t nodes);

  // The vertices of one primitive among those of the figure.
  struct Part {
    size_t first, count; // vertices
    bool smooth;         // it has normals
    MFColor colors;
    MFFloat alphas;
  };
  using PartKey = std::pair<size_t, size_t>; // number of the node, and of the primitive in its mesh

  size_t size() const { return skins_.size(); }
  void beginFigure();
  // Adds a primitive, whose points and normals it takes.
  void add(const PartKey& key, size_t skin, const Item& attributes, Vertices&& vertices);
  bool empty() const { return size_ == 0; }
  size_t vertices() const { return size_; }
  // Null: the primitive is no part of the figure.
  Part* find(const PartKey& key);

  // Write the parts of the open HAnimHumanoid: skinCoord and skinNormal, the joints of a node into
  // the open list of its children, and the list of all joints.
  void writeVertices(NodeStream& out);
  void writeJoints(NodeStream& out, size_t node);
  void writeList(NodeStream& out);
  std::string_view coordinate() const { return coordinate_; } // DEF names
  std::string_view normal() const { return normal_; }

 private:
  struct Joint {
    Imath::M44d inverseBind;
    MFInt32 vertices;
    MFFloat weights;
  };
  // Four joints and weights for each vertex.
  struct Set {
    Values joints, weights;
  };
  std::vector<Set> readSets(const Item& attributes, size_t count);
  const std::vector<Imath::M44d>& bindsOf(size_t skin);
  void addWeights(const Item& attributes, size_t skin, size_t count);

  const MeshFile& file_;
  Accessors& accessors_;
  Scratch scratch_;
  std::vector<Item> skins_;
  std::vector<std::vector<size_t>> nodes_;           // nodes that are joints, by skin
  std::map<size_t, std::vector<Imath::M44d>> binds_; // inverse bind matrices, by skin
  std::map<PartKey, Part> parts_;
  // By the node of the joint and the skin.
  std::map<std::pair<size_t, size_t>, Joint> joints_;
  size_t size_ = 0;
  MFVec3f points_, normals_;
  bool smooth_ = false;
  std::string_view coordinate_, normal_;
  std::vector<std::string_view> written_; // DEF names of joints
};

} // namespace xvrml::gltf

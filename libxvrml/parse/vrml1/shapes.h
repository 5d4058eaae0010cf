// shapes.h: the Shapes of VRML97 that stand for the geometry of VRML 1.0 in a state. One node of
// VRML 1.0 becomes several Shapes where its materials differ in more than VRML97 can say in one.
// [the thread that loads]
#pragma once

#include <map>

#include "parse/vrml1/looks.h"

namespace xvrml::vrml1 {

// MaterialBinding and NormalBinding: what gets a material or a normal of its own. With an index,
// a field of the shape says which one.
enum class Binding : uint8_t {
  overall,
  perPart,
  perPartIndexed,
  perFace,
  perFaceIndexed,
  perVertex,
  perVertexIndexed
};
constexpr bool isIndexed(Binding b) {
  return b == Binding::perPartIndexed || b == Binding::perFaceIndexed ||
         b == Binding::perVertexIndexed;
}

class Shapes {
 public:
  Shapes(Graph& graph, Looks& looks) : graph_(graph), looks_(looks) {}
  // Returns the Shapes of a node of geometry. last: the node is not converted again, so that its
  // arrays may be moved.
  MFNode make(const TreeNode& node, State& state, bool last);

 private:
  // Indices of an IndexedFaceSet or IndexedLineSet. Indices of colours and normals are one for each
  // corner, with -1 as in coordIndex, or one for each face.
  struct Indices {
    MFInt32 values;
    bool perCorner = true;
  };
  // The arrays of a set of faces, in the order in which VRML97 has them.
  struct Faces {
    const TreeNode& from;
    NodeRef coord;
    MFInt32 coordIndex, materialIndex, normalIndex, texCoordIndex;
    NodeRef texCoord;       // given, or null: that of the state
    bool hasNormals = true; // the state's normals apply
  };
  // How a face set is drawn, apart from its materials.
  struct Dress {
    NodeRef normal, texCoord;
    Indices normals;
    MFInt32 texCoordIndex;
  };

  MFNode faces(Faces& faces, State& state);
  NodeRef faceSet(const Faces& faces, State& state, const Dress& dress, const Indices& materials,
                  const std::vector<uint32_t>* chosen);
  Dress dress(const Faces& faces, State& state, bool split);
  void dressNormals(const Faces& faces, State& state, Dress& dress);
  void dressTexture(const Faces& faces, State& state, bool split, Dress& dress);
  Indices materials(State& state, const MFInt32& coordIndex, const MFInt32& materialIndex,
                    Binding binding);
  MFNode cube(const TreeNode& node, State& state);
  MFNode parts(const TreeNode& node, State& state);
  MFNode lines(const TreeNode& node, State& state, bool last);
  MFNode points(const TreeNode& node, State& state);
  MFNode text(const TreeNode& node, State& state);
  NodeRef fontStyle(const TreeNode& from, State& state);
  NodeRef shape(const TreeNode& from, NodeRef appearance, NodeRef geometry);

  Binding binding(State& state, Slot slot, Binding ifDefault);
  NodeRef coordinates(const TreeNode& from, State& state);
  NodeRef normals(State& state);
  NodeRef textureCoordinates(State& state);
  NodeRef changed(const TreeNode& from, const TextureChain& chain, const NodeRef& coordinates);

  Graph& graph_;
  Looks& looks_;
  std::map<const TreeNode*, NodeRef> properties_; // Coordinates, normals and the like
  // Texture coordinates with a transformation applied.
  std::map<std::pair<const Node*, const TextureChain*>, NodeRef> changed_;
};

// Returns whether an index field is left at its default [ -1 ].
bool isAbsent(const MFInt32& index);
// Returns for each corner or face the number of its material or normal, by the binding.
// `coordIndex` separates faces by negative numbers. `given`: the shape's materialIndex or
// normalIndex.
MFInt32 boundIndices(const MFInt32& coordIndex, const MFInt32& given, Binding binding);
size_t faceCount(const MFInt32& coordIndex);

} // namespace xvrml::vrml1

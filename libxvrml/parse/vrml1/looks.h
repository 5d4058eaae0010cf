// looks.h: the appearances of VRML97 that stand for Material, Texture2 and Texture2Transform of
// VRML 1.0. A Material of VRML 1.0 holds lists, from which MaterialBinding chooses for each part,
// face or vertex. Everything is made once for each state that it depends on. [the thread that
// loads]
#pragma once

#include <map>
#include <tuple>

#include "parse/vrml1/graph.h"
#include "parse/vrml1/state.h"
#include "xvrml/nodes.h"

namespace xvrml::vrml1 {

// Texture2Transforms accumulate: the last one acts first on the coordinates.
struct TextureChain {
  const TreeNode* node;
  // The matrix of all of them: s' = a s + b t + e, t' = c s + d t + f.
  double a = 1, b = 0, c = 0, d = 1, e = 0, f = 0;
  Vec2f apply(const Vec2f& p) const {
    return {float(a * double(p.x) + b * double(p.y) + e),
            float(c * double(p.x) + d * double(p.y) + f)};
  }
};

// The part of a shape that a material is for.
enum class Use : uint8_t {
  surface,
  lines,  // lines and points, which VRML97 draws in emissiveColor
  colours // a surface with a Color node
};

class Looks {
 public:
  explicit Looks(Graph& graph) : graph_(graph) {}

  // The lists of a Material, seen as materials with a number.
  struct List {
    size_t count = 1;
    bool uniform = true; // they differ in nothing but the colour that a Color node can give
    // For each material the first one that is equal to it but for that colour.
    std::vector<uint32_t> first;
    NodeRef colours, lineColours; // Color nodes with one colour for each material
  };
  // Returns the lists of the material in effect.
  List& list(State& state);
  // Returns a Color node with a colour for each of these materials.
  NodeRef colours(const TreeNode& from, State& state, Use use);
  // Returns the colour of a material in a Color node.
  SFColor colour(State& state, size_t index, Use use);

  // Returns an Appearance with a material of the list, the texture and its transformation.
  NodeRef appearance(const TreeNode& from, State& state, size_t index, Use use);
  // Returns whether a picture is in effect.
  bool isTextured(State& state);

  // Adds a Texture2Transform to the state.
  void addTransform(State& state, const TreeNode& node);
  // Returns the transformation if no TextureTransform can say it, so that the texture coordinates
  // have to be changed; else null.
  const TextureChain* unspeakable(State& state);

 private:
  NodeRef material(const TreeNode& from, const TreeNode& material, size_t index, Use use);
  // Returns what makes the colours of a Color node shine by themselves.
  NodeRef unlit(const TreeNode& from, const TreeNode& material, size_t index);
  NodeRef texture(const TreeNode& texture);
  NodeRef textureTransform(const TreeNode& from, const TextureChain& chain);

  Graph& graph_;
  std::map<const TreeNode*, List> lists_;
  std::map<std::tuple<const TreeNode*, size_t, Use>, NodeRef> materials_;
  std::map<const TreeNode*, NodeRef> textures_;
  std::map<std::pair<const TextureChain*, const TreeNode*>, TextureChain> chains_;
  std::map<const TextureChain*, NodeRef> transforms_;
  std::map<std::tuple<const TreeNode*, size_t, const TreeNode*, const TextureChain*, Use>, NodeRef>
      appearances_;
};

} // namespace xvrml::vrml1

// converter.h: traverses a VRML 1.0 tree with its state, and builds the VRML97 graph of the file.
// Groups become groups, properties become the fields of what they apply to. [the thread that loads]
#pragma once

#include <unordered_map>

#include "parse/vrml1/group.h"
#include "parse/vrml1/shapes.h"

namespace xvrml::vrml1 {

class Converter {
 public:
  // nesting: greatest depth of nodes, counted through USEs.
  Converter(Graph& graph, uint64_t nesting)
      : graph_(graph), looks_(graph), shapes_(graph, looks_), nesting_(nesting) {}
  // Returns the roots of the graph.
  MFNode convert(const Tree& tree);

 private:
  // A conversion of a node: it holds wherever the state agrees in the slots of the mask.
  struct Key {
    const TreeNode* node;
    uint32_t mask;
    State::Values values;
    bool operator==(const Key&) const = default;
  };
  struct KeyHash {
    size_t operator()(const Key& key) const;
  };

  void traverse(const TreeNode& node, Group& group);
  void traverseChildren(const TreeNode& node, Group& group);
  void traverseSwitch(const TreeNode& node, Group& group);
  void traverseTransformSeparator(const TreeNode& node, Group& group);
  void info(const TreeNode& node, Group& group);
  void setProperty(const TreeNode& node, Group& group);

  // These return the node of VRML97, or null if there is nothing to show.
  NodeRef converted(const TreeNode& node);
  NodeRef convertAlone(const TreeNode& node);
  NodeRef separator(const TreeNode& node);
  NodeRef anchor(const TreeNode& node);
  NodeRef lod(const TreeNode& node);
  NodeRef inlined(const TreeNode& node);
  NodeRef grouped(const TreeNode& node, bool named, MFNode children);

  Graph& graph_;
  Looks looks_;
  Shapes shapes_;
  State state_;
  const uint64_t nesting_;
  uint64_t depth_ = 0;
  uint64_t sharing_ = 0; // number of nodes around the present one that are USEd
  // The slots that conversions of a node have read, and their results.
  std::unordered_map<const TreeNode*, std::vector<uint32_t>> masks_;
  std::unordered_map<Key, NodeRef, KeyHash> results_;
};

// Lights and cameras, in the coordinates of the group that gets them (lights_cameras.cpp).
NodeRef convertLight(Graph& graph, const TreeNode& node, const Placement& placement);
NodeRef convertCamera(Graph& graph, const TreeNode& node);
bool isCamera(const TreeNode& node);

} // namespace xvrml::vrml1

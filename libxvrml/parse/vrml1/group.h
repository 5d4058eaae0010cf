// group.h: collects the children of a group of VRML97 while a group of VRML 1.0 is traversed. It
// turns what VRML 1.0 says by order into nesting: transformations and lights apply to what follows.
// [the thread that loads]
#pragma once

#include "parse/vrml1/graph.h"
#include "parse/vrml1/placement.h"

namespace xvrml::vrml1 {

class Group {
 public:
  explicit Group(Graph& graph) : graph_(graph), levels_(1) {}

  // The transformation of what is added next.
  Placement placement;

  // Adds a node at the placement. Children that follow each other at one placement share a
  // Transform.
  void add(const NodeRef& child, const TreeNode& from);
  // Adds a light, whose numbers are in the coordinates of the group. It shines on what follows.
  void addLight(const NodeRef& light, const TreeNode& from);
  // Returns the children. The group is empty afterwards.
  MFNode finish();

 private:
  // Everything that follows a light is nested in a Group with it. More lights than this in one
  // group stand in the innermost of these Groups.
  static constexpr size_t maximumLevels = 64;

  // Children of the group, or of the Group that begins with a light.
  struct Level {
    MFNode children;
    const TreeNode* from = nullptr; // the light
    bool onlyLights = true;
    // The Transform that is the last child and grows, and its placement; null: there is none.
    NodeRef transform;
    Placement placed;
  };

  void closeTransform(Level& level);

  Graph& graph_;
  std::vector<Level> levels_;
};

} // namespace xvrml::vrml1

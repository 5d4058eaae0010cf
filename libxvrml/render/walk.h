// walk.h: the walk of a renderer over a world. It uses an explicit stack, so nesting costs no C++
// stack. [the thread that owns the world]
#pragma once

#include <optional>
#include <unordered_map>
#include <vector>

#include "geometry/matrix.h"
#include "xvrml/node_map.h"
#include "xvrml/renderer.h"

namespace xvrml {

class RenderWalk {
 public:
  RenderWalk(const World& world, Renderer& renderer, const RenderOptions& options);
  void run();

  const World& world() const { return world_; }
  const RenderOptions& options() const { return options_; }
  // Returns how many Shapes the viewer sees that have the geometry node.
  uint64_t usesOf(const Node& geometry);

 private:
  // A node whose children are visited.
  struct Level {
    NodeRef node; // keeps it when a callback takes it out of the world
    Matrix inner, local;
    bool isSingular = false; // no child can be visible
    size_t planesAt = 0;     // how many of planes_ cut the node itself
    size_t planesBelow = 0;  // how many of them cut its children
  };
  struct Open {
    NodeRef node;
    size_t depth; // how many levels are above it
  };
  struct Nothing {};

  void visit(const NodeRef& node);
  void enter(Level&& entered);
  void leaveDownTo(size_t depth);
  RenderState stateOf(const Level& level) const;
  const Matrix& outside(size_t depth) const;
  void appendParts(Node& node, const Matrix& toWorld);
  void addPlanes(const Matrix& toWorld);

  const World& world_;
  Renderer& renderer_;
  const RenderOptions& options_;
  const Matrix view_;
  std::vector<Open> open_;
  std::vector<Level> levels_;
  std::vector<Node*> path_;                   // the nodes of `levels_`, then the visited one
  NodeMap<Nothing> above_;                    // the nodes of `levels_`
  std::vector<std::array<double, 4>> planes_; // what ClipPlanes leave, in world coordinates
  std::vector<Node*> parts_;
  std::optional<std::unordered_map<const Node*, uint64_t>> uses_;
};

} // namespace xvrml

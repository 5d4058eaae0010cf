// binding.h: the stacks of the bindable nodes Viewpoint, Background, Fog and NavigationInfo (clause
// 4.6.10). [the browser's thread]
#pragma once

#include <array>
#include <vector>

#include "event/engine.h"
#include "nodes/bindable.h"
#include "xvrml/camera.h"

namespace xvrml {

class Viewer;

class Binding {
 public:
  Binding(Engine& engine, Viewer& viewer) : engine_(engine), viewer_(viewer) {}

  // Binds the first node of each type in a file, including prototype bodies but not Inlines. Stacks
  // in use are kept.
  void bindFirst(const Scope& scope);
  // Handles a set_bind event.
  void set(Node& node, bool bound);
  // Removes nodes that have left the scene, as if they had received set_bind FALSE. Returns whether
  // there was one.
  bool dropAbsent();
  // Removes a node that is no longer part of the world from its stack, without events.
  void forget(const Node& node);
  BoundNodes bound() const;
  // Returns all Viewpoints in the scene in file order, including those in Inlines.
  static std::vector<Node*> viewpoints(const Scope& scope);

 private:
  static constexpr size_t types = bindableStacks;
  static constexpr size_t viewpointStack = size_t(BindableStack::viewpoint);
  struct Entry {
    NodeRef node;
    bool inScene; // it has been in the scene; a node outside the scene may be bound too
  };
  using Stack = std::vector<Entry>;       // the bound node is last
  static size_t typeOf(const Node& node); // returns `types` if the node is not bindable
  Node* top(size_t type) const {
    return stacks_[type].empty() ? nullptr : stacks_[type].back().node.get();
  }
  void push(size_t type, Node& node);
  void remove(size_t type, size_t index);
  void sendBindEvents(Node& node, bool bound);

  Engine& engine_;
  Viewer& viewer_;
  std::array<Stack, types> stacks_;
};

} // namespace xvrml

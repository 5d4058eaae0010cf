// binding.h: the stacks of bindable nodes (clause 4.6.10): Viewpoint, Background, Fog,
// NavigationInfo. [the browser's thread]
#pragma once

#include <array>
#include <vector>

#include "event/engine.h"
#include "xvrml/camera.h"

namespace xvrml {

class Viewer;

class Binding {
 public:
  Binding(Engine& engine, Viewer& viewer) : engine_(engine), viewer_(viewer) {}

  // Binds the first node of each type in a file, bodies of prototypes included, Inlines not. Stacks
  // that are in use stay.
  void bindFirst(const Scope& scope);
  // A set_bind event.
  void set(Node& node, bool bound);
  // Nodes that have left the scene leave their stacks, as if they had received set_bind FALSE. True
  // if there was one.
  bool dropAbsent();
  // The node is no longer part of the world: it leaves its stack without a word.
  void forget(const Node& node);
  BoundNodes bound() const;
  // All Viewpoints in the scene in the order of the files, Inlines included.
  static std::vector<Node*> viewpoints(const Scope& scope);

 private:
  static constexpr size_t types = 4;
  struct Entry {
    NodeRef node;
    bool inScene; // it has been; a node that hangs nowhere yet may be bound
  };
  using Stack = std::vector<Entry>;       // the bound one last
  static size_t typeOf(const Node& node); // `types`: not bindable
  Node* top(size_t type) const {
    return stacks_[type].empty() ? nullptr : stacks_[type].back().node.get();
  }
  void push(size_t type, Node& node);
  void remove(size_t type, size_t index);
  void tell(Node& node, bool bound);

  Engine& engine_;
  Viewer& viewer_;
  std::array<Stack, types> stacks_;
};

} // namespace xvrml

// walk.h: walks over nodes that visit each node once. They do not recurse, because a hostile world
// may be deeper than the stack. The caller says where a walk goes on: down, up, or into prototypes.
// [any thread that owns the nodes]
#pragma once

#include <type_traits>
#include <utility>
#include <vector>

#include "xvrml/node_map.h"
#include "xvrml/world.h"

namespace xvrml {

class SeenNodes {
 public:
  // Returns whether the node was not in the set. node: not null.
  bool insert(const Node* node) { return nodes_.insert(node, {}).second; }
  bool contains(const Node* node) const { return nodes_.contains(node); }

 private:
  struct Nothing {};
  NodeMap<Nothing> nodes_;
};

// Calls visit(node, open) for each node in `open`, the last one first; null is skipped. visit
// appends to `open` the nodes where the walk goes on. If visit returns false, the walk ends and
// walk() returns false. Nodes in `seen` are skipped; it grows by the visited ones.
template <class N, class Visit>
bool walk(std::vector<N*> open, SeenNodes& seen, const Visit& visit) {
  while (!open.empty()) {
    N* node = open.back();
    open.pop_back();
    if (!node || !seen.insert(node)) continue;
    if constexpr (std::is_void_v<decltype(visit(*node, open))>)
      visit(*node, open);
    else if (!visit(*node, open))
      return false;
  }
  return true;
}
template <class N, class Visit> bool walk(std::vector<N*> open, const Visit& visit) {
  SeenNodes seen;
  return walk(std::move(open), seen, visit);
}

// Appends the nodes that the node's own fields hold, in the order of the fields. Null is included.
template <class N> void appendChildren(const Node& node, std::vector<N*>& out) {
  for (const FieldInfo& field : node.type().fields) {
    if (!holdsValue(field)) continue;
    if (field.type == FieldType::SFNode)
      out.push_back(static_cast<const SFNode*>(node.storage(field))->get());
    else if (field.type == FieldType::MFNode)
      for (const NodeRef& child : *static_cast<const MFNode*>(node.storage(field)))
        out.push_back(child.get());
  }
}

// Appends the roots of a scope, in the order of the file. Null is included.
template <class N> void appendRoots(const Scope& scope, std::vector<N*>& out) {
  for (const NodeRef& root : scope.roots) out.push_back(root.get());
}
inline std::vector<Node*> rootsOf(const Scope& scope) {
  std::vector<Node*> roots;
  appendRoots(scope, roots);
  return roots;
}

} // namespace xvrml

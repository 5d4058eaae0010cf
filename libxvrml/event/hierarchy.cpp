// hierarchy.cpp: walks the graph down through fields, and up through the parents in Live.
#include "event/hierarchy.h"

#include <algorithm>

#include "geometry/descend.h"
#include "geometry/node_matrix.h"
#include "graph/expansion.h"
#include "graph/field_access.h"
#include "nodes/visible.h"
#include "xvrml/nodes.h"
#include "xvrml/walk.h"

namespace xvrml {

void childrenInHierarchy(Node& node, std::vector<Node*>& out) {
  if (node.type().index < 0) {
    if (const auto* instance = nodeCast<ProtoInstance>(&node);
        instance && !instance->body.roots.empty())
      out.push_back(instance->body.roots[0].get());
    return;
  }
  if (node.type().expand) {
    if (Node* standsFor = expansionOf(node)) out.push_back(standsFor);
    return;
  }
  // Editors keep references to other nodes in a MetadataSet; they do not put them into the scene.
  const bool describes = node.type().index == nodes::MetadataSet::typeIndex;
  forEachChild(node, [&](NodeRef& child, const FieldInfo&) {
    if (!describes || child->type().is("metadataObject")) out.push_back(child.get());
  });
  if (const Scope* content = inlineScope(node)) appendRoots(*content, out);
}

void childrenInScene(Node& node, std::vector<Node*>& out) {
  if (!appendPlaced(node, out)) childrenInHierarchy(node, out);
}

void holdersOf(const Node& node, std::vector<Node*>& holders) {
  if (!node.live) return;
  const Parents& parents = liveOf(node)->parents;
  holders.insert(holders.end(), parents.begin(), parents.end());
}

std::vector<Path> pathsTo(const Node& node, size_t limit) {
  struct Open {
    Node* node;
    size_t next; // next parent to visit
  };
  std::vector<Path> paths;
  if (!node.live) return paths;
  std::vector<Open> open{{liveOf(node)->node, 0}};
  size_t steps = 0;
  const size_t maximumSteps = std::max<size_t>(1000 * limit, 100'000);
  while (!open.empty() && paths.size() < limit && ++steps < maximumSteps) {
    Open& top = open.back();
    const Live& live = *liveOf(*top.node);
    if (top.next == 0 && live.root) {
      Path& path = paths.emplace_back();
      for (size_t i = open.size(); i-- > 0;) path.push_back(open[i].node);
    }
    if (top.next == live.parents.size()) {
      open.pop_back();
      continue;
    }
    Node* parent = live.parents[top.next++];
    if (isPlacedBy(*parent, *top.node)) open.push_back({parent, 0});
  }
  return paths;
}

bool isInScene(const Node& node) {
  if (!node.live) return false;
  return !walk(std::vector<const Node*>{&node}, [](const Node& one, auto& open) {
    const Live& live = *liveOf(one);
    for (Node* parent : live.parents)
      if (isPlacedBy(*parent, one)) open.push_back(parent);
    return !live.root;
  });
}

Matrix localToWorld(const Path& path) {
  Matrix matrix;
  for (Node* node : path)
    if (hasMatrix(*node)) matrix = compose(matrix, matrixOf(*node));
  return matrix;
}

bool isChosen(const Path& path) {
  for (size_t i = 0; i + 1 < path.size(); ++i) {
    const auto* choice = nodeCast<nodes::Switch>(path[i]);
    if (choice && chosenChild(*choice) != path[i + 1]) return false;
  }
  return true;
}

} // namespace xvrml

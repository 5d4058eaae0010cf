#include "write/names.h"

#include <fmt/format.h>

#include "base/lexer.h"
#include "graph/expander.h"
#include "graph/field_access.h"
#include "xvrml/walk.h"

namespace xvrml {

std::string nameText(const std::string& name) {
  if (isIdentifier(name)) return name;
  std::string text;
  for (const char c : name)
    text += isVrmlSeparator(c) || static_cast<unsigned char>(c) < 0x20 ? '_' : c;
  return text;
}

Names::Names(const std::vector<Node*>& roots, const std::vector<Route>& routes) {
  std::vector<Node*> nodes;
  std::unordered_map<const Node*, uint32_t> index;
  collectNodes(roots, nodes, index);
  std::unordered_map<const Node*, size_t> uses;
  for (Node* root : roots) ++uses[root];
  for (Node* node : nodes)
    forEachChild(*node, [&](NodeRef& child, const FieldInfo&) { ++uses[child.get()]; });
  for (const Route& route : routes) {
    uses[route.from.get()] += 2;
    uses[route.to.get()] += 2;
  }
  std::unordered_map<std::string, int> given;
  for (Node* node : nodes) {
    if (node->defName.empty()) continue;
    names_.emplace(node, nameText(node->defName));
    if (++given[names_[node]] > 1) repeated_.insert(names_[node]);
  }
  size_t number = 0;
  for (Node* node : nodes) {
    if (uses[node] < 2 || names_.contains(node)) continue;
    std::string name;
    do name = fmt::format("_{}{}", node->type().name, ++number);
    while (given.contains(name));
    names_.emplace(node, std::move(name));
  }
}

} // namespace xvrml

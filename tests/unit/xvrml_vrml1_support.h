// xvrml_vrml1_support.h: what the tests of VRML 1.0 share.
#pragma once

#include <cmath>
#include <sstream>
#include <unordered_map>

#include "geometry/matrix.h"
#include "graph/field_access.h"
#include "unit/xvrml_parser_support.h"
#include "xvrml/nodes.h"
#include "xvrml/world.h"

namespace vrml1_test {

using namespace xvrml;
using Messages = std::vector<std::string>;

inline std::unique_ptr<World> load(const std::string& text, const LoadOptions& options = {}) {
  return loadWorldFromMemory("#VRML V1.0 ascii\n" + text, "test.wrl", options);
}

inline Messages messagesOf(const World& world) {
  Messages all;
  for (const Diagnostic& one : world.diagnostics.list())
    all.push_back(one.text().substr(0, one.text().find('\n')));
  return all;
}

// Calls visit(node) for every node in the order of the file, shared ones at each use.
template <class Visit> void walkAll(Node* node, const Visit& visit) {
  visit(node);
  forEachChild(*node, [&](NodeRef& child, const FieldInfo&) { walkAll(child.get(), visit); });
}

// Returns the nodes of a type, shared ones at each use.
template <class T> std::vector<T*> every(const World& world) {
  std::vector<T*> all;
  for (const NodeRef& root : world.scope.roots)
    walkAll(root.get(), [&](Node* node) {
      if (T* found = nodeCast<T>(node)) all.push_back(found);
    });
  return all;
}

// Returns the only node of a type; null if there are none or several.
template <class T> T* only(const World& world) {
  const auto all = every<T>(world);
  return all.size() == 1 ? all[0] : nullptr;
}

inline nodes::Material* materialOf(const nodes::Shape& shape) {
  const auto* appearance = nodeCast<nodes::Appearance>(shape.appearance);
  return appearance ? nodeCast<nodes::Material>(appearance->material) : nullptr;
}

} // namespace vrml1_test

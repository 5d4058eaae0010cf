// walk.h: Visits the nodes of a world with those of its prototypes and Inlines. [any thread that
// owns the nodes]
#pragma once

#include <utility>
#include <vector>

#include "xvrml/walk.h"

namespace picture {

using NodeList = std::vector<const xvrml::Node*>;

// Visits nodes and all nodes below them, bodies of prototypes and contents of Inlines included.
// Calls enter() for each such scope.
template <class Visit, class Enter>
void walkInto(NodeList first, const Visit& visit, const Enter& enter) {
  xvrml::walk(std::move(first), [&](const xvrml::Node& node, NodeList& open) {
    visit(node);
    xvrml::appendChildren(node, open);
    const auto add = [&](const xvrml::Scope& scope) {
      enter(scope);
      xvrml::appendRoots(scope, open);
    };
    if (const auto* instance = xvrml::nodeCast<xvrml::ProtoInstance>(&node)) add(instance->body);
    if (const xvrml::Scope* content = xvrml::inlineScope(node)) add(*content);
  });
}

template <class Visit, class Enter>
void walkInto(const xvrml::Scope& scope, const Visit& visit, const Enter& enter) {
  enter(scope);
  NodeList roots;
  xvrml::appendRoots(scope, roots);
  walkInto(std::move(roots), visit, enter);
}

} // namespace picture

// change.h: what a running world tells its renderer: which fields have new values, and which fields
// may ever change.
#pragma once

#include <string>
#include <vector>

#include "xvrml/node.h"

namespace xvrml {

// A field or exposedField has a new value, or a bindable node was bound or unbound (`field` is then
// its set_bind). The kind of change is field->change; changes of kind `none` are not reported.
// Several changes of one field between two calls of takeChanges are reported once. If node and
// field are null, the world has other roots (world.scope.roots).
struct FieldChange {
  NodeRef node;
  const FieldInfo* field;
};
using FieldChanges = std::vector<FieldChange>;

// Returns the kinds of change that events may bring to a node: bit 1 << int(Change::...). It is 0
// for a node of a world that does not run. The kinds come from the world as it stands:
// - ROUTEs, also through prototypes;
// - the nodes that Scripts with directOutput refer to;
// - all fields that have changed since the world began to run.
//
// Code that groups static nodes splits the groups here.
uint16_t reachOf(const Node& node);
inline bool reaches(const Node& node, Change kind) { return reachOf(node) >> int(kind) & 1; }
// Returns the reason why a kind is in reachOf, for messages: "ROUTE from Clock.fraction_changed".
// "" if it is not.
std::string reachReason(const Node& node, Change kind);

// Appends the nodes of a running world that hold a node among their children, once for each time
// they do. Prototype instances hold the nodes of their body, Inlines hold what they loaded.
void holdersOf(const Node& node, std::vector<Node*>& holders);

} // namespace xvrml

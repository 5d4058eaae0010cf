// change.h: what a running world tells those who draw it: which fields have new values, and which
// ever may get some.
#pragma once

#include <string>
#include <vector>

#include "xvrml/node.h"

namespace xvrml {

// A field or exposedField has a new value, or a bindable node was bound or unbound (field: its
// set_bind). The kind of change is field->change; changes of kind `none` are not reported. Several
// changes of one field between two readings are one. node and field null: the roots of the world
// are others (world.scope.roots).
struct FieldChange {
  NodeRef node;
  const FieldInfo* field;
};
using FieldChanges = std::vector<FieldChange>;

// Which kinds of change events may bring to a node, seen from the world as it stands: ROUTEs
// (through prototypes), the nodes that Scripts with directOutput refer to, and whatever has been
// changed since the world runs. Bit 1 << int(Change::...); 0 for a node of a world that does not
// run. Whoever groups static things splits here.
uint16_t reachOf(const Node& node);
inline bool reaches(const Node& node, Change kind) { return reachOf(node) >> int(kind) & 1; }
// Why a kind is in reachOf, for people: "ROUTE from Clock.fraction_changed"; empty if it is not.
std::string reachReason(const Node& node, Change kind);

// Appends the nodes of a running world that hold a node among their children (prototype instances
// hold the nodes of their body, Inlines what they loaded), once for each time they do.
void holdersOf(const Node& node, std::vector<Node*>& holders);

} // namespace xvrml

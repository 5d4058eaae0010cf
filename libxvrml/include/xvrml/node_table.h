// node_table.h: the constant tables that nodegen writes, and what the library makes of them.
// Included by generated sources.
#pragma once

#include <limits>
#include <span>

#include "xvrml/node.h"

namespace xvrml {

// FieldInfo without its default, which a new node holds already.
struct FieldRow {
  const char* name;
  FieldType type;
  Access access;
  Change change;
  uint32_t offset;
  FieldRange range;
  const char* nodeTypes;
  const char* text;
};

// NodeType as a constant. `roles` are separated by blanks.
struct NodeRow {
  const char* name;
  const char* roles;
  const char* component;
  const char* clause;
  const char* text;
  std::span<const FieldRow> fields;
  Node* (*create)(const NodeType& type);
};

// A node as `create` makes it.
template <class T> Node* createNode(const NodeType& type) { return new T(type); }

// The description of a row's nodes at position `index` of the registry; defaults are read from a
// new node.  [any thread]
NodeType makeNodeType(const NodeRow& row, int index);

} // namespace xvrml

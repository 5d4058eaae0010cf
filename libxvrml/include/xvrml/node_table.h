// node_table.h: the constant tables that nodegen writes, and their conversion to NodeType. Included
// by generated sources.
#pragma once

#include <limits>
#include <span>

#include "xvrml/node.h"

namespace xvrml {

// These are the words of FieldRow::words, joined by |. The bits never change: plug-ins have them
// compiled in.
inline constexpr uint8_t fieldHoldsUrls = 1; // `urls`
inline constexpr uint8_t fieldOfX3d = 2;     // `x3d`

// FieldInfo as a constant. The default is left out: a new node holds it.
struct FieldRow {
  const char* name;
  FieldType type;
  Access access;
  Change change;
  uint8_t words;
  uint32_t offset;
  FieldRange range;
  const char* nodeTypes;
  const char* text;
  const RareAccess* rare = nullptr; // FieldInfo::rare and rareOffset
  uint32_t rareOffset = 0;
};

// NodeType as a constant. `roles` are separated by blanks.
struct NodeRow {
  const char* name;
  const char* roles;
  const char* component;
  Standard standard;
  const char* clause;
  const char* text;
  std::span<const FieldRow> fields;
  Node* (*create)(const NodeType& type);
};

// Makes a node; for NodeRow::create.
template <class T> Node* createNode(const NodeType& type) { return new T(type); }

// Returns the description of a row's nodes, at position `index` of the registry. Defaults are read
// from a new node.  [any thread]
NodeType makeNodeType(const NodeRow& row, int index);

} // namespace xvrml

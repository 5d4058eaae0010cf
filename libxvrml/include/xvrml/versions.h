// versions.h: what the version of a node's file decides about its fields (docs/versions.md): by
// which names they are called, whether events change them, which numbers they may have, and their
// defaults. Everything that takes a name from a file, a Script or a user asks here. [any thread
// that owns the node]
#pragma once

#include <span>
#include <string_view>

#include "xvrml/file_head.h"
#include "xvrml/node.h"

namespace xvrml {

// Return the field or event that the standard of the node's file calls by a name: X3D's "children"
// of a Switch is VRML97's "choice". Our own names are found, too. Null if there is none. As
// NodeType's functions do, the last two find set_x and x_changed of an exposedField x.
const FieldInfo* findField(const Node& node, std::string_view name);
const FieldInfo* findEventIn(const Node& node, std::string_view name);
const FieldInfo* findEventOut(const Node& node, std::string_view name);
// Returns our own name for a field or event that the standard of the node's file calls by a name.
// That of our own name is the name itself. The result lives as long as the name.
std::string_view ownName(const Node& node, std::string_view name);
// Returns the name that the standard of the node's file gives to a field or event. It ends with a
// zero byte, and lives as long as the node's type.
std::string_view fieldName(const Node& node, const FieldInfo& field);
// Returns the name that the other standard, VRML97 or X3D, gives to it; empty: both names are
// equal.
std::string_view otherFieldName(const Node& node, const FieldInfo& field);

// Where a version of X3D differs from what FieldInfo says: a row of `since` in the .node files.
struct FieldRevision {
  int type; // typeIndex of the node
  std::string_view field;
  int major, minor; // the first version of X3D that says so
  Access access;
  FieldRange range;
  Value defaultValue;
  std::string_view clause; // ISO/IEC 19775-1, in the edition of that version
};
// Returns the rows of a type, in the order of the versions.
std::span<const FieldRevision> revisionsOf(const NodeType& type);
// Returns how a version changes a field; null: it is as FieldInfo says.
const FieldRevision* revisionOf(const NodeType& type, const FieldInfo& field,
                                const FileVersion& version);
// Returns the default of a field in files of a version.
const Value& defaultIn(const NodeType& type, const FieldInfo& field, const FileVersion& version);
// Return the range and the default of a field in the version of the node's file.
const FieldRange& rangeIn(const Node& node, const FieldInfo& field);
const Value& defaultIn(const Node& node, const FieldInfo& field);
// Returns false if a number of the value lies outside of rangeIn().
bool inRange(const Node& node, const FieldInfo& field, const Value& value);

} // namespace xvrml

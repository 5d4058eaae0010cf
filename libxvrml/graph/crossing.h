// crossing.h: passes values of a prototype instance's interface to the nodes in its body that are
// connected by IS (ISO/IEC 14772-1 4.8.2). Used when a file is read, and when a field is set in a
// world that does not run. [any thread that owns the nodes]
#pragma once

#include "xvrml/world.h"

namespace xvrml {

struct IsAssignment {
  const ProtoInstance& instance;
  const FieldInfo& from;                   // field of the interface
  Node& node;                              // node in the body
  const FieldInfo& to;                     // the node's field that IS `from`, of the same type
  std::shared_ptr<const std::string> base; // the file that URLs in the value count from
  bool checkCycles = false;                // the value may hold the node itself
};

// Adapts URLs that pass into the body (4.5.3). URLs of a built-in node or a Script become relative
// to the node's file. Strings of a prototype instance stay as they are, because it may show them as
// text; the caller stores `base` beside them or passes it on.
void passUrls(const IsAssignment& assignment, MFString& urls);

// Adapts strings that a node in the body hands out to the instance. If the instance's own strings
// lead to the same URLs, these are returned. Otherwise URLs become relative to the instance's file.
struct ReturnedUrls {
  MFString urls;
  bool kept; // they are the instance's strings, which keep their base
};
ReturnedUrls returnUrls(const Node& node, const FieldInfo& out, const ProtoInstance& instance,
                        const FieldInfo& to, const MFString& urls);

// Stores the base of strings that a program assigns to a field: the file of the instance. Strings
// that the field already has keep their base. Called before the strings are stored.
void assignUrlBase(Node& node, const FieldInfo& field, const Value& value);

// Sets the node's field to the value. URLs are adapted (passUrls), and numbers are brought into the
// field's range. Nodes are left out, with a message, if the field does not
// accept them or if they hold the node.
void assignThroughIs(const IsAssignment& assignment, const Value& value, Diagnostics& diagnostics);

} // namespace xvrml

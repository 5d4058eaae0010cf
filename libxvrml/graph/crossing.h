// crossing.h: passes values of a prototype instance's interface to the nodes in its body that are
// connected by IS (ISO/IEC 14772-1 4.8.2). Used when a file is read, and when a field is set in a
// world that does not run. [any thread that owns the nodes]
#pragma once

#include "xvrml/world.h"

namespace xvrml {

struct IsAssignment {
  const ProtoInstance& instance;
  const FieldInfo& from; // field of the interface
  Node& node;            // node in the body
  const FieldInfo& to;   // the node's field that IS `from`, of the same type
  bool given;            // the value stands in the instance's file, not in the declaration's
  bool checkCycles;      // the value may hold the node itself
};

// Sets the node's field to the value. Relative urls become relative to the node's file, and numbers
// are brought into the field's range. Nodes are left out, with a message, if the field does not
// accept them or if they hold the node.
void assignThroughIs(const IsAssignment& assignment, const Value& value, Diagnostics& diagnostics);

} // namespace xvrml

// crossing.h: values that cross the border of a prototype's instance inwards: what a node in the
// body gets whose field IS a field of the interface (ISO/IEC 14772-1 4.8.2). Used while a file is
// read, and when a field is set in a world that stands still. [any thread that owns the nodes]
#pragma once

#include "xvrml/world.h"

namespace xvrml {

struct Crossing {
  const ProtoInstance& instance;
  const FieldInfo& from; // of the interface
  Node& node;            // in the body
  const FieldInfo& to;   // its field that IS `from`, of the same type
  bool findLoops;        // the value may hold the node itself; else it is known not to
};

// Gives the node the value: urls relative to the node's file, numbers within the field's range,
// nodes that the field takes and that do not hold the node. What is left out is told.
void giveAcross(const Crossing& crossing, const Value& value, Diagnostics& diagnostics);

} // namespace xvrml

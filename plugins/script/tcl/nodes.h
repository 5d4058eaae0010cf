// nodes.h: nodes as commands: `node7 get translation`. [the browser's thread]
#pragma once

#include "interpreter.h"

namespace tclscript {

// The node that an object names, 0 for NULL and the empty string; false if it names none.
bool nodeOf(Interpreter& interpreter, Tcl_Obj* object, XsNode& node);

// Writes an own field, sends an own eventOut, or sends an event to a node: what `$node set` does.
// TCL_ERROR with a message.
int setField(Interpreter& interpreter, XsNode node, const std::string& name, Tcl_Obj* object);

} // namespace tclscript

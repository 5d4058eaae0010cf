// nodes.h: Implements nodes as commands, such as `node7 get translation`. [the browser's thread]
#pragma once

#include "interpreter.h"

namespace tclscript {

// Gets the node that an object names, 0 for NULL and the empty string. Returns false if it names
// none.
bool nodeOf(Interpreter& interpreter, Tcl_Obj* object, XsNode& node);

// Implements `$node set`: writes a field or sends an eventOut of the Script, or sends an event to a
// node. Returns TCL_ERROR with a message.
int setField(Interpreter& interpreter, XsNode node, const std::string& name, Tcl_Obj* object);

} // namespace tclscript

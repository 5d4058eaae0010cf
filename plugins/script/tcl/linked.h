// linked.h: Connects a field or eventOut of a Script with its Tcl variable (variables.cpp). [the
// browser's thread]
#pragma once

#include "interpreter.h"

namespace tclscript {

struct Linked {
  Interpreter* interpreter = nullptr;
  std::string variable;
  XsType type{};
  Interpreter::Output output{};
  Object last; // last value of the variable
};

} // namespace tclscript

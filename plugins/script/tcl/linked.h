// linked.h: a field or eventOut of a Script and its Tcl variable; see variables.cpp. [the browser's
// thread]
#pragma once

#include "interpreter.h"

namespace tclscript {

struct Linked {
  Interpreter* interpreter = nullptr;
  std::string variable;
  XsType type{};
  Interpreter::Output output{};
  Object last; // value
};

} // namespace tclscript

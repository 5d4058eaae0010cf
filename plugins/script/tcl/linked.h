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
  Object last;          // last value of the variable
  bool renewed = false; // an event sets the variable just now: nothing is written or sent
};

// Gives the variable of an inputOutput field the value of an event that has arrived.
void renewVariable(const std::vector<std::unique_ptr<Linked>>& linked, const char* name,
                   Object value);

} // namespace tclscript

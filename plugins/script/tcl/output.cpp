// output.cpp: Implements `puts`, which writes to the host's log, and `exit`, which ends only the
// Script. [the browser's thread]
#include <cstring>

#include "interpreter.h"

namespace tclscript {
namespace {

constexpr size_t longestLine = 1 << 20; // limit for puts -nonewline

int putsCommand(ClientData data, Tcl_Interp* tcl, int count, Tcl_Obj* const words[]) {
  Interpreter& interpreter = *static_cast<Interpreter*>(data);
  const bool noNewline = count > 2 && std::strcmp(Tcl_GetString(words[1]), "-nonewline") == 0;
  const int first = noNewline ? 2 : 1;
  if (count - first < 1 || count - first > 2) {
    Tcl_WrongNumArgs(tcl, 1, words, "?-nonewline? ?channelId? string");
    return TCL_ERROR;
  }
  if (count - first == 2) {
    const std::string channel = Tcl_GetString(words[first]);
    if (channel != "stdout" && channel != "stderr") {
      if (interpreter.trusted()) { // a file that the program has opened
        std::vector<Tcl_Obj*> copy(words, words + count);
        const Object original = Tcl_NewStringObj("::xvrml::puts", -1);
        copy[0] = original.get();
        return Tcl_EvalObjv(tcl, count, copy.data(), 0);
      }
      Tcl_SetObjResult(tcl, Tcl_ObjPrintf("can not find channel named \"%s\"", channel.c_str()));
      return TCL_ERROR;
    }
  }
  std::string& line = interpreter.unfinishedLine;
  const std::string text = hostText(words[count - 1]);
  if (noNewline && line.size() + text.size() <= longestLine) {
    line += text;
    return TCL_OK;
  }
  interpreter.log(0, 0, line + text);
  line.clear();
  return TCL_OK;
}

int exitCommand(ClientData data, Tcl_Interp* tcl, int count, Tcl_Obj* const words[]) {
  if (count > 2) {
    Tcl_WrongNumArgs(tcl, 1, words, "?returnCode?");
    return TCL_ERROR;
  }
  static_cast<Interpreter*>(data)->exit();
  return TCL_OK;
}

} // namespace

void addOutput(Interpreter& interpreter) {
  Tcl_Interp* tcl = interpreter.tcl();
  Tcl_CreateObjCommand(tcl, "::puts", putsCommand, &interpreter, nullptr);
  Tcl_CreateObjCommand(tcl, "::exit", exitCommand, &interpreter, nullptr);
}

} // namespace tclscript

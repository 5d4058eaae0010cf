// safe.cpp: Creates the interpreter of an untrusted world from a list of permitted commands.
// Commands that reach files, sockets, processes, channels, other interpreters, the environment or
// the event queue are replaced by commands that explain the refusal; all others are deleted. The
// remaining commands only compute. Their memory, and single commands that take long, are limited by
// the process that the engine runs in. [the browser's thread]
#include <algorithm>
#include <cstring>
#include <iterator>
#include <stdexcept>

#include "interpreter.h"

namespace tclscript {
namespace {

// Commands of the global namespace that stay.
constexpr const char* allowed[] = {
    "after",   "append",   "apply",    "array",     "binary", "break",   "case",      "catch",
    "clock",   "concat",   "continue", "coroutine", "dict",   "error",   "eval",      "expr",
    "for",     "foreach",  "format",   "global",    "if",     "incr",    "info",      "join",
    "lappend", "lassign",  "lindex",   "linsert",   "list",   "llength", "lmap",      "lrange",
    "lrepeat", "lreplace", "lreverse", "lsearch",   "lset",   "lsort",   "namespace", "proc",
    "puts",    "regexp",   "regsub",   "rename",    "return", "scan",    "set",       "split",
    "string",  "subst",    "switch",   "tailcall",  "throw",  "time",    "trace",     "try",
    "unset",   "uplevel",  "upvar",    "variable",  "while",  "yield",   "yieldto"};
// Refused commands that give an explanation.
constexpr const char* refused[] = {
    "cd",         "chan",   "close",  "encoding",  "eof",           "exec",  "fblocked",
    "fconfigure", "fcopy",  "file",   "fileevent", "flush",         "gets",  "glob",
    "interp",     "load",   "open",   "pid",       "pwd",           "read",  "seek",
    "socket",     "source", "tell",   "unload",    "update",        "vwait", "auto_load",
    "tk",         "bind",   "button", "toplevel",  "thread::create"};
constexpr const char* namespacesThatGo[] = {
    "::tcl::chan", "::tcl::file",    "::tcl::encoding", "::tcl::unsupported",
    "::tcl::zlib", "::tcl::process", "::zlib",          "::oo"};
// Subcommands of an ensemble that stay; the commands behind the others are deleted.
struct Ensemble {
  const char* name;
  const char* space;
  const char* keep; // subcommands that stay, as a Tcl list
};
constexpr Ensemble ensembles[] = {
    {"::info", "::tcl::info",
     "args body cmdcount commands complete coroutine default errorstack exists frame functions "
     "globals level locals patchlevel procs tclversion vars"},
    {"::clock", "::tcl::clock", "clicks microseconds milliseconds seconds"}};

// Replaces functions that init.tcl would load from a file.
constexpr const char functions[] = R"tcl(
namespace eval ::tcl::mathfunc {
  proc min {first args} {foreach x $args {if {$x < $first} {set first $x}}; expr {$first + 0}}
  proc max {first args} {foreach x $args {if {$x > $first} {set first $x}}; expr {$first + 0}}
}
)tcl";

int refuse(ClientData data, Tcl_Interp* tcl, int, Tcl_Obj* const[]) {
  Tcl_SetObjResult(tcl, Tcl_ObjPrintf("%s: allowed only in a trusted world (vv --trust)",
                                      static_cast<const char*>(data)));
  Tcl_SetErrorCode(tcl, "XVRML", "TRUST", nullptr);
  return TCL_ERROR;
}

// Implements `package require Tcl`, which is harmless and common; other packages are refused.
int package(ClientData data, Tcl_Interp* tcl, int count, Tcl_Obj* const words[]) {
  const bool wanted = count >= 3 && std::strcmp(Tcl_GetString(words[1]), "require") == 0;
  if (wanted && std::strcmp(Tcl_GetString(words[2]), "Tcl") == 0) {
    Tcl_SetObjResult(tcl, Tcl_NewStringObj(TCL_PATCH_LEVEL, -1));
    return TCL_OK;
  }
  if (!wanted) return refuse(data, tcl, count, words);
  Tcl_SetObjResult(tcl, Tcl_ObjPrintf("package %s: allowed only in a trusted world (vv --trust)",
                                      Tcl_GetString(words[2])));
  Tcl_SetErrorCode(tcl, "XVRML", "TRUST", nullptr);
  return TCL_ERROR;
}

// Runs a script of the engine; an error makes the interpreter unusable.
void run(Tcl_Interp* tcl, const std::string& script) {
  if (Tcl_Eval(tcl, script.c_str()) != TCL_OK) throw std::runtime_error(Tcl_GetStringResult(tcl));
}

std::vector<std::string> listOf(Tcl_Interp* tcl, const std::string& script) {
  run(tcl, script);
  std::vector<std::string> names;
  Tcl_Obj** elements;
  int count;
  if (Tcl_ListObjGetElements(tcl, Tcl_GetObjResult(tcl), &count, &elements) != TCL_OK)
    throw std::runtime_error(Tcl_GetStringResult(tcl));
  for (int i = 0; i < count; ++i) names.emplace_back(Tcl_GetString(elements[i]));
  return names;
}

template <size_t n> bool isOneOf(const char* const (&list)[n], const std::string& name) {
  return std::find(std::begin(list), std::end(list), name) != std::end(list);
}

void keepOnly(Tcl_Interp* tcl, const Ensemble& ensemble) {
  const std::string quoted = std::string("{") + ensemble.keep + "}";
  run(tcl, std::string("set ::xvrml_map {}; foreach name ") + quoted +
               " {lappend ::xvrml_map $name " + ensemble.space +
               "::$name}; namespace ensemble configure " + ensemble.name +
               " -map $::xvrml_map; unset ::xvrml_map name");
  for (const std::string& command :
       listOf(tcl, std::string("info commands ") + ensemble.space + "::*")) {
    const std::string tail = command.substr(std::strlen(ensemble.space) + 2);
    if ((" " + std::string(ensemble.keep) + " ").find(" " + tail + " ") == std::string::npos)
      Tcl_DeleteCommand(tcl, command.c_str());
  }
}

void strip(Tcl_Interp* tcl) {
  if (Tcl_MakeSafe(tcl) != TCL_OK) throw std::runtime_error(Tcl_GetStringResult(tcl));
  // Deletes the hidden commands, so that they cannot be exposed again.
  for (const std::string& hidden : listOf(tcl, "interp hidden")) {
    const std::string token = "xvrml_hidden";
    if (Tcl_ExposeCommand(tcl, hidden.c_str(), token.c_str()) != TCL_OK)
      throw std::runtime_error(Tcl_GetStringResult(tcl));
    Tcl_DeleteCommand(tcl, token.c_str());
  }
  for (const Ensemble& ensemble : ensembles) keepOnly(tcl, ensemble);
  for (const char* space : namespacesThatGo)
    if (Tcl_FindNamespace(tcl, space, nullptr, 0))
      run(tcl, std::string("namespace delete ") + space);
  for (const char* command : {"::tcl::pkgconfig", "::tcl::Bgerror"})
    Tcl_DeleteCommand(tcl, command);
  for (const std::string& command : listOf(tcl, "info commands ::*"))
    if (!isOneOf(allowed, command.substr(2))) Tcl_DeleteCommand(tcl, command.c_str());
  for (const char* name : refused)
    Tcl_CreateObjCommand(tcl, (std::string("::") + name).c_str(), refuse, const_cast<char*>(name),
                         nullptr);
  Tcl_CreateObjCommand(tcl, "::package", package, const_cast<char*>("package"), nullptr);
  for (const char* variable : {"env", "tcl_library", "tcl_pkgPath", "auto_path", "tcl_interactive",
                               "argv", "argv0", "argc"})
    Tcl_UnsetVar(tcl, variable, TCL_GLOBAL_ONLY);
  run(tcl, functions);
  Tcl_ResetResult(tcl);
}

} // namespace

bool makeSafe(Interpreter& interpreter) {
  try {
    strip(interpreter.tcl());
    return true;
  } catch (const std::exception& error) {
    Tcl_SetObjResult(interpreter.tcl(), Tcl_NewStringObj(error.what(), -1));
    return false;
  }
}

} // namespace tclscript

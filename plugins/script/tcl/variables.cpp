// variables.cpp: Exposes the fields and eventOuts of a Script as global Tcl variables. Writing a
// variable writes the field or sends the event. An invalid value is a Tcl error, and the variable
// keeps its previous value. [the browser's thread]
#include "interpreter.h"
#include "linked.h"

namespace tclscript {
namespace {

constexpr int traced =
    TCL_GLOBAL_ONLY | TCL_TRACE_WRITES | TCL_TRACE_UNSETS | TCL_TRACE_RESULT_OBJECT;

char* onChange(ClientData data, Tcl_Interp* tcl, const char*, const char*, int flags);

void link(Linked& linked) {
  Tcl_Interp* tcl = linked.interpreter->tcl();
  Tcl_SetVar2Ex(tcl, linked.variable.c_str(), nullptr, linked.last.get(), TCL_GLOBAL_ONLY);
  Tcl_TraceVar2(tcl, linked.variable.c_str(), nullptr, traced, onChange, &linked);
}

// Returns the message as an object, because Tcl keeps the program's result.
char* refused(Tcl_Interp* tcl) {
  Tcl_Obj* message = Tcl_DuplicateObj(Tcl_GetObjResult(tcl));
  Tcl_IncrRefCount(message);
  return reinterpret_cast<char*>(message);
}

char* onChange(ClientData data, Tcl_Interp* tcl, const char*, const char*, int flags) {
  Linked& linked = *static_cast<Linked*>(data);
  if ((flags & TCL_INTERP_DESTROYED) || linked.renewed) return nullptr;
  if (flags & TCL_TRACE_UNSETS) {
    if (flags & TCL_TRACE_DESTROYED) link(linked); // the variable cannot be unset
    return nullptr;
  }
  Interpreter& interpreter = *linked.interpreter;
  const Object now = Tcl_GetVar2Ex(tcl, linked.variable.c_str(), nullptr, TCL_GLOBAL_ONLY);
  if (!now.get()) return nullptr;
  const Tcl_InterpState state = Tcl_SaveInterpState(tcl, TCL_OK);
  Converted value;
  int code = fromTcl(interpreter, now.get(), linked.type, value);
  if (code == TCL_OK && !interpreter.isRunning())
    interpreter.postponeSet(interpreter.self(), linked.variable, now);
  else if (code == TCL_OK)
    code = interpreter.answer(interpreter.give(linked.output, interpreter.self(),
                                               linked.variable.c_str(), std::move(value)));
  char* message = code == TCL_OK ? nullptr : refused(tcl);
  Tcl_RestoreInterpState(tcl, state);
  if (code == TCL_OK)
    linked.last = now;
  else
    Tcl_SetVar2Ex(tcl, linked.variable.c_str(), nullptr, linked.last.get(), TCL_GLOBAL_ONLY);
  return message;
}

} // namespace

void addVariables(Interpreter& interpreter, std::vector<std::unique_ptr<Linked>>& linked) {
  const XsScriptInfo& info = interpreter.info();
  Tcl_SetVar2Ex(interpreter.tcl(), "self", nullptr, interpreter.nodeName(info.self).get(),
                TCL_GLOBAL_ONLY);
  for (uint32_t i = 0; i < info.fieldCount; ++i) {
    const XsField& field = info.fields[i];
    if (field.access == XS_EVENT_IN) continue;
    XsValue value{};
    const bool known = interpreter.host()->read(interpreter.host(), info.self, info.self,
                                                field.name, &value) == XS_OK;
    linked.push_back(std::make_unique<Linked>());
    Linked& made = *linked.back();
    made.interpreter = &interpreter;
    made.variable = field.name;
    made.type = field.type;
    made.output =
        field.access == XS_EVENT_OUT ? Interpreter::Output::send : Interpreter::Output::write;
    made.last = known ? toTcl(interpreter, value) : Object(Tcl_NewObj());
    link(made);
  }
}

void renewVariable(const std::vector<std::unique_ptr<Linked>>& linked, const char* name,
                   Object value) {
  for (const auto& one : linked) {
    if (one->variable != name) continue;
    one->last = std::move(value);
    one->renewed = true;
    Tcl_SetVar2Ex(one->interpreter->tcl(), name, nullptr, one->last.get(), TCL_GLOBAL_ONLY);
    one->renewed = false;
    return;
  }
}

} // namespace tclscript

// timers.cpp: Implements `after`. It uses the world's clock, so that a world at a given time is the
// same however it is drawn. If Tk is in use, it uses the wall clock, because Tk's widgets expect
// that. The engine's tick serves the timers. [the browser's thread]
#include <algorithm>
#include <cstring>

#include "interpreter.h"
#include "steady_clock.h"

namespace tclscript {
namespace {

constexpr size_t maxTimers = 10'000;
constexpr int maxAtOnce = 1000;
constexpr Tcl_WideInt longestSleep = 200; // milliseconds; Tk's own procedures sleep

std::string idOf(const Timer& timer) { return "after#" + std::to_string(timer.id); }

Tcl_Obj* scriptOf(int count, Tcl_Obj* const* words) {
  return count == 1 ? words[0] : Tcl_ConcatObj(count, words);
}

int add(Interpreter& interpreter, double seconds, int count, Tcl_Obj* const* words) {
  Tcl_Interp* tcl = interpreter.tcl();
  if (interpreter.timers.size() >= maxTimers) {
    Tcl_SetObjResult(tcl, Tcl_NewStringObj("after: more than 10000 scripts are waiting", -1));
    return TCL_ERROR;
  }
  const bool wall = interpreter.trusted() && interpreter.hasTk();
  const double now =
      wall ? steadySeconds() : interpreter.host()->now(interpreter.host(), interpreter.self());
  interpreter.timers.push_back(
      {now + seconds, wall, ++interpreter.lastTimer, scriptOf(count, words)});
  Tcl_SetObjResult(tcl, Tcl_NewStringObj(idOf(interpreter.timers.back()).c_str(), -1));
  return TCL_OK;
}

int cancel(Interpreter& interpreter, int count, Tcl_Obj* const* words) {
  const Object wanted = scriptOf(count, words);
  const std::string text = Tcl_GetString(wanted.get());
  auto& timers = interpreter.timers;
  auto found =
      std::find_if(timers.begin(), timers.end(), [&](const Timer& t) { return idOf(t) == text; });
  if (found == timers.end())
    found = std::find_if(timers.begin(), timers.end(),
                         [&](const Timer& t) { return text == Tcl_GetString(t.script.get()); });
  if (found != timers.end()) timers.erase(found);
  return TCL_OK;
}

int info(Interpreter& interpreter, int count, Tcl_Obj* const* words) {
  const Object all = Tcl_NewListObj(0, nullptr);
  for (const Timer& timer : interpreter.timers) {
    if (count == 1 && idOf(timer) == Tcl_GetString(words[0])) {
      Tcl_Obj* parts[] = {timer.script.get(), Tcl_NewStringObj("timer", -1)};
      Tcl_SetObjResult(interpreter.tcl(), Tcl_NewListObj(2, parts));
      return TCL_OK;
    }
    Tcl_ListObjAppendElement(nullptr, all.get(), Tcl_NewStringObj(idOf(timer).c_str(), -1));
  }
  if (count == 1) {
    Tcl_SetObjResult(interpreter.tcl(),
                     Tcl_ObjPrintf("event \"%s\" doesn't exist", Tcl_GetString(words[0])));
    return TCL_ERROR;
  }
  Tcl_SetObjResult(interpreter.tcl(), all.get());
  return TCL_OK;
}

int afterCommand(ClientData data, Tcl_Interp* tcl, int count, Tcl_Obj* const words[]) {
  Interpreter& interpreter = *static_cast<Interpreter*>(data);
  if (count < 2) {
    Tcl_WrongNumArgs(tcl, 1, words, "option ?arg ...?");
    return TCL_ERROR;
  }
  const char* option = Tcl_GetString(words[1]);
  if (std::strcmp(option, "cancel") == 0 && count > 2)
    return cancel(interpreter, count - 2, words + 2);
  if (std::strcmp(option, "idle") == 0 && count > 2)
    return add(interpreter, 0, count - 2, words + 2);
  if (std::strcmp(option, "info") == 0 && count <= 3)
    return info(interpreter, count - 2, words + 2);
  Tcl_WideInt milliseconds;
  if (Tcl_GetWideIntFromObj(nullptr, words[1], &milliseconds) != TCL_OK) {
    Tcl_SetObjResult(
        tcl,
        Tcl_ObjPrintf("bad argument \"%s\": must be cancel, idle, info, or an integer", option));
    return TCL_ERROR;
  }
  milliseconds = std::max<Tcl_WideInt>(milliseconds, 0);
  if (count > 2) return add(interpreter, double(milliseconds) / 1000, count - 2, words + 2);
  if (interpreter.trusted() && interpreter.hasTk() && milliseconds <= longestSleep) {
    Tcl_Sleep(int(milliseconds));
    return TCL_OK;
  }
  Tcl_SetObjResult(tcl, Tcl_NewStringObj("after without a script would stop the world", -1));
  return TCL_ERROR;
}

} // namespace

void addTimers(Interpreter& interpreter) {
  Tcl_CreateObjCommand(interpreter.tcl(), "::after", afterCommand, &interpreter, nullptr);
}

// Runs the due timers, earliest first. Timers that they add wait for the next tick.
void runTimers(Interpreter& interpreter, double time) {
  const uint64_t last = interpreter.lastTimer;
  const double wall = steadySeconds();
  Tcl_Interp* tcl = interpreter.tcl();
  for (int i = 0; i < maxAtOnce && !Tcl_LimitExceeded(tcl); ++i) {
    auto& timers = interpreter.timers;
    auto next = timers.end();
    for (auto t = timers.begin(); t != timers.end(); ++t)
      if (t->id <= last && t->due <= (t->wall ? wall : time) + 1e-9 &&
          (next == timers.end() || t->due < next->due || (t->due == next->due && t->id < next->id)))
        next = t;
    if (next == timers.end()) break;
    const Object script = next->script;
    timers.erase(next);
    const int code = Tcl_EvalObjEx(tcl, script.get(), TCL_EVAL_GLOBAL);
    if (interpreter.isOver()) break;
    if (code != TCL_OK && code != TCL_RETURN) interpreter.report(code, hostText(script.get()));
    Tcl_ResetResult(tcl);
  }
}

} // namespace tclscript

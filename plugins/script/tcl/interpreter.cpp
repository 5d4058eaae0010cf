#include "interpreter.h"

#include <cstring>

#include "linked.h"
#include "nodes.h"

namespace tclscript {
namespace {

constexpr int commandsPerCheck = 1000;       // commands between two calls of shouldStop
constexpr int microsecondsPerCheck = 20'000; // the same interval for a loop that calls no command
constexpr int maxDepth = 1000;               // maximum recursion depth
constexpr size_t maxPendingSets = 10'000;

XsString view(std::string_view text) { return {text.data(), text.size()}; }

} // namespace

thread_local Interpreter* Interpreter::running_ = nullptr;

// Exists while a function of the engine runs for a Script.
struct Call {
  explicit Call(Interpreter& interpreter)
      : outer(std::exchange(Interpreter::running_, &interpreter)), interpreter(interpreter) {
    Tcl_Preserve(interpreter.tcl_);
    interpreter.startClock();
    for (const Interpreter::PendingSet& late : std::exchange(interpreter.pendingSets_, {}))
      if (setField(interpreter, late.node, late.name, late.value.get()) != TCL_OK)
        interpreter.report(TCL_ERROR);
  }
  ~Call() {
    Tcl_LimitTypeReset(interpreter.tcl_, TCL_LIMIT_TIME);
    Tcl_ResetResult(interpreter.tcl_);
    Tcl_Release(interpreter.tcl_);
    Interpreter::running_ = outer;
  }
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;
  Interpreter* outer;
  Interpreter& interpreter;
};

Interpreter::Interpreter(const XsHost* host, const XsScriptInfo* info)
    : host_(host), info_(info), tcl_(Tcl_CreateInterp()) {
  Tcl_SetRecursionLimit(tcl_, maxDepth);
}

Interpreter::~Interpreter() {
  Interpreter* const outer = std::exchange(running_, this);
  stopped_ = exited_ = true;
  destroyWindows();
  Tcl_DeleteInterp(tcl_);
  running_ = outer;
}

XsResult Interpreter::create() {
  const Call call(*this);
  // the following commands are the engine's own and must not be interrupted
  Tcl_LimitTypeReset(tcl_, TCL_LIMIT_TIME);
  Tcl_CmdInfo found; // to find the function behind commands made by `proc`
  if (Tcl_Eval(tcl_, "proc ::xvrml_procedure {} {}") == TCL_OK &&
      Tcl_GetCommandInfo(tcl_, "::xvrml_procedure", &found))
    procedure_ = found.objProc;
  Tcl_DeleteCommand(tcl_, "::xvrml_procedure");
  Tcl_Eval(tcl_, "expr {srand(1)}"); // a world behaves the same at each start
  if (trusted()) {
    if (makeTrusted(*this) != TCL_OK) {
      log(3, 0, Tcl_GetStringResult(tcl_));
      return XS_FAILED;
    }
  } else if (!makeSafe(*this)) {
    log(3, 0, std::string("no safe interpreter: ") + Tcl_GetStringResult(tcl_));
    return XS_FAILED;
  }
  addOutput(*this);
  addTimers(*this);
  addBrowser(*this);
  addVariables(*this, linked_);
  // From here on the program's commands are counted.
  Tcl_LimitAddHandler(tcl_, TCL_LIMIT_COMMANDS, onLimit, this, nullptr);
  Tcl_LimitAddHandler(tcl_, TCL_LIMIT_TIME, onLimit, this, nullptr);
  Tcl_Eval(tcl_, "info cmdcount");
  int count = 0;
  Tcl_GetIntFromObj(nullptr, Tcl_GetObjResult(tcl_), &count);
  Tcl_LimitSetCommands(tcl_, count + commandsPerCheck);
  Tcl_LimitTypeSet(tcl_, TCL_LIMIT_COMMANDS);
  startClock();
  const Object program = tclText({info_->text.data, size_t(info_->text.bytes)});
  return finish(Tcl_EvalObjEx(tcl_, program.get(), TCL_EVAL_GLOBAL | TCL_EVAL_DIRECT),
                {info_->text.data, size_t(info_->text.bytes)});
}

// --- Limits ---

void Interpreter::startClock() {
  Tcl_Time until;
  Tcl_GetTime(&until);
  until.usec += microsecondsPerCheck;
  if (until.usec >= 1'000'000) {
    until.sec += 1;
    until.usec -= 1'000'000;
  }
  Tcl_LimitSetTime(tcl_, &until);
  Tcl_LimitTypeSet(tcl_, TCL_LIMIT_TIME);
}

// Called when the limit of commands or time is reached. Asks the host whether to continue. If not,
// Tcl unwinds the program, and `catch` does not stop that.
void Interpreter::onLimit(ClientData data, Tcl_Interp* tcl) {
  Interpreter& interpreter = *static_cast<Interpreter*>(data);
  // the Script whose tick serves an event of this one
  Interpreter& charged = running_ ? *running_ : interpreter;
  const bool commands = Tcl_LimitTypeExceeded(tcl, TCL_LIMIT_COMMANDS);
  if (charged.stopped_ ||
      charged.host_->shouldStop(charged.host_, charged.self(), commands ? commandsPerCheck : 0)) {
    charged.stopped_ = interpreter.stopped_ = true;
    return;
  }
  if (commands) Tcl_LimitSetCommands(tcl, Tcl_LimitGetCommands(tcl) + commandsPerCheck);
  interpreter.startClock();
}

void Interpreter::endProgram(const char* why) {
  Tcl_CancelEval(tcl_, Tcl_NewStringObj(why, -1), nullptr, TCL_CANCEL_UNWIND);
}

void Interpreter::exit() {
  exited_ = true;
  endProgram("exit");
}

void Interpreter::destroyWindows() {
  timers.clear();
  if (!trusted() || !hasTk()) return;
  // Bindings to the destruction of a window may still run briefly, whatever ended the program.
  constexpr int few = 10'000;
  Tcl_LimitSetCommands(tcl_, Tcl_LimitGetCommands(tcl_) + few);
  startClock();
  Tcl_CmdInfo info;
  if (!Tcl_GetCommandInfo(tcl_, "::destroy", &info) || !info.objProc) return;
  const Object words[] = {Tcl_NewStringObj("destroy", -1), Tcl_NewStringObj(".", -1)};
  Tcl_Obj* objects[] = {words[0].get(), words[1].get()};
  info.objProc(info.objClientData, tcl_, 2, objects);
  constexpr int rounds = 20; // so that the display is notified: no further tick will come
  for (int i = 0; i < rounds && Tcl_DoOneEvent(TCL_WINDOW_EVENTS | TCL_IDLE_EVENTS | TCL_DONT_WAIT);
       ++i) {}
}

// --- Calls ---

XsResult Interpreter::finish(int code, std::string_view script) {
  if (stopped_) {
    destroyWindows();
    return XS_STOPPED;
  }
  if (exited_) {
    destroyWindows();
    return XS_OK;
  }
  if (code == TCL_OK || code == TCL_RETURN) return XS_OK;
  report(code, script);
  return XS_FAILED;
}

bool Interpreter::isProcedure(const char* name) {
  Tcl_CmdInfo info;
  return Tcl_GetCommandInfo(tcl_, name, &info) && info.objProc == procedure_;
}

XsResult Interpreter::callProcedure(const char* name, const std::vector<Object>& arguments) {
  if (stopped_) return XS_STOPPED;
  if (exited_) return XS_OK;
  const std::string global = std::string("::") + name;
  if (!isProcedure(global.c_str())) return XS_OK;
  const Call call(*this);
  size_t taken = arguments.size();
  const Object query[] = {Tcl_NewStringObj("::tcl::info::args", -1), tclText(global)};
  Tcl_Obj* asked[] = {query[0].get(), query[1].get()};
  if (Tcl_EvalObjv(tcl_, 2, asked, TCL_EVAL_GLOBAL) == TCL_OK) {
    Tcl_Obj** names;
    int count;
    if (Tcl_ListObjGetElements(nullptr, Tcl_GetObjResult(tcl_), &count, &names) == TCL_OK &&
        size_t(count) < taken &&
        (count == 0 || std::strcmp(Tcl_GetString(names[count - 1]), "args") != 0))
      taken = size_t(count);
  }
  std::vector<Tcl_Obj*> words = {query[1].get()};
  for (size_t i = 0; i < taken; ++i) words.push_back(arguments[i].get());
  return finish(Tcl_EvalObjv(tcl_, int(words.size()), words.data(), TCL_EVAL_GLOBAL));
}

XsResult Interpreter::event(const XsEvent& event) {
  if (stopped_) return XS_STOPPED;
  if (exited_) return XS_OK;
  const bool exposed = info_->fields[event.index].access == XS_EXPOSED_FIELD;
  if (exposed) renewVariable(linked_, event.name, toTcl(*this, event.value));
  const std::string name = (exposed ? "set_" : "") + std::string(event.name);
  if (!isProcedure(("::" + name).c_str())) return XS_OK;
  return callProcedure(name.c_str(), {toTcl(*this, event.value), Tcl_NewDoubleObj(event.time)});
}

XsResult Interpreter::tick(double time) {
  if (stopped_) return XS_STOPPED;
  if (exited_) return XS_OK;
  if (timers.empty() && pendingSets_.empty() && !trusted()) return XS_OK;
  constexpr int most = 500; // maximum number of queued events per tick
  const Call call(*this);
  runTimers(*this, time);
  for (int i = 0; trusted() && i < most && !stopped_ && !exited_; ++i)
    if (!Tcl_DoOneEvent(TCL_ALL_EVENTS | TCL_DONT_WAIT)) break;
  return finish(TCL_OK);
}

// --- The host ---

int Interpreter::answer(XsResult result, const char* what) {
  if (result == XS_OK) return TCL_OK;
  XsString why{"", 0};
  host_->lastError(host_, self(), &why);
  std::string message(why.data ? why.data : "", size_t(why.bytes));
  if (what) message = std::string(what) + ": " + message;
  Tcl_SetObjResult(tcl_, tclText(message).get());
  Tcl_SetErrorCode(tcl_, "XVRML", "HOST", nullptr);
  if (result == XS_STOPPED) {
    stopped_ = true;
    endProgram("the Script's time is up");
  }
  return TCL_ERROR;
}

XsResult Interpreter::give(Output kind, XsNode node, const char* name, Converted&& value) {
  switch (kind) {
  case Output::send: return host_->send(host_, self(), name, &value.value);
  case Output::write: return host_->write(host_, self(), name, &value.value);
  case Output::post: break;
  }
  return host_->post(host_, self(), node, name, &value.value);
}

void Interpreter::postponeSet(XsNode node, std::string name, Object value) {
  if (pendingSets_.size() < maxPendingSets)
    pendingSets_.push_back({node, std::move(name), std::move(value)});
}

void Interpreter::log(int severity, uint32_t line, std::string_view text) {
  host_->log(host_, self(), severity, line, view(text));
}

void Interpreter::report(int code, std::string_view script) {
  const Object result = Tcl_GetObjResult(tcl_);
  const Object options = Tcl_GetReturnOptions(tcl_, code);
  const auto option = [&](const char* name) -> Tcl_Obj* {
    Tcl_Obj* found = nullptr;
    const Object key = Tcl_NewStringObj(name, -1);
    Tcl_DictObjGet(nullptr, options.get(), key.get(), &found);
    return found;
  };
  Tcl_Obj* trace = option("-errorinfo");
  Tcl_Obj* line = option("-errorline");
  int errorLine = 0;
  if (line) Tcl_GetIntFromObj(nullptr, line, &errorLine);
  const ErrorPlace place = errorPlace({info_->text.data, size_t(info_->text.bytes)},
                                      trace ? hostText(trace) : "", script, errorLine);
  std::string message = hostText(result.get());
  if (code == TCL_BREAK || code == TCL_CONTINUE) message = "break or continue outside of a loop";
  if (message.empty()) message = "error";
  if (!place.procedure.empty()) message += " (in procedure " + place.procedure + ")";
  log(3, place.line, message);
}

} // namespace tclscript

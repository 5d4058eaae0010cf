// interpreter.h: what one Script node is in Tcl: a Tcl interpreter, the variables of its fields,
// the commands of its nodes, its timers, and the limits under which it runs. Made by engine.cpp for
// each Script. [the browser's thread]
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <tcl.h>

#include "values.h"
#include "xvrml/xscript.h"

namespace tclscript {

struct Linked; // a field or eventOut and its Tcl variable, variables.cpp

struct Timer {
  double due; // seconds of the world's time, or of a steady clock
  bool wall;
  uint64_t id;
  Object script;
};

class Interpreter {
 public:
  Interpreter(const XsHost* host, const XsScriptInfo* info);
  ~Interpreter();
  Interpreter(const Interpreter&) = delete;
  Interpreter& operator=(const Interpreter&) = delete;

  XsResult create(); // runs the program's outermost statements
  // Calls a procedure of the program if it has one of this name; arguments beyond those it takes
  // are left out.
  XsResult callProcedure(const char* name, const std::vector<Object>& arguments);
  XsResult event(const XsEvent& event);
  XsResult tick(double time);

  // --- For the commands ---
  Tcl_Interp* tcl() const { return tcl_; }
  const XsHost* host() const { return host_; }
  const XsScriptInfo& info() const { return *info_; }
  XsNode self() const { return info_->self; }
  bool trusted() const { return info_->flags & XS_TRUSTED; }
  bool hasTk() const { return Tcl_PkgPresent(tcl_, "Tk", nullptr, 0) != nullptr; }
  // False while another Script's tick serves an event of this one: Tcl has one queue for all
  // interpreters of a thread.
  bool isRunning() const { return running_ == this; }
  bool isOver() const { return stopped_ || exited_; }
  // TCL_OK, or an error with the host's reason. Ends the program if its time is up.
  int answer(XsResult result, const char* what = nullptr);
  // An event from an eventOut, a field's new value, an event to another node.
  enum class Output : uint8_t { send, write, post };
  XsResult give(Output kind, XsNode node, const char* name, Converted&& value);
  // Does this at the beginning of the next call.
  void later(XsNode node, std::string name, Object value);
  void endProgram(const char* why); // nothing of the program runs any more, no `catch` holds it
  void exit();                      // what `exit` does: ends the program, and its windows
  void report(int code,
              std::string_view script = {}); // logs the error that an evaluation ended with
  void log(int severity, uint32_t line, std::string_view text);
  // The command of a node, made when it is met first; "NULL".
  Object nodeName(XsNode node);

  std::unordered_map<XsNode, Tcl_Command> nodes; // the commands that there are
  std::vector<Timer> timers;
  uint64_t lastTimer = 0;
  std::string unfinishedLine; // of puts -nonewline

 private:
  friend struct Call;
  struct Late { // `set` of a node
    XsNode node;
    std::string name;
    Object value;
  };
  XsResult finish(int code, std::string_view script = {}); // of an evaluation
  bool isProcedure(const char* name);
  void destroyWindows();
  static void onLimit(ClientData data, Tcl_Interp* tcl);
  void startClock();

  static thread_local Interpreter* running_;
  const XsHost* host_;
  const XsScriptInfo* info_;
  Tcl_Interp* tcl_;
  Tcl_ObjCmdProc* procedure_ = nullptr; // what runs a `proc`
  std::vector<std::unique_ptr<Linked>> linked_;
  std::deque<Late> late_;
  bool stopped_ = false; // its time was up
  bool exited_ = false;
};

// --- What the other files put into an interpreter ---
void addVariables(Interpreter& interpreter,
                  std::vector<std::unique_ptr<Linked>>& linked); // variables.cpp
void addBrowser(Interpreter& interpreter);                       // browser.cpp
void addOutput(Interpreter& interpreter);                        // output.cpp: puts, exit
void addTimers(Interpreter& interpreter);                        // timers.cpp: after
void runTimers(Interpreter& interpreter, double time);
bool makeSafe(
    Interpreter& interpreter); // safe.cpp: before the others; false, with a message: it is not safe
int makeTrusted(Interpreter& interpreter); // trusted.cpp: before the others

// errors.cpp: the line of the program (from 1; 0: not known) that an error's trace leads to, and in
// which procedure it is.
struct ErrorPlace {
  uint32_t line = 0;
  std::string procedure;
};
// script: what was evaluated, if it was a piece of the program; errorLine: the line within it.
ErrorPlace errorPlace(std::string_view program, std::string_view trace, std::string_view script,
                      int errorLine);

} // namespace tclscript

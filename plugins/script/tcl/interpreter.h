// interpreter.h: Owns the state of one Script in Tcl: a Tcl interpreter, the variables of its
// fields, the commands of its nodes, its timers and its limits. engine.cpp creates one for each
// Script. [the browser's thread]
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

struct Linked; // a field or eventOut and its Tcl variable, defined in linked.h

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

  XsResult create(); // runs the program's top level
  // Calls a procedure of the program if it exists; arguments beyond those it takes are omitted.
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
  // False while another Script's tick serves an event of this one: Tcl has one event queue for all
  // interpreters of a thread.
  bool isRunning() const { return running_ == this; }
  bool isOver() const { return stopped_ || exited_; }
  // Returns TCL_OK, or TCL_ERROR with the host's reason. Ends the program if its time is up.
  int answer(XsResult result, const char* what = nullptr);
  // Sends an eventOut, writes a field, or posts an event to another node.
  enum class Output : uint8_t { send, write, post };
  XsResult give(Output kind, XsNode node, const char* name, Converted&& value);
  // Sets a node's field at the beginning of the next call.
  void postponeSet(XsNode node, std::string name, Object value);
  void endProgram(const char* why); // Stops the program for good; `catch` cannot prevent it.
  void exit();                      // Implements `exit`: ends the program and its windows.
  // Logs the error that ended an evaluation.
  void report(int code, std::string_view script = {});
  void log(int severity, uint32_t line, std::string_view text);
  // Returns the name of a node's command, which is created on first use; "NULL" for no node.
  Object nodeName(XsNode node);

  std::unordered_map<XsNode, Tcl_Command> nodes; // existing commands
  std::vector<Timer> timers;
  uint64_t lastTimer = 0;
  std::string unfinishedLine; // text of puts -nonewline

 private:
  friend struct Call;
  struct PendingSet { // A postponed `set` of a node's field.
    XsNode node;
    std::string name;
    Object value;
  };
  XsResult finish(int code, std::string_view script = {}); // handles the result of an evaluation
  bool isProcedure(const char* name);
  void destroyWindows();
  static void onLimit(ClientData data, Tcl_Interp* tcl);
  void startClock();

  static thread_local Interpreter* running_;
  const XsHost* host_;
  const XsScriptInfo* info_;
  Tcl_Interp* tcl_;
  Tcl_ObjCmdProc* procedure_ = nullptr; // the function that implements commands made by `proc`
  std::vector<std::unique_ptr<Linked>> linked_;
  std::deque<PendingSet> pendingSets_;
  bool stopped_ = false; // its time is up
  bool exited_ = false;
};

// --- Functions of the other files, which add to an interpreter ---
// in variables.cpp
void addVariables(Interpreter& interpreter, std::vector<std::unique_ptr<Linked>>& linked);
void addBrowser(Interpreter& interpreter); // in browser.cpp
void addOutput(Interpreter& interpreter);  // in output.cpp: puts, exit
void addTimers(Interpreter& interpreter);  // in timers.cpp: after
void runTimers(Interpreter& interpreter, double time);
// In safe.cpp; call it before the others. Logs a message and returns false if the interpreter is
// unsafe.
bool makeSafe(Interpreter& interpreter);
int makeTrusted(Interpreter& interpreter); // in trusted.cpp; call it before the others

// The line of the program (from 1; 0: unknown) where an error happened, and the procedure. In
// errors.cpp.
struct ErrorPlace {
  uint32_t line = 0;
  std::string procedure;
};
// Finds the place of an error from its trace. script: the evaluated text, if it was a part of the
// program; errorLine: the line within it.
ErrorPlace errorPlace(std::string_view program, std::string_view trace, std::string_view script,
                      int errorLine);

} // namespace tclscript

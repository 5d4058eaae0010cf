// interpreter.h: Runs a Script in Python: owns its module, provides the objects its functions use,
// and reports their exceptions. Every member needs Python's lock (GIL). [the browser's thread]
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <unordered_map>

#include "memory.h"
#include "runtime.h"
#include "values.h"
#include "watchdog.h"

namespace python {

class Interpreter {
 public:
  Interpreter(const XsHost* host, const XsScriptInfo* info);
  ~Interpreter();
  Interpreter(const Interpreter&) = delete;
  Interpreter& operator=(const Interpreter&) = delete;

  XsResult load(); // compiles the program and runs it as a module
  XsResult event(const XsEvent& event);
  // Calls the function without arguments, if the module has it.
  XsResult call(const char* function);

  // --- Implementation of the objects `script` and `browser`; these functions raise Python
  // exceptions ---
  // a field's value, or the last value that an eventOut sent
  py::object get(const std::string& name);
  void set(const std::string& name, const py::handle& value);
  py::list names() const;
  void post(XsNode node, const std::string& event, const py::handle& value);
  void check(XsResult result) const; // raises the exception for a result of the host
  void print(const py::args& values, const py::kwargs& options);
  const XsHost* host() const { return host_; }
  XsNode self() const { return info_.self; }
  const Nodes& nodes() const { return nodes_; }
  XsNode numberOf(const py::handle& node) const;
  py::object nodeOf(XsNode number) const;
  uintptr_t browser() const { return browser_; }

  static Interpreter* running(); // the Script whose function runs on this thread; null: none

 private:
  template <class Work> XsResult run(Work&& work);
  XsResult failed(py::error_already_set& error, bool stopped);
  std::string describe(py::error_already_set& error, uint32_t& line) const;
  void log(int32_t severity, uint32_t line, const std::string& text) const;
  const XsField* find(const std::string& name) const;
  void flushPrinted();

  const XsHost* host_;
  const XsScriptInfo& info_;
  const bool file_; // the program is in a file of its own
  uintptr_t browser_ = 0;
  Nodes nodes_;
  py::module_ binding_;
  std::unordered_map<std::string, const XsField*> fields_;
  std::string name_; // name of the module
  py::object module_;
  py::dict globals_;
  // Shared with `script` and `browser`; the pointer in it becomes null when this is destroyed.
  std::shared_ptr<Interpreter*> link_;
  Account memory_;
  std::string printed_; // a printed line that is not finished
  bool ended_ = false;  // the program has called sys.exit
};

// Creates the objects `script` and `browser` of a module.
py::object makeScriptObject(const std::shared_ptr<Interpreter*>& link);
py::object makeBrowserObject(const std::shared_ptr<Interpreter*>& link);
// Returns the Script that an object `script` represents; null for other objects.
Interpreter* scriptOf(const py::handle& object);

} // namespace python

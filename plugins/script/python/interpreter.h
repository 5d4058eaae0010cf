// interpreter.h: a Script in Python: its module, what its functions find there, and what becomes of
// their exceptions. All members with Python's lock. [the browser's thread]
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
  XsResult call(const char* function); // without arguments, if the module has one

  // --- What the objects `script` and `browser` do. Raise Python exceptions. ---
  py::object get(const std::string& name); // of a field, or what an eventOut sent last
  void set(const std::string& name, const py::handle& value);
  py::list names() const;
  void post(XsNode node, const std::string& event, const py::handle& value);
  void check(XsResult result) const; // raises what the host's answer means
  void print(const py::args& values, const py::kwargs& options);
  const XsHost* host() const { return host_; }
  XsNode self() const { return info_.self; }
  const Nodes& nodes() const { return nodes_; }
  XsNode numberOf(const py::handle& node) const;
  py::object nodeOf(XsNode number) const;
  uintptr_t browser() const { return browser_; }

  static Interpreter* running(); // whose function runs on this thread; null: none

 private:
  template <class Work> XsResult run(Work&& work);
  XsResult failed(py::error_already_set& error, bool stopped);
  std::string describe(py::error_already_set& error, uint32_t& line) const;
  void log(int32_t severity, uint32_t line, const std::string& text) const;
  const XsField* find(const std::string& name) const;
  void flushPrinted();

  const XsHost* host_;
  const XsScriptInfo& info_;
  const bool file_; // the program is a file of its own
  uintptr_t browser_ = 0;
  Nodes nodes_;
  py::module_ binding_;
  std::unordered_map<std::string, const XsField*> fields_;
  std::string name_; // of the module
  py::object module_;
  py::dict globals_;
  std::shared_ptr<Interpreter*> link_; // what `script` and `browser` hold: null once this is gone
  Account memory_;
  std::string printed_; // a line that has no end yet
  bool ended_ = false;  // by sys.exit
};

// Makes the objects `script` and `browser` of a module.
py::object makeScriptObject(const std::shared_ptr<Interpreter*>& link);
py::object makeBrowserObject(const std::shared_ptr<Interpreter*>& link);
// The Script that an object `script` stands for; null if it is none.
Interpreter* scriptOf(const py::handle& object);

} // namespace python

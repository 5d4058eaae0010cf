#include "interpreter.h"

#include <algorithm>
#include <map>
#include <utility>

namespace python {
namespace {

thread_local Interpreter* current = nullptr;

// Counts the Scripts of each browser. After the last one has ended, Python can no longer change its
// nodes.
std::map<uintptr_t, int>& scriptsOf() {
  static auto& counts = *new std::map<uintptr_t, int>();
  return counts;
}

// Assigns to a node's attribute on behalf of the Script that is running on this thread, if it
// belongs to the same world.
bool assign(uintptr_t browser, uintptr_t node, const std::string& field, const py::object& value) {
  Interpreter* const script = Interpreter::running();
  if (!script || script->browser() != browser) return false;
  const XsNode number =
      script->host()->number(script->host(), script->self(), reinterpret_cast<void*>(node));
  script->post(number, field, value);
  return true;
}

// Removes the common indentation of a program in a world's file. Its first line follows "python:".
py::object dedented(const py::object& text) {
  const py::tuple parts = text.attr("partition")("\n");
  const py::object rest = py::module_::import("textwrap").attr("dedent")(parts[2]);
  return parts[0].attr("lstrip")() + parts[1] + rest;
}

// Returns as many of the arguments as the function declares.
py::tuple fitting(const py::object& function, const py::tuple& arguments) {
  if (!PyFunction_Check(function.ptr())) return arguments;
  const py::object code = function.attr("__code__");
  const bool any = code.attr("co_flags").cast<int>() & CO_VARARGS;
  const size_t takes =
      any ? arguments.size() : std::min(arguments.size(), code.attr("co_argcount").cast<size_t>());
  py::tuple fit(takes);
  for (size_t i = 0; i < takes; ++i) fit[i] = arguments[i];
  return fit;
}

std::string textOf(const py::handle& object) {
  try {
    return fromText(py::str(object));
  } catch (py::error_already_set&) { return "(no text)"; }
}

} // namespace

Interpreter* Interpreter::running() { return current; }

Interpreter::Interpreter(const XsHost* host, const XsScriptInfo* info)
    : host_(host), info_(*info), file_(*info->scheme == 0),
      link_(std::make_shared<Interpreter*>(this)) {
  if (info_.size >= sizeof(XsScriptInfo) && info_.memory > 0)
    memory_.most = int64_t(std::min<uint64_t>(info_.memory, INT64_MAX));
  for (uint32_t i = 0; i < info_.fieldCount; ++i) fields_[info_.fields[i].name] = &info_.fields[i];
  nodes_ = {[this](XsNode number) { return nodeOf(number); },
            [this](const py::handle& node) { return numberOf(node); }};
}

Interpreter::~Interpreter() {
  *link_ = nullptr;
  if (globals_) {
    try {
      py::module_::import("sys").attr("modules").attr("pop")(name_, py::none());
      globals_.attr("clear")(); // functions and their module refer to each other
    } catch (py::error_already_set&) {}
  }
  globals_ = py::dict();
  module_ = py::none();
  if (!browser_ || --scriptsOf()[browser_] > 0) return;
  scriptsOf().erase(browser_);
  if (!binding_) return; // the binding could not be imported
  try {
    binding_.attr("_script_end")(browser_);
  } catch (py::error_already_set&) {}
}

// Runs Python code with the Script's limits of time and memory; exceptions become messages.
template <class Work> XsResult Interpreter::run(Work&& work) {
  if (ended_) return XS_OK;
  XsResult result = XS_OK;
  bool stopped = false;
  std::optional<py::error_already_set> error;
  {
    Interpreter* const outer = std::exchange(current, this);
    const Watchdog watch(host_, info_.self);
    Account* const before = chargeTo(&memory_);
    try {
      work();
    } catch (py::error_already_set& raised) {
      chargeTo(nullptr);
      error.emplace(raised);
    } catch (const std::exception& failure) {
      chargeTo(nullptr);
      log(3, 0, failure.what());
      result = XS_FAILED;
    }
    chargeTo(before);
    stopped = watch.stopped();
    current = outer;
  }
  flushPrinted();
  if (error) result = failed(*error, stopped);
  if (error || stopped) PyErr_Clear();
  return stopped ? XS_STOPPED : result;
}

XsResult Interpreter::failed(py::error_already_set& error, bool stopped) {
  uint32_t line = 0;
  const std::string text = describe(error, line);
  if (stopped) {
    log(3, line, "stopped here: the function has taken too long");
    return XS_STOPPED;
  }
  if (error.matches(PyExc_SystemExit)) {
    ended_ = true;
    log(1, line, "the Script has ended itself (" + text + ")");
    return XS_OK;
  }
  log(3, line, text);
  // Ctrl-C was meant for the whole program: interrupt it again
  if (isProgram() && error.matches(PyExc_KeyboardInterrupt)) PyErr_SetInterrupt();
  return XS_FAILED;
}

// Returns text such as "ZeroDivisionError: division by zero", and the last line of the program in
// the traceback.
std::string Interpreter::describe(py::error_already_set& error, uint32_t& line) const {
  std::string text = textOf(error.type().attr("__name__"));
  if (const std::string value = error.value() ? textOf(error.value()) : ""; !value.empty())
    text += ": " + value;
  if (error.matches(PyExc_MemoryError))
    text += memory_.most == INT64_MAX
                ? ""
                : " (a Script may use " + std::to_string(memory_.most >> 20) + " MiB)";
  try {
    if (error.matches(PyExc_SyntaxError) && error.value() &&
        textOf(error.value().attr("filename")) == info_.origin) {
      line = error.value().attr("lineno").cast<uint32_t>();
      return textOf(error.type().attr("__name__")) + ": " + textOf(error.value().attr("msg"));
    }
    std::string elsewhere;
    for (py::object at = error.trace() ? error.trace() : py::object(py::none()); !at.is_none();
         at = at.attr("tb_next")) {
      const py::object frame = at.attr("tb_frame");
      if (frame.attr("f_globals").ptr() == globals_.ptr()) {
        line = at.attr("tb_lineno").cast<uint32_t>();
        elsewhere.clear();
      } else {
        elsewhere = " (in " + textOf(frame.attr("f_code").attr("co_filename")) + ":" +
                    textOf(at.attr("tb_lineno")) + ")";
      }
    }
    return text + elsewhere;
    // the program's own exception class failed while it was formatted
  } catch (const std::exception&) { return text; }
}

void Interpreter::log(int32_t severity, uint32_t line, const std::string& text) const {
  host_->log(host_, info_.self, severity, line, {text.data(), text.size()});
}

XsResult Interpreter::load() {
  const bool shares = host_->size >= sizeof(XsHost) && host_->object && host_->number;
  browser_ = shares ? reinterpret_cast<uintptr_t>(host_->object(host_, info_.self, 0)) : 0;
  if (!browser_) {
    log(3, 0, "Scripts in Python run in the browser's own process only");
    return XS_FAILED;
  }
  ++scriptsOf()[browser_];
  try {
    binding_ = binding();
    binding_.attr("_script_assign")(py::cpp_function(assign));
    static uint64_t number = 0;
    name_ = "xvrml_script_" + std::to_string(++number);
    module_ = py::module_::import("types").attr("ModuleType")(name_);
    globals_ = module_.attr("__dict__");
    py::module_::import("sys").attr("modules")[name_.c_str()] = module_; // needed by dataclasses
    globals_["__file__"] = info_.origin;
    globals_["__builtins__"] = py::module_::import("builtins");
    globals_["script"] = makeScriptObject(link_);
    globals_["browser"] = makeBrowserObject(link_);
    const std::shared_ptr<Interpreter*> link = link_;
    globals_["print"] = py::cpp_function([link](const py::args& values, const py::kwargs& options) {
      if (*link && running() == *link) return (*link)->print(values, options);
      // called on a thread that the Script started
      py::module_::import("builtins").attr("print")(*values, **options);
    });
    if (file_) { // modules of the program are in the same folder
      const py::object folder = py::module_::import("os.path").attr("dirname")(info_.origin);
      py::list path = py::module_::import("sys").attr("path");
      if (!path.contains(folder)) path.append(folder);
    }
  } catch (const StartError& error) {
    log(3, 0, error.what());
    return XS_FAILED;
  } catch (py::error_already_set& error) { return failed(error, false); }
  return run([&] {
    py::object text = toText(info_.text);
    if (!file_) text = dedented(text);
    const py::object code =
        py::module_::import("builtins").attr("compile")(text, info_.origin, "exec");
    if (!PyEval_EvalCode(code.ptr(), globals_.ptr(), globals_.ptr())) throw py::error_already_set();
  });
}

XsResult Interpreter::event(const XsEvent& event) {
  const bool exposed = info_.fields[event.index].access == XS_EXPOSED_FIELD;
  const py::object function =
      globals_.attr("get")(exposed ? std::string("set_") + event.name : event.name);
  if (function.is_none()) return XS_OK;
  return run([&] {
    function(*fitting(function, py::make_tuple(toPython(event.value, nodes_), event.time)));
  });
}

XsResult Interpreter::call(const char* name) {
  const py::object function = globals_.attr("get")(name);
  return function.is_none() ? XS_OK : run([&] { function(); });
}

const XsField* Interpreter::find(const std::string& name) const {
  const auto found = fields_.find(name);
  return found == fields_.end() ? nullptr : found->second;
}

py::object Interpreter::get(const std::string& name) {
  const XsField* field = find(name);
  if (!field) throw py::attribute_error("the Script has no field or eventOut " + name);
  if (field->access == XS_EVENT_IN)
    throw py::attribute_error(name + " is an eventIn; its value comes to the function " + name);
  XsValue value;
  check(host_->read(host_, info_.self, info_.self, name.c_str(), &value));
  return toPython(value, nodes_);
}

void Interpreter::set(const std::string& name, const py::handle& object) {
  const XsField* field = find(name);
  if (!field) throw py::attribute_error("the Script has no field or eventOut " + name);
  if (field->access == XS_EVENT_IN)
    throw py::attribute_error(name + " is an eventIn: events come from there");
  const Owned owned(object, field->type, name, nodes_);
  const auto give = field->access == XS_EVENT_OUT ? host_->send : host_->write;
  check(give(host_, info_.self, name.c_str(), &owned.value()));
}

py::list Interpreter::names() const {
  py::list all;
  for (uint32_t i = 0; i < info_.fieldCount; ++i)
    if (info_.fields[i].access != XS_EVENT_IN) all.append(info_.fields[i].name);
  return all;
}

void Interpreter::post(XsNode node, const std::string& event, const py::handle& object) {
  XsField field;
  check(host_->findField(host_, info_.self, node, event.c_str(), &field));
  const XsType type = field.type;
  const Owned owned(object, type, event, nodes_);
  check(host_->post(host_, info_.self, node, event.c_str(), &owned.value()));
}

void Interpreter::check(XsResult result) const {
  if (result == XS_OK) return;
  if (result == XS_STOPPED && Watchdog::mustEnd()) throw py::error_already_set();
  XsString why{"", 0};
  host_->lastError(host_, info_.self, &why);
  const std::string text(why.data, why.bytes);
  if (result == XS_NO_FIELD) throw py::attribute_error(text);
  PyErr_SetString(result == XS_NOT_ALLOWED  ? PyExc_PermissionError
                  : result == XS_WRONG_TYPE ? PyExc_TypeError
                  : result == XS_NO_NODE    ? PyExc_ValueError
                                            : PyExc_RuntimeError,
                  text.c_str());
  throw py::error_already_set();
}

py::object Interpreter::nodeOf(XsNode number) const {
  if (number == 0) return py::none();
  return binding_.attr("_script_node")(
      browser_, reinterpret_cast<uintptr_t>(host_->object(host_, info_.self, number)));
}

// Accepts None, a Node, or `script`, which means the Script's own node.
XsNode Interpreter::numberOf(const py::handle& object) const {
  if (object.is_none()) return 0;
  if (const Interpreter* script = scriptOf(object); script && script->browser() == browser_)
    return script == this ? info_.self : 0;
  if (!py::isinstance(object, binding_.attr("Node")))
    throw py::type_error("a Node or None expected, not " +
                         textOf(py::type::handle_of(object).attr("__name__")));
  const auto address = binding_.attr("_script_address")(object, browser_).cast<uintptr_t>();
  return host_->number(host_, info_.self, reinterpret_cast<void*>(address));
}

void Interpreter::print(const py::args& values, const py::kwargs& options) {
  if (options.contains("file") && !options["file"].is_none()) {
    py::module_::import("builtins").attr("print")(*values, **options);
    return;
  }
  const auto option = [&](const char* name, const char* usual) {
    return options.contains(name) && !options[name].is_none() ? textOf(options[name])
                                                              : std::string(usual);
  };
  const std::string between = option("sep", " ");
  for (size_t i = 0; i < values.size(); ++i)
    printed_ += (i > 0 ? between : "") + fromText(py::str(values[i]));
  printed_ += option("end", "\n");
  for (size_t end = 0; (end = printed_.find('\n')) != printed_.npos; printed_.erase(0, end + 1))
    log(0, 0, printed_.substr(0, end));
}

void Interpreter::flushPrinted() {
  if (!printed_.empty()) log(0, 0, std::exchange(printed_, {}));
}

} // namespace python

// objects.cpp: Defines the objects `script` and `browser` of a Script in Python. Needs Python's
// lock (GIL). [the browser's thread]
#include <pybind11/pybind11.h>

#include "interpreter.h"

namespace python {
namespace {

struct Linked {
  std::shared_ptr<Interpreter*> link;
  // Returns the Script if its function is running; the host accepts calls only for that one.
  Interpreter& script() const {
    if (!*link) throw py::value_error("the Script has ended");
    if (Interpreter::running() != *link)
      throw py::value_error("no function of this Script is running");
    return **link;
  }
};
struct ScriptObject : Linked {};
struct BrowserObject : Linked {};

using TextGetter = XsResult (*XsHost::*)(const XsHost*, XsNode, XsString*);
template <TextGetter get> py::str text(const BrowserObject& self) {
  Interpreter& s = self.script();
  XsString out{"", 0};
  s.check((s.host()->*get)(s.host(), s.self(), &out));
  return toText(out);
}
using NumberGetter = double (*XsHost::*)(const XsHost*, XsNode);
template <NumberGetter get> double number(const BrowserObject& self) {
  Interpreter& s = self.script();
  return (s.host()->*get)(s.host(), s.self());
}

struct Texts {
  explicit Texts(const py::handle& object, const char* what) : texts(textsOf(object, what)) {
    for (const std::string& one : texts) strings.push_back({one.c_str(), one.size()});
  }
  std::vector<std::string> texts;
  std::vector<XsString> strings;
};

void setDescription(const BrowserObject& self, const py::str& description) {
  Interpreter& s = self.script();
  const std::string bytes = fromText(description);
  s.check(s.host()->setDescription(s.host(), s.self(), {bytes.c_str(), bytes.size()}));
}

py::object createFromString(const BrowserObject& self, const py::str& vrml) {
  Interpreter& s = self.script();
  const std::string bytes = fromText(vrml);
  XsValue made;
  s.check(s.host()->createVrmlFromString(s.host(), s.self(), {bytes.c_str(), bytes.size()}, &made));
  return toPython(made, s.nodes());
}

void createFromUrl(const BrowserObject& self, const py::object& urls, const py::object& node,
                   const std::string& event) {
  Interpreter& s = self.script();
  const Texts list(urls, "urls");
  s.check(s.host()->createVrmlFromUrl(s.host(), s.self(), uint32_t(list.strings.size()),
                                      list.strings.data(), s.numberOf(node), event.c_str()));
}

void loadUrl(const BrowserObject& self, const py::object& urls, const py::object& parameters) {
  Interpreter& s = self.script();
  const Texts list(urls, "urls"), more(parameters, "parameters");
  s.check(s.host()->loadUrl(s.host(), s.self(), uint32_t(list.strings.size()), list.strings.data(),
                            uint32_t(more.strings.size()), more.strings.data()));
}

void replaceWorld(const BrowserObject& self, const py::object& nodes) {
  Interpreter& s = self.script();
  const Owned owned(nodes, XS_MFNODE, "nodes", s.nodes());
  s.check(s.host()->replaceWorld(s.host(), s.self(), owned.value().count, owned.value().of.nodes));
}

using Router = XsResult (*XsHost::*)(const XsHost*, XsNode, XsNode, const char*, XsNode,
                                     const char*);
template <Router change> void route(const BrowserObject& self, const py::object& from,
                                    const std::string& out, const py::object& to,
                                    const std::string& in) {
  Interpreter& s = self.script();
  const XsNode source = s.numberOf(from), target = s.numberOf(to);
  s.check((s.host()->*change)(s.host(), s.self(), source, out.c_str(), target, in.c_str()));
}

void defineTypes() {
  static bool defined = false;
  if (defined) return;
  defined = true;
  const py::module_ home = py::module_::import("types").attr("ModuleType")("xvrml.script");
  home.inc_ref(); // the types live as long as the interpreter
  py::class_<ScriptObject>(
      home, "Script", py::module_local(),
      "The Script: its fields and eventOuts are attributes; assigning to an eventOut sends.")
      .def("__getattr__", [](const ScriptObject& self,
                             const std::string& name) { return self.script().get(name); })
      .def("__setattr__", [](const ScriptObject& self, const std::string& name,
                             const py::object& value) { self.script().set(name, value); })
      .def("__dir__", [](const ScriptObject& self) { return self.script().names(); });
  py::class_<BrowserObject>(home, "Browser", py::module_local(),
                            "The Browser object (4.12.10), named as in the Python binding.")
      .def_property_readonly("name", text<&XsHost::getName>)
      .def_property_readonly("version", text<&XsHost::getVersion>)
      .def_property_readonly("world_url", text<&XsHost::getWorldUrl>)
      .def_property_readonly("current_speed", number<&XsHost::getCurrentSpeed>)
      .def_property_readonly("current_frame_rate", number<&XsHost::getCurrentFrameRate>)
      .def_property_readonly("now", number<&XsHost::now>)
      .def("set_description", setDescription, py::arg("text"))
      .def("create_vrml_from_string", createFromString, py::arg("text"))
      .def("create_vrml_from_url", createFromUrl, py::arg("urls"), py::arg("node"),
           py::arg("event"))
      .def("load_url", loadUrl, py::arg("urls"), py::arg("parameters") = py::tuple())
      .def("replace_world", replaceWorld, py::arg("nodes"))
      .def("add_route", route<&XsHost::addRoute>, py::arg("from_node"), py::arg("out"),
           py::arg("to_node"), py::arg("in_"))
      .def("delete_route", route<&XsHost::deleteRoute>, py::arg("from_node"), py::arg("out"),
           py::arg("to_node"), py::arg("in_"));
}

} // namespace

py::object makeScriptObject(const std::shared_ptr<Interpreter*>& link) {
  defineTypes();
  return py::cast(ScriptObject{{link}});
}
py::object makeBrowserObject(const std::shared_ptr<Interpreter*>& link) {
  defineTypes();
  return py::cast(BrowserObject{{link}});
}
Interpreter* scriptOf(const py::handle& object) {
  return py::isinstance<ScriptObject>(object) ? *object.cast<const ScriptObject&>().link : nullptr;
}

} // namespace python

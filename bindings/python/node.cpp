// node.cpp: the Python class Node: attributes are fields, found in the type's table. Called with the GIL held.
#include <fmt/format.h>

#include "objects.h"
#include "picture/nearest.h"

using namespace xvrml;

namespace {

bool holdsValue(const FieldInfo& field) { return field.access == Access::field || field.access == Access::exposedField; }

const FieldInfo* findValue(const Node& node, const std::string& name) {
  const FieldInfo* field = node.type().find(name);
  return field && holdsValue(*field) ? field : nullptr;
}

// events: they count as fields, in a running world.
[[noreturn]] void noField(const Node& node, const std::string& name, bool events) {
  std::vector<std::string> names;
  for (const FieldInfo& field : node.type().fields)
    if (holdsValue(field) || events) names.push_back(field.name);
  const std::string near = picture::nearest(name, names);
  throw py::attribute_error(
      fmt::format("{} has no field {}{}", node.type().name, name, near.empty() ? "" : fmt::format("; did you mean {}?", near)));
}

py::object value(const NodeObject& self, const FieldInfo& field) { return toPython(self.node->get(field), self.world); }

// In a running world an eventOut's value is the last one that it sent.
py::object getAttribute(const NodeObject& self, const std::string& name) {
  if (const FieldInfo* field = findValue(*self.node, name)) return value(self, *field);
  Browser* browser = self.world->browser();
  const FieldInfo* out = browser ? self.node->type().findEventOut(name) : nullptr;
  if (!out) noField(*self.node, name, browser);
  auto lock = self.world->lock();
  return toPython(browser->get(*self.node, name), self.world);
}

// In a running world exposedFields and eventIns get an event.
void setAttribute(const NodeObject& self, const std::string& name, const py::handle& object) {
  Browser* browser = self.world->browser();
  const FieldInfo* field = findValue(*self.node, name);
  if (!field && browser) field = self.node->type().findEventIn(name);
  if (!field) noField(*self.node, name, browser);
  if (browser && scriptAssigns(self, field->name, object)) return;
  if (const char* why = self.world->frozen()) throw py::value_error(why);
  Value fresh = fromPython(object, *field, self);
  auto lock = self.world->lock();
  if (browser)
    self.world->run([&] { browser->set(*self.node, field->name, std::move(fresh)); });
  else
    self.node->set(*field, std::move(fresh));
}

// A property of Node whose name is also a field's (NavigationInfo has a field `type`): the field.
template <class Get> auto unlessField(const char* name, Get get) {
  return [name, get](const NodeObject& self) -> py::object {
    if (const FieldInfo* field = findValue(*self.node, name)) return value(self, *field);
    return get(self);
  };
}

py::object fieldTypes(const NodeObject& self) {
  py::dict types;
  for (const FieldInfo& field : self.node->type().fields)
    if (holdsValue(field)) types[toText(field.name)] = py::str(std::string(fieldTypeName(field.type)));
  return types;
}

py::list directory(const NodeObject& self) {
  py::list names;
  for (const char* name : {"node_type", "type", "fields", "def_name"}) names.append(name);
  for (const FieldInfo& field : self.node->type().fields)
    if (holdsValue(field)) names.append(toText(field.name));
  return names;
}

std::string describe(const NodeObject& self) {
  const Node& node = *self.node;
  return fmt::format("<{}{}{}>", node.defName.empty() ? "" : "DEF " + node.defName + " ", node.type().name,
                     node.source.line ? fmt::format(" at line {}", node.source.line) : "");
}

} // namespace

void defineNode(py::module_& module) {
  py::class_<NodeObject>(module, "Node",
                         "A node of a world. Its fields are attributes; reading gives a copy, assigning changes the node.")
      .def_property_readonly(
          "node_type", [](const NodeObject& self) { return toText(self.node->type().name); },
          "The name of the node's type, e.g. 'Transform'.")
      .def_property_readonly(
          "type", unlessField("type", [](const NodeObject& self) { return py::object(toText(self.node->type().name)); }),
          "node_type, but for nodes with a field of this name (NavigationInfo): that field.")
      .def_property_readonly("fields", unlessField("fields", fieldTypes), "The fields and their types, as a dict.")
      .def_property_readonly(
          "def_name", unlessField("def_name", [](const NodeObject& self) { return py::object(toText(self.node->defName)); }),
          "The node's DEF name, '' if it has none.")
      .def("__getattr__", getAttribute)
      .def("__setattr__", setAttribute)
      .def("__dir__", directory)
      .def("__repr__", [](const NodeObject& self) { return toText(describe(self)); })
      .def(
          "__eq__", [](const NodeObject& self, const NodeObject& other) { return self.node == other.node; }, py::is_operator())
      .def("__hash__", [](const NodeObject& self) { return std::hash<const void*>()(self.node.get()); });
}

// node.cpp: Implements the Python class Node and a subclass for every node type. Attributes are
// fields, looked up in the type's table. [GIL held]
#include <memory>
#include <unordered_map>

#include <fmt/format.h>

#include "objects.h"
#include "xvrml/build.h"
#include "xvrml/set_field.h"
#include "xvrml/versions.h"

using namespace xvrml;

namespace {

const FieldInfo* findValue(const Node& node, const std::string& name) {
  const FieldInfo* field = findField(node, name);
  return field && holdsValue(*field) ? field : nullptr;
}

// events: also list the eventIns and eventOuts, which are attributes in a running world.
[[noreturn]] void noField(const Node& node, const std::string& name, bool events) {
  std::vector<std::string> names;
  for (const FieldInfo& field : node.type().fields)
    if (holdsValue(field) || events) names.emplace_back(fieldName(node, field));
  throw py::attribute_error(
      fmt::format("{} has no field {}{}", node.type().name, name, didYouMean(name, names)));
}

py::object value(const NodeObject& self, const FieldInfo& field) {
  const WorldPtr world = self.world();
  const auto lock = world->lockGraph();
  return fieldToPython(self, field);
}

// Returns the value of a field. In a running world, an eventOut's value is the last one that it
// sent.
py::object getAttribute(const NodeObject& self, const std::string& name) {
  if (const FieldInfo* field = findValue(*self.node, name)) return value(self, *field);
  const WorldPtr world = self.world();
  Browser* browser = world->browser();
  const FieldInfo* out = browser ? findEventOut(*self.node, name) : nullptr;
  if (!out) noField(*self.node, name, browser);
  const auto lock = world->lockGraph();
  return toPython(browser->get(*self.node, name), world);
}

// Returns whether a node in the body of an instance receives a value of the interface only as an
// event: a Script's eventIn.
bool takesEvent(const ProtoInstance& instance, const std::string& name) {
  for (const IsConnection& connection : instance.is) {
    if (connection.interfaceName != name) continue;
    const FieldInfo* in = connection.node->type().findEventIn(connection.field);
    const auto* inner = nodeCast<ProtoInstance>(connection.node);
    if ((in && in->access == Access::eventIn) || (inner && takesEvent(*inner, connection.field)))
      return true;
  }
  return false;
}

// Sets a field of a static world, as if the file contained the value.
void setStaticField(WorldObject& world, const NodeRef& node, const FieldInfo& field, Value value) {
  const auto* instance = nodeCast<ProtoInstance>(node);
  if (!world.world) {
    node->set(field, std::move(value));
    return;
  }
  {
    const ReleaseGil release; // an Inline reads a file
    setField(*world.world, *node, field.name, std::move(value));
  }
  if (instance && field.access == Access::exposedField && takesEvent(*instance, field.name))
    world.initialEvents.emplace_back(node, field.name);
}

// Sets a field. In a running world, exposedFields and eventIns receive an event.
void setAttribute(const NodeObject& self, const std::string& name, const py::handle& given) {
  // A sequence that makes its nodes when they are asked is asked once.
  const bool lazy = PySequence_Check(given.ptr()) && !PyUnicode_Check(given.ptr()) &&
                    !PyTuple_Check(given.ptr()) && !PyList_Check(given.ptr());
  const FieldInfo* declared = findValue(*self.node, name);
  py::object object = py::reinterpret_borrow<py::object>(given);
  if (lazy && declared && declared->type == FieldType::MFNode) object = py::tuple(object);
  const WorldPtr world = self.world();
  Browser* browser = world->browser();
  const FieldInfo* field = findValue(*self.node, name);
  if (!field && browser) field = findEventIn(*self.node, name);
  if (!field) noField(*self.node, name, browser);
  if (browser && scriptAssigns(self, field->name, object)) return;
  if (const char* why = world->frozen()) throw py::value_error(why);
  Value fresh = fromPython(object, *field, self);
  const bool nodes = field->type == FieldType::SFNode || field->type == FieldType::MFNode;
  const auto lock = world->lock();
  WorldPtr now = world;
  WorldObject::Changing also;
  if (nodes) {
    refuseLoops(self, *field, fresh);
    joinWorlds(self, object);
    now = self.world();
    if (now != world) also = now->lock(); // a loose node has joined a world, which may be running
    browser = now->browser();
  }
  if (now->openSteps > 0) {
    if (nodes)
      throw EditError("within a step, nodes are inserted, moved and removed by World.edit");
    return now->change([&] { now->editor->set(*self.node, field->name, std::move(fresh)); });
  }
  if (browser)
    now->change([&] { browser->set(*self.node, field->name, std::move(fresh)); });
  else
    setStaticField(*now, self.node, *field, std::move(fresh));
}

// Returns the field if the node has a field of that name, otherwise Node's property (NavigationInfo
// has a field `type`).
template <class Get> auto unlessField(const char* name, Get get) {
  return [name, get](const NodeObject& self) -> py::object {
    if (const FieldInfo* field = findValue(*self.node, name)) return value(self, *field);
    return get(self);
  };
}

py::object fieldTypes(const NodeObject& self) {
  py::dict types;
  for (const FieldInfo& field : self.node->type().fields)
    if (holdsValue(field))
      types[toText(std::string(fieldName(*self.node, field)))] =
          py::str(std::string(fieldTypeName(field.type)));
  return types;
}

py::list directory(const NodeObject& self) {
  py::list names;
  for (const char* name : {"node_type", "type", "fields", "def_name"}) names.append(name);
  for (const FieldInfo& field : self.node->type().fields)
    if (holdsValue(field)) names.append(toText(std::string(fieldName(*self.node, field))));
  return names;
}

std::string describe(const NodeObject& self) {
  const Node& node = *self.node;
  return fmt::format("<{}{}{}>", node.defName.empty() ? "" : "DEF " + node.defName + " ",
                     node.type().name,
                     node.source.line ? fmt::format(" at line {}", node.source.line) : "");
}

// Classes by node type, owned by the module for the life of the interpreter. A plug-in's classes
// are made when it is loaded.
auto& classes() {
  static auto& all = *new std::unordered_map<const NodeType*, PyTypeObject*>();
  return all;
}
PyTypeObject* nodeClass = nullptr;

std::string description(const NodeType& type) {
  std::string text = type.text + "\n";
  if (!type.clause.empty())
    text += fmt::format("{} clause {}.\n", standardName(type.standard), type.clause);
  text += "\n";
  for (const FieldInfo& field : type.fields) {
    const char* kind[] = {"field", "exposedField", "eventIn", "eventOut"};
    text += fmt::format("{} ({} {}): {}\n", field.name, kind[size_t(field.access)],
                        fieldTypeName(field.type), field.text);
  }
  return text;
}

PyTypeObject* classOf(const NodeType& type) {
  if (type.index < 0) return nodeClass; // nodes of prototypes and Scripts have the class Node
  if (!type.create) return classOf(*nodeTypes()[size_t(type.index)]); // a node's own type
  PyTypeObject*& known = classes()[&type];
  if (known) return known;
  py::dict members;
  members["__slots__"] = py::tuple();
  members["__doc__"] = toText(description(type));
  members["__module__"] = "xvrml";
  const py::handle base(reinterpret_cast<PyObject*>(nodeClass));
  py::object made = py::reinterpret_borrow<py::object>(py::type::handle_of(base))(
      toText(type.name), py::make_tuple(base), members);
  return known = reinterpret_cast<PyTypeObject*>(made.release().ptr());
}

py::dict nodeClasses() {
  py::dict all;
  for (const NodeType* type : nodeTypes())
    all[toText(type->name)] =
        py::reinterpret_borrow<py::object>(reinterpret_cast<PyObject*>(classOf(*type)));
  return all;
}

// The constructor of all classes; keywords are fields. The node is in no world until it is added to
// one.
void makeLoose(py::detail::value_and_holder& self, const py::kwargs& fields) {
  const NodeType* type = nullptr;
  for (PyTypeObject* one = Py_TYPE(self.inst); one && !type; one = one->tp_base)
    for (const auto& [known, its] : classes())
      if (its == one) type = known;
  if (!type)
    throw py::type_error(
        "Node is the class of all nodes: make one of a type, as xvrml.Box(size=(1, 2, 3))");
  NodeRef node = makeNode(*type);
  if (!node) throw py::type_error(type->name + " nodes come from files alone");
  auto made = std::make_unique<NodeObject>(std::make_shared<WorldObject>(), std::move(node));
  made->isUnowned = true;
  for (const auto& [name, value] : fields) setAttribute(*made, fromText(name), value);
  self.value_ptr() = made.release();
}

} // namespace

py::object asNode(const WorldPtr& world, const NodeRef& node) {
  if (!node) return py::none();
  PyTypeObject* type = classOf(node->type());
  auto made = py::reinterpret_steal<py::object>(type->tp_new(type, py::tuple().ptr(), nullptr));
  if (!made) throw py::error_already_set();
  // Create the instance in the same way as pybind11.
  static const py::detail::type_info* info = py::detail::get_type_info(typeid(NodeObject), true);
  auto* instance = reinterpret_cast<py::detail::instance*>(made.ptr());
  instance->get_value_and_holder(info).value_ptr() = new NodeObject(world, node);
  info->init_instance(instance, nullptr);
  return made;
}

void defineNode(py::module_& module) {
  py::class_<NodeObject> all(
      module, "Node",
      "A node. Its fields are attributes, and assigning to an attribute changes the node. Lists of "
      "numbers are read-only arrays: snapshots of the current value.");
  nodeClass = reinterpret_cast<PyTypeObject*>(all.ptr());
  module.def("_node_classes", nodeClasses);
  all.def("__init__", makeLoose, py::detail::is_new_style_constructor())
      .def_property_readonly(
          "node_type", [](const NodeObject& self) { return toText(self.node->type().name); },
          "The name of the node's type, e.g. 'Transform'.")
      .def_property_readonly("type",
                             unlessField("type",
                                         [](const NodeObject& self) {
                                           return py::object(toText(self.node->type().name));
                                         }),
                             "The name of the node's type, like node_type. For nodes with a field "
                             "called type (NavigationInfo), the value of that field.")
      .def_property_readonly("fields", unlessField("fields", fieldTypes),
                             "A dict of the names and types of the fields.")
      .def_property_readonly("def_name",
                             unlessField("def_name",
                                         [](const NodeObject& self) {
                                           return py::object(toText(self.node->defName));
                                         }),
                             "The node's DEF name, '' if it has none.")
      .def("__getattr__", getAttribute)
      .def("__setattr__", setAttribute)
      .def("__dir__", directory)
      .def("__repr__", [](const NodeObject& self) { return toText(describe(self)); })
      .def(
          "__eq__",
          [](const NodeObject& self, const NodeObject& other) { return self.node == other.node; },
          py::is_operator())
      .def("__hash__",
           [](const NodeObject& self) { return std::hash<const void*>()(self.node.get()); });
}

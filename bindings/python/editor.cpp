// editor.cpp: Implements the Python class Editor, which edits the file of a world. [GIL held]
#include <fmt/format.h>

#include <pybind11/stl.h>

#include "libpicture/files/save_edits.h"
#include "objects.h"
#include "xvrml/edit.h"
#include "xvrml/versions.h"

using namespace xvrml;

namespace {

struct EditorObject {
  WorldPtr world;
};
struct StepObject {
  WorldPtr world;
  std::string name;
};

Editor& editorOf(const WorldPtr& world) {
  if (!world->editor) {
    if (Browser* browser = world->browser())
      world->editor = std::make_shared<Editor>(*browser);
    else
      world->editor = std::make_shared<Editor>(world->graph());
  }
  return *world->editor;
}

// Runs an edit without the GIL, then the callbacks of the events that it causes.
template <class Work> void edit(const EditorObject& self, const Work& work) {
  const auto lock = self.world->lock();
  Editor& editor = editorOf(self.world);
  self.world->change([&] { work(editor); });
}

Node& own(const EditorObject& self, const NodeObject& node) {
  if (!sameWorld(node.world(), self.world)) throw py::value_error("a node of this world expected");
  return *node.node;
}

// Returns the place of a node: the only one, or the only one in this parent and field.
NodeSlot placeOf(const EditorObject& self, const NodeObject& node, const NodeObject* parent,
                 const std::string& field) {
  Node& wanted = own(self, node);
  Node* const within = parent ? &own(self, *parent) : nullptr;
  const auto lock = self.world->lockGraph();
  std::vector<NodeSlot> places = editorOf(self.world).placesOf(wanted);
  std::erase_if(places, [&](const NodeSlot& place) {
    return (within && place.parent != within) ||
           (!field.empty() &&
            place.field != (place.parent ? ownName(*place.parent, field) : field));
  });
  if (places.size() == 1) return places.front();
  throw EditError(places.empty()
                      ? "the node does not stand in the world's own file"
                      : fmt::format("the node stands in {} places: say which by parent and field",
                                    places.size()));
}

// Returns the place that a node is put to. index: none appends.
NodeSlot targetOf(const EditorObject& self, const NodeObject* parent, const std::string& field,
                  std::optional<size_t> index) {
  NodeSlot slot{parent ? &own(self, *parent) : nullptr, "", index.value_or(0)};
  if (slot.parent) slot.field = ownName(*slot.parent, field);
  if (index) return slot;
  const auto lock = self.world->lockGraph();
  if (!slot.parent) {
    slot.index = self.world->graph().scope.roots.size();
  } else if (const FieldInfo* info = slot.parent->type().find(slot.field);
             info && info->type == FieldType::MFNode && holdsValue(*info)) {
    slot.index = static_cast<const MFNode*>(slot.parent->storage(*info))->size();
  }
  return slot;
}

py::object insert(const EditorObject& self, const std::string& text, const NodeObject* parent,
                  const std::string& field, std::optional<size_t> index) {
  const NodeSlot slot = targetOf(self, parent, field, index);
  NodeRef made;
  edit(self, [&](Editor& editor) { made = editor.insert(slot, text); });
  return asNode(self.world, made);
}

void use(const EditorObject& self, const NodeObject& node, const NodeObject* parent,
         const std::string& field, std::optional<size_t> index) {
  const NodeSlot slot = targetOf(self, parent, field, index);
  Node& used = own(self, node);
  edit(self, [&](Editor& editor) { editor.use(slot, used); });
}

void removeNode(const EditorObject& self, const NodeObject& node, const NodeObject* parent,
                const std::string& field) {
  const NodeSlot slot = placeOf(self, node, parent, field);
  edit(self, [&](Editor& editor) { editor.remove(slot); });
}

void move(const EditorObject& self, const NodeObject& node, const NodeObject* parent,
          const std::string& field, std::optional<size_t> index) {
  const NodeSlot from = placeOf(self, node, nullptr, "");
  NodeSlot to = targetOf(self, parent, field, index);
  // The place is counted without the node.
  if (!index && from.parent == to.parent && from.field == to.field && to.index > 0) --to.index;
  edit(self, [&](Editor& editor) { editor.move(from, to); });
}

py::object duplicate(const EditorObject& self, const NodeObject& node, const NodeObject* parent,
                     const std::string& field) {
  const NodeSlot slot = placeOf(self, node, parent, field);
  NodeRef made;
  edit(self, [&](Editor& editor) { made = editor.duplicate(slot); });
  return asNode(self.world, made);
}

py::object wrap(const EditorObject& self, const NodeObject& node, const std::string& type) {
  const NodeSlot slot = placeOf(self, node, nullptr, "");
  NodeRef made;
  edit(self, [&](Editor& editor) { made = editor.wrap(slot, type); });
  return asNode(self.world, made);
}

void route(const EditorObject& self, const NodeObject& from, const std::string& out,
           const NodeObject& to, const std::string& in, bool add) {
  Node &source = own(self, from), &target = own(self, to);
  edit(self, [&](Editor& editor) {
    add ? editor.addRoute(source, out, target, in) : editor.removeRoute(source, out, target, in);
  });
}

py::object nameOrNone(const std::string& name, bool any) {
  return any ? py::object(toText(name)) : py::none();
}

py::object step(const EditorObject& self, bool again) {
  std::string name;
  bool any = false;
  edit(self, [&](Editor& editor) {
    name = again ? editor.redoName() : editor.undoName();
    any = again ? editor.redo() : editor.undo();
  });
  return nameOrNone(name, any);
}

void save(const EditorObject& self, const py::object& given, bool overwrite) {
  const std::string path = given.is_none() ? "" : toPath(given);
  if (self.world->openSteps > 0) throw EditError("a step is open: save after its block");
  std::string failure;
  edit(self, [&](Editor& editor) {
    try {
      picture::saveEdits(editor, self.world->graph(), path, overwrite);
    } catch (const EditError&) { throw; } catch (const std::runtime_error& error) {
      failure = error.what();
    }
  });
  raiseOsError(failure);
}

void enter(const StepObject& self) {
  const auto lock = self.world->lock();
  editorOf(self.world).begin(self.name);
  ++self.world->openSteps;
}

void leave(const StepObject& self, const py::object& failure, const py::object&,
           const py::object&) {
  const auto lock = self.world->lock();
  --self.world->openSteps;
  Editor& editor = editorOf(self.world);
  self.world->change([&] { failure.is_none() ? editor.end() : editor.cancel(); });
}

} // namespace

void defineEditor(py::module_& module, py::object worldClass) {
  py::register_exception<EditError>(module, "EditError", PyExc_ValueError);
  py::class_<StepObject>(module, "EditStep", "A step of edits, for a with statement.")
      .def("__enter__", enter)
      .def("__exit__", leave);
  const auto parent = py::arg("parent") = py::none();
  const auto children = py::arg("field") = "children";
  const auto index = py::arg("index") = py::none();
  py::class_<EditorObject>(
      module, "Editor",
      "Edits the file of a world (World.edit). Each edit changes the world at once and can be "
      "undone; save() writes the file, in which only the edited parts differ.")
      .def(
          "__call__",
          [](const EditorObject& self, const std::string& name) {
            return StepObject{self.world, name};
          },
          py::arg("name"),
          "Returns a step for a with statement. Within it, assigning to a node's attributes edits "
          "the file. An exception undoes the step.")
      .def(
          "set",
          [](const EditorObject& self, const NodeObject& node, const std::string& field,
             const py::object& value) {
            Node& target = own(self, node);
            const FieldInfo* const info = findField(target, field);
            if (!info)
              throw EditError(fmt::format("there is no field {}.{}", target.type().name, field));
            Value converted = fromPython(value, *info, node);
            edit(self,
                 [&](Editor& editor) { editor.set(target, info->name, std::move(converted)); });
          },
          py::arg("node"), py::arg("field"), py::arg("value"), "Sets a field that holds no nodes.")
      .def("insert", insert, py::arg("text"), parent, children, index,
           "Inserts a node that is given as text, such as 'Shape { geometry Box { } }' or, in a "
           "file of XML, '<Shape><Box/></Shape>', and returns it. parent: None for the top of the "
           "file. index: None for the end.")
      .def("use", use, py::arg("node"), parent, children, index,
           "Lets a node stand at a further place (USE).")
      .def("remove", removeNode, py::arg("node"), parent, py::arg("field") = "",
           "Removes a node. parent and field say where, if it stands in several places.")
      .def("move", move, py::arg("node"), parent, children, index,
           "Moves a node. The index is counted without it.")
      .def("duplicate", duplicate, py::arg("node"), parent, py::arg("field") = "",
           "Inserts a copy of a node behind it, and returns the copy.")
      .def("wrap", wrap, py::arg("node"), py::arg("type") = "Transform",
           "Puts a grouping node around a node, and returns the grouping node.")
      .def(
          "rename",
          [](const EditorObject& self, const NodeObject& node, const std::string& name) {
            Node& target = own(self, node);
            edit(self, [&](Editor& editor) { editor.rename(target, name); });
          },
          py::arg("node"), py::arg("name"), "Gives a node a DEF name, or another one.")
      .def(
          "add_route",
          [](const EditorObject& self, const NodeObject& from, const std::string& out,
             const NodeObject& to, const std::string& in) { route(self, from, out, to, in, true); },
          py::arg("from_node"), py::arg("out"), py::arg("to_node"), py::arg("in_"),
          "Adds a route to the file.")
      .def(
          "delete_route",
          [](const EditorObject& self, const NodeObject& from, const std::string& out,
             const NodeObject& to,
             const std::string& in) { route(self, from, out, to, in, false); },
          py::arg("from_node"), py::arg("out"), py::arg("to_node"), py::arg("in_"),
          "Removes a route from the file.")
      .def(
          "undo", [](const EditorObject& self) { return step(self, false); },
          "Undoes the last step. Returns its name, None if there is none.")
      .def(
          "redo", [](const EditorObject& self) { return step(self, true); },
          "Does the step again that was undone last. Returns its name, None if there is none.")
      .def_property_readonly(
          "changed", [](const EditorObject& self) { return editorOf(self.world).isChanged(); },
          "Whether there are edits that have not been saved.")
      .def_property_readonly(
          "read_only",
          [](const EditorObject& self) {
            const auto lock = self.world->lock();
            const std::string reason = editorOf(self.world).whyReadOnly();
            return nameOrNone(reason, !reason.empty());
          },
          "Why the file cannot be edited; None if it can.")
      .def(
          "text",
          [](const EditorObject& self) {
            std::string text;
            edit(self, [&](Editor& editor) { text = editor.text(); });
            return toText(text);
          },
          "Returns the text of the file with all edits.")
      .def("save", save, py::arg("path") = py::none(), py::kw_only(), py::arg("overwrite") = false,
           "Writes the file; with a path, another one. Raises EditError if another program has "
           "written to the file since, unless overwrite is True.");
  worldClass.attr("edit") = py::reinterpret_borrow<py::object>(reinterpret_cast<PyObject*>(
      &PyProperty_Type))(py::cpp_function([](const WorldPtr& self) {
                           self->graph(); // raises ValueError for loose nodes
                           return EditorObject{self};
                         }),
                         py::none(), py::none(), "Edits the file of the world: an Editor.");
}

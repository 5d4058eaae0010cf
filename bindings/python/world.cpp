// world.cpp: Implements the Python class World: names, problems, contents, events, writing. [GIL
// held; released for long operations]
#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "arrays.h"
#include "libpicture/bare_model.h"
#include "libpicture/export/export.h"
#include "libpicture/files/atomic_file.h"
#include "objects.h"
#include "xvrml/versions.h"

using namespace xvrml;

namespace {

const char* severityName(Severity severity) {
  switch (severity) {
  case Severity::note: return "note";
  case Severity::warning: return "warning";
  case Severity::error: break;
  }
  return "error";
}

py::object getNode(const WorldPtr& self, const std::string& name) {
  const auto& names = self->graph().scope.names;
  auto found = names.find(name);
  if (found != names.end()) return asNode(self, found->second);
  std::vector<std::string> known;
  for (const auto& [one, node] : names) known.push_back(one);
  throw py::key_error(fmt::format("no node is called {}{}", name, didYouMean(name, known)));
}

py::tuple names(const WorldPtr& self) {
  py::list out;
  for (const auto& [name, node] : self->graph().scope.names) out.append(toText(name));
  return py::tuple(out);
}

py::tuple roots(const WorldPtr& self) {
  py::list out;
  for (const NodeRef& root : self->graph().scope.roots) out.append(asNode(self, root));
  return py::tuple(out);
}

std::vector<Diagnostic> warnings(const WorldPtr& self) {
  const auto lock = self->lockDrawing();
  return self->graph().diagnostics.list();
}

picture::RenderSettings withoutPicture() {
  picture::RenderSettings settings;
  settings.backend = "null";
  return settings;
}

// Returns the viewpoints. In Python a viewpoint's matrix is its own pose, from which
// render(viewpoint=...) looks, instead of its parent's matrix.
std::vector<ViewpointInfo> viewpoints(const WorldPtr& self) {
  std::vector<ViewpointInfo> list;
  const auto lock = self->lock();
  interruptible([&](picture::ProgressCallback watch) {
    picture::Renderer renderer(self->graph(), withoutPicture(), std::move(watch));
    list = renderer.viewpoints();
    picture::View view;
    view.up = Axis::y; // avoids guessing the up axis from the world's extent for each viewpoint
    for (size_t i = 0; i < list.size(); ++i) {
      view.viewpoint = i;
      std::ranges::copy(renderer.placeOf(view).camera.matrix, list[i].matrix);
    }
  });
  return list;
}

py::str toVrml(const WorldPtr& self) {
  const auto lock = self->lockGraph();
  return toText(writeWorld(self->graph()));
}

py::str toX3d(const WorldPtr& self, const std::string& encoding) {
  const std::pair<const char*, Encoding> encodings[] = {
      {"xml", Encoding::x3dXml}, {"classic", Encoding::x3dClassic}, {"json", Encoding::x3dJson}};
  for (const auto& [name, as] : encodings) {
    if (encoding != name) continue;
    const auto lock = self->lockGraph();
    return toText(writeWorld(self->graph(), "", as));
  }
  throw py::value_error(
      fmt::format("encoding: 'xml', 'classic' or 'json' expected, not '{}'", encoding));
}

void save(const WorldPtr& self, const py::object& file) {
  const std::string path = toPath(file);
  std::string failure;
  const auto lock = self->lockGraph();
  World& world = self->graph();
  {
    const ReleaseGil release;
    try {
      if (const picture::ExportFormat* format = picture::exportFormatOf(path)) {
        const picture::Exported exported = format->make(world, {path, ""});
        picture::writeExported(exported);
        for (const std::string& remark : exported.remarks) world.diagnostics.warn({}, remark);
      } else {
        picture::writeFile(path, writeWorld(world, path));
        for (const std::string& change : changesByWriting(world, path, writtenEncoding(path)))
          world.diagnostics.warn({}, change);
        if (const std::string change = picture::changeOfLook(world); !change.empty())
          world.diagnostics.warn({}, change);
      }
    } catch (const std::runtime_error& error) { failure = error.what(); }
  }
  raiseOsError(failure);
}

double now(const WorldPtr& self) { return self->browser() ? self->browser()->now() : 0; }

void setTime(const WorldPtr& self, double time) {
  Browser& browser = self->live();
  const auto lock = self->lock();
  if (!(time < latestTime)) // rejects NaN too
    throw py::value_error(
        fmt::format("time: a number of seconds below {} expected, not {}", latestTime, time));
  if (time < browser.now())
    throw py::value_error(
        fmt::format("time: from {} on expected, not {}: it does not go back", browser.now(), time));
  self->change([&] { browser.tick(time); });
}

Node& own(const WorldPtr& self, const NodeObject& node) {
  if (!sameWorld(node.world(), self)) throw py::value_error("a node of this world expected");
  return *node.node;
}

std::string nearestEvent(const Node& node, const std::string& name, bool out) {
  std::vector<std::string> known;
  for (const FieldInfo& field : node.type().fields)
    if (field.access == Access::exposedField ||
        field.access == (out ? Access::eventOut : Access::eventIn))
      known.emplace_back(fieldName(node, field));
  return didYouMean(name, known);
}

uint64_t listen(const WorldPtr& self, const NodeObject& object, const std::string& event,
                py::function function) {
  Node& from = own(self, object);
  if (!findEventOut(from, event))
    throw py::attribute_error(fmt::format("{} has no eventOut {}{}", from.type().name, event,
                                          nearestEvent(from, event, true)));
  return self->listen(object.node, event, std::move(function));
}

// Adds or removes a route; the list that is written changes too.
bool route(const WorldPtr& self, const NodeObject& from, const std::string& out,
           const NodeObject& to, const std::string& in, bool add) {
  Node &source = own(self, from), &target = own(self, to);
  const FieldInfo *sends = findEventOut(source, out), *takes = findEventIn(target, in);
  if (!sends)
    throw py::attribute_error(fmt::format("{} has no eventOut {}{}", source.type().name, out,
                                          nearestEvent(source, out, true)));
  if (!takes)
    throw py::attribute_error(fmt::format("{} has no eventIn {}{}", target.type().name, in,
                                          nearestEvent(target, in, false)));
  if (sends->type != takes->type)
    throw py::type_error(fmt::format("{} is {}, {} is {}", out, fieldTypeName(sends->type), in,
                                     fieldTypeName(takes->type)));
  const auto lock = self->lock();
  std::vector<Route>& written = self->graph().scope.routes;
  const auto found = std::find_if(written.begin(), written.end(), [&](const Route& r) {
    return r.from == from.node && r.to == to.node &&
           source.type().findEventOut(r.fromField) == sends &&
           target.type().findEventIn(r.toField) == takes;
  });
  bool done = add || found != written.end();
  if (Browser* browser = self->browser())
    self->change([&] {
      done = add ? browser->addRoute(source, out, target, in)
                 : browser->deleteRoute(source, out, target, in);
    });
  if (!add && found != written.end()) written.erase(found);
  if (add && done && found == written.end())
    written.push_back({from.node,
                       std::string(ownName(source, out)),
                       to.node,
                       std::string(ownName(target, in)),
                       {}});
  return done;
}

// Names a node, or renames it, as DEF does in a file.
void setName(const WorldPtr& self, const NodeObject& node, const std::string& name) {
  auto& names = self->graph().scope.names;
  constexpr std::string_view keywords[] = {"DEF",     "EXTERNPROTO", "FALSE", "IS",          "NULL",
                                           "PROTO",   "ROUTE",       "TO",    "TRUE",        "USE",
                                           "eventIn", "eventOut",    "field", "exposedField"};
  const auto cannotBeIn = [](unsigned char c) { // Annex A.3
    return c <= ' ' || c == 0x7f ||
           std::string_view(",\"'#.[]\\{}").find(char(c)) != std::string_view::npos;
  };
  const bool good = !name.empty() && std::ranges::none_of(name, cannotBeIn) &&
                    std::string_view("+-0123456789").find(name[0]) == std::string_view::npos &&
                    std::ranges::find(keywords, name) == std::end(keywords);
  if (!good)
    throw py::value_error(
        fmt::format("name: {} cannot be a DEF name", std::string(py::repr(py::str(name)))));
  if (const auto found = names.find(name); found != names.end() && found->second != node.node)
    throw py::value_error(fmt::format("name: the world has a node called {}", name));
  if (const auto former = names.find(node.node->defName);
      former != names.end() && former->second == node.node)
    names.erase(former);
  node.node->defName = name;
  names[name] = node.node;
}

const NodeObject& add(const WorldPtr& self, const NodeObject& added,
                      const std::optional<std::string>& name) {
  const WorldPtr from = added.world();
  self->graph(); // raises ValueError for loose nodes
  if (!from->loose() && !sameWorld(from, self))
    throw py::value_error("the node is in another world");
  const Node* drawn = renderedNode(added.node.get());
  if (drawn && !drawn->type().is("child") && !added.node->type().is("child"))
    throw py::value_error(
        fmt::format("add(): node: {} cannot stand at the root of a world: a child "
                    "node expected (4.6.5)",
                    added.node->type().name));
  const auto lock = self->lock();
  if (name) setName(self, added, *name);
  if (from->loose()) from->joined = self;
  if (Browser* browser = self->browser()) {
    self->change([&] { browser->addRoot(added.node); });
    return added;
  }
  World& world = self->graph();
  auto& roots = world.scope.roots;
  if (std::find(roots.begin(), roots.end(), added.node) == roots.end()) roots.push_back(added.node);
  world.edited = true;
  return added;
}

void removeNode(const WorldPtr& self, const NodeObject& removed) {
  Node& node = own(self, removed);
  const auto lock = self->lock();
  if (Browser* browser = self->browser()) return self->change([&] { browser->removeRoot(node); });
  World& world = self->graph();
  std::erase(world.scope.roots, removed.node);
  world.edited = true;
}

WorldPtr emptyWorld() {
  auto made = std::make_shared<WorldObject>();
  made->world = std::make_unique<World>();
  made->world->path = "<memory>";
  return made;
}

// Rejects unknown attributes; a misspelt name would be stored without any effect.
void setAttribute(const py::object& self, const py::str& name, const py::object& value) {
  const py::handle type = py::type::handle_of(self);
  const bool ours = std::string(py::str(type.attr("__module__"))).starts_with("xvrml");
  if (ours && !py::hasattr(type, name) && fromText(name) != "__dict__") {
    std::vector<std::string> known;
    for (const py::handle one : py::reinterpret_steal<py::list>(PyObject_Dir(type.ptr())))
      if (!fromText(one).starts_with("_")) known.push_back(fromText(one));
    throw py::attribute_error(fmt::format("a World has no attribute {}{}", fromText(name),
                                          didYouMean(fromText(name), known)));
  }
  if (PyObject_GenericSetAttr(self.ptr(), name.ptr(), value.ptr()) != 0)
    throw py::error_already_set();
}

} // namespace

size_t applyRules(const WorldPtr& self, const std::vector<picture::ShaderRule>& rules) {
  const auto lock = self->lock();
  World& world = self->graph();
  size_t given = 0;
  try {
    if (Browser* browser = self->browser())
      self->change([&] {
        given = picture::applyShaderRules(rules, "", world,
                                          [&](Node& shape, const NodeRef& appearance) {
                                            browser->set(shape, "appearance", appearance);
                                          });
      });
    else
      given = picture::applyShaderRules(rules, "", world);
  } catch (const picture::ShaderError& error) { throw py::value_error(error.what()); }
  self->shadersGiven = self->shadersGiven || given > 0;
  return given;
}

namespace {

size_t setShader(const WorldPtr& self, const std::string& selector, const std::string& shader) {
  if (selector.empty() || selector.find('=') != selector.npos)
    throw py::value_error(
        fmt::format("selector: a DEF name, material:GLOB, appearance:GLOB, shape:GLOB, kicad:GLOB, "
                    "colour:R,G,B or * was expected, not {}",
                    std::string(py::repr(py::str(selector)))));
  return applyRules(self, {{selector + "=" + shader, "set_shader:", {}, false}});
}

} // namespace

void defineWorld(py::module_& module) {
  py::class_<Diagnostic>(module, "Diagnostic",
                         "A problem found in a world, with its file, line and column.")
      .def_property_readonly("severity",
                             [](const Diagnostic& d) { return severityName(d.severity); })
      .def_property_readonly("file", [](const Diagnostic& d) { return toText(d.file); })
      .def_readonly("line", &Diagnostic::line)
      .def_readonly("column", &Diagnostic::column)
      .def_property_readonly("message", [](const Diagnostic& d) { return toText(d.message); })
      .def("__str__", [](const Diagnostic& d) { return toText(d.text()); })
      .def("__repr__", [](const Diagnostic& d) {
        return toText("<" + d.text().substr(0, d.text().find('\n')) + ">");
      });
  py::class_<ViewpointInfo>(module, "ViewpointInfo", "A viewpoint of a world.")
      .def_property_readonly(
          "name", [](const ViewpointInfo& v) { return toText(v.name); },
          "DEF name, '' if it has none.")
      .def_property_readonly("description",
                             [](const ViewpointInfo& v) { return toText(v.description); })
      .def_property_readonly(
          "matrix", [](const ViewpointInfo& v) { return matrixArray(v.matrix); },
          "The pose: camera to world, 4x4 for column vectors, looking along -z "
          "with +y up. render(camera=...) accepts it.")
      .def("__repr__", [](const ViewpointInfo& v) {
        return toText("<Viewpoint " + (v.name.empty() ? v.description : v.name) + ">");
      });
  py::class_<WorldObject, WorldPtr> world(
      module, "World",
      "A world. World() is an empty one. world['NAME'] is the node with the DEF name NAME. The "
      "world is static until its time or its events are used.",
      py::dynamic_attr());
  world.def(py::init(&emptyWorld))
      .def_property_readonly(
          "path", [](const WorldPtr& self) { return toText(self->graph().path); },
          "The file that the world was loaded from.")
      .def_property_readonly("warnings", warnings,
                             "All problems found so far, errors included, in order.")
      .def_property_readonly("names", names, "The DEF names of the file.")
      .def_property_readonly("roots", roots, "The nodes at the top level of the file.")
      .def_property_readonly("viewpoints", viewpoints, "The viewpoints in the order of the file.")
      .def_property("time", now, setTime,
                    "Seconds since the world was loaded. Assigning a later time advances the clock "
                    "and delivers all events: sensors send, routes forward, Scripts run. An "
                    "earlier time raises ValueError.")
      .def_property_readonly(
          "epoch",
          [](const WorldPtr& self) {
            return self->browser() ? self->browser()->epoch() : worldEpoch;
          },
          "The world's own clock at time 0, in seconds since 1970. Assign epoch + time to a "
          "startTime to start something now.")
      .def("_set_script_patience",
           [](const WorldPtr& self, double seconds) {
             Browser& browser = self->live();
             const auto lock = self->lock();
             browser.setScriptPatience(seconds);
           })
      .def_property_readonly("_edits", [](const WorldPtr& self) { return self->edits; })
      .def("__getitem__",
           [](const WorldPtr& self, const py::object& name) {
             if (!py::isinstance<py::str>(name))
               throw py::type_error(
                   "the index of a world is the DEF name of a node, which is a str");
             return getNode(self, fromText(name));
           })
      .def("__contains__",
           [](const WorldPtr& self, const py::object& name) {
             return py::isinstance<py::str>(name) &&
                    self->graph().scope.names.count(fromText(name)) > 0;
           })
      .def("__iter__", [](const WorldPtr& self) { return py::iter(names(self)); })
      .def("__len__", [](const WorldPtr& self) { return self->graph().scope.names.size(); })
      .def("__bool__", [](const WorldPtr&) { return true; })
      .def("__setattr__", setAttribute)
      .def("add", add, py::arg("node"), py::arg("name") = py::none(),
           py::return_value_policy::reference,
           "Adds a node to the top level of the world. name: its DEF name. Returns the node.")
      .def("remove", removeNode, py::arg("node"), "Removes a node from the top level.")
      .def(
          "listen", listen, py::arg("node"), py::arg("event"), py::arg("callback"),
          "Calls callback(value, time) whenever an eventOut or exposedField has sent: after all "
          "events of the cascade, on the thread that caused them. Returns a number for unlisten().")
      .def(
          "unlisten",
          [](const WorldPtr& self, const NodeObject& node, uint64_t number) {
            self->unlisten(own(self, node), number);
          },
          py::arg("node"), py::arg("number"))
      .def(
          "add_route",
          [](const WorldPtr& self, const NodeObject& from, const std::string& out,
             const NodeObject& to,
             const std::string& in) { return route(self, from, out, to, in, true); },
          py::arg("from_node"), py::arg("out"), py::arg("to_node"), py::arg("in_"),
          "Adds a route, unless it exists.")
      .def(
          "delete_route",
          [](const WorldPtr& self, const NodeObject& from, const std::string& out,
             const NodeObject& to,
             const std::string& in) { return route(self, from, out, to, in, false); },
          py::arg("from_node"), py::arg("out"), py::arg("to_node"), py::arg("in_"),
          "Removes a route. Returns False if it did not exist.")
      .def(
          "set_shader", setShader, py::arg("selector"), py::arg("shader"),
          "Gives shapes another surface shader, as --shader of vv does: "
          "set_shader('material:PIN-*', 'Metal:roughness=.22'). The selector is a DEF name, "
          "material:GLOB, appearance:GLOB, shape:GLOB, kicad:GLOB, colour:R,G,B, or '*' for shapes "
          "without a shader. Returns the number of shapes; 0 is also a warning of the world.")
      .def("to_vrml", toVrml, "Returns the world as VRML97 text.")
      .def("to_x3d", toX3d, py::arg("encoding") = "xml",
           "Returns the world as X3D text, in the encoding 'xml', 'classic' (ClassicVRML) or "
           "'json'.")
      .def("save", save, py::arg("path"),
           "Writes the world as a file: as X3D in XML if its suffix is .x3d, as X3D ClassicVRML if "
           "it is .x3dv, as X3D in JSON if it is .x3dj or .json, as glTF if it is .glb or .gltf, "
           "as a mesh if it is .stl, .ply or .obj, "
           "else "
           "as VRML97. Relative urls of nodes that were read from a file lead to the same files as "
           "before. What glTF or a mesh has nothing for becomes a warning of the world.")
      .def("__repr__",
           [](const WorldPtr& self) { return toText("<World " + self->graph().path + ">"); });
  defineRender(world);
  defineEditor(module, world);
}

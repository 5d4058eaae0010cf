// browser.cpp: Implements the Python class Browser, a World that runs. The caller passes times,
// events and pointer positions. Listeners' callbacks run on the calling thread. [GIL held; released
// while the world runs]
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <pybind11/functional.h>
#include <pybind11/stl.h>

#include "arrays.h"
#include "objects.h"
#include "parameters.h"

using namespace xvrml;

namespace {

// A world that runs from the beginning.
struct BrowserObject : WorldObject {};
using BrowserPtr = std::shared_ptr<BrowserObject>;

// The arguments of Browser(), in the order of Python's signature. The values are the defaults.
struct BrowserArguments {
  py::object source;
  double start = 0;
  py::object limits = py::none();
  bool allowAbsolute = false;
  py::object scriptPath = py::none();
  bool trust = false;
  double epoch = worldEpoch;
  bool directOutputAlways = false;
};

BrowserPtr makeBrowser(const BrowserArguments& given) {
  if (!(given.start >= -latestTime && given.start < latestTime))
    throw py::value_error(fmt::format("start: a number between -{0} and {0} was expected, not {1}",
                                      latestTime, given.start));
  if (!(given.epoch > -1 &&
        given.epoch < latestTime)) // rejects NaN too; same range as --epoch of vv
    throw py::value_error(fmt::format("epoch: a number between -1 and {} was expected, not {}",
                                      latestTime, given.epoch));
  BrowserOptions options;
  if (!given.scriptPath.is_none()) options.scriptPath = toPath(given.scriptPath);
  options.trustScripts = given.trust;
  RunOptions more;
  more.epoch = given.epoch;
  more.directOutputAlways = given.directOutputAlways;
  auto made = std::make_shared<BrowserObject>();
  std::unique_ptr<World> world = loadSource(given.source, given.limits, given.allowAbsolute);
  made->run(std::move(world), options, given.start, more);
  return made;
}

void tick(const BrowserPtr& self, double time) {
  if (!(time >= self->running->now() && time < latestTime)) // rejects NaN too
    throw py::value_error(fmt::format("tick: a time from {} to {} expected, not {}",
                                      self->running->now(), latestTime, time));
  const auto lock = self->lock();
  self->change([&] { self->running->tick(time); });
}

py::object node(const BrowserPtr& self, const std::string& name) {
  return asNode(self, self->running->node(name));
}

Node& own(const BrowserPtr& self, const NodeObject& node) {
  if (!sameWorld(node.world(), self)) throw py::value_error("a node of this browser expected");
  return *node.node;
}

py::object createNode(const BrowserPtr& self, const std::string& type, const py::kwargs& fields) {
  NodeRef made;
  const auto lock = self->lock();
  try {
    made = self->running->createNode(type);
  } catch (const std::invalid_argument& error) {
    std::vector<std::string> known;
    for (const NodeType* one : nodeTypes()) known.push_back(one->name);
    throw py::value_error(error.what() + didYouMean(type, known));
  }
  py::object object = asNode(self, made);
  for (const auto& [name, value] : fields) py::setattr(object, name, value);
  return object;
}

py::tuple createFromString(const BrowserPtr& self, const py::str& text) {
  const std::string bytes = fromText(text);
  MFNode made;
  const auto lock = self->lock();
  self->change([&] { made = self->running->createVrmlFromString(bytes); });
  py::tuple out(made.size());
  for (size_t i = 0; i < made.size(); ++i) out[i] = asNode(self, made[i]);
  return out;
}

void replaceWorld(const BrowserPtr& self, const std::vector<NodeObject>& nodes) {
  MFNode list;
  for (const NodeObject& one : nodes) list.emplace_back(&own(self, one));
  const auto lock = self->lock();
  self->change([&] { self->running->replaceWorld(list); });
}

void loadUrl(const BrowserPtr& self, const std::vector<std::string>& urls) {
  const auto lock = self->lock();
  self->change([&] { self->running->loadUrl(urls); });
}

py::dict bound(const BrowserPtr& self) {
  const BoundNodes nodes = self->running->bound();
  py::dict out;
  out["viewpoint"] = asNode(self, nodes.viewpoint);
  out["background"] = asNode(self, nodes.background);
  out["fog"] = asNode(self, nodes.fog);
  out["navigation_info"] = asNode(self, nodes.navigationInfo);
  return out;
}

py::array camera(const BrowserPtr& self, double aspect) {
  if (!(aspect > 0)) throw py::value_error("camera: aspect: a number above 0 expected");
  return matrixArray(self->running->camera(aspect).matrix);
}

using Triple = std::array<double, 3>;

py::object pick(const BrowserPtr& self, const Triple& origin, const Triple& direction,
                bool bothSides) {
  PickOptions options;
  options.bothSides = bothSides;
  PickHit hit;
  const auto lock = self->lock();
  if (!self->running->pick(origin.data(), direction.data(), options, hit)) return py::none();
  py::dict out;
  out["distance"] = hit.distance;
  out["point"] = py::make_tuple(hit.point[0], hit.point[1], hit.point[2]);
  out["normal"] = py::make_tuple(hit.normal[0], hit.normal[1], hit.normal[2]);
  out["tex_coord"] = py::make_tuple(hit.texCoord.x, hit.texCoord.y);
  py::list path;
  for (const PickHit::Step& step : hit.path) path.append(asNode(self, step.node));
  out["path"] = py::tuple(path);
  return out;
}

template <class Kind> Kind named(const char* what, const std::string& name,
                                 std::initializer_list<std::pair<const char*, Kind>> all) {
  std::string known;
  for (const auto& [one, kind] : all) {
    if (name == one) return kind;
    known += (known.empty() ? "" : ", ") + std::string(one);
  }
  throw py::value_error(fmt::format("{}: one of {} expected, not {}", what, known, name));
}

} // namespace

Navigation navigationOf(const std::string& name) {
  return named<Navigation>("navigation", name,
                           {{"none", Navigation::none},
                            {"walk", Navigation::walk},
                            {"fly", Navigation::fly},
                            {"examine", Navigation::examine}});
}

const char* navigationName(Navigation kind) {
  constexpr const char* names[] = {"none", "walk", "fly", "examine"};
  return names[size_t(kind)];
}

Key keyOf(const std::string& name) {
  return named<Key>("key", name,
                    {{"left", Key::left},
                     {"right", Key::right},
                     {"up", Key::up},
                     {"down", Key::down},
                     {"page_up", Key::pageUp},
                     {"page_down", Key::pageDown},
                     {"home", Key::home},
                     {"shift", Key::shift},
                     {"alt", Key::alt}});
}

namespace {

struct NavigateArguments {
  double dt = 0;
  double ahead = 0, right = 0, up = 0, turn = 0, tilt = 0, roll = 0;
};

void navigate(const BrowserPtr& self, const NavigateArguments& given) {
  if (!(given.dt >= 0)) throw py::value_error("navigate: dt: seconds from 0 on expected");
  const NavigationInput input{given.ahead, given.right, given.up,
                              given.turn,  given.tilt,  given.roll};
  const auto lock = self->lock();
  self->change([&] { self->running->navigate(input, given.dt); });
}

} // namespace

void defineBrowser(py::module_& module) {
  py::class_<BrowserObject, WorldObject, BrowserPtr> browser(
      module, "Browser",
      "A world that runs. tick(time) sets its clock; no clock runs in the background. Assigning to "
      "a field of a node sends an event.");
  using B = BrowserArguments;
  defineConstructor(browser, makeBrowser, parameterList(requiredParameter("source", &B::source)),
                    parameterList(parameter("start", &B::start), parameter("limits", &B::limits),
                                  parameter("allow_absolute", &B::allowAbsolute),
                                  parameter("script_path", &B::scriptPath),
                                  parameter("trust", &B::trust), parameter("epoch", &B::epoch),
                                  parameter("direct_output_always", &B::directOutputAlways)),
                    "source: a file name, bytes or a file object, as for load(). start: the time "
                    "at which the world begins to run, in seconds after epoch. epoch: time 0 in "
                    "seconds since 1970; nodes and Scripts see epoch + time. trust: Scripts may do "
                    "whatever the user may do. direct_output_always: Scripts without directOutput "
                    "TRUE may also change nodes, as in browsers of 1997.");
  using N = NavigateArguments;
  defineMethod(browser, "navigate", navigate, parameterList(requiredParameter("dt", &N::dt)),
               parameterList(parameter("ahead", &N::ahead), parameter("right", &N::right),
                             parameter("up", &N::up), parameter("turn", &N::turn),
                             parameter("tilt", &N::tilt), parameter("roll", &N::roll)),
               "Moves the viewer for dt seconds. The other arguments are speeds from -1 to 1.");
  browser
      .def_property_readonly(
          "now", [](const BrowserPtr& self) { return self->running->now(); },
          "The current time, in seconds after epoch.")
      .def_property_readonly(
          "generation", [](const BrowserPtr& self) { return self->running->generation(); },
          "A number that increases each time the world is replaced by another one.")
      .def("tick", tick, py::arg("time"),
           "Advances the clock to `time` and delivers all events: sensors send, routes forward, "
           "Scripts run.")
      .def("node", node, py::arg("name"), "Returns the node with a DEF name of the file, or None.")
      .def("create_node", createNode, py::arg("type"),
           "Creates a node of a type. Keyword arguments are its fields.")
      .def(
          "add_root",
          [](const BrowserPtr& self, const NodeObject& added) {
            const auto lock = self->lock();
            self->change([&] { self->running->addRoot(NodeRef(&own(self, added))); });
          },
          py::arg("node"))
      .def(
          "remove_root",
          [](const BrowserPtr& self, const NodeObject& removed) {
            const auto lock = self->lock();
            self->change([&] { self->running->removeRoot(own(self, removed)); });
          },
          py::arg("node"))
      .def("create_vrml_from_string", createFromString, py::arg("text"),
           "Returns the nodes of a VRML text, which needs no header. Raises ParseError if no part "
           "of it can be used.")
      .def("load_url", loadUrl, py::arg("urls"),
           "Replaces the world by the first of these files that can be read. If none can be read, "
           "the world stays.")
      .def("replace_world", replaceWorld, py::arg("nodes"),
           "Replaces all nodes of the world by these.")
      .def_property_readonly("bound", bound,
                             "The bound nodes as a dict of viewpoint, background, fog and "
                             "navigation_info; None for each that has no bound node.")
      .def(
          "bind_viewpoint",
          [](const BrowserPtr& self, const std::string& name) {
            const auto lock = self->lock();
            bool done = false;
            self->change([&] { done = self->running->bindViewpoint(name); });
            return done;
          },
          py::arg("name"),
          "Binds the Viewpoint with this DEF name or description. Returns False if there is none.")
      .def("camera", camera, py::arg("aspect") = 4.0 / 3,
           "Returns the viewer's camera-to-world matrix, 4x4 for column vectors.")
      .def(
          "set_transition",
          [](const BrowserPtr& self, double seconds) { self->running->setTransition(seconds); },
          py::arg("seconds"),
          "Sets how many world seconds a move to another viewpoint takes; 0: the viewer jumps.")
      .def(
          "pointer",
          [](const BrowserPtr& self, double x, double y, bool button, double aspect) {
            const auto lock = self->lock();
            self->change([&] {
              self->running->setAspect(aspect);
              self->running->pointer(x, y, button);
            });
          },
          py::arg("x"), py::arg("y"), py::arg("button") = false, py::arg("aspect") = 4.0 / 3,
          "Moves the pointer to (x, y) of the picture, from -1 at the left and bottom to 1 at the "
          "right and top.")
      .def(
          "pointer_ray",
          [](const BrowserPtr& self, const Triple& origin, const Triple& direction, bool button) {
            const auto lock = self->lock();
            self->change(
                [&] { self->running->pointerRay(origin.data(), direction.data(), button); });
          },
          py::arg("origin"), py::arg("direction"), py::arg("button") = false,
          "Moves the pointer, given as a ray in the world.")
      .def(
          "pointer_leave",
          [](const BrowserPtr& self) {
            const auto lock = self->lock();
            self->change([&] { self->running->pointerLeave(); });
          },
          "Moves the pointer out of the picture.")
      .def_property_readonly("sensors_at_pointer",
                             [](const BrowserPtr& self) {
                               py::list list;
                               for (const NodeRef& sensor : self->running->sensorsAtPointer())
                                 list.append(asNode(self, sensor));
                               return py::tuple(list);
                             })
      .def("pick", pick, py::arg("origin"), py::arg("direction"), py::arg("both_sides") = false,
           "Returns the nearest hit of a ray as a dict of distance, point, normal, tex_coord and "
           "path (the nodes from the root to the Shape), or None.")
      .def(
          "key",
          [](const BrowserPtr& self, const std::string& name, bool pressed) {
            const Key which = keyOf(name);
            const auto lock = self->lock();
            self->change([&] { self->running->key(which, pressed); });
          },
          py::arg("name"), py::arg("pressed"))
      .def(
          "press_key",
          [](const BrowserPtr& self, const std::string& name, bool pressed) {
            const auto lock = self->lock();
            bool taken = false;
            self->change([&] { taken = self->running->worldKey(name, pressed); });
            return taken;
          },
          py::arg("name"), py::arg("pressed") = true,
          "Presses (or releases) a key of the world's keyboard for its KeySensor or StringSensor: "
          "the character that it types, or a name such as 'F1', 'Up', 'Shift' or 'Enter'. Returns "
          "whether a sensor has taken it.")
      .def(
          "type_text",
          [](const BrowserPtr& self, const std::string& text) {
            const auto lock = self->lock();
            bool taken = false;
            self->change([&] { taken = self->running->worldText(text); });
            return taken;
          },
          py::arg("text"),
          "Presses and releases the key of each character; a line feed is the key Enter. Returns "
          "whether a sensor has taken any.")
      .def_property_readonly(
          "senses_keys", [](const BrowserPtr& self) { return self->running->sensesKeys(); },
          "Whether a KeySensor or StringSensor of the world is enabled.")
      .def_property(
          "navigation",
          [](const BrowserPtr& self) { return navigationName(self->running->navigation()); },
          [](const BrowserPtr& self, const std::string& name) {
            self->running->setNavigation(navigationOf(name));
          },
          "The navigation mode: 'none', 'walk', 'fly' or 'examine'.")
      .def("load_inlines",
           [](const BrowserPtr& self) {
             const auto lock = self->lock();
             uint64_t loaded = 0;
             self->change([&] { loaded = self->running->loadInlines(); });
             return loaded;
           })
      .def("__repr__", [](const BrowserPtr& self) {
        return toText(
            fmt::format("<Browser {} at {} s>", self->graph().path, self->running->now()));
      });
}

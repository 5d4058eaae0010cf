// objects.h: the C++ side of the Python classes World and Node. All members are used with the interpreter's lock (GIL) held,
// except where a comment says otherwise.
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "picture/renderer.h"
#include "xvrml/browser.h"
#include "xvrml/world.h"

namespace py = pybind11;

struct WorldObject {
  std::unique_ptr<xvrml::World> world; // null where a Browser has taken it over
  // Held while a render reads the graph on another thread, and for every change of it. Wait for it without the GIL. A thread
  // may hold it twice: a callback of a tick uses nodes. Shared with what Scripts see of the same world.
  std::shared_ptr<std::recursive_mutex> mutex = std::make_shared<std::recursive_mutex>();

  virtual ~WorldObject() = default;
  virtual xvrml::World& graph() { return *world; }
  virtual xvrml::Browser* browser() { return nullptr; }  // what runs the world; null: it stands still
  virtual const char* frozen() const { return nullptr; } // why it cannot be changed from here; null: it can
  // Changes of a running world: `work` without the GIL; afterwards the first exception of a callback is raised.
  virtual void run(const std::function<void()>& work) { work(); }
  virtual std::shared_ptr<picture::Renderer> renderer(const picture::RenderSettings& settings, picture::Watch watch) {
    return std::make_shared<picture::Renderer>(*world, settings, std::move(watch));
  }

  virtual void rest() {} // gives up what is kept for the next picture, the cluster's context with it

  std::unique_lock<std::recursive_mutex> lock() {
    py::gil_scoped_release release;
    return std::unique_lock(*mutex);
  }
};
using WorldPtr = std::shared_ptr<WorldObject>;

// A node and the world that owns it: the world lives as long as any of its nodes is in a variable.
struct NodeObject {
  WorldPtr world;
  xvrml::NodeRef node;
};

// Nodes that a Script was given are of the same world as those of the Browser that runs it.
inline bool sameWorld(const WorldPtr& a, const WorldPtr& b) { return a == b || (a->browser() && a->browser() == b->browser()); }

// Text of a file may be anything; Python's own way to keep bytes that are not UTF-8.
py::str toText(const std::string& bytes);
std::string fromText(const py::handle& text);

// The value of a field as a Python object: numbers, tuples, read-only arrays, text, nodes.
py::object toPython(const xvrml::Value& value, const WorldPtr& world);

// The Python object as a value of the field. Raises TypeError or ValueError naming the field and what it takes.
xvrml::Value fromPython(const py::handle& object, const xvrml::FieldInfo& field, const NodeObject& owner);

// A world from a file name, bytes or a file object. Raises ParseError or OSError.
std::unique_ptr<xvrml::World> loadSource(const py::object& source, const py::object& limits, bool allowAbsolute);

// A file name: str or os.PathLike.
std::string toPath(const py::handle& path);

// What the script engine of Python (plugins/script/python) uses: see script.cpp.
// A browser that is being made or runs, and what is locked for its world; null: it is no more.
void scriptsLock(const xvrml::Browser* browser, std::shared_ptr<std::recursive_mutex> mutex);
// From here on, on this thread: Scripts of a browser that nobody knows yet belong to the one that is being made.
struct MakingBrowser {
  explicit MakingBrowser(std::shared_ptr<std::recursive_mutex> mutex);
  ~MakingBrowser();
};
// Assigns for the Script that is running on this thread, if one is: the event leaves when its function returns.
bool scriptAssigns(const NodeObject& node, const std::string& field, const py::handle& value);

void defineScripts(py::module_& module);
void defineNode(py::module_& module);
void defineWorld(py::module_& module);
void defineBrowser(py::module_& module);
void definePicture(py::module_& module);

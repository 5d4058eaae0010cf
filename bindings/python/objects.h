// objects.h: the C++ side of the Python classes World and Node. All members are used with the interpreter's lock (GIL) held,
// except where a comment says otherwise.
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "xvrml/world.h"

namespace py = pybind11;

struct WorldObject {
  std::unique_ptr<xvrml::World> world;
  // Held while a render reads the graph on another thread, and for every change of it. Wait for it without the GIL.
  std::mutex mutex;

  std::unique_lock<std::mutex> lock() {
    py::gil_scoped_release release;
    return std::unique_lock(mutex);
  }
};
using WorldPtr = std::shared_ptr<WorldObject>;

// A node and the world that owns it: the world lives as long as any of its nodes is in a variable.
struct NodeObject {
  WorldPtr world;
  xvrml::NodeRef node;
};

// Text of a file may be anything; Python's own way to keep bytes that are not UTF-8.
py::str toText(const std::string& bytes);
std::string fromText(const py::handle& text);

// The value of a field as a Python object: numbers, tuples, read-only arrays, text, nodes.
py::object toPython(const xvrml::Value& value, const WorldPtr& world);

// The Python object as a value of the field. Raises TypeError or ValueError naming the field and what it takes.
xvrml::Value fromPython(const py::handle& object, const xvrml::FieldInfo& field, const NodeObject& owner);

// A file name: str or os.PathLike.
std::string toPath(const py::handle& path);

void defineNode(py::module_& module);
void defineWorld(py::module_& module);
void definePicture(py::module_& module);

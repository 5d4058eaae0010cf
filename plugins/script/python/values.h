// values.h: Converts VRML's values to Python objects and back, in the shapes of the Python binding.
// It shares no code with bindings/python/convert.cpp
// (docs/decisions/0045-two-conversions-to-python.md). A change of what counts as a number, a truth
// value or a text is made in both. Needs Python's lock (GIL). [the browser's thread]
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include <xvrml/xscript.h>

namespace py = pybind11;

namespace python {

// Converts between the host's node numbers and the binding's objects.
struct Nodes {
  std::function<py::object(XsNode)> toPython;
  std::function<XsNode(const py::handle&)> toHost; // raises TypeError or ValueError
};

// Converts to numbers, tuples, str or Node. MF types of numbers become read-only arrays, or tuples
// without numpy. Images become arrays of (height, width, components), rows from the top.
py::object toPython(const XsValue& value, const Nodes& nodes);

// A value that owns its memory.
class Owned {
 public:
  // Raises TypeError or ValueError: "name (SFVec3f): 3 numbers expected, not str".
  Owned(const py::handle& object, XsType type, const std::string& name, const Nodes& nodes);
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
  const XsValue& value() const { return value_; }

 private:
  void read(const py::handle& object, const std::string& name, const Nodes& nodes);
  template <class T> void hold(const std::vector<T>& elements) {
    value_.count = uint32_t(elements.size());
    value_.of.data = elements.data();
  }
  XsValue value_{};
  std::vector<float> floats_;
  std::vector<double> doubles_;
  std::vector<int32_t> ints_;
  std::vector<XsNode> nodes_;
  std::vector<std::string> texts_;
  std::vector<XsString> strings_;
  std::vector<std::vector<uint8_t>> pixels_; // one list for each image
  std::vector<XsImage> images_;
};

const char* typeName(XsType type);
// Bytes that are not UTF-8 are kept by Python's surrogateescape.
py::str toText(const XsString& bytes);
std::string fromText(const py::handle& text);
// Converts a str or a sequence of str.
std::vector<std::string> textsOf(const py::handle& object, const char* what);

} // namespace python

// module.cpp: Defines the extension module xvrml._xvrml, load() and the exceptions.
#include <cerrno>
#include <cstring>
#include <limits>

#include <fmt/format.h>
#include <unistd.h>

#include "arrays.h"
#include "cluster_object.h"
#include "libpicture/renderer.h"
#include "merge.h"
#include "objects.h"
#include "openrt/openrt.h"
#include "xvrml/node_plugin.h"
#include "xvrml/step_error.h"

using namespace xvrml;

namespace {

// Owned by the module for the life of the interpreter.
PyObject* parseError = nullptr;

void setParseError(const Diagnostic& d) {
  py::object error = py::reinterpret_borrow<py::object>(parseError)(toText(d.text()));
  error.attr("file") = toText(d.file);
  error.attr("line") = d.line;
  error.attr("column") = d.column;
  PyErr_SetObject(parseError, error.ptr());
}

[[noreturn]] void raise(const Diagnostic& d) {
  setParseError(d);
  throw py::error_already_set();
}

void setLimits(Limits& limits, const py::dict& given) {
  for (const auto& [key, value] : given) {
    const std::string name = py::str(key);
    const unsigned long long number =
        py::isinstance<py::int_>(value) ? PyLong_AsUnsignedLongLong(value.ptr()) : 0;
    if (!py::isinstance<py::int_>(value) || PyErr_Occurred()) {
      PyErr_Clear();
      throw py::value_error("limits: " + name +
                            ": a whole number of 64 bits expected, not negative");
    }
    if (setLimit(limits, name, number)) continue;
    std::vector<std::string> names;
    for (const LimitInfo& limit : limitTable()) names.emplace_back(limit.name);
    throw py::value_error(fmt::format("limits: there is no {}{}", name, didYouMean(name, names)));
  }
}

// Gets the bytes of bytes, bytearray, memoryview, and of the result of read().
bool bytesOf(const py::object& source, std::string& bytes) {
  if (py::isinstance<py::str>(source) || !PyObject_CheckBuffer(source.ptr())) return false;
  Py_buffer buffer;
  if (PyObject_GetBuffer(source.ptr(), &buffer, PyBUF_SIMPLE) != 0) throw py::error_already_set();
  bytes.assign(static_cast<const char*>(buffer.buf), size_t(buffer.len));
  PyBuffer_Release(&buffer);
  return true;
}

template <class Load> std::unique_ptr<World> loadWith(Load load) {
  std::unique_ptr<World> made;
  try {
    const ReleaseGil release;
    made = load();
  } catch (const LoadError& error) { raise(error.diagnostic); }
  return made;
}

WorldPtr load(const py::object& source, const py::object& limits, bool allowAbsolute,
              double stepError) {
  if (stepError != 0 && !(stepError > leastStepError && stepError < mostStepError))
    throw py::value_error("step_error: 0, or millimetres between 1e-6 and 1e18, expected");
  auto made = std::make_shared<WorldObject>();
  made->world = loadSource(source, limits, allowAbsolute, stepError);
  return made;
}

// Returns a line for each rejected plug-in.
py::list loadPlugins(const py::object& path) {
  std::vector<std::string> refused;
  const std::string folders = path.is_none() ? "" : toPath(path);
  {
    const ReleaseGil release;
    refused = loadNodePlugins(folders);
  }
  py::list lines;
  for (const std::string& line : refused) lines.append(toText(line));
  return lines;
}

// Rejects X.__new__(X), which would create an object without a C++ part; pybind11 would pass
// uninitialised memory to its methods.
void refuseEmptyObjects(const py::module_& module) {
  for (const auto& [name, value] : py::reinterpret_borrow<py::dict>(module.attr("__dict__")))
    if (PyType_Check(value.ptr()))
      if (auto* info = py::detail::get_type_info(reinterpret_cast<PyTypeObject*>(value.ptr())))
        info->operator_new = [](size_t) -> void* {
          throw py::type_error("the object was made by __new__ alone: __init__ has not run");
        };
}

// pickle and copy call the common base class. pybind11 would answer with a C++ exception that
// passes through Python's C code.
PyObject* newObject(PyTypeObject* type, PyObject*, PyObject*) {
  try {
    if (!py::detail::all_type_info(type).empty()) return py::detail::make_new_instance(type);
    PyErr_Format(PyExc_TypeError, "objects of %s alone cannot be made, copied or pickled",
                 type->tp_name);
  } catch (const std::exception& error) { PyErr_SetString(PyExc_RuntimeError, error.what()); }
  return nullptr;
}

// Has pybind11 look up numpy's functions. It would do so at the first array, under a lock of its
// own. Importing numpy releases the GIL, so a second thread could then wait for this lock with the
// GIL, for ever. Only one thread at a time imports a module. Without numpy, arrays raise
// ImportError.
void findNumpy() {
  try {
    newArray<uint8_t>({0});
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_ImportError)) throw;
  }
}

} // namespace

std::unique_ptr<World> loadSource(const py::object& source, const py::object& limits,
                                  bool allowAbsolute, double stepError) {
  LoadOptions options;
  options.stepError = stepError;
  options.allowAbsolute = allowAbsolute;
  if (!limits.is_none()) {
    if (!py::isinstance<py::dict>(limits))
      throw py::type_error("limits: a dict of names and numbers expected");
    setLimits(options.limits, limits.cast<py::dict>());
  }
  std::string bytes, name = "<memory>";
  bool inMemory = bytesOf(source, bytes);
  if (!inMemory && py::hasattr(source, "read")) {
    py::object content = source.attr("read")();
    if (py::isinstance<py::str>(content))
      bytes = fromText(content);
    else if (!bytesOf(content, bytes))
      throw py::type_error("load: read() of the file object must return bytes or str");
    py::object given = py::getattr(source, "name", py::none());
    if (py::isinstance<py::str>(given)) name = fromText(given);
    inMemory = true;
  }
  if (inMemory) return loadWith([&] { return loadWorldFromMemory(bytes, name, options); });
  const std::string path = toPath(source);
  if (::access(path.c_str(), R_OK) != 0) {
    errno = errno ? errno : ENOENT;
    PyErr_SetFromErrnoWithFilename(PyExc_OSError, path.c_str());
    throw py::error_already_set();
  }
  return loadWith([&] { return loadWorld(path, options); });
}

PYBIND11_MODULE(_xvrml, module) {
  findNumpy();
  watchInterpreter();
  reinterpret_cast<PyTypeObject*>(py::detail::get_internals().instance_base)->tp_new = newObject;
  parseError = PyErr_NewExceptionWithDoc("xvrml.ParseError",
                                         "Raised if no part of a world can be used. The attributes "
                                         "file, line and column are the place of the error.",
                                         PyExc_ValueError, nullptr);
  if (!parseError) throw py::error_already_set();
  module.add_object("ParseError", parseError);
  py::register_exception_translator([](std::exception_ptr failure) {
    try {
      if (failure) std::rethrow_exception(failure);
    } catch (const LoadError& error) { setParseError(error.diagnostic); }
  });
  // Functions check their arguments. A conversion error that none of them has caught is still
  // caused by the caller's value.
  py::register_exception_translator([](std::exception_ptr failure) {
    try {
      if (failure) std::rethrow_exception(failure);
    } catch (const py::cast_error&) {
      PyErr_SetString(PyExc_TypeError, "a value has a type or a size that is not expected");
    }
  });
  py::register_exception<picture::RenderError>(module, "RenderError", PyExc_RuntimeError);
  defineCluster(module);
  defineNode(module);
  definePicture(module);
  defineDenoise(module);
  defineCompare(module);
  defineMerge(module);
  defineFilm(module);
  defineMeasurement(module);
  defineWorld(module);
  defineBrowser(module);
  defineViewer(module);
  defineScripts(module);
  defineShapes(module);
  defineRenderer(module);
  defineAppearance(module);
  defineRt(module);
  refuseEmptyObjects(module);
  refuseEmptyObjects(module.attr("rt"));
  module.attr("__version__") =
      fmt::format("{}.{}.{}", OPENRT_VERSION_MAJOR, OPENRT_VERSION_MINOR, OPENRT_VERSION_PATCH);
  module.def("load_node_plugins", loadPlugins, py::arg("path") = py::none(),
             "Loads the node plug-ins of these folders (separated by colons), of $XVRML_NODE_PATH "
             "and of the installation. Returns a message for each refused plug-in.");
  module.def("load", load, py::arg("source"), py::kw_only(), py::arg("limits") = py::none(),
             py::arg("allow_absolute") = false, py::arg("step_error") = 0.0,
             "Loads a world from a file name, bytes or a file object. Raises ParseError or "
             "OSError. World.warnings has the problems of single nodes. step_error: how far the "
             "triangles of STEP models are from their surfaces at most, in millimetres; 0: a "
             "thousandth of the size of each part.");
}

// runtime.h: Provides the one Python interpreter of a process. A host that is a Python program has
// one already; otherwise it is started here, without signal handlers. [the browser's thread]
#pragma once

#include <stdexcept>
#include <string>

#include <pybind11/pybind11.h>

namespace py = pybind11;

namespace python {

// Holds the interpreter's lock (GIL) for its lifetime. Any thread.
class Gil {
 public:
  Gil() : state_(PyGILState_Ensure()) {}
  ~Gil() { PyGILState_Release(state_); }
  Gil(const Gil&) = delete;
  Gil& operator=(const Gil&) = delete;

 private:
  PyGILState_STATE state_;
};

struct StartError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Starts Python if it is not running. Call it without the lock. Throws StartError.
void startPython();
// Returns the binding's module, from the package beside the engine or from Python's path. Call it
// with the lock. Throws StartError.
py::module_ binding();
bool isProgram(); // a Python program runs the worlds
// Returns whether this is Python's main thread, which runs the calls ordered with
// Py_AddPendingCall.
bool isMainThread();

} // namespace python

// runtime.h: the one Python interpreter of a process: that of the program, where the host is a
// Python program; else one that is started here, without handlers of signals. [the browser's
// thread]
#pragma once

#include <stdexcept>
#include <string>

#include <pybind11/pybind11.h>

namespace py = pybind11;

namespace python {

// The interpreter's lock, for as long as it lives. Any thread.
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

// Starts Python if it does not run. Without the lock. Throws StartError.
void startPython();
// The functions of the binding's module, from its package beside the engine or on Python's path.
// With the lock. Throws StartError.
py::module_ binding();
bool isProgram();    // it is a Python program that runs worlds
bool isMainThread(); // of Python: the one that runs what others ask for (Py_AddPendingCall)

} // namespace python

// watchdog.h: Stops functions of Scripts that exceed their time. Python cannot be interrupted from
// outside, so a running function is made to call the host's shouldStop. On Python's main thread a
// timer thread orders calls (Py_AddPendingCall); on other threads a trace function does it, which
// is slower. A stopped function gets an exception at each of its lines, so that it cannot catch it
// for long. [the thread that holds Python's lock]
#pragma once

#include <pybind11/pybind11.h>

#include <xvrml/xscript.h>

namespace python {

class Watchdog {
 public:
  Watchdog(const XsHost* host, XsNode self); // a function of the Script begins
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;
  bool stopped() const { return stopped_; }

  // Calls shouldStop for the running function of this thread. Returns true, with an exception set,
  // if it must end.
  static bool mustEnd();

 private:
  static int trace(PyObject*, struct _frame*, int what, PyObject*);
  void endTrace();
  const XsHost* host_;
  const XsNode self_;
  Watchdog* const outer_; // the Watchdog of another browser
  bool stopped_ = false, tracing_ = false;
  uint32_t lines_ = 0;
  pybind11::object before_; // the program's own trace function
};

// Returns the class of the exception (borrowed). It is not derived from Exception, so that `except
// Exception` does not catch it.
PyObject* stoppedType();

} // namespace python

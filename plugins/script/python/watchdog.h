// watchdog.h: stops functions of Scripts whose time is up. Python cannot be interrupted from
// outside; what runs too long is made to ask the host by itself: on Python's main thread by calls
// that a timer's thread orders (Py_AddPendingCall), on others by a trace function, which is slower.
// What may not run on gets an exception at each of its lines, which it cannot catch for long. [the
// thread that holds Python's lock]
#pragma once

#include <pybind11/pybind11.h>

#include <xvrml/xscript.h>

namespace python {

class Watch {
 public:
  Watch(const XsHost* host, XsNode self); // a function of the Script begins
  ~Watch();
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;
  bool stopped() const { return stopped_; }

  // The running function of this thread asks the host; true: it must end, an exception is set.
  static bool mustEnd();

 private:
  static int trace(PyObject*, struct _frame*, int what, PyObject*);
  void endTrace();
  const XsHost* host_;
  const XsNode self_;
  Watch* const outer_; // of another browser
  bool stopped_ = false, tracing_ = false;
  uint32_t lines_ = 0;
  pybind11::object before_; // the trace function of the program's own
};

// The class of the exception: no Exception, so that `except Exception` lets it pass. Borrowed.
PyObject* stoppedType();

} // namespace python

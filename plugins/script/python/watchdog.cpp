#include "watchdog.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "runtime.h"

namespace python {
namespace {

constexpr auto period = std::chrono::milliseconds(20);
constexpr uint32_t linesBetween = 1000;

thread_local Watchdog* running = nullptr;

// Repeatedly orders a call on Python's main thread while a function runs there. The timer thread
// never ends; it sleeps while no function runs.
class Timer {
 public:
  static Timer& get() {
    static auto& timer = *new Timer();
    return timer;
  }
  void begin() {
    const std::scoped_lock lock(mutex_);
    if (++active_ == 1) wake_.notify_one();
  }
  void end() {
    const std::scoped_lock lock(mutex_);
    --active_;
  }

 private:
  Timer() {
    std::thread([this] { run(); }).detach();
  }
  void run() {
    std::unique_lock lock(mutex_);
    for (;;) {
      wake_.wait(lock, [this] { return active_ > 0; });
      lock.unlock();
      std::this_thread::sleep_for(period);
      lock.lock();
      if (active_ == 0 || ordered_.exchange(true)) continue;
      lock.unlock(); // a thread that ends a function holds the GIL
      if (Py_AddPendingCall(&Timer::called, nullptr) != 0) ordered_ = false;
      // Up to Python 3.11, the main thread checks for pending calls only when it is asked to
      // release the GIL.
      if (Py_IsInitialized()) PyGILState_Release(PyGILState_Ensure());
      lock.lock();
    }
  }
  static int called(void*) {
    ordered_ = false;
    return Watchdog::mustEnd() ? -1 : 0;
  }

  static inline std::atomic<bool> ordered_ = false; // ordered and not called yet
  std::mutex mutex_;
  std::condition_variable wake_;
  int active_ = 0;
};

} // namespace

PyObject* stoppedType() {
  static PyObject* const type =
      PyErr_NewExceptionWithDoc("xvrml.ScriptStopped", "The time of a Script's function is up.",
                                PyExc_BaseException, nullptr);
  return type;
}

Watchdog::Watchdog(const XsHost* host, XsNode self) : host_(host), self_(self), outer_(running) {
  // Create the class now: a program may be stopped deep in a recursion, where there is no room for
  // it.
  stoppedType();
  running = this;
  if (isMainThread()) {
    Timer::get().begin();
  } else if (py::module_::import("sys").attr("gettrace")().is_none()) {
    tracing_ = true;
    PyEval_SetTrace(&Watchdog::trace, nullptr);
  }
}

Watchdog::~Watchdog() {
  if (isMainThread()) Timer::get().end();
  if (tracing_) endTrace();
  running = outer_;
}

void Watchdog::endTrace() {
  PyObject *type = nullptr, *value = nullptr, *traceback = nullptr;
  PyErr_Fetch(&type, &value, &traceback);
  PyEval_SetTrace(nullptr, nullptr);
  if (before_ && !before_.is_none()) {
    try {
      py::module_::import("sys").attr("settrace")(before_);
    } catch (py::error_already_set&) {} // the program's own trace function could not be restored
  }
  PyErr_Restore(type, value, traceback);
}

bool Watchdog::mustEnd() {
  Watchdog* const watch = running;
  if (!watch) return false;
  if (!watch->stopped_ && !watch->host_->shouldStop(watch->host_, watch->self_, 0)) return false;
  if (!watch->stopped_) {
    watch->stopped_ = true;
    if (!watch->tracing_) {
      try {
        watch->before_ = py::module_::import("sys").attr("gettrace")();
      } catch (py::error_already_set&) {} // then there is none
      watch->tracing_ = true;
      PyEval_SetTrace(&Watchdog::trace, nullptr);
    }
  }
  PyErr_SetNone(stoppedType());
  return true;
}

int Watchdog::trace(PyObject*, PyFrameObject*, int what, PyObject*) {
  Watchdog* const watch = running;
  if (!watch || (what != PyTrace_LINE && what != PyTrace_CALL)) return 0;
  if (!watch->stopped_ && ++watch->lines_ % linesBetween != 0) return 0;
  return mustEnd() ? -1 : 0;
}

} // namespace python

// gil.h: Releases and acquires the interpreter's lock (GIL) around long operations, also while the
// interpreter ends. A thread that asks for the GIL after that point is ended by Python with
// pthread_exit(), which aborts the process when it happens in a C++ destructor. Therefore all work
// without the GIL is stopped and awaited before the interpreter ends. A thread that does not stop
// never asks for the GIL again.
#pragma once

#include <pybind11/pybind11.h>

namespace py = pybind11;

// mutexes held by this thread that other threads may wait for
inline thread_local int trackedMutexesHeld = 0;

// A mutex that other threads may wait for without holding the GIL. A thread that holds one when the
// interpreter ends continues until it has released it.
template <class Mutex> class TrackedMutex : public Mutex {
 public:
  void lock() {
    Mutex::lock();
    ++trackedMutexesHeld;
  }
  bool try_lock() {
    const bool locked = Mutex::try_lock();
    trackedMutexesHeld += locked;
    return locked;
  }
  void unlock() {
    --trackedMutexesHeld;
    Mutex::unlock();
  }
};

// Releases the GIL for its lifetime. After the interpreter has begun to end, the constructor does
// not return on a daemon thread that holds no TrackedMutex mutex: such a thread would start new
// work again and again, and the end would wait for it.
class ReleaseGil {
 public:
  ReleaseGil();
  ~ReleaseGil(); // does not return on a daemon thread after the interpreter has ended
  ReleaseGil(const ReleaseGil&) = delete;
  ReleaseGil& operator=(const ReleaseGil&) = delete;

 private:
  PyThreadState* state_;
};

// Acquires the GIL for its lifetime, inside a ReleaseGil. False: the GIL was not acquired because
// the interpreter ends; the caller must stop its work.
class AcquireGil {
 public:
  AcquireGil();
  ~AcquireGil();
  AcquireGil(const AcquireGil&) = delete;
  AcquireGil& operator=(const AcquireGil&) = delete;
  explicit operator bool() const { return held_; }

 private:
  bool held_;
  PyGILState_STATE state_{};
};

// Returns whether the interpreter is ending and another thread ends it. Nothing long should begin
// then. [GIL not needed]
bool interpreterEnds();

// Call once, when the module is imported.
void watchInterpreter();

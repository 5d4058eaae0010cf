// gil.h: the interpreter's lock (GIL) around what takes long, also while the interpreter ends.
// Python ends a thread that asks for the lock after the interpreter has begun to end by
// pthread_exit(): from a destructor in C++ that aborts the process. So before the end all that is
// under way without the lock is stopped and waited for, and what does not stop never asks for the
// lock again.
#pragma once

#include <pybind11/pybind11.h>

namespace py = pybind11;

inline thread_local int awaitedHere = 0; // mutexes that this thread holds and others may wait for

// A mutex that others may wait for while they are without the interpreter's lock. A thread that
// holds one when the interpreter ends goes on until it has given it back.
template <class Mutex> class Awaited : public Mutex {
 public:
  void lock() {
    Mutex::lock();
    ++awaitedHere;
  }
  bool try_lock() {
    const bool locked = Mutex::try_lock();
    awaitedHere += locked;
    return locked;
  }
  void unlock() {
    --awaitedHere;
    Mutex::unlock();
  }
};

// Gives the lock up while it lives. Once the interpreter ends a daemon thread that holds nothing
// does not return from the constructor: it would begin something new again and again, and the end
// would wait for it.
class ReleaseGil {
 public:
  ReleaseGil();
  ~ReleaseGil(); // does not return on a daemon thread once the interpreter has ended
  ReleaseGil(const ReleaseGil&) = delete;
  ReleaseGil& operator=(const ReleaseGil&) = delete;

 private:
  PyThreadState* state_;
};

// Takes the lock while it lives, within ReleaseGil. False: it was not taken, because the
// interpreter ends: stop what you do.
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

// Whether the interpreter ends and this is not the thread that ends it: nothing long should begin.
// [GIL not needed]
bool interpreterEnds();

// To be called once, when the module is imported.
void watchInterpreter();

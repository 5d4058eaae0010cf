// gil.cpp: Implements the lock guards. An atexit hook waits for the other threads: it runs after
// non-daemon threads have been joined, and before the interpreter refuses its lock to daemon
// threads.
#include "gil.h"

#include <chrono>
#include <mutex>
#include <thread>

#include <pthread.h>
#include <unistd.h>

namespace {

enum class State { runs, ends, ended };

struct Sections { // state of the process; never destroyed, because threads may outlive the module
  std::mutex mutex;
  State state = State::runs;
  std::thread::id ending; // the thread that ends the interpreter
  int inside = 0;         // number of threads that have released the GIL
  int asking = 0;         // number of threads that are asking for the GIL
};
Sections& sections() {
  static Sections& all = *new Sections;
  return all;
}

// nested ReleaseGils of this thread: one inside a callback of another
thread_local int nestedReleases = 0;

// Registers that this thread is about to ask for the GIL. Returns false if it must not ask.
bool mayAcquireGil(bool whileItEnds) {
  Sections& s = sections();
  const std::scoped_lock lock(s.mutex);
  const bool other = s.ending != std::this_thread::get_id();
  if (other && (s.state == State::ended || (s.state == State::ends && !whileItEnds))) return false;
  s.asking++;
  return true;
}

void finishAcquiring(int inside) {
  Sections& s = sections();
  const std::scoped_lock lock(s.mutex);
  s.asking--;
  s.inside += inside;
}

template <class Condition>
bool waitFor(std::chrono::milliseconds longest, const Condition& condition) {
  using Clock = std::chrono::steady_clock;
  for (const auto end = Clock::now() + longest;;
       std::this_thread::sleep_for(std::chrono::milliseconds(2))) {
    {
      const std::scoped_lock lock(sections().mutex);
      if (condition()) return true;
    }
    if (Clock::now() >= end) return false;
  }
}

// Waits for the other threads. Renders stop within a fraction of a second, because their progress
// callback ends them; a file that is being read continues.
void endInterpreter() {
  using std::chrono::seconds;
  Sections& s = sections();
  {
    const std::scoped_lock lock(s.mutex);
    s.state = State::ends;
    s.ending = std::this_thread::get_id();
  }
  PyThreadState* state = PyEval_SaveThread();
  waitFor(seconds(5), [&] { return s.inside == 0; });
  {
    const std::scoped_lock lock(s.mutex);
    s.state = State::ended;
  }
  // this is short: this thread does not hold the GIL
  waitFor(seconds(60), [&] { return s.asking == 0; });
  PyEval_RestoreThread(state);
}

} // namespace

ReleaseGil::ReleaseGil() {
  bool ends = false;
  {
    Sections& s = sections();
    const std::scoped_lock lock(s.mutex);
    ends = s.state != State::runs && s.ending != std::this_thread::get_id() &&
           trackedMutexesHeld == 0 && nestedReleases == 0;
    if (!ends) {
      s.inside++;
      nestedReleases++;
    }
  }
  state_ = PyEval_SaveThread();
  while (ends) ::pause(); // blocks until the process ends
}

ReleaseGil::~ReleaseGil() {
  while (!mayAcquireGil(true)) ::pause(); // blocks until the process ends
  PyEval_RestoreThread(state_);
  nestedReleases--;
  finishAcquiring(-1);
}

AcquireGil::AcquireGil() : held_(mayAcquireGil(false)) {
  if (!held_) return;
  state_ = PyGILState_Ensure();
  finishAcquiring(0);
}

AcquireGil::~AcquireGil() {
  if (held_) PyGILState_Release(state_);
}

bool interpreterEnds() {
  Sections& s = sections();
  const std::scoped_lock lock(s.mutex);
  return s.state != State::runs && s.ending != std::this_thread::get_id();
}

void watchInterpreter() {
  sections();
  // After fork(), the child has only the calling thread, none of the threads counted here.
  pthread_atfork([] { sections().mutex.lock(); }, [] { sections().mutex.unlock(); },
                 [] {
                   Sections& s = sections();
                   s.inside = s.asking = 0;
                   s.mutex.unlock();
                 });
  py::module_::import("atexit").attr("register")(py::cpp_function(endInterpreter));
}

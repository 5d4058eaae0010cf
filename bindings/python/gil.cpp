// gil.cpp: A hook of atexit does the waiting: it runs after threads that are no daemons
// have been joined, and before the interpreter refuses its lock to those that are.
#include "gil.h"

#include <chrono>
#include <mutex>
#include <thread>

#include <pthread.h>
#include <unistd.h>

namespace {

enum class State { runs, ends, ended };

struct Sections { // of this process; never destroyed: threads may outlive the module
  std::mutex mutex;
  State state = State::runs;
  std::thread::id ending; // the thread that ends the interpreter
  int inside = 0;         // threads that have given the lock up
  int asking = 0;         // threads that ask for it
};
Sections& sections() {
  static Sections& all = *new Sections;
  return all;
}

thread_local int insideHere = 0; // of them, those of this thread: one in a callback of another

// Before a thread asks for the lock. False: it must not.
bool mayAsk(bool whileItEnds) {
  Sections& s = sections();
  const std::scoped_lock lock(s.mutex);
  const bool other = s.ending != std::this_thread::get_id();
  if (other && (s.state == State::ended || (s.state == State::ends && !whileItEnds))) return false;
  s.asking++;
  return true;
}

void asked(int inside) {
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

// Renders stop within a fraction of a second, because their watch says so; a file that is being
// read goes on.
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
  waitFor(seconds(60),
          [&] { return s.asking == 0; }); // they get it soon: this thread does not have it
  PyEval_RestoreThread(state);
}

} // namespace

ReleaseGil::ReleaseGil() {
  bool ends = false;
  {
    Sections& s = sections();
    const std::scoped_lock lock(s.mutex);
    ends = s.state != State::runs && s.ending != std::this_thread::get_id() && awaitedHere == 0 &&
           insideHere == 0;
    if (!ends) {
      s.inside++;
      insideHere++;
    }
  }
  state_ = PyEval_SaveThread();
  while (ends) ::pause(); // until the process ends
}

ReleaseGil::~ReleaseGil() {
  while (!mayAsk(true)) ::pause(); // until the process ends
  PyEval_RestoreThread(state_);
  insideHere--;
  asked(-1);
}

AcquireGil::AcquireGil() : held_(mayAsk(false)) {
  if (!held_) return;
  state_ = PyGILState_Ensure();
  asked(0);
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
  // A child has the thread that called fork() and none of those that were inside.
  pthread_atfork([] { sections().mutex.lock(); }, [] { sections().mutex.unlock(); },
                 [] {
                   Sections& s = sections();
                   s.inside = s.asking = 0;
                   s.mutex.unlock();
                 });
  py::module_::import("atexit").attr("register")(py::cpp_function(endInterpreter));
}

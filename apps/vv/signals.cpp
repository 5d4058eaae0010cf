// signals.cpp: see signals.h.
#include "signals.h"

#include <atomic>
#include <csignal>

#include <unistd.h>

#include "picture/atomic_file.h"
#include "values.h"
#include "video.h"

namespace vv {

namespace {

std::atomic<bool> deferred{false}, interruptSeen{false}, saveWanted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void onInterrupt(int) {
  if (deferred && !interruptSeen.exchange(true)) return;
  picture::removeTemporary();
  abandonVideos();
  ::_exit(exitInterrupted);
}

void onSave(int) { saveWanted = true; }

void install(int signal, void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  ::sigemptyset(&action.sa_mask);
  ::sigaction(signal, &action, nullptr);
}

} // namespace

void installSignals() {
  install(SIGINT, onInterrupt);
  install(SIGTERM, onInterrupt);
  install(SIGUSR1, onSave);
  install(SIGPIPE, SIG_IGN); // a write that fails says so itself
}

void deferInterrupt(bool on) { deferred = on; }
bool interrupted() { return interruptSeen; }
bool takeSaveRequest() { return saveWanted.exchange(false); }

} // namespace vv

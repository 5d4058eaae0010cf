#include "process/signals.h"

#include <atomic>
#include <csignal>
#include <cstring>
#include <ctime>

#include <unistd.h>

#include "libpicture/files/atomic_file.h"
#include "openrt/openrt.h"
#include "process/exit_codes.h"

namespace vv {

namespace {

std::atomic<bool> deferred{false}, interruptSeen{false}, saveWanted{false};
std::atomic<unsigned> patience{0};   // time limit after the first SIGINT, in seconds
std::atomic<int64_t> interruptAt{0}; // steady-clock time of the first SIGINT, in seconds
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int64_t>::is_always_lock_free);

int64_t steadySeconds() {
  timespec now = {};
  ::clock_gettime(CLOCK_MONOTONIC, &now); // async-signal-safe
  return now.tv_sec;
}

void onInterrupt(int number) {
  if (number != SIGALRM && deferred && !interruptSeen.exchange(true)) {
    interruptAt = steadySeconds();
    if (patience > 0) ::alarm(patience);
    return;
  }
  picture::removeTemporaries();
  ::_exit(exitInterrupted);
}

void onSave(int) { saveWanted = true; }

void put(const char* text) {
  if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) return; // standard error is closed
}

// Prints which shader was running, then lets the crash continue. Calls only async-signal-safe
// functions.
void onCrash(int number) {
  const char* const name = number == SIGSEGV  ? "SIGSEGV"
                           : number == SIGBUS ? "SIGBUS"
                           : number == SIGFPE ? "SIGFPE"
                                              : "SIGILL";
  const char* const shader = rtRunningShader();
  put("vv: crash (");
  put(name);
  put(shader ? ") in the shader " : "), not in a shader");
  put(shader ? shader : "");
  put("\n");
  picture::removeTemporaries();
  ::signal(number, SIG_DFL);
  ::raise(number);
}

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
  install(SIGXCPU, onInterrupt); // the soft limit of a batch system
  struct sigaction before = {};
  ::sigaction(SIGHUP, nullptr, &before);
  if (before.sa_handler != SIG_IGN) install(SIGHUP, onInterrupt); // nohup ignores it
  install(SIGUSR1, onSave);
  for (int crash : {SIGSEGV, SIGBUS, SIGFPE, SIGILL}) install(crash, onCrash);
  install(SIGPIPE, SIG_IGN); // failed writes report errors themselves
  install(SIGXFSZ, SIG_IGN);
}

void deferInterrupt(bool on, unsigned seconds) {
  patience = seconds;
  deferred = on;
  if (seconds > 0) install(SIGALRM, onInterrupt);
}
void interruptHandled() { ::alarm(0); }
void limitInterrupt() {
  if (interruptSeen && patience > 0) ::alarm(patience);
}
bool interrupted() { return interruptSeen; }
int secondsInterrupted() { return interruptSeen ? int(steadySeconds() - interruptAt) : 0; }
bool takeSaveRequest() { return saveWanted.exchange(false); }

} // namespace vv

// notifier.cpp: Implements the notifier with poll(2) over the files of this thread.
#include "notifier.h"

#include <algorithm>
#include <vector>

#include <poll.h>

#include <tcl.h>

namespace tclscript {
namespace {

struct Watched {
  int file;
  int mask;  // events to wait for: TCL_READABLE, TCL_WRITABLE, TCL_EXCEPTION
  int ready; // the bits that are set in a queued event
  Tcl_FileProc* call;
  ClientData data;
};
thread_local std::vector<Watched> watched;

struct FileEvent {
  Tcl_Event header;
  int file;
};

Watched* find(int file) {
  const auto found = std::find_if(watched.begin(), watched.end(),
                                  [&](const Watched& w) { return w.file == file; });
  return found == watched.end() ? nullptr : &*found;
}

int serve(Tcl_Event* event, int flags) {
  if (!(flags & TCL_FILE_EVENTS)) return 0;
  const int file = reinterpret_cast<FileEvent*>(event)->file;
  if (Watched* w = find(file)) {
    const int mask = w->ready & w->mask;
    w->ready = 0;
    if (mask) w->call(w->data, mask); // may change the list
  }
  return 1;
}

// needed only where another event loop drives Tcl; here the host ticks
void setTimer(CONST86 Tcl_Time*) {}
void serviceMode(int) {}

void createFileHandler(int file, int mask, Tcl_FileProc* call, ClientData data) {
  if (Watched* w = find(file))
    *w = {file, mask, w->ready, call, data};
  else
    watched.push_back({file, mask, 0, call, data});
}
void deleteFileHandler(int file) {
  watched.erase(std::remove_if(watched.begin(), watched.end(),
                               [&](const Watched& w) { return w.file == file; }),
                watched.end());
}

// Another thread wants to wake this one; not needed, because this one waits only briefly.
ClientData initialize() { return nullptr; }
void finalize(ClientData) { watched.clear(); }
void alert(ClientData) {}

int waitForEvent(CONST86 Tcl_Time* longest) {
  std::vector<pollfd> files;
  for (const Watched& w : watched) {
    const int events = (w.mask & TCL_READABLE ? POLLIN : 0) |
                       (w.mask & TCL_WRITABLE ? POLLOUT : 0) |
                       (w.mask & TCL_EXCEPTION ? POLLPRI : 0);
    files.push_back({w.file, short(events), 0});
  }
  // Always limit the wait: Tcl is called from a frame of the host.
  constexpr int maxMilliseconds = 20;
  const int milliseconds =
      longest
          ? int(std::min<long long>(longest->sec * 1000LL + longest->usec / 1000, maxMilliseconds))
          : maxMilliseconds;
  if (poll(files.data(), nfds_t(files.size()), milliseconds) <= 0) return 0;
  for (const pollfd& p : files) {
    const int mask = (p.revents & (POLLIN | POLLHUP | POLLERR) ? TCL_READABLE : 0) |
                     (p.revents & POLLOUT ? TCL_WRITABLE : 0) |
                     (p.revents & POLLPRI ? TCL_EXCEPTION : 0);
    Watched* w = find(p.fd);
    if (!w || !(mask & w->mask)) continue;
    if (!w->ready) {
      auto* event = reinterpret_cast<FileEvent*>(ckalloc(sizeof(FileEvent)));
      event->header.proc = serve;
      event->file = p.fd;
      Tcl_QueueEvent(&event->header, TCL_QUEUE_TAIL);
    }
    w->ready |= mask;
  }
  return 0;
}

} // namespace

void setNotifier() {
  static Tcl_NotifierProcs procs = {
      setTimer, waitForEvent, createFileHandler, deleteFileHandler, initialize,
      finalize, alert,        serviceMode};
  Tcl_SetNotifier(&procs);
}

} // namespace tclscript

// process.h: processes that this one starts: their descriptors, memory, time and end; and how such
// a process is bound to the one that started it. Where a system lacks a call, the function does
// what is next best, and says so.
#pragma once

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <string>
#include <string_view>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/types.h>
#include <unistd.h>

#if defined(__linux__)
#include <sys/prctl.h>
#include <sys/syscall.h>
#else
#include <crt_externs.h>
#include <libproc.h>
#endif

namespace os {

// Makes the new process close descriptors from `first` on. Returns the flags that
// posix_spawnattr_setflags needs for it.
inline short closeFrom(posix_spawn_file_actions_t* actions, int first) {
#if defined(__linux__)
  posix_spawn_file_actions_addclosefrom_np(actions, first);
  return 0;
#else
  (void)actions;
  (void)first;
  return POSIX_SPAWN_CLOEXEC_DEFAULT; // all but those that the actions name
#endif
}

// Returns a descriptor that refers to a process even if its number is reused; -1 if there is none.
inline int processDescriptor(pid_t process) {
#if defined(__linux__)
  return int(syscall(SYS_pidfd_open, process, 0));
#else
  (void)process;
  return -1;
#endif
}

// Ends a process, by its descriptor if there is one.
inline void endProcess(pid_t process, int descriptor) {
#if defined(__linux__)
  if (descriptor >= 0) {
    syscall(SYS_pidfd_send_signal, descriptor, SIGKILL, nullptr, 0);
    return;
  }
#else
  (void)descriptor;
#endif
  ::kill(process, SIGKILL);
}

// Limits the address space of a process; macOS has no such limit.
inline void limitAddressSpace(pid_t process, uint64_t bytes) {
#if defined(__linux__)
  rlimit old{};
  if (prlimit(process, RLIMIT_AS, nullptr, &old) != 0) return;
  const rlimit fresh{bytes < old.rlim_max ? rlim_t(bytes) : old.rlim_max, old.rlim_max};
  prlimit(process, RLIMIT_AS, &fresh, nullptr);
#else
  (void)process;
  (void)bytes;
#endif
}

// Returns the processor time that a process has used, in seconds; 0 if unknown.
inline double processorSeconds(pid_t process) {
#if defined(__linux__)
  clockid_t clock{};
  timespec time{};
  if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &time) != 0) return 0;
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
#else
  proc_taskinfo info{};
  if (proc_pidinfo(process, PROC_PIDTASKINFO, 0, &info, sizeof info) != int(sizeof info)) return 0;
  return 1e-9 * double(info.pti_total_user + info.pti_total_system);
#endif
}

// Returns true if a process computes, or would if a processor were free; false if it waits.
inline bool computes(pid_t process) {
#if defined(__linux__)
  char line[512] = {};
  std::FILE* file = std::fopen(("/proc/" + std::to_string(process) + "/stat").c_str(), "re");
  if (!file) return false;
  const size_t got = std::fread(line, 1, sizeof line - 1, file);
  std::fclose(file);
  // The state follows the program's name.
  const size_t name = std::string_view(line, got).rfind(") ");
  return name != std::string_view::npos && name + 2 < got && line[name + 2] == 'R';
#else
  proc_taskinfo info{};
  return proc_pidinfo(process, PROC_PIDTASKINFO, 0, &info, sizeof info) == int(sizeof info) &&
         info.pti_numrunning > 0;
#endif
}

// Returns the description of a signal.
inline std::string signalName(int signal) {
#if defined(__linux__)
  const char* const name = sigdescr_np(signal);
#else
  const char* const name = strsignal(signal);
#endif
  return name ? name : "?";
}

// Waits until a descriptor is ready, for at most so long; as poll() does.
inline int pollFor(pollfd& ready, int64_t nanoseconds) {
#if defined(__linux__)
  const timespec time{time_t(nanoseconds / 1'000'000'000), long(nanoseconds % 1'000'000'000)};
  return ppoll(&ready, 1, &time, nullptr);
#else
  return poll(&ready, 1, int((nanoseconds + 999'999) / 1'000'000));
#endif
}

// Asks for a signal when the thread that started this process ends. macOS has no such signal;
// there, a process ends when it reads from the socket that has closed.
inline void signalWhenParentEnds(int signal) {
#if defined(__linux__)
  prctl(PR_SET_PDEATHSIG, signal);
#else
  (void)signal;
#endif
}

// Gives up the rights of programs that have more than their user. macOS has no such call.
inline bool giveUpPrivileges() {
#if defined(__linux__)
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0;
#else
  return true;
#endif
}

// Tells whether the system can filter the calls of a process.
inline bool canFilterCalls() {
#if defined(__linux__)
  return prctl(PR_GET_SECCOMP) >= 0;
#else
  return false;
#endif
}

// Makes a pipe whose ends close in programs that the process starts. Returns false if it cannot.
inline bool makePipe(int ends[2]) {
#if defined(__linux__)
  return pipe2(ends, O_CLOEXEC) == 0;
#else
  if (pipe(ends) != 0) return false;
  for (int i = 0; i < 2; ++i) fcntl(ends[i], F_SETFD, FD_CLOEXEC);
  return true;
#endif
}

// Forgets all environment variables. Unlike clearenv(), it leaves an empty list, which Tcl needs.
inline void emptyEnvironment() {
  static char* empty[] = {nullptr};
#if defined(__linux__)
  environ = empty;
#else
  *_NSGetEnviron() = empty;
#endif
}

// Replaces a missing list of environment variables, as after clearenv(), by an empty one.
inline void listEnvironment() {
#if defined(__linux__)
  if (!environ) emptyEnvironment();
#endif
}

// Returns the bytes of this process's address space; 0 if unknown.
inline uint64_t addressSpace() {
#if defined(__linux__)
  unsigned long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "re")) {
    if (std::fscanf(file, "%lu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return uint64_t(pages) * uint64_t(sysconf(_SC_PAGESIZE));
#else
  return 0; // no limit is set there
#endif
}

} // namespace os

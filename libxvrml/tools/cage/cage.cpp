#include "tools/cage/cage.h"

#include <cerrno>
#include <csignal>
#include <cstring>

#include <poll.h>
#include <sys/resource.h>
#include <unistd.h>

#ifdef XVRML_WITH_SECCOMP
#include <seccomp.h>
#endif

#include "system/process.h"

namespace xvrml {
namespace {

// Sets resource limits. Core dumps are off, because they contain the program's memory and fill
// disks. Processor time is limited to a day, so that no process stays for ever. New file
// descriptors are forbidden: the limit is the lowest free number, which the next one would get.
bool limitResources(std::string& why) {
  const int lowestFree = dup(0);
  if (lowestFree >= 0) close(lowestFree);
  const struct {
    decltype(RLIMIT_CORE) resource;
    rlim_t most;
    const char* name;
  } table[] = {{RLIMIT_CORE, 0, "core files"},
               {RLIMIT_FSIZE, 0, "file sizes"},
               {RLIMIT_NPROC, 0, "processes"},
               {RLIMIT_CPU, 24 * 3600, "processor time"},
               {RLIMIT_NOFILE, lowestFree >= 0 ? rlim_t(lowestFree) : 0, "files"}};
  for (const auto& limit : table) {
    const rlimit both{limit.most, limit.most};
    if (setrlimit(limit.resource, &both) != 0) {
      why = std::string("cannot limit ") + limit.name;
      return false;
    }
  }
  return true;
}

#ifdef XVRML_WITH_SECCOMP
// Allowed system calls: memory, time, files already open, waiting, own signals (abort), exit. All
// others fail with EPERM.
constexpr int allowed[] = {SCMP_SYS(brk),
                           SCMP_SYS(mmap),
                           SCMP_SYS(munmap),
                           SCMP_SYS(mremap),
                           SCMP_SYS(madvise),
                           SCMP_SYS(mprotect),
                           SCMP_SYS(read),
                           SCMP_SYS(readv),
                           SCMP_SYS(write),
                           SCMP_SYS(writev),
                           SCMP_SYS(recvfrom),
                           SCMP_SYS(sendto),
                           SCMP_SYS(recvmsg),
                           SCMP_SYS(close),
                           SCMP_SYS(fstat),
                           SCMP_SYS(newfstatat),
                           SCMP_SYS(lseek),
                           SCMP_SYS(poll),
                           SCMP_SYS(ppoll),
                           SCMP_SYS(select),
                           SCMP_SYS(pselect6),
                           SCMP_SYS(epoll_wait),
                           SCMP_SYS(epoll_pwait),
                           SCMP_SYS(futex),
                           SCMP_SYS(clock_gettime),
                           SCMP_SYS(gettimeofday),
                           SCMP_SYS(time),
                           SCMP_SYS(clock_getres),
                           SCMP_SYS(nanosleep),
                           SCMP_SYS(clock_nanosleep),
                           SCMP_SYS(sched_yield),
                           SCMP_SYS(getrandom),
                           SCMP_SYS(getrusage),
                           SCMP_SYS(times),
                           SCMP_SYS(getpid),
                           SCMP_SYS(gettid),
                           SCMP_SYS(getuid),
                           SCMP_SYS(geteuid),
                           SCMP_SYS(getgid),
                           SCMP_SYS(getegid),
                           SCMP_SYS(sysinfo),
                           SCMP_SYS(getcwd),
                           SCMP_SYS(rt_sigaction),
                           SCMP_SYS(rt_sigprocmask),
                           SCMP_SYS(rt_sigreturn),
                           SCMP_SYS(sigaltstack),
                           SCMP_SYS(restart_syscall),
                           SCMP_SYS(exit),
                           SCMP_SYS(exit_group)};

bool filterCalls(std::string& why) {
  scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ERRNO(EPERM));
  if (!filter) {
    why = "no filter of system calls";
    return false;
  }
  int error = seccomp_attr_set(filter, SCMP_FLTATR_CTL_TSYNC,
                               1); // also for threads that an engine has made in prepare()
  seccomp_attr_set(filter, SCMP_FLTATR_CTL_OPTIMIZE, 2);
  for (const int call : allowed)
    if (error == 0) error = seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 0);
  // Allow signals to this process only, for abort().
  if (error == 0)
    error = seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(tgkill), 1,
                             SCMP_A0(SCMP_CMP_EQ, uint64_t(getpid())));
  if (error == 0) error = seccomp_load(filter);
  seccomp_release(filter);
  if (error != 0) why = std::string("no filter of system calls: ") + std::strerror(-error);
  return error == 0;
}
#else
bool filterCalls(std::string&) { return true; }
#endif

} // namespace

// Ends this process with its parent. The kernel sends the signal when the thread that started this
// process ends. If the other end of the socket is still open, the parent's other threads continue,
// and so does this process.
bool bindToParent(long parent, int socket) {
  static int other;
  other = socket;
  struct sigaction action {};
  action.sa_flags = SA_RESTART;
  action.sa_handler = [](int) {
    const int saved = errno;
    pollfd end{other, 0, 0};
    if (poll(&end, 1, 0) > 0) _exit(0);
    errno = saved;
  };
  sigaction(SIGUSR2, &action, nullptr);
  os::signalWhenParentEnds(SIGUSR2);
  return getppid() == parent && chdir("/") == 0;
}

bool enterSandbox(std::string& why) {
  os::emptyEnvironment();
  if (!limitResources(why)) return false;
  if (!os::giveUpPrivileges()) {
    why = "no way to give up privileges";
    return false;
  }
  return filterCalls(why);
}

uint64_t addressSpace() {
  const uint64_t bytes = os::addressSpace();
  return bytes > (uint64_t(64) << 30) ? 0 : bytes;
}

} // namespace xvrml

#include "script/remote/child.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "plugin_files.h"

namespace xvrml {
namespace {

namespace fs = std::filesystem;

constexpr const char* programName = "xvrml-script-host";
// Environment variables that engines may need while they are prepared; the environment is empty
// when a Script's program runs. LD_LIBRARY_PATH is not passed on. A user may have set it for
// another program, perhaps with an empty element for the current folder, and it would choose this
// program's libraries.
constexpr std::array inheritedVariables = {"TCL_LIBRARY", "ASAN_OPTIONS", "UBSAN_OPTIONS",
                                           "TSAN_OPTIONS"};

bool usable(const fs::path& program, std::string& why) {
  if (access(program.c_str(), X_OK) != 0)
    why = fmt::format("{}: {}", program.string(), std::strerror(errno));
  else if (!plugin_files::trusted(program.parent_path().string()))
    why = fmt::format("{}: its folder is refused: {}", program.string(),
                      plugin_files::objection(program.parent_path().string()));
  else if (const std::string objection = plugin_files::objection(program.string());
           !objection.empty())
    why = fmt::format("{} is refused: {}", program.string(), objection);
  else
    return true;
  return false;
}

struct Actions {
  Actions() {
    posix_spawn_file_actions_init(&files);
    posix_spawnattr_init(&attributes);
  }
  ~Actions() {
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
  }
  Actions(const Actions&) = delete;
  Actions& operator=(const Actions&) = delete;
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
};

} // namespace

std::string findScriptHostProgram(std::string& why) {
  if (const char* named = secure_getenv("XVRML_SCRIPT_HOST"); named && *named)
    return usable(named, why) ? std::string(named) : std::string();
  static const char here = 0;
  std::error_code error;
  Dl_info info{};
  std::vector<fs::path> places;
  if (dladdr(&here, &info) != 0 && info.dli_fname)
    places.push_back(fs::canonical(info.dli_fname, error).parent_path());
  places.push_back(fs::read_symlink("/proc/self/exe", error).parent_path());
  for (const fs::path& place : places)
    for (const char* folder : {"../libexec/xvrml", "../../libexec/xvrml", "../bin", "."}) {
      const fs::path program = fs::canonical(place / folder / programName, error);
      if (!error) return usable(program, why) ? program.string() : std::string();
    }
  why = fmt::format("the program {} is not installed beside the library", programName);
  return {};
}

Child::~Child() {
  kill();
  if (pid_ > 0) reap(1000);
  if (descriptor_ >= 0) close(descriptor_);
}

int Child::start(const std::string& program, std::string& why) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    why = fmt::format("no socket pair: {}", std::strerror(errno));
    return -1;
  }
  Actions actions;
  for (int standard = 0; standard < 3; ++standard)
    posix_spawn_file_actions_addopen(&actions.files, standard, "/dev/null", O_RDWR, 0);
  posix_spawn_file_actions_adddup2(&actions.files, ends[1], 3);
  posix_spawn_file_actions_addclosefrom_np(&actions.files, 4);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setflags(&actions.attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF |
                                                    POSIX_SPAWN_SETSID); // not ended by Ctrl-C
  posix_spawnattr_setsigmask(&actions.attributes, &none);
  posix_spawnattr_setsigdefault(&actions.attributes, &all);
  std::string name = program, parent = std::to_string(getpid());
  char* arguments[] = {name.data(), parent.data(), nullptr};
  std::vector<std::string> variables;
  for (const char* variable : inheritedVariables)
    if (const char* value = std::getenv(variable); value && *value)
      variables.push_back(fmt::format("{}={}", variable, value));
  std::vector<char*> environment;
  for (std::string& variable : variables) environment.push_back(variable.data());
  environment.push_back(nullptr);
  // Use posix_spawn: fork would copy the page tables of a browser with gigabytes of geometry.
  const int error = posix_spawn(&pid_, program.c_str(), &actions.files, &actions.attributes,
                                arguments, environment.data());
  close(ends[1]);
  if (error != 0) {
    pid_ = 0;
    close(ends[0]);
    why = fmt::format("{}: {}", program, std::strerror(error));
    return -1;
  }
  owner_ = getpid();
  descriptor_ = int(syscall(SYS_pidfd_open, pid_, 0));
  return ends[0];
}

void Child::limitMemory(uint64_t bytes) {
  rlimit old{};
  if (pid_ <= 0 || ended_ || prlimit(pid_, RLIMIT_AS, nullptr, &old) != 0) return;
  const rlimit fresh{std::min<rlim_t>(bytes, old.rlim_max), old.rlim_max};
  prlimit(pid_, RLIMIT_AS, &fresh, nullptr);
}

double Child::processorSeconds() const {
  clockid_t clock{};
  timespec time{};
  if (pid_ <= 0 || ended_ || clock_getcpuclockid(pid_, &clock) != 0 ||
      clock_gettime(clock, &time) != 0)
    return 0;
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

bool Child::computes() const {
  if (pid_ <= 0 || ended_) return false;
  char line[512] = {};
  std::FILE* file = std::fopen(fmt::format("/proc/{}/stat", pid_).c_str(), "re");
  if (!file) return false;
  const size_t got = std::fread(line, 1, sizeof line - 1, file);
  std::fclose(file);
  // The state follows the program's name.
  const size_t name = std::string_view(line, got).rfind(") ");
  return name != std::string_view::npos && name + 2 < got && line[name + 2] == 'R';
}

void Child::kill() noexcept {
  if (pid_ <= 0 || ended_ || owner_ != getpid()) return; // not in a copy made by fork()
  if (descriptor_ >= 0)
    syscall(SYS_pidfd_send_signal, descriptor_, SIGKILL, nullptr, 0);
  else
    ::kill(pid_, SIGKILL);
}

// Waits for the end. If the application has already waited for the process, the exit status stays
// unknown.
bool Child::reap(int milliseconds) noexcept {
  if (ended_ || pid_ <= 0 || owner_ != getpid()) return true;
  for (int left = milliseconds;; left -= 5) {
    rusage usage{};
    const pid_t got = wait4(pid_, &status_, WNOHANG, &usage);
    if (got == pid_ || (got < 0 && errno == ECHILD)) {
      known_ = got == pid_;
      peak_ = usage.ru_maxrss;
      return ended_ = true;
    }
    if (left <= 0) return false;
    pollfd end{descriptor_, POLLIN, 0};
    poll(&end, descriptor_ >= 0 ? 1 : 0, 5);
  }
}

std::string Child::ending() {
  if (!reap(200)) {
    kill();
    reap(1000);
    return "broke off";
  }
  if (!known_) return "ended";
  if (WIFEXITED(status_)) return fmt::format("ended with code {}", WEXITSTATUS(status_));
  const int signal = WTERMSIG(status_);
  constexpr long much = 64 * 1024; // in kB, more than any language needs for itself
  return fmt::format("ended by signal {} ({})", signal,
                     sigdescr_np(signal) ? sigdescr_np(signal) : "?") +
         (peak_ > much ? fmt::format(", having used {} MB", peak_ / 1024) : "");
}

} // namespace xvrml

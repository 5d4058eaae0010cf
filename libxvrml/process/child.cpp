#include "process/child.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "plugin_files.h"
#include "system/files.h"
#include "system/libraries.h"
#include "system/process.h"
#include "system/sockets.h"

namespace xvrml {
namespace {

namespace fs = std::filesystem;

// Environment variables that engines may need while they are prepared; the environment is empty
// when a program of a world runs. LD_LIBRARY_PATH is not passed on. A user may have set it for
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

std::string findHelper(const HelperProgram& helper, std::string& why) {
  if (const char* named = os::trustedEnvironment(helper.variable); named && *named)
    return usable(named, why) ? std::string(named) : std::string();
  static const char here = 0;
  std::error_code error;
  Dl_info info{};
  std::vector<fs::path> places;
  if (dladdr(&here, &info) != 0 && info.dli_fname)
    places.push_back(fs::canonical(info.dli_fname, error).parent_path());
  places.push_back(os::programFile(error).parent_path());
  for (const fs::path& place : places)
    for (const char* folder : {"../libexec/xvrml", "../../libexec/xvrml", "../bin", "."}) {
      const fs::path program = fs::canonical(place / folder / helper.name, error);
      if (!error) return usable(program, why) ? program.string() : std::string();
    }
  why = fmt::format("the program {} is not installed beside the library", helper.name);
  return {};
}

Child::~Child() {
  kill();
  if (pid_ > 0) reap(1000);
  if (descriptor_ >= 0) close(descriptor_);
}

int Child::start(const std::string& program, std::string& why) {
  int ends[2];
  if (os::streamPair(ends) != 0) {
    why = fmt::format("no socket pair: {}", std::strerror(errno));
    return -1;
  }
  Actions actions;
  for (int standard = 0; standard < 3; ++standard)
    posix_spawn_file_actions_addopen(&actions.files, standard, "/dev/null", O_RDWR, 0);
  posix_spawn_file_actions_adddup2(&actions.files, ends[1], 3);
  const short closing = os::closeFrom(&actions.files, 4);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setflags(&actions.attributes,
                           short(POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF |
                                 POSIX_SPAWN_SETSID | closing)); // not ended by Ctrl-C
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
  descriptor_ = os::processDescriptor(pid_);
  return ends[0];
}

void Child::limitMemory(uint64_t bytes) {
  if (pid_ > 0 && !ended_) os::limitAddressSpace(pid_, bytes);
}

double Child::processorSeconds() const {
  return pid_ <= 0 || ended_ ? 0 : os::processorSeconds(pid_);
}

bool Child::computes() const { return pid_ > 0 && !ended_ && os::computes(pid_); }

void Child::kill() noexcept {
  if (pid_ <= 0 || ended_ || owner_ != getpid()) return; // not in a copy made by fork()
  os::endProcess(pid_, descriptor_);
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
  return fmt::format("ended by signal {} ({})", signal, os::signalName(signal)) +
         (peak_ > much ? fmt::format(", having used {} MB", peak_ / 1024) : "");
}

} // namespace xvrml

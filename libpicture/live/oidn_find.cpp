// oidn_find.cpp: Finds Open Image Denoise: where it is looked for, and how a library that may end
// the process is tried in a child process.
#include <dlfcn.h>
#include <fcntl.h>
#include <glob.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <string_view>

#include <fmt/format.h>

#include "libpicture/live/oidn.h"
#include "system/libraries.h"
#include "system/process.h"

namespace picture::live {

namespace {

constexpr const char* variable = "OPENRT_OIDN_LIBRARY";
constexpr const char* names[] = {"libOpenImageDenoise.so.2", "libOpenImageDenoise.so"};
constexpr const char* inPackage = "/oidn/lib/libOpenImageDenoise.so.2"; // where pyoidn has it
constexpr char finished = '\n';          // ends what the child of a trial says
constexpr int trialMilliseconds = 60000; // a busy machine may need seconds

std::mutex mutex; // guards `packages`
std::vector<std::string>& packages() {
  static std::vector<std::string> folders;
  return folders;
}

std::string given() {
  const char* const name = os::trustedEnvironment(variable);
  return name ? name : "";
}

// Returns the folder `up` levels above the file of this code, a program or a Python module.
std::string folderAbove(int up) {
  Dl_info place{};
  if (!dladdr(reinterpret_cast<const void*>(&OidnLibrary::lookIn), &place) || !place.dli_fname)
    return "";
  std::error_code error;
  std::filesystem::path path = std::filesystem::canonical(place.dli_fname, error);
  while (up-- > 0) path = path.parent_path();
  return error ? "" : path.string();
}

// Adds the files of this name below folders, which may be patterns of the shell.
void addFiles(const std::string& pattern, std::vector<std::string>& files) {
  const std::string wanted = pattern + inPackage;
  if (::access(wanted.c_str(), F_OK) == 0) return files.push_back(wanted);
  glob_t found{};
  if (::glob(wanted.c_str(), 0, nullptr, &found) == 0)
    for (size_t i = 0; i < found.gl_pathc; i++) files.emplace_back(found.gl_pathv[i]);
  ::globfree(&found);
}

// Returns the files of Python packages pyoidn that are installed where pip installs: beside this
// project's own package (site-packages/xvrml/_xvrml.so, site-packages/xvrml/bin/vv), in the virtual
// environment of the shell, and for Debian's Python by the user or by root.
std::vector<std::string> packageFiles() {
  std::vector<std::string> files;
  for (const int up : {2, 3}) // above the package
    if (const std::string folder = folderAbove(up); folder.size() > 1)
      addFiles(folder + "/pyoidn", files);
  {
    const std::lock_guard lock(mutex);
    for (const std::string& folder : packages()) addFiles(folder, files);
  }
  constexpr const char* below = "/lib/python3*/site-packages/pyoidn";
  // A relative path would mean whatever lies in the folder in which the program was started.
  if (const char* const environment = os::trustedEnvironment("VIRTUAL_ENV");
      environment && *environment == '/')
    addFiles(std::string(environment) + below, files);
  if (const char* const home = os::trustedEnvironment("HOME"); home && *home == '/')
    addFiles(std::string(home) + "/.local" + below, files);
  addFiles(std::string("/usr/local") + below, files);
  addFiles("/usr/local/lib/python3*/dist-packages/pyoidn", files);
  return files;
}

// The names under which the library is looked for.
std::vector<std::string> candidates() {
  std::vector<std::string> files(std::begin(names), std::end(names));
  const std::vector<std::string> more = packageFiles();
  files.insert(files.end(), more.begin(), more.end());
  return files;
}

std::shared_ptr<const OidnLibrary> look() {
  const std::string file = given();
  if (file == "none") return nullptr;
  if (!file.empty()) {
    if (auto found = OidnLibrary::load(file)) return found;
    throw OidnError(fmt::format("{}: there is no library {}", variable, file));
  }
  for (const std::string& name : candidates())
    if (auto found = OidnLibrary::load(name)) return found;
  return nullptr;
}

// Loads the library and filters a small picture.
void tryLibrary() {
  const auto found = look();
  if (!found) return;
  OidnFilter filter(found, 1, OidnQuality::fast, OidnGuides::none);
  OidnImages images;
  images.resize(16, 16);
  std::fill(images.colour.begin(), images.colour.end(), 0.5f);
  filter.denoise(images);
}

// The child of a trial: its problem is written to the pipe, and then that it has finished. It ends
// without the parent's exit handlers.
[[noreturn]] void runChild(int pipe) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT}) std::signal(signal, SIG_DFL);
  std::string problem;
  try {
    tryLibrary();
  } catch (const std::exception& error) { problem = error.what(); }
  problem.resize(std::min(problem.size(), size_t(4096)));
  problem += finished;
  const char* from = problem.data();
  for (size_t left = problem.size(); left > 0;) {
    const ssize_t written = ::write(pipe, from, left);
    if (written <= 0) break;
    from += written;
    left -= size_t(written);
  }
  ::_exit(0);
}

// Returns what the child says, or how it ended.
std::string problemOf(pid_t child, int pipe) {
  std::string said;
  char part[512];
  bool late = false;
  for (;;) {
    pollfd ready{pipe, POLLIN, 0};
    const int count = ::poll(&ready, 1, trialMilliseconds);
    if (count < 0 && errno == EINTR) continue;
    late = count == 0;
    const ssize_t bytes = count > 0 ? ::read(pipe, part, sizeof part) : 0;
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes <= 0) break;
    said.append(part, size_t(bytes));
  }
  if (late) ::kill(child, SIGKILL);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {}
  const std::string file = given().empty() ? names[0] : given();
  if (late) return fmt::format("{} does not answer within {} s", file, trialMilliseconds / 1000);
  if (WIFSIGNALED(status))
    return fmt::format("{} crashes when it is tried ({}): it is not a working Open Image Denoise 2",
                       file, ::strsignal(WTERMSIG(status)));
  if (!said.ends_with(finished))
    return fmt::format(
        "{} ends the process that loads it: it is not a working Open Image Denoise 2", file);
  said.pop_back();
  return said;
}

// Returns why the library cannot be used; "": it can, or there is none, or no child can be made.
std::string tryInChild() {
  int ends[2];
  if (!os::makePipe(ends)) return "";
  const pid_t child = ::fork();
  if (child == 0) runChild(ends[1]);
  ::close(ends[1]);
  std::string problem;
  if (child > 0) problem = problemOf(child, ends[0]);
  ::close(ends[0]);
  return problem;
}

} // namespace

void OidnLibrary::lookIn(const std::string& packageFolder) {
  const std::lock_guard lock(mutex);
  packages().push_back(packageFolder);
}

std::shared_ptr<const OidnLibrary> OidnLibrary::find() {
  static std::once_flag once;
  static std::shared_ptr<const OidnLibrary> found;
  static std::string problem;
  std::call_once(once, [] {
    try {
      found = look();
    } catch (const std::exception& error) { problem = error.what(); }
  });
  if (!problem.empty()) throw OidnError(problem);
  return found;
}

std::shared_ptr<const OidnLibrary> OidnLibrary::findTried() {
  static std::once_flag once;
  static std::string problem;
  std::call_once(once, [] { problem = tryInChild(); });
  if (!problem.empty()) throw OidnError(problem);
  return find();
}

} // namespace picture::live

// files.h: what a system says of files: their times, the clock that stamps them, the place of the
// running program. Stateless; any thread.
#pragma once

#include <ctime>
#include <filesystem>
#include <system_error>

#include <sys/stat.h>

#if defined(__APPLE__)
#include <cstdint>
#include <string>

#include <mach-o/dyld.h>
#endif

namespace os {

// Returns when a file was changed last.
inline timespec modifiedTime(const struct stat& status) {
#if defined(__APPLE__)
  return status.st_mtimespec;
#else
  return status.st_mtim;
#endif
}

// Returns the earliest time that a file can be stamped with when it is changed from now on. A stamp
// may be later than the change's time by this clock: since Linux 6.13 some are of the finer
// CLOCK_REALTIME.
inline timespec fileClock() {
  timespec time{};
#if defined(__linux__)
  clock_gettime(CLOCK_REALTIME_COARSE, &time);
#else
  clock_gettime(CLOCK_REALTIME, &time);
#endif
  return time;
}

// Returns the file of the running program; empty, with an error, if it is unknown.
inline std::filesystem::path programFile(std::error_code& error) {
#if defined(__APPLE__)
  uint32_t size = 0;
  _NSGetExecutablePath(nullptr, &size);
  std::string path(size, '\0');
  if (_NSGetExecutablePath(path.data(), &size) != 0) {
    error = std::make_error_code(std::errc::no_such_file_or_directory);
    return {};
  }
  return std::filesystem::canonical(path.c_str(), error);
#else
  return std::filesystem::read_symlink("/proc/self/exe", error);
#endif
}

} // namespace os

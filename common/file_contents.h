// file_contents.h: Reads small files that users name on a command line: also pipes, such as those
// that a shell makes of the output of a program. Reading is bounded. [any thread]
#pragma once

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

// Returns the content of a file of at most `most` bytes. Throws std::runtime_error with the reason
// alone ("it is a folder"), so that callers name the file.
inline std::string fileContents(const std::string& path, size_t most) {
  struct File {
    int fd;
    ~File() {
      if (fd >= 0) ::close(fd);
    }
  };
  const File file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY)};
  struct stat info {};
  if (file.fd < 0 || ::fstat(file.fd, &info) != 0) throw std::runtime_error(std::strerror(errno));
  if (S_ISDIR(info.st_mode)) throw std::runtime_error("it is a folder");
  std::string text;
  char block[65536];
  while (text.size() <= most) {
    const ssize_t got = ::read(file.fd, block, sizeof block);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw std::runtime_error(std::strerror(errno));
    if (got == 0) return text;
    text.append(block, size_t(got));
  }
  throw std::runtime_error("it is longer than " + std::to_string(most) + " bytes");
}

// spare_descriptors.h: Tells in time that file descriptors are short. Some libraries end the
// process when they cannot open one: ZeroMQ does so when it starts. Stateless; any thread.
#pragma once

#include <cerrno>
#include <string>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

// Throws std::system_error unless `count` more descriptors can be opened now. what: who needs them.
inline void needDescriptors(int count, const std::string& what) {
  std::vector<int> opened;
  int reason = 0;
  while (reason == 0 && int(opened.size()) < count) {
    const int fd = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (fd < 0)
      reason = errno;
    else
      opened.push_back(fd);
  }
  for (const int fd : opened) ::close(fd);
  if (reason == EMFILE || reason == ENFILE)
    throw std::system_error(reason, std::generic_category(),
                            what + " needs " + std::to_string(count) +
                                " more file descriptors (ulimit -n)");
}

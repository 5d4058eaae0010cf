// wake_up.h: a file descriptor that becomes readable when another thread asks for attention.
#pragma once

#include <cerrno>
#include <cstdint>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#if defined(__linux__)
#include <sys/eventfd.h>
#endif

namespace os {

class WakeUp {
 public:
  // Throws std::system_error, if there are too many open files.
  WakeUp() {
#if defined(__linux__)
    read_ = write_ = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (read_ < 0) fail();
#else
    int ends[2];
    if (::pipe(ends) != 0) fail();
    read_ = ends[0];
    write_ = ends[1];
    for (const int end : ends) {
      ::fcntl(end, F_SETFD, FD_CLOEXEC);
      ::fcntl(end, F_SETFL, O_NONBLOCK);
    }
#endif
  }
  ~WakeUp() {
    ::close(read_);
    if (write_ != read_) ::close(write_);
  }
  WakeUp(const WakeUp&) = delete;
  WakeUp& operator=(const WakeUp&) = delete;

  int fd() const { return read_; }
  // If the counter or the pipe is full, the descriptor is readable anyway.
  void call() { // [any thread]
    const uint64_t one = 1;
    static_cast<void>(!::write(write_, &one, sizeof one));
  }
  // Makes it unreadable. Returns whether it was called.
  bool clear() {
    uint64_t count = 0;
    bool called = false;
    while (::read(read_, &count, sizeof count) == ssize_t(sizeof count)) called = true;
    return called;
  }

 private:
  [[noreturn]] static void fail() {
    throw std::system_error(errno, std::generic_category(), "no descriptor to wake a thread by");
  }
  int read_ = -1, write_ = -1;
};

} // namespace os

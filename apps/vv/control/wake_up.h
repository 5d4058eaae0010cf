// wake_up.h: A file descriptor that becomes readable when another thread asks for attention.
#pragma once

#include <cstdint>
#include <new>

#include <sys/eventfd.h>
#include <unistd.h>

namespace vv::control {

class WakeUp {
 public:
  WakeUp() : fd_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    if (fd_ < 0) throw std::bad_alloc();
  }
  ~WakeUp() { ::close(fd_); }
  WakeUp(const WakeUp&) = delete;
  WakeUp& operator=(const WakeUp&) = delete;

  int fd() const { return fd_; }
  void call() { // [any thread]
    const uint64_t one = 1;
    static_cast<void>(!::write(fd_, &one, sizeof one));
  }
  void clear() {
    uint64_t count = 0;
    static_cast<void>(!::read(fd_, &count, sizeof count));
  }

 private:
  int fd_;
};

} // namespace vv::control

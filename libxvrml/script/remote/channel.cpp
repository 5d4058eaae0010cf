// channel.cpp: Part of the library and of xvrml-script-host.
#include "script/remote/channel.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace xvrml::wire {
namespace {

constexpr size_t chunk = 64 << 10;

// Waits until the socket is ready; false if it is not in time.
bool wait(int socket, short what, Clock::time_point until) {
  for (;;) {
    const auto left =
        std::chrono::duration_cast<std::chrono::nanoseconds>(until - Clock::now()).count();
    if (left <= 0) return false;
    const timespec time{time_t(left / 1'000'000'000), long(left % 1'000'000'000)};
    pollfd ready{socket, what, 0};
    const int count = ppoll(&ready, 1, &time, nullptr);
    if (count > 0) return true; // errors, too: the call that follows tells
    if (count < 0 && errno != EINTR) return true;
  }
}

} // namespace

Channel::~Channel() { close(socket_); }

bool Channel::send(std::string_view message) {
  auto until = Clock::now() + patience_;
  while (!message.empty()) {
    const ssize_t sent =
        ::send(socket_, message.data(), message.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent > 0) {
      message.remove_prefix(size_t(sent));
      until = Clock::now() + patience_;
    } else if (errno == EAGAIN) {
      if (!wait(socket_, POLLOUT, until)) return false;
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

Channel::Got Channel::some(char* to, size_t room, Clock::time_point until, size_t& got) {
  for (;;) {
    const ssize_t count = recv(socket_, to, room, until == never ? 0 : MSG_DONTWAIT);
    if (count > 0) {
      got = size_t(count);
      return Got::message;
    }
    if (count == 0) return Got::closed;
    if (errno == EAGAIN) {
      if (!wait(socket_, POLLIN, until)) return Got::nothing;
    } else if (errno != EINTR) {
      return Got::closed;
    }
  }
}

// At least one byte to place arrived_ of `to`, at most as many as wanted: what has arrived before,
// or from the socket.
Channel::Got Channel::fill(char* to, size_t wanted, Clock::time_point until) {
  size_t got = 0;
  if (used_ == filled_ && wanted >= chunk) { // not copied twice
    const Got result = some(to + arrived_, wanted, until, got);
    arrived_ += got;
    return result;
  }
  if (used_ == filled_) {
    ahead_.resize(chunk);
    used_ = filled_ = 0;
    if (const Got result = some(ahead_.data(), chunk, until, filled_); result != Got::message)
      return result;
  }
  got = std::min(wanted, filled_ - used_);
  std::memcpy(to + arrived_, ahead_.data() + used_, got);
  used_ += got;
  arrived_ += got;
  return Got::message;
}

Channel::Got Channel::receive(Message& message, Clock::time_point until) {
  while (!headed_) {
    const Got got =
        fill(reinterpret_cast<char*>(&partial_.header), sizeof(Header) - arrived_, until);
    if (got != Got::message) return got;
    if (arrived_ < sizeof(Header)) continue;
    if (partial_.header.bytes > maximumMessage || partial_.header.bytes % 8 != 0) return Got::bad;
    headed_ = true;
    arrived_ = 0;
    partial_.bytes.clear();
  }
  while (arrived_ < partial_.header.bytes) {
    // Memory as it arrives, not as it is claimed.
    const size_t room =
        std::min<size_t>(partial_.header.bytes, std::max<size_t>(2 * arrived_, 16 * chunk));
    partial_.bytes.resize(room);
    const Got got = fill(partial_.bytes.data(), room - arrived_, until);
    if (got != Got::message) return got;
  }
  headed_ = false;
  arrived_ = 0;
  std::swap(message, partial_);
  return Got::message;
}

} // namespace xvrml::wire

// channel.cpp: sends and receives messages over a socket. Part of the library and of the programs
// that it starts.
#include "process/channel.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <unistd.h>

#include "system/process.h"
#include "system/sockets.h"

namespace xvrml::wire {
namespace {

constexpr size_t chunk = 64 << 10;

// Waits until the socket is ready. Returns false on a timeout.
bool wait(int socket, short what, Clock::time_point until) {
  for (;;) {
    const auto left =
        std::chrono::duration_cast<std::chrono::nanoseconds>(until - Clock::now()).count();
    if (left <= 0) return false;
    pollfd ready{socket, what, 0};
    const int count = os::pollFor(ready, left);
    if (count > 0) return true; // also on errors, which the next call reports
    if (count < 0 && errno != EINTR) return true;
  }
}

} // namespace

Channel::~Channel() { close(socket_); }

bool Channel::send(std::string_view message) {
  auto until = Clock::now() + patience_;
  while (!message.empty()) {
    const ssize_t sent =
        ::send(socket_, message.data(), message.size(), os::noSignal | MSG_DONTWAIT);
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

Channel::Received Channel::receiveSome(char* to, size_t room, Clock::time_point until,
                                       size_t& got) {
  for (;;) {
    const ssize_t count = recv(socket_, to, room, until == never ? 0 : MSG_DONTWAIT);
    if (count > 0) {
      got = size_t(count);
      return Received::message;
    }
    if (count == 0) return Received::closed;
    if (errno == EAGAIN) {
      if (!wait(socket_, POLLIN, until)) return Received::nothing;
    } else if (errno != EINTR) {
      return Received::closed;
    }
  }
}

// Appends between one and `wanted` bytes at to + arrived_, from the buffer or from the socket.
Channel::Received Channel::fill(char* to, size_t wanted, Clock::time_point until) {
  size_t got = 0;
  if (used_ == filled_ && wanted >= chunk) { // avoids a second copy
    const Received result = receiveSome(to + arrived_, wanted, until, got);
    arrived_ += got;
    return result;
  }
  if (used_ == filled_) {
    buffer_.resize(chunk);
    used_ = filled_ = 0;
    if (const Received result = receiveSome(buffer_.data(), chunk, until, filled_);
        result != Received::message)
      return result;
  }
  got = std::min(wanted, filled_ - used_);
  std::memcpy(to + arrived_, buffer_.data() + used_, got);
  used_ += got;
  arrived_ += got;
  return Received::message;
}

Channel::Received Channel::receive(Message& message, Clock::time_point until) {
  while (!headed_) {
    const Received got =
        fill(reinterpret_cast<char*>(&partial_.header), sizeof(Header) - arrived_, until);
    if (got != Received::message) return got;
    if (arrived_ < sizeof(Header)) continue;
    if (partial_.header.bytes > maximumMessage || partial_.header.bytes % 8 != 0)
      return Received::bad;
    headed_ = true;
    arrived_ = 0;
    partial_.bytes.clear();
  }
  while (arrived_ < partial_.header.bytes) {
    // Allocate memory as bytes arrive, not as the header claims.
    const size_t room =
        std::min<size_t>(partial_.header.bytes, std::max<size_t>(2 * arrived_, 16 * chunk));
    partial_.bytes.resize(room);
    const Received got = fill(partial_.bytes.data(), room - arrived_, until);
    if (got != Received::message) return got;
  }
  headed_ = false;
  arrived_ = 0;
  std::swap(message, partial_);
  return Received::message;
}

} // namespace xvrml::wire

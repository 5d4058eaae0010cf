// sockets.h: sockets that are closed in programs that this one starts and that raise no signal when
// the other end has gone, and what the system says of the other end. Any thread.
#pragma once

#include <optional>

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/types.h>
#include <unistd.h>

namespace os {

// For send(): no signal if the other end has gone.
#if defined(__linux__)
inline constexpr int noSignal = MSG_NOSIGNAL;
#else
inline constexpr int noSignal = 0; // an option of the socket says so (prepareSocket)
#endif

#if !defined(__linux__)
// Returns the socket with the settings that Linux has as flags of the calls.
inline int prepareSocket(int fd, bool blocking) {
  if (fd < 0) return fd;
  const int on = 1;
  ::fcntl(fd, F_SETFD, FD_CLOEXEC);
  if (!blocking) ::fcntl(fd, F_SETFL, O_NONBLOCK);
  ::setsockopt(fd, SOL_SOCKET, SO_NOSIGPIPE, &on, sizeof on);
  return fd;
}
#endif

// Returns a stream socket that does not block; -1, with errno, as socket() does.
inline int streamSocket(int family) {
#if defined(__linux__)
  return ::socket(family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
#else
  return prepareSocket(::socket(family, SOCK_STREAM, 0), false);
#endif
}

// Makes two ends of a local stream, which block; as socketpair() does.
inline int streamPair(int (&ends)[2]) {
#if defined(__linux__)
  return ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends);
#else
  if (const int result = ::socketpair(AF_UNIX, SOCK_STREAM, 0, ends); result != 0) return result;
  for (const int end : ends) prepareSocket(end, true);
  return 0;
#endif
}

// Accepts a connection, which does not block; -1, with errno, as accept() does.
inline int acceptStream(int listening) {
#if defined(__linux__)
  return ::accept4(listening, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
#else
  return prepareSocket(::accept(listening, nullptr, nullptr), false);
#endif
}

// Returns the user of the process at the other end of a local socket.
inline std::optional<uid_t> peerUser(int fd) {
#if defined(__linux__)
  ucred who{};
  socklen_t size = sizeof who;
  if (::getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &who, &size) == 0) return who.uid;
#else
  uid_t user = 0;
  gid_t group = 0;
  if (::getpeereid(fd, &user, &group) == 0) return user;
#endif
  return std::nullopt;
}

} // namespace os

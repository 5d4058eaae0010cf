#include "control/listener.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <fmt/format.h>

#include "options/values.h"
#include "system/sockets.h"

namespace vv::control {

namespace {

constexpr int backlog = 64;

[[noreturn]] void fail(const Place& place, const std::string& why) {
  throw Failure{exitRender, fmt::format("--control {}: {}", place.text(place.port), why)};
}

// A socket that is closed unless release() is called.
class Socket {
 public:
  explicit Socket(int family) : fd_(os::streamSocket(family)) {}
  ~Socket() {
    if (fd_ >= 0) ::close(fd_);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  int fd() const { return fd_; }
  int release() { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

bool isLoopback(const sockaddr* address) {
  if (address->sa_family == AF_INET) {
    const auto* four = reinterpret_cast<const sockaddr_in*>(address);
    return (ntohl(four->sin_addr.s_addr) >> 24) == 127;
  }
  const auto* six = reinterpret_cast<const sockaddr_in6*>(address);
  return address->sa_family == AF_INET6 && IN6_IS_ADDR_LOOPBACK(&six->sin6_addr);
}

uint16_t portOf(int fd) {
  sockaddr_storage bound{};
  socklen_t size = sizeof bound;
  if (::getsockname(fd, reinterpret_cast<sockaddr*>(&bound), &size) != 0) return 0;
  return ntohs(bound.ss_family == AF_INET6
                   ? reinterpret_cast<const sockaddr_in6*>(&bound)->sin6_port
                   : reinterpret_cast<const sockaddr_in*>(&bound)->sin_port);
}

// Removes a socket file that nobody listens at any more.
void removeAbandoned(const Place& place, const sockaddr_un& address) {
  struct stat info {};
  if (::lstat(place.path.c_str(), &info) != 0) return;
  if (!S_ISSOCK(info.st_mode)) fail(place, "there is a file of this name");
  const Socket probe(AF_UNIX);
  if (::connect(probe.fd(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ||
      errno != ECONNREFUSED)
    fail(place, "another program listens there");
  ::unlink(place.path.c_str());
}

std::unique_ptr<Listener> listenAtPath(const Place& place, Mailbox& mailbox) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, place.path.data(), place.path.size()); // parse() checks the length
  removeAbandoned(place, address);
  Socket socket(AF_UNIX);
  if (socket.fd() < 0 ||
      ::bind(socket.fd(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::chmod(place.path.c_str(), S_IRUSR | S_IWUSR) != 0 || ::listen(socket.fd(), backlog) != 0)
    fail(place, std::strerror(errno));
  return listenPlain(socket.release(), place, 0, mailbox);
}

struct FreeAddresses {
  void operator()(addrinfo* found) const { ::freeaddrinfo(found); }
};

std::unique_ptr<addrinfo, FreeAddresses> lookUp(const Place& place) {
  addrinfo hints{}, *found = nullptr;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE;
  if (const int error =
          ::getaddrinfo(place.host.c_str(), std::to_string(place.port).c_str(), &hints, &found))
    fail(place, ::gai_strerror(error));
  return std::unique_ptr<addrinfo, FreeAddresses>(found);
}

Place numeric(Place place, const addrinfo& found) {
  char digits[NI_MAXHOST];
  if (const int error = ::getnameinfo(found.ai_addr, found.ai_addrlen, digits, sizeof digits,
                                      nullptr, 0, NI_NUMERICHOST))
    fail(place, ::gai_strerror(error));
  place.host = digits;
  return place;
}

} // namespace

std::unique_ptr<Listener> listenAt(const Place& place, const KeyRing& keys, Mailbox& mailbox) {
  if (place.isPath()) return listenAtPath(place, mailbox);
  const auto found = lookUp(place);
  if (!isLoopback(found->ai_addr)) {
    if (keys.empty())
      fail(place, "other machines can reach this address, so a key is needed: --key FILE "
                  "(openrt-worker --new-key FILE makes one), or an address of this machine and a "
                  "tunnel of ssh (docs/control.md)");
    return listenWithKeys(numeric(place, *found), keys, mailbox); // ZeroMQ binds no names
  }
  Socket socket(found->ai_family);
  const int on = 1;
  if (socket.fd() < 0 || ::setsockopt(socket.fd(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0 ||
      ::bind(socket.fd(), found->ai_addr, found->ai_addrlen) != 0 ||
      ::listen(socket.fd(), backlog) != 0)
    fail(place, std::strerror(errno));
  const uint16_t port = portOf(socket.fd());
  return listenPlain(socket.release(), place, port, mailbox);
}

} // namespace vv::control

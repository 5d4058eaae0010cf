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

[[noreturn]] void fail(const Address& address, const std::string& why) {
  throw Failure{exitRender, fmt::format("--control {}: {}", address.text(address.port), why)};
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
void removeAbandoned(const Address& address, const sockaddr_un& endpoint) {
  struct stat info {};
  if (::lstat(address.path.c_str(), &info) != 0) return;
  if (!S_ISSOCK(info.st_mode)) fail(address, "there is a file of this name");
  const Socket probe(AF_UNIX);
  if (::connect(probe.fd(), reinterpret_cast<const sockaddr*>(&endpoint), sizeof endpoint) == 0 ||
      errno != ECONNREFUSED)
    fail(address, "another program listens there");
  ::unlink(address.path.c_str());
}

std::unique_ptr<Listener> listenAtPath(const Address& address, Mailbox& mailbox) {
  sockaddr_un endpoint{};
  endpoint.sun_family = AF_UNIX;
  std::memcpy(endpoint.sun_path, address.path.data(),
              address.path.size()); // parse() checks the length
  removeAbandoned(address, endpoint);
  Socket socket(AF_UNIX);
  if (socket.fd() < 0 ||
      ::bind(socket.fd(), reinterpret_cast<const sockaddr*>(&endpoint), sizeof endpoint) != 0 ||
      ::chmod(address.path.c_str(), S_IRUSR | S_IWUSR) != 0 || ::listen(socket.fd(), backlog) != 0)
    fail(address, std::strerror(errno));
  return listenPlain(socket.release(), address, 0, mailbox);
}

struct FreeAddresses {
  void operator()(addrinfo* found) const { ::freeaddrinfo(found); }
};

std::unique_ptr<addrinfo, FreeAddresses> lookUp(const Address& address) {
  addrinfo hints{}, *found = nullptr;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE;
  if (const int error =
          ::getaddrinfo(address.host.c_str(), std::to_string(address.port).c_str(), &hints, &found))
    fail(address, ::gai_strerror(error));
  return std::unique_ptr<addrinfo, FreeAddresses>(found);
}

Address numeric(Address address, const addrinfo& found) {
  char digits[NI_MAXHOST];
  if (const int error = ::getnameinfo(found.ai_addr, found.ai_addrlen, digits, sizeof digits,
                                      nullptr, 0, NI_NUMERICHOST))
    fail(address, ::gai_strerror(error));
  address.host = digits;
  return address;
}

} // namespace

std::unique_ptr<Listener> listenAt(const Address& address, const KeyRing& keys, Mailbox& mailbox) {
  if (address.isPath()) return listenAtPath(address, mailbox);
  const auto found = lookUp(address);
  if (!isLoopback(found->ai_addr)) {
    if (keys.empty())
      fail(address, "other machines can reach this address, so a key is needed: --key FILE "
                    "(openrt-worker --new-key FILE makes one), or an address of this machine and a "
                    "tunnel of ssh (docs/control.md)");
    return listenWithKeys(numeric(address, *found), keys, mailbox); // ZeroMQ binds no names
  }
  Socket socket(found->ai_family);
  const int on = 1;
  if (socket.fd() < 0 || ::setsockopt(socket.fd(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0 ||
      ::bind(socket.fd(), found->ai_addr, found->ai_addrlen) != 0 ||
      ::listen(socket.fd(), backlog) != 0)
    fail(address, std::strerror(errno));
  const uint16_t port = portOf(socket.fd());
  return listenPlain(socket.release(), address, port, mailbox);
}

} // namespace vv::control

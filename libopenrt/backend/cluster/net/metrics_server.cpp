#include "backend/cluster/net/metrics_server.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>

#include "backend/cluster/net/addresses.h"
#include "keep_running.h"
#include "steady_clock.h"
#include "system/sockets.h"
#include "system/wake_up.h"

namespace openrt::cluster {
namespace {

// Anybody who reaches the port may connect, so that all of it is bounded.
constexpr size_t mostClients = 16, requestBytes = 8192;
constexpr double patience = 5; // seconds that a client may take
constexpr int backlog = 16;

struct Client {
  int fd = -1;
  double until = 0;
  std::string request, answer;
  size_t sent = 0; // bytes that have gone
};

std::string response(const char* status, const std::string& body) {
  return std::string("HTTP/1.1 ") + status +
         "\r\nContent-Type: text/plain; version=0.0.4; charset=utf-8\r\nContent-Length: " +
         std::to_string(body.size()) + "\r\nConnection: close\r\n\r\n" + body;
}

// Returns a listening socket.
int listenAt(const Address& address) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const std::string what = "cannot listen at " + address.shown();
  if (const int error =
          ::getaddrinfo(address.host.c_str(), std::to_string(address.port).c_str(), &hints, &found);
      error != 0)
    throw std::runtime_error(what + ": " + ::gai_strerror(error));
  const int fd = os::streamSocket(found->ai_family), on = 1;
  const bool good = fd >= 0 && ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) == 0 &&
                    ::bind(fd, found->ai_addr, found->ai_addrlen) == 0 &&
                    ::listen(fd, backlog) == 0;
  const int error = errno;
  ::freeaddrinfo(found);
  if (good) return fd;
  if (fd >= 0) ::close(fd);
  throw std::system_error(error, std::generic_category(), what);
}

uint16_t portOf(int fd) {
  sockaddr_storage place{};
  socklen_t size = sizeof place;
  if (::getsockname(fd, reinterpret_cast<sockaddr*>(&place), &size) != 0) return 0;
  return ntohs(place.ss_family == AF_INET6 ? reinterpret_cast<sockaddr_in6&>(place).sin6_port
                                           : reinterpret_cast<sockaddr_in&>(place).sin_port);
}

} // namespace

struct MetricsServer::Impl {
  Impl(const std::string& where, std::function<std::string()> t)
      : address(Address::parse(where)), text(std::move(t)), listening(listenAt(address)) {
    address.port = portOf(listening);
    clients.reserve(mostClients); // so that an accepted client can always be kept
    thread = std::thread([this] { run(); });
  }
  ~Impl() {
    stopping = true;
    wakeUp.call();
    thread.join();
    closeAll();
    ::close(listening);
  }

  void run() {
    keepRunning([this] { return stopping.load(); }, [this] { waitAndServe(); },
                [this] { closeAll(); });
  }

  void waitAndServe() {
    std::vector<pollfd> all{{wakeUp.fd(), POLLIN, 0}};
    // While there are too many, the others wait in the system's queue.
    all.push_back({clients.size() < mostClients ? listening : -1, POLLIN, 0});
    for (const Client& client : clients)
      all.push_back({client.fd, short(client.answer.empty() ? POLLIN : POLLOUT), 0});
    constexpr int milliseconds = 500; // for the clients' limit
    ::poll(all.data(), nfds_t(all.size()), clients.empty() ? -1 : milliseconds);
    if (all[0].revents) wakeUp.clear();
    const double now = steadySeconds();
    for (size_t i = 0; i < clients.size(); i++)
      if (now > clients[i].until || (all[i + 2].revents && !serve(clients[i]))) close(clients[i]);
    std::erase_if(clients, [](const Client& client) { return client.fd < 0; });
    if (!all[1].revents) return;
    if (const int fd = os::acceptStream(listening); fd >= 0)
      clients.push_back({fd, now + patience, {}, {}, 0});
    else
      ::poll(nullptr, 0, 10); // no descriptor is free, perhaps for long
  }

  // Frees what the clients need, where memory is short. One that was closed has no descriptor.
  void closeAll() {
    for (Client& client : clients)
      if (client.fd >= 0) close(client);
    clients.clear();
  }

  static void close(Client& client) { ::close(std::exchange(client.fd, -1)); }

  // Reads or writes what can be. Returns false when the client is done.
  bool serve(Client& client) const {
    if (client.answer.empty()) {
      char bytes[2048];
      const ssize_t n = ::recv(client.fd, bytes, sizeof bytes, 0);
      if (n < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
      if (n == 0 || client.request.size() + size_t(n) > requestBytes) return false;
      client.request.append(bytes, size_t(n));
      if (client.request.find("\r\n\r\n") == std::string::npos) return true;
      client.answer = answerTo(client.request);
    }
    const ssize_t n = ::send(client.fd, client.answer.data() + client.sent,
                             client.answer.size() - client.sent, os::noSignal);
    if (n < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
    client.sent += size_t(n);
    return client.sent < client.answer.size();
  }

  std::string answerTo(const std::string& request) const {
    if (!request.starts_with("GET ")) return response("405 Method Not Allowed", "GET only\n");
    const size_t end = request.find_first_of(" ?\r", 4);
    if (request.substr(4, end - 4) != "/metrics") return response("404 Not Found", "/metrics\n");
    return response("200 OK", text());
  }

  Address address;
  std::function<std::string()> text;
  int listening;
  std::vector<Client> clients;
  os::WakeUp wakeUp;
  std::atomic<bool> stopping{false};
  std::thread thread;
};

MetricsServer::MetricsServer(const std::string& address, std::function<std::string()> text)
    : impl_(std::make_unique<Impl>(address, std::move(text))) {}
MetricsServer::~MetricsServer() = default;

std::string MetricsServer::address() const { return impl_->address.shown(); }

} // namespace openrt::cluster

// socket_listener.cpp: Listens with plain TCP or unix sockets. One thread waits for all of them.
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "control/connection.h"
#include "control/listener.h"
#include "keep_running.h"
#include "steady_clock.h"
#include "system/sockets.h"
#include "system/wake_up.h"

namespace vv::control {

namespace {

// Tells whether the other end of a unix socket belongs to this user, or to root. The folder may be
// open to others.
bool isOurs(int fd) {
  const std::optional<uid_t> user = os::peerUser(fd);
  return user && (*user == ::geteuid() || *user == 0);
}

class SocketListener final : public Listener {
 public:
  SocketListener(int fd, const Address& address, uint16_t port, Mailbox& mailbox)
      : fd_(fd), address_(address), port_(port), mailbox_(mailbox), thread_([this] { run(); }) {}

  ~SocketListener() override {
    ending_ = true;
    wake_->call();
    thread_.join();
    for (const auto& connection : connections_) connection->work(); // the last answers
    connections_.clear();
    ::close(fd_);
    if (address_.isPath()) ::unlink(address_.path.c_str());
  }

  std::string address() const override { return address_.text(port_); }

 private:
  void run() {
    keepRunning([this] { return ending_.load(); }, [this] { step(); },
                [this] { connections_.clear(); }); // the clients see that they are cut
  }

  void step() {
    constexpr int idle = 1000, soon = 50; // milliseconds
    const bool waits = waitingSince_ != 0;
    // New clients come before the connections, so that a connection that a client has ended before
    // it opened the next one is seen to end.
    std::vector<pollfd> polled{{wake_->fd(), POLLIN, 0}, {waits ? -1 : fd_, POLLIN, 0}};
    for (const auto& connection : connections_) {
      const bool reads = connection->wantsToRead(), writes = connection->wantsToWrite();
      // a closed socket would wake the thread for ever while its commands wait for the world
      polled.push_back({reads || writes ? connection->fd() : -1,
                        short((reads ? POLLIN | POLLRDHUP : 0) | (writes ? POLLOUT : 0)), 0});
    }
    if (::poll(polled.data(), polled.size(), waits || anyIsEnding() ? soon : idle) < 0) return;
    if (polled[0].revents) wake_->clear();
    size_t i = 2;
    for (const auto& connection : connections_) {
      const short events = polled[i++].revents;
      if (events & POLLRDHUP) connection->noteEnd();
      if ((events & (POLLIN | POLLHUP | POLLERR)) && connection->wantsToRead()) connection->read();
      connection->work();
    }
    const double now = steadySeconds();
    connections_.remove_if([&](const auto& connection) { return connection->hasEnded(now); });
    if (polled[1].revents) waitingSince_ = now;
    if (waitingSince_ != 0 && !mustWait(now)) accept();
  }

  bool anyIsEnding() const {
    return std::any_of(connections_.begin(), connections_.end(),
                       [](const auto& connection) { return connection->isEnding(); });
  }

  // Tells whether a new client waits in the socket's queue: all places are taken, and one of them
  // becomes free as soon as the last commands of a client that has gone are done. If that takes
  // long, the new client is told that there is no place.
  bool mustWait(double now) const {
    constexpr double patience = 2; // seconds
    return connections_.size() >= limits.clients && anyIsEnding() && now < waitingSince_ + patience;
  }

  // Accepts one client, or refuses it.
  void accept() {
    const int fd = os::acceptStream(fd_);
    if (fd < 0) {
      waitingSince_ = 0;
      // out of file descriptors: do not ask again at once
      if (errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
      return;
    }
    std::string why;
    ClientId client = 0;
    const bool ours = !address_.isPath() || isOurs(fd);
    if (!ours)
      why = "this socket belongs to another user";
    else
      client = mailbox_.join([wake = wake_] { wake->call(); }, why);
    if (client == 0) { // the next one that waits is refused at once, too
      const std::string text = errorAnswer("", ours ? "limit" : "refused", why) + "\n";
      static_cast<void>(!::send(fd, text.data(), text.size(), os::noSignal));
      ::close(fd);
      return;
    }
    waitingSince_ = 0;
    const int on = 1; // answers must not wait for further ones
    if (!address_.isPath()) ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    connections_.push_back(std::make_unique<Connection>(fd, client, mailbox_));
  }

  const int fd_;
  const Address address_;
  const uint16_t port_;
  Mailbox& mailbox_;
  std::shared_ptr<os::WakeUp> wake_ = std::make_shared<os::WakeUp>();
  std::atomic<bool> ending_{false};
  std::list<std::unique_ptr<Connection>> connections_;
  double waitingSince_ = 0; // time since which a client waits to be accepted; 0: none waits
  std::thread thread_;      // the last member, because it uses the others
};

} // namespace

std::unique_ptr<Listener> listenPlain(int fd, const Address& address, uint16_t port,
                                      Mailbox& mailbox) {
  return std::make_unique<SocketListener>(fd, address, port, mailbox);
}

} // namespace vv::control

// control_sockets.cpp: Tests how lines travel between sockets and the mailbox: order, the first
// line, half-closed connections, clients that do not read, and lines without an end.
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "control/address.h"
#include "control/connection.h"
#include "control/listener.h"
#include "options/values.h"

using namespace vv::control;

namespace {

constexpr int patience = 20; // seconds, for what takes a moment on an idle machine

class Peer {
 public:
  explicit Peer(uint16_t port) : fd_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval limit{patience, 0};
    ::setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    ::setsockopt(fd_, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
    EXPECT_EQ(::connect(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  }
  ~Peer() { ::close(fd_); }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  // Returns false if the other side takes no more.
  bool send(const std::string& text) {
    for (size_t sent = 0; sent < text.size();) {
      const ssize_t put = ::send(fd_, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
      if (put <= 0) return false;
      sent += size_t(put);
    }
    return true;
  }
  void end() { ::shutdown(fd_, SHUT_WR); }
  // Returns the next line; "" at the end of the connection.
  std::string line() {
    size_t end;
    while ((end = input_.find('\n')) == input_.npos) {
      char block[65536];
      const ssize_t got = ::recv(fd_, block, sizeof block, 0);
      if (got <= 0) return "";
      input_.append(block, size_t(got));
    }
    std::string line = input_.substr(0, end);
    input_.erase(0, end + 1);
    return line;
  }

 private:
  int fd_;
  std::string input_;
};

class ControlSockets : public testing::Test {
 protected:
  ControlSockets() {
    const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(::bind(fd, reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(::listen(fd, 64), 0);
    EXPECT_EQ(::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size), 0);
    port = ntohs(address.sin_port);
    listener = listenPlain(fd, Address::parse("127.0.0.1:0"), port, mailbox);
  }

  // Waits for the next letter.
  Letter letter() {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(patience);
    while (std::chrono::steady_clock::now() < end) {
      if (auto found = mailbox.take()) return std::move(*found);
      mailbox.wait(1);
    }
    ADD_FAILURE() << "no letter came";
    return {};
  }

  Mailbox mailbox;
  uint16_t port = 0;
  std::unique_ptr<Listener> listener;
};

const std::string hello = "{\"command\":\"hello\"}\n";

TEST_F(ControlSockets, LinesComeInOrderAndAnswersGoBack) {
  EXPECT_EQ(listener->address(), "127.0.0.1:" + std::to_string(port));
  Peer peer(port);
  constexpr int count = 5000;
  std::thread sender([&] {
    for (int i = 0; i < count; ++i)
      peer.send("{\"id\":" + std::to_string(i) + ",\"command\":\"hello\"}\n\r\n");
  });
  for (int i = 0; i < count; ++i) {
    const Letter one = letter();
    ASSERT_EQ(one.line.id, std::to_string(i));
    mailbox.send(one.client, one.line.id);
    mailbox.processed(one.client, one.bytes);
  }
  sender.join();
  for (int i = 0; i < count; ++i) ASSERT_EQ(peer.line(), std::to_string(i));
}

TEST_F(ControlSockets, ClientsAreToldApartAndMissed) {
  ClientId first = 0;
  {
    Peer a(port), b(port);
    a.send(hello);
    const Letter one = letter();
    first = one.client;
    mailbox.processed(one.client, one.bytes);
    b.send(hello);
    const Letter other = letter();
    EXPECT_NE(first, other.client);
    mailbox.send(other.client, "for b");
    mailbox.processed(other.client, other.bytes);
    EXPECT_EQ(b.line(), "for b");
  }
  Letter left = letter();
  EXPECT_EQ(left.kind, Letter::Kind::left);
  left = letter();
  EXPECT_EQ(left.kind, Letter::Kind::left);
  mailbox.send(first, "to nobody"); // must not matter
}

TEST_F(ControlSockets, AnotherProtocolIsCutOff) {
  auto page = std::make_unique<Peer>(port);
  page->send("POST / HTTP/1.1\r\nHost: localhost\r\n\r\n{\"command\":\"quit\"}\n");
  const std::string told = page->line();
  EXPECT_NE(told.find("\"code\":\"syntax\""), std::string::npos) << told;
  EXPECT_EQ(page->line(), "");
  page.reset();
  EXPECT_EQ(letter().kind, Letter::Kind::left); // and no command
}

TEST_F(ControlSockets, ALaterBadLineIsAnswered) {
  Peer peer(port);
  peer.send(hello + "nonsense\n");
  const Letter first = letter(), second = letter();
  EXPECT_TRUE(first.line.command);
  EXPECT_EQ(second.line.code, "syntax");
}

// A client may end its side, as `printf ... | nc` does, and still get its answers.
TEST_F(ControlSockets, AHalfClosedConnectionGetsItsAnswers) {
  Peer peer(port);
  peer.send(hello + "{\"id\":2,\"command\":\"hello\"}"); // the last line has no line feed
  peer.end();
  const Letter first = letter(), second = letter();
  EXPECT_EQ(second.line.id, "2");
  mailbox.send(first.client, "one");
  mailbox.processed(first.client, first.bytes);
  mailbox.send(second.client, "two");
  mailbox.processed(second.client, second.bytes);
  EXPECT_EQ(peer.line(), "one");
  EXPECT_EQ(peer.line(), "two");
  EXPECT_EQ(peer.line(), "");
}

TEST_F(ControlSockets, AClientThatDoesNotReadIsCutOff) {
  Peer lazy(port), other(port);
  lazy.send(hello);
  const Letter one = letter();
  mailbox.processed(one.client, one.bytes);
  const std::string event(1 << 20, 'x');
  for (size_t sent = 0; sent < 2 * limits.unreadBytes; sent += event.size())
    mailbox.send(one.client, event); // never waits
  other.send(hello);
  const Letter fine = letter();
  mailbox.send(fine.client, "fine");
  EXPECT_EQ(other.line(), "fine");
  std::string last;
  for (std::string line; !(line = lazy.line()).empty();) last = line.substr(0, 300);
  EXPECT_NE(last.find("unreadBytes="), std::string::npos) << last;
}

TEST_F(ControlSockets, ALineWithoutAnEndIsCutOff) {
  Peer peer(port);
  std::string part(1 << 20, ' ');
  part[0] = '{';
  size_t sent = 0;
  while (sent < 4 * limits.lineBytes && peer.send(part)) sent += part.size();
  EXPECT_LT(sent, 4 * limits.lineBytes) << "it must not be read for ever";
  const std::string told = peer.line();
  EXPECT_NE(told.find("lineBytes="), std::string::npos) << told;
}

// A client that was cut off has time to read why, and then its place is free.
TEST(ControlConnection, ACutConnectionEndsEvenIfTheClientDoesNotRead) {
  int ends[2];
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends), 0);
  Mailbox mailbox;
  std::string why;
  const ClientId client = mailbox.join([] {}, why);
  Connection connection(ends[0], client, mailbox);
  mailbox.send(client, std::string(8 << 20, 'x')); // more than the socket holds
  mailbox.cut(client, "limit", "why");
  connection.work();
  EXPECT_TRUE(connection.wantsToWrite());
  EXPECT_TRUE(connection.isEnding());
  EXPECT_FALSE(connection.hasEnded(100));
  EXPECT_FALSE(connection.hasEnded(109));
  EXPECT_TRUE(connection.hasEnded(111));
  ::close(ends[1]);
}

TEST_F(ControlSockets, ClientsThatWaitForTheWorldAreNotReadOn) {
  Peer peer(port);
  peer.send(hello);
  const std::string line =
      "{\"command\":\"create\",\"vrml\":\"" + std::string(8 << 20, 'x') + "\"}\n";
  std::thread sender([&] {
    for (size_t sent = 0; sent < 2 * limits.waitingBytes; sent += line.size())
      if (!peer.send(line)) return;
    peer.end();
  });
  // The mailbox holds a little more than the limit, and the rest waits in the sockets.
  size_t bytes = 0;
  Letter first = letter();
  const ClientId client = first.client;
  bytes += first.bytes;
  while (!mailbox.isFull(client)) std::this_thread::yield();
  const size_t waiting = mailbox.waiting();
  EXPECT_LE(waiting, limits.waitingBytes / line.size() + 2);
  mailbox.processed(client, first.bytes);
  size_t letters = 0;
  for (Letter one = letter(); one.kind == Letter::Kind::command; one = letter()) {
    ++letters;
    mailbox.processed(client, one.bytes);
  }
  sender.join();
  EXPECT_EQ(letters, (2 * limits.waitingBytes + line.size() - 1) / line.size());
}

TEST_F(ControlSockets, TooManyClientsAreRefused) {
  std::vector<std::unique_ptr<Peer>> peers;
  for (size_t i = 0; i < limits.clients; ++i) {
    peers.push_back(std::make_unique<Peer>(port));
    peers.back()->send(hello);
    letter();
  }
  Peer late(port);
  EXPECT_NE(late.line().find("clients="), std::string::npos);
  EXPECT_EQ(late.line(), "");
}

// Commands of clients that have gone wait for the world. A new client waits for one of their
// places.
TEST_F(ControlSockets, PlacesOfClientsThatHaveGoneBecomeFree) {
  std::thread others([&] {
    for (size_t i = 0; i < 2 * limits.clients; ++i) Peer(port).send(hello);
  });
  while (mailbox.waiting() < limits.clients) std::this_thread::yield();
  for (size_t i = 0; i < 2 * limits.clients;) { // none was refused
    const Letter one = letter();
    if (one.kind == Letter::Kind::left) continue;
    EXPECT_TRUE(one.line.command);
    mailbox.processed(one.client, one.bytes);
    ++i;
  }
  others.join();
  Peer late(port);
  late.send(hello);
  Letter last = letter();
  while (last.kind == Letter::Kind::left) last = letter();
  mailbox.send(last.client, "welcome");
  EXPECT_EQ(late.line(), "welcome");
}

TEST_F(ControlSockets, NobodyWaitsLongForAPlace) {
  std::vector<std::unique_ptr<Peer>> peers;
  for (size_t i = 0; i < limits.clients; ++i) {
    peers.push_back(std::make_unique<Peer>(port));
    peers.back()->send(hello); // never done
    letter();
  }
  peers[0]->end();
  Peer late(port), later(port);
  EXPECT_NE(late.line().find("clients="), std::string::npos);
  EXPECT_NE(later.line().find("clients="), std::string::npos);
}

TEST(ControlPlace, AddressesAreRead) {
  EXPECT_EQ(Address::parse(":7").text(7), "127.0.0.1:7");
  EXPECT_EQ(Address::parse("[::1]:0").text(9), "[::1]:9");
  EXPECT_EQ(Address::parse("localhost:65535").port, 65535);
  EXPECT_EQ(Address::parse("unix:a/b").path, "a/b");
  for (const char* wrong :
       {"", "7", "localhost", "a:65536", "a:-1", "a:", "::1:5", "unix:", "a b:5"})
    EXPECT_THROW(Address::parse(wrong), vv::UsageError) << wrong;
  EXPECT_THROW(Address::parse("unix:" + std::string(200, 'x')), vv::UsageError);
}

} // namespace

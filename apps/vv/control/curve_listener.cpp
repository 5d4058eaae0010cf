// curve_listener.cpp: Listens for other machines: ZeroMQ with CURVE keys encrypts what is sent and
// lets in only those who have the key (docs/decisions/0052-control-off-loopback.md). Each line is
// a message to or from a DEALER socket of the client. One thread uses all sockets.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <zmq.hpp>

#include "control/listener.h"
#include "keep_running.h"
#include "options/values.h"
#include "spare_descriptors.h"
#include "system/wake_up.h"

namespace vv::control {

namespace {

using Clock = std::chrono::steady_clock;

constexpr char zapDomain[] = "vv-control";
constexpr std::chrono::milliseconds step{50};
// An empty message that often finds out whether a client is still there. Clients ignore it.
constexpr std::chrono::seconds beat{1};

std::string_view textOf(const zmq::message_t& message) {
  return {message.data<char>(), message.size()};
}

zmq::context_t makeContext() {
  needDescriptors(32, "--control");
  return zmq::context_t();
}

class CurveListener final : public Listener {
 public:
  CurveListener(const Address& address, const KeyRing& keys, Mailbox& mailbox)
      : address_(address), keys_(keys), mailbox_(mailbox), context_(makeContext()),
        door_(context_, zmq::socket_type::rep), socket_(context_, zmq::socket_type::router) {
    setUp();
    thread_ = std::thread([this] { run(); });
  }

  ~CurveListener() override {
    ending_ = true;
    wake_->call();
    thread_.join();
    for (auto& [route, client] : clients_) {
      serve(route, client); // the last answers
      mailbox_.leave(client.id);
    }
  }

  std::string address() const override { return address_.text(port_); }

 private:
  struct Client {
    ClientId id = 0;
    std::string output; // lines that the socket has not accepted
    bool isCut = false; // its messages are ignored
    Clock::time_point nextBeat;
  };

  void setUp() {
    namespace opt = zmq::sockopt;
    constexpr int second = 1000;
    door_.set(opt::linger, 0);
    door_.bind("inproc://zeromq.zap.01");
    socket_.set(opt::linger, 200);
    socket_.set(opt::router_mandatory, true);
    socket_.set(opt::maxmsgsize, int64_t(limits.lineBytes));
    socket_.set(opt::ipv6, address_.host.find(':') != address_.host.npos);
    socket_.set(opt::handshake_ivl, 5 * second);
    socket_.set(opt::heartbeat_ivl, 2 * second);
    socket_.set(opt::heartbeat_timeout, 10 * second);
    socket_.set(opt::heartbeat_ttl, 10 * second);
    socket_.set(opt::curve_server, true);
    socket_.set(opt::curve_secretkey, keys_.secretKey);
    socket_.set(opt::zap_domain, zapDomain);
    try {
      socket_.bind("tcp://" + address_.text(address_.port));
    } catch (const zmq::error_t& error) {
      throw Failure{exitRender,
                    fmt::format("--control {}: {}", address_.text(address_.port), error.what())};
    }
    const std::string bound = socket_.get(opt::last_endpoint);
    port_ = uint16_t(std::stoul(bound.substr(bound.rfind(':') + 1)));
  }

  void run() {
    const auto step = [this] {
      try {
        work();
      } catch (const zmq::error_t&) {} // a socket that was interrupted; the next round tries again
    };
    keepRunning([this] { return ending_.load(); }, step,
                [this] {
                  for (const auto& [route, client] : clients_) mailbox_.leave(client.id);
                  clients_.clear();
                });
  }

  void work() {
    zmq::pollitem_t items[] = {{socket_.handle(), 0, ZMQ_POLLIN, 0},
                               {door_.handle(), 0, ZMQ_POLLIN, 0},
                               {nullptr, wake_->fd(), ZMQ_POLLIN, 0}};
    zmq::poll(items, std::size(items), step);
    if (items[2].revents) wake_->clear();
    while (answerDoor()) {}
    constexpr int most = 1000; // so that answers are sent meanwhile
    for (int i = 0; i < most && receive(); ++i) {}
    for (auto at = clients_.begin(); at != clients_.end();) {
      if (serve(at->first, at->second)) {
        ++at;
        continue;
      }
      mailbox_.leave(at->second.id);
      at = clients_.erase(at);
    }
  }

  // Receives one message. Returns false if there is none.
  bool receive() {
    zmq::message_t route, line;
    if (!socket_.recv(route, zmq::recv_flags::dontwait)) return false;
    bool more = route.more();
    for (bool first = true; more; first = false) {
      zmq::message_t part;
      if (!socket_.recv(part)) return false;
      more = part.more();
      if (first) line = std::move(part);
    }
    std::string_view text = textOf(line);
    while (text.ends_with('\n') || text.ends_with('\r')) text.remove_suffix(1);
    if (Client* client = clientOf(std::string(textOf(route))); client && !text.empty())
      deliver(*client, text);
    return true;
  }

  void deliver(Client& client, std::string_view text) {
    if (client.isCut) return;
    if (!mailbox_.deliver(client.id, text)) client.isCut = true;
    if (!mailbox_.isFull(client.id)) return;
    mailbox_.cut(client.id, "limit",
                 fmt::format("more than waitingBytes={} bytes of this client's commands wait for "
                             "the world: it is cut off",
                             limits.waitingBytes));
    client.isCut = true;
  }

  // Returns null if there are too many clients; this one is told so.
  Client* clientOf(const std::string& route) {
    if (const auto found = clients_.find(route); found != clients_.end()) return &found->second;
    std::string why;
    const auto join = [&] { return mailbox_.join([wake = wake_] { wake->call(); }, why); };
    ClientId id = join();
    if (id == 0) {
      forgetGone();
      id = join();
    }
    if (id == 0) {
      static_cast<void>(sendTo(route, errorAnswer("", "limit", why)));
      return nullptr;
    }
    Client& client = clients_[route];
    client.id = id;
    client.nextBeat = Clock::now() + beat;
    return &client;
  }

  enum class Sent { done, later, gone };

  Sent sendTo(const std::string& route, std::string_view line) {
    try {
      if (!socket_.send(zmq::buffer(route), zmq::send_flags::sndmore | zmq::send_flags::dontwait))
        return Sent::later;
      // ZeroMQ accepts all parts of a message or none.
      static_cast<void>(socket_.send(zmq::buffer(line), zmq::send_flags::dontwait));
      return Sent::done;
    } catch (const zmq::error_t& error) {
      if (error.num() == EHOSTUNREACH) return Sent::gone;
      throw;
    }
  }

  // Forgets clients whose connections have ended, without waiting for their next beat.
  void forgetGone() {
    for (auto at = clients_.begin(); at != clients_.end();) {
      if (sendTo(at->first, "") != Sent::gone) {
        ++at;
        continue;
      }
      mailbox_.leave(at->second.id);
      at = clients_.erase(at);
    }
  }

  // Sends what waits for a client. Returns false if it is gone.
  bool serve(const std::string& route, Client& client) try {
    if (!mailbox_.takeOutput(client.id, client.output)) client.isCut = true;
    size_t begin = 0;
    Sent sent = Sent::done;
    for (size_t end; (end = client.output.find('\n', begin)) != client.output.npos;
         begin = end + 1) {
      sent = sendTo(route, std::string_view(client.output).substr(begin, end - begin));
      if (sent != Sent::done) break;
    }
    client.output.erase(0, begin);
    mailbox_.setUnsent(client.id, client.output.size());
    // ZeroMQ cannot end its connection; it is ignored from now on, and takes no place
    if (client.isCut && client.output.empty()) mailbox_.leave(client.id);
    if (sent == Sent::done && Clock::now() > client.nextBeat) {
      client.nextBeat = Clock::now() + beat;
      sent = sendTo(route, "");
    }
    return sent != Sent::gone;
  } catch (const zmq::error_t&) {
    return true; // interrupted; the next round tries again
  }

  // Answers one of ZeroMQ's questions whether a key is accepted (ZAP, RFC 27). The question is
  // version, number, domain, address, identity, mechanism, credentials.
  bool answerDoor() {
    constexpr size_t fields = 7, curveBytes = 32;
    std::vector<std::string> asked;
    for (bool more = true; more;) {
      zmq::message_t part;
      if (!door_.recv(part, zmq::recv_flags::dontwait)) return false;
      asked.emplace_back(textOf(part));
      more = part.more();
    }
    bool in = false;
    if (asked.size() == fields && asked[2] == zapDomain && asked[5] == "CURVE" &&
        asked[6].size() == curveBytes) {
      char key[41] = "";
      zmq_z85_encode(key, reinterpret_cast<const uint8_t*>(asked[6].data()), curveBytes);
      in = key == keys_.publicKey ||
           std::find(keys_.allowed.begin(), keys_.allowed.end(), key) != keys_.allowed.end();
    }
    const std::string answer[] = {"1.0",
                                  asked.size() > 1 ? asked[1] : "",
                                  in ? "200" : "400",
                                  in ? "OK" : "this key is not accepted",
                                  "",
                                  ""};
    for (size_t i = 0; i < std::size(answer); ++i)
      door_.send(zmq::buffer(answer[i]),
                 i + 1 < std::size(answer) ? zmq::send_flags::sndmore : zmq::send_flags::none);
    return true;
  }

  const Address address_;
  const KeyRing keys_;
  Mailbox& mailbox_;
  zmq::context_t context_;
  zmq::socket_t door_, socket_;
  uint16_t port_ = 0;
  std::shared_ptr<os::WakeUp> wake_ = std::make_shared<os::WakeUp>();
  std::atomic<bool> ending_{false};
  std::map<std::string, Client> clients_; // by the routing id of their connection
  std::thread thread_;
};

} // namespace

std::unique_ptr<Listener> listenWithKeys(const Address& address, const KeyRing& keys,
                                         Mailbox& mailbox) {
  return std::make_unique<CurveListener>(address, keys, mailbox);
}

} // namespace vv::control

// sockets.cpp: replaces ZeroMQ's defaults, which are: no heartbeats, messages of any size, an
// endless wait at the end, and queues of 1000 messages of any size.
#include "backend/cluster/net/sockets.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <stdexcept>

#include "backend/cluster/messages/messages.h"
#include "backend/cluster/net/addresses.h"
#include "spare_descriptors.h"

namespace openrt::cluster {
namespace {

constexpr char zapDomain[] = "openrt";
constexpr size_t curveBytes = 32;

std::string_view textOf(const zmq::message_t& m) { return {m.data<char>(), m.size()}; }

// Returns why a handshake failed. If the other side closes during the handshake, ZeroMQ reports no
// more than that.
std::string failureText(uint16_t event, int value, bool withKeys) {
  if (event == ZMQ_EVENT_HANDSHAKE_FAILED_AUTH)
    return "our key is not on its list of accepted keys";
  if (event == ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL &&
      value == ZMQ_PROTOCOL_ERROR_ZMTP_MECHANISM_MISMATCH)
    return withKeys ? "it uses no key, but this side does: give --key FILE there, too"
                    : "it uses a key, but this side does not: give --key FILE";
  if (event == ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL &&
      value == ZMQ_PROTOCOL_ERROR_ZMTP_CRYPTOGRAPHIC)
    return "it has another key";
  if (event == ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL) return "it does not speak this protocol";
  return withKeys ? "it closed the connection: most likely it has another key or none (give --key "
                    "FILE there, too)"
                  : "it closed the connection: most likely it expects a key (give --key FILE)";
}

} // namespace

zmq::context_t makeContext() {
  constexpr int ioThreads = 2, sockets = 16384, descriptors = 32;
  needDescriptors(descriptors, "the network of a cluster");
  zmq::context_t context(ioThreads);
  context.set(zmq::ctxopt::max_sockets, sockets);
  context.set(zmq::ctxopt::blocky, false);
  return context;
}

zmq::socket_t makeSocket(zmq::context_t& context, zmq::socket_type type, const KeyRing& keys,
                         const std::string& serverKey) {
  namespace opt = zmq::sockopt;
  constexpr int milliseconds = 1000, queued = 64, backlog = 1024;
  zmq::socket_t s(context, type);
  s.set(opt::linger, 0);
  s.set(opt::sndhwm, queued);
  s.set(opt::rcvhwm, queued);
  s.set(opt::maxmsgsize, int64_t(largestMessage));
  s.set(opt::immediate, true);
  s.set(opt::ipv6, true);
  s.set(opt::backlog, backlog);
  s.set(opt::connect_timeout, 4 * milliseconds);
  s.set(opt::handshake_ivl, 5 * milliseconds);
  // The Wire makes a new socket, so that no old messages are in its queue.
  s.set(opt::reconnect_ivl, -1);
  // Only for connections that no peer uses any more: the Wire's own heartbeats (Beat) notice a loss
  // much sooner. A message of 64 MiB may be in transit meanwhile.
  s.set(opt::heartbeat_ivl, 5 * milliseconds);
  s.set(opt::heartbeat_timeout, 120 * milliseconds);
  s.set(opt::heartbeat_ttl, 120 * milliseconds);
  s.set(opt::tcp_keepalive, 1);
  s.set(opt::tcp_keepalive_idle, 10);
  s.set(opt::tcp_keepalive_intvl, 5);
  s.set(opt::tcp_keepalive_cnt, 3);
  s.set(opt::tcp_maxrt, 30 * milliseconds);
  if (type == zmq::socket_type::router) s.set(opt::router_mandatory, true);
  if (keys.empty()) return s;
  if (serverKey.empty()) {
    s.set(opt::curve_server, true);
    s.set(opt::curve_secretkey, keys.secretKey);
    s.set(opt::zap_domain, zapDomain);
  } else {
    s.set(opt::curve_serverkey, serverKey);
    s.set(opt::curve_publickey, keys.publicKey);
    s.set(opt::curve_secretkey, keys.secretKey);
  }
  return s;
}

Monitor::Monitor(zmq::context_t& context, zmq::socket_t& socket, bool withKeys)
    : watched_(socket), pair_(context, zmq::socket_type::pair), withKeys_(withKeys) {
  static std::atomic<uint64_t> number{0};
  const std::string place = "inproc://openrt-monitor-" + std::to_string(++number);
  constexpr int events = ZMQ_EVENT_CONNECTED | ZMQ_EVENT_ACCEPTED | ZMQ_EVENT_HANDSHAKE_SUCCEEDED |
                         ZMQ_EVENT_HANDSHAKE_FAILED_NO_DETAIL |
                         ZMQ_EVENT_HANDSHAKE_FAILED_PROTOCOL | ZMQ_EVENT_HANDSHAKE_FAILED_AUTH |
                         ZMQ_EVENT_CLOSED | ZMQ_EVENT_DISCONNECTED;
  if (zmq_socket_monitor(watched_.handle(), place.c_str(), events) != 0) throw zmq::error_t();
  pair_.set(zmq::sockopt::linger, 0);
  pair_.connect(place);
}

Monitor::~Monitor() { zmq_socket_monitor(watched_.handle(), nullptr, 0); }

std::optional<ConnectionEvent> Monitor::next() {
  for (;;) {
    zmq::message_t event, address;
    if (!pair_.recv(event, zmq::recv_flags::dontwait)) return std::nullopt;
    if (event.more()) static_cast<void>(pair_.recv(address));
    uint16_t number;
    int32_t value;
    if (event.size() < sizeof number + sizeof value) continue;
    std::memcpy(&number, event.data(), sizeof number);
    std::memcpy(&value, event.data<char>() + sizeof number, sizeof value);
    using Kind = ConnectionEvent::Kind;
    switch (number) {
    case ZMQ_EVENT_CONNECTED: return ConnectionEvent{Kind::connected, value, {}};
    case ZMQ_EVENT_ACCEPTED: return ConnectionEvent{Kind::accepted, value, {}};
    case ZMQ_EVENT_HANDSHAKE_SUCCEEDED: return ConnectionEvent{Kind::opened, -1, {}};
    case ZMQ_EVENT_CLOSED: return ConnectionEvent{Kind::closed, -1, {}};
    case ZMQ_EVENT_DISCONNECTED: return ConnectionEvent{Kind::disconnected, value, {}};
    default: return ConnectionEvent{Kind::failed, -1, failureText(number, value, withKeys_)};
    }
  }
}

Authenticator::Authenticator(zmq::context_t& context, const KeyRing& keys)
    : socket_(context, zmq::socket_type::rep), keys_(keys) {
  socket_.set(zmq::sockopt::linger, 0);
  socket_.bind("inproc://zeromq.zap.01");
}

// Request: version, number, domain, address, identity, mechanism, credentials. Reply: version,
// number, status, text, user, metadata.
bool Authenticator::answer(const std::function<void(const std::string&)>& refused) {
  constexpr size_t fields = 7;
  std::string request[fields];
  size_t count = 0;
  for (bool more = true; more; count++) {
    zmq::message_t part;
    if (!socket_.recv(part, zmq::recv_flags::dontwait)) return false;
    if (count < fields) request[count] = textOf(part);
    more = part.more();
  }
  const auto& [version, number, domain, address, identity, mechanism, credentials] = request;
  std::string key;
  if (count == fields && domain == zapDomain && mechanism == "CURVE" &&
      credentials.size() == curveBytes) {
    char text[41];
    if (zmq_z85_encode(text, reinterpret_cast<const uint8_t*>(credentials.data()), curveBytes))
      key = text;
  }
  const bool in = !key.empty() &&
                  (key == keys_.publicKey || std::find(keys_.allowed.begin(), keys_.allowed.end(),
                                                       key) != keys_.allowed.end());
  if (!in)
    refused(shownEndpoint(address) + ": its key " + key + " is not on the list of accepted keys");
  const std::string reply[] = {
      "1.0", number, in ? "200" : "400", in ? "OK" : "this key is not accepted", in ? key : "", ""};
  for (size_t i = 0; i < std::size(reply); i++)
    socket_.send(zmq::buffer(reply[i]),
                 i + 1 < std::size(reply) ? zmq::send_flags::sndmore : zmq::send_flags::none);
  return true;
}

} // namespace openrt::cluster

// sockets.h: ZeroMQ sockets with safe settings and keys, a monitor that reports connection events,
// and the authenticator that decides which callers are let in. Used by the Wire, on its thread.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include <zmq.hpp>

#include "backend/cluster/net/wire.h"
#include "steady_clock.h"

namespace openrt::cluster {

zmq::context_t makeContext();
// Makes a socket. serverKey: key of the side to call; empty for a listening socket.
zmq::socket_t makeSocket(zmq::context_t& context, zmq::socket_type type, const KeyRing& keys,
                         const std::string& serverKey);

// An event of a socket's connections.
struct ConnectionEvent {
  enum class Kind : uint8_t {
    connected,
    accepted,
    opened,
    failed,
    closed,
    disconnected
  } kind = Kind::closed;
  int fd = -1;     // for connected, accepted, disconnected
  std::string why; // failed: why the handshake failed, for the user
};

class Monitor {
 public:
  Monitor(zmq::context_t& context, zmq::socket_t& socket, bool withKeys);
  ~Monitor(); // must run before the socket is closed
  Monitor(const Monitor&) = delete;
  Monitor& operator=(const Monitor&) = delete;
  std::optional<ConnectionEvent> next();
  zmq::socket_ref socket() { return pair_; }

 private:
  zmq::socket_t& watched_;
  zmq::socket_t pair_;
  bool withKeys_;
};

// Decides which callers are let in: answers ZeroMQ's requests (ZAP, RFC 27) from the list of
// allowed keys.
class Authenticator {
 public:
  Authenticator(zmq::context_t& context, const KeyRing& keys);
  zmq::socket_ref socket() { return socket_; }
  // Answers one request if there is one. Passes the reason of a refusal to `refused`.
  bool answer(const std::function<void(const std::string&)>& refused);

 private:
  zmq::socket_t socket_;
  KeyRing keys_;
};

} // namespace openrt::cluster

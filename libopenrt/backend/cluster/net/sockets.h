// sockets.h: ZeroMQ sockets as the wire wants them: every default that is unsafe is set, keys are
// put in, what happens to their connections is told, and who is let in is decided. Used by the
// Wire, on its thread.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include <zmq.hpp>

#include "backend/cluster/net/wire.h"

namespace openrt::cluster {

inline double steadyNow() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

zmq::context_t makeContext();
// serverKey: of the side to call; empty where one listens.
zmq::socket_t makeSocket(zmq::context_t& context, zmq::socket_type type, const KeyRing& keys,
                         const std::string& serverKey);

// What happens to the connections of a socket.
struct Happening {
  enum class Kind : uint8_t {
    connected,
    accepted,
    opened,
    failed,
    closed,
    disconnected
  } kind = Kind::closed;
  int fd = -1;     // connected, accepted, disconnected
  std::string why; // failed: of the handshake, for people
};

class Monitor {
 public:
  Monitor(zmq::context_t& context, zmq::socket_t& socket, bool withKeys);
  ~Monitor(); // before the socket is closed
  Monitor(const Monitor&) = delete;
  Monitor& operator=(const Monitor&) = delete;
  std::optional<Happening> next();
  zmq::socket_ref socket() { return pair_; }

 private:
  zmq::socket_t& watched_;
  zmq::socket_t pair_;
  bool withKeys_;
};

// Who may call: answers ZeroMQ's questions (ZAP, RFC 27) with the allow-list.
class Gate {
 public:
  Gate(zmq::context_t& context, const KeyRing& keys);
  zmq::socket_ref socket() { return socket_; }
  // Answers one question if there is one. The reason of a refusal goes to `refused`.
  bool answer(const std::function<void(const std::string&)>& refused);

 private:
  zmq::socket_t socket_;
  KeyRing keys_;
};

} // namespace openrt::cluster

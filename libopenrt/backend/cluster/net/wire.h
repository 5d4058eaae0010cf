// wire.h: exchanges messages between a master and its workers over ZeroMQ, encrypted with CURVE
// where they leave the machine. A message is a header (messages.fbs) and bulk frames. One thread,
// except wake().
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "backend/cluster/net/keys.h"

namespace openrt::cluster {

inline constexpr uint16_t defaultPort = 7447;
inline constexpr size_t largestMessage = size_t(64) << 20; // limit for each frame of a message
inline constexpr size_t pieceBytes = size_t(1) << 20; // size of the pieces in which arrays are sent

using Peer = uint32_t; // number given by the Wire; a peer that reconnects gets a new one

using Frames = std::vector<std::vector<std::byte>>; // frames of one message; [0] is the header

inline size_t bytesOf(const Frames& frames) {
  size_t sum = 0;
  for (const auto& frame : frames) sum += frame.size();
  return sum;
}

struct WireOptions {
  std::vector<std::string> connect; // addresses to call: HOST[:PORT] or HOST:PORT=PUBLICKEY
  std::string listen;               // ADDRESS[:PORT] to listen at; empty: none
  KeyRing keys;                     // empty: no encryption, loopback addresses only
  double heartbeat = 0.1;           // idle seconds after which a side sends a heartbeat
  double silence = 0.5;             // silent seconds after which a peer counts as lost
};

struct Event {
  // refused: a call that was not answered, or a caller that was not let in. It is reported once;
  // the Wire keeps trying.
  enum class Kind : uint8_t { nothing, joined, message, left, refused, woken } kind = Kind::nothing;
  Peer peer = 0; // the peer; 0 for a refused call
  // message: its header is verified (messages.h); never a Beat or a Bye
  Frames frames;
  // joined: the peer's address; left, refused: the reason, for the user
  std::string text;
};

class Wire {
 public:
  // Throws std::runtime_error with a message for the user:
  // * no key for an address that is not loopback (with the remedy),
  // * an address that cannot be bound,
  // * a key file that other users may read.
  explicit Wire(const WireOptions& options);
  ~Wire();
  // Waits for an event, at most `seconds`. It also sends and checks heartbeats: a peer that was
  // silent for `silence` seconds has left. Call it about every `heartbeat` seconds. Addresses to
  // call are called again after every loss.
  Event receive(double seconds);
  // Sends a message without waiting. Returns false if the peer's queue is full or it has left; the
  // frames are then unchanged.
  bool send(Peer peer, Frames&& frames);
  // Calls an address once, besides those of the options. Returns the number of the peer to be:
  // `joined` or, if there is no answer, `left` follows. Throws std::runtime_error as the
  // constructor does.
  Peer call(const std::string& address);
  // Sends Bye and closes; no `left` event follows.
  void close(Peer peer, const std::string& why);
  // Counts a message that its reader found invalid. The third one closes the peer, and `left`
  // follows.
  void bad(Peer peer, const std::string& why);
  void pace(double heartbeat, double silence); // sets the intervals that the other side asks for
  // Returns the listening address with its port; empty if there is none.
  std::string address() const;
  void wake(); // [any] makes receive() return
  struct Traffic {
    uint64_t sent = 0, received = 0; // bytes sent and received
    double latency = 0;              // smoothed round trip of heartbeats in seconds
  };
  // Returns the counters of a peer, for a while also after it has left.
  Traffic traffic(Peer peer) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace openrt::cluster

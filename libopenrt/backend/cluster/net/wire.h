// wire.h: messages between a master and its workers over ZeroMQ, with CURVE where they leave the
// machine. A message is a header (messages.fbs) and bulk frames. One thread's, but for Waker.
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
inline constexpr size_t largestMessage = size_t(64) << 20; // of any frame of a message
inline constexpr size_t pieceBytes = size_t(1) << 20;      // of an array that travels

using Peer = uint32_t; // numbered by the Wire; a peer that comes again has a new number

using Frames = std::vector<std::vector<std::byte>>; // of a message; [0] is the header

inline size_t bytesOf(const Frames& frames) {
  size_t sum = 0;
  for (const auto& frame : frames) sum += frame.size();
  return sum;
}

struct WireOptions {
  std::vector<std::string> connect; // HOST[:PORT] or HOST:PORT=PUBLICKEY of those to call
  std::string listen;               // ADDRESS[:PORT] where to be called; empty: nowhere
  KeyRing keys;                     // empty: plain, loopback addresses only
  double heartbeat = 0.1;           // seconds after which an idle side says that it lives
  double silence = 0.5;             // after which a side that says nothing has left
};

struct Event {
  // refused: a call that nobody took, or somebody who called and was not let in; said once, the
  // wire goes on trying.
  enum class Kind : uint8_t { nothing, joined, message, left, refused, woken } kind = Kind::nothing;
  Peer peer = 0;    // 0 if refused
  Frames frames;    // message: the header verifies (messages.h); neither a Beat nor a Bye
  std::string text; // who joined (address); why left or refused, for people
};

class Wire {
 public:
  // Throws std::runtime_error with a message for people: no key for an address that is not loopback
  // (and the remedy), an address that cannot be bound, a key file that others may read.
  explicit Wire(const WireOptions& options);
  ~Wire();
  // Waits at most so long. Heartbeats are sent and watched in here: a peer that was silent for
  // `silence` seconds has left. To be called at least every `heartbeat` seconds, about. Those that
  // are called are called again whenever they have left.
  Event receive(double seconds);
  // Does not wait. False: the peer's queue is full, or it has left; the frames are as they were.
  bool send(Peer peer, Frames&& frames);
  void close(Peer peer, const std::string& why); // says Bye; no `left` follows
  // A message that was none for the one who read it: the third one closes the peer, and `left`
  // follows.
  void bad(Peer peer, const std::string& why);
  void pace(double heartbeat, double silence); // as the other side asks
  std::string address() const;                 // where it listens, with the port; empty: nowhere
  void wake();                                 // [any] receive() returns
  struct Traffic {
    uint64_t sent = 0, received = 0; // bytes
    double latency = 0;              // seconds there and back, smoothed, from heartbeats
  };
  Traffic traffic(Peer peer) const; // also of one that has left, for a while

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace openrt::cluster

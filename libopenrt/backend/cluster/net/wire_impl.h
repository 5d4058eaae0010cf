// wire_impl.h: what the Wire is made of: those it calls (a socket each, so that nothing old waits
// in a queue after a loss), those who call (one socket for all), and the peers that come of both.
// For wire.cpp, wire_calls.cpp and wire_peers.cpp alone.
#pragma once

#include <deque>
#include <map>
#include <unordered_map>

#include "backend/cluster/net/addresses.h"
#include "backend/cluster/net/flow.h"
#include "backend/cluster/net/messages.h"
#include "backend/cluster/net/sockets.h"
#include "backend/cluster/net/wire.h"

namespace openrt::cluster {

struct Wire::Impl {
  // Somebody to call, again and again.
  struct Call {
    Address address;
    std::unique_ptr<Lookup> lookup;
    std::optional<zmq::socket_t> socket;
    std::optional<Monitor> monitor; // of it, so it is closed first
    double next = 0, deadline = 0;  // when to try; when an attempt has failed
    uint32_t failures = 0;          // in a row
    uint32_t byes = 0; // connections in a row that the other side has soon ended by a Bye
    double joined = 0; // when the connection stood
    int fd = -1;
    Peer peer = 0; // once it has answered
    std::string told;
  };

  struct PeerState {
    Peer id = 0;
    Call* call = nullptr; // null: it has called
    std::string route;    // then its name at the socket
    std::string address;
    int fd = -1;
    bool met = false;  // `joined` was told
    bool gone = false; // has left as far as others know; what it says is not heard
    double told = 0;   // a Bye, last time
    double heard = 0, said = 0, asked = 0, measured = 0;
    uint64_t messagesSent = 0, messagesReceived = 0; // numbers of the last ones (seal.h)
    Flow flow;                                       // of a message that has not come whole
    int badOnes = 0;
    Traffic traffic;
  };

  explicit Impl(const WireOptions& options);
  ~Impl();

  // wire.cpp
  Event receive(double seconds);
  void keep(double now);
  void poll(double seconds);
  void push(Event::Kind kind, Peer peer, std::string text);
  void refused(const std::string& text);

  // wire_calls.cpp
  void startCall(Call& call, double now);
  void dial(Call& call, const Address& address, double now);
  void keepCalls(double now);
  void readCall(Call& call, double now);
  void hangUp(Call& call, double delay, bool sayBye);
  void failCall(Call& call, const std::string& why, double now);

  // wire_peers.cpp
  PeerState* find(Peer peer);
  void listen(const std::string& where);
  void watchCallers();
  void readCallers(double now);
  PeerState& caller(const std::string& route, int fd, const std::string& address, double now);
  bool readFrames(zmq::socket_t& socket, Frames& frames, int& fd, std::string& address,
                  bool& tooMany);
  void take(PeerState& peer, Frames&& frames, bool tooMany, double now);
  void countBad(PeerState& peer, const std::string& why, double now);
  void shutOut(PeerState& peer, const std::string& why, double now);
  bool sendTo(PeerState& peer, Frames&& frames, double now);
  void sayBye(PeerState& peer, const std::string& why, double now);
  // Tells it, and forgets or blocks the peer. bye: it has said so.
  void leave(PeerState& peer, const std::string& why, double now, bool bye = false);
  void forget(Peer peer);
  void keepPeers(double now);

  KeyRing keys;
  double heartbeat, silence;
  zmq::context_t context;
  std::optional<Gate> gate;
  std::deque<Call> calls; // addresses stay
  std::optional<zmq::socket_t> door;
  std::optional<Monitor> doorMonitor;
  std::map<Peer, PeerState> peers;
  std::unordered_map<std::string, Peer> routes;
  std::map<int, Peer> callersByFd;
  std::vector<Peer>
      closing; // callers whose connection is closed; what they have sent before counts
  std::map<Peer, Traffic> former;
  Peer lastPeer = 0;
  std::deque<Event> events;
  std::map<std::string, double> refusals; // when they were told
  double kept = 0;
  int wakeFd = -1;
};

} // namespace openrt::cluster

// wire_impl.h: the parts of the Wire: outgoing calls (a socket each, so that no old messages wait
// in a queue after a loss), one listening socket for all callers, and the peers behind both. Only
// for wire.cpp, wire_calls.cpp and wire_peers.cpp.
#pragma once

#include <deque>
#include <list>
#include <map>
#include <unordered_map>

#include "backend/cluster/messages/messages.h"
#include "backend/cluster/net/addresses.h"
#include "backend/cluster/net/flow.h"
#include "backend/cluster/net/sockets.h"
#include "backend/cluster/net/wire.h"
#include "system/wake_up.h"

namespace openrt::cluster {

struct Wire::Impl {
  // An address that is called: again after every loss, or once.
  struct Call {
    Address address;
    Peer once = 0;     // the peer of an address that is called once; 0: called again
    bool over = false; // called once, and ended
    std::unique_ptr<Lookup> lookup;
    std::optional<zmq::socket_t> socket;
    std::optional<Monitor> monitor; // monitors `socket` and is closed first
    double next = 0, deadline = 0;  // time of the next attempt; time limit of this one
    uint32_t failures = 0;          // failed attempts in a row
    // Connections in a row that the other side ended soon with a Bye.
    uint32_t endedSoon = 0;
    double joined = 0; // when the connection was established
    int fd = -1;
    Peer peer = 0;           // set once the other side has answered
    std::string lastFailure; // the failure reported last
  };

  struct PeerState {
    Peer id = 0;
    Call* call = nullptr; // null if the peer has called us
    std::string route;    // routing id at the listening socket, for callers
    std::string address;
    int fd = -1;
    bool joinReported = false; // `joined` was reported
    bool hasLeft = false;      // reported as left; its messages are ignored
    double byeSentAt = 0;      // when the last Bye was sent
    double lastReceivedAt = 0, lastSentAt = 0, beatSentAt = 0, latencyMeasuredAt = 0;
    uint64_t messagesSent = 0, messagesReceived = 0; // numbers of the last messages (seal.h)
    Flow flow;                                       // detects a message that is still arriving
    int badOnes = 0;
    Traffic traffic;
  };

  explicit Impl(const WireOptions& options);
  ~Impl();

  // wire.cpp
  Event receive(double seconds);
  void runTimers(double now);
  void poll(double seconds);
  void pushEvent(Event::Kind kind, Peer peer, std::string text);
  void refused(const std::string& text);

  // wire_calls.cpp
  Call& addCall(const std::string& text);
  void startCall(Call& call, double now);
  void dial(Call& call, const Address& address, double now);
  void updateCalls(double now);
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
  void handleMessage(PeerState& peer, Frames&& frames, bool tooMany, double now);
  void countBad(PeerState& peer, const std::string& why, double now);
  void block(PeerState& peer, const std::string& why, double now);
  bool sendTo(PeerState& peer, Frames&& frames, double now);
  void sayBye(PeerState& peer, const std::string& why, double now);
  // Reports that the peer has left, and forgets or blocks it. bye: the peer has sent a Bye.
  void leave(PeerState& peer, const std::string& why, double now, bool bye = false);
  void forget(Peer peer);
  void checkPeers(double now);

  KeyRing keys;
  double heartbeat, silence;
  zmq::context_t context;
  std::optional<Authenticator> authenticator;
  std::list<Call> calls; // a list, because addresses must stay valid
  std::optional<zmq::socket_t> listenSocket;
  std::optional<Monitor> listenMonitor;
  std::map<Peer, PeerState> peers;
  std::unordered_map<std::string, Peer> routes;
  std::map<int, Peer> callersByFd;
  // Callers whose connection is closed. Messages they sent before still count.
  std::vector<Peer> closing;
  std::map<Peer, Traffic> former;
  Peer lastPeer = 0;
  std::deque<Event> events;
  std::map<std::string, double> refusals; // reasons and when they were reported
  double timersRunAt = 0;
  os::WakeUp wakeUp;
};

} // namespace openrt::cluster

// wire_calls.cpp: outgoing calls: from the name lookup to an open connection, and again after every
// loss. Each attempt has its own socket. [wire]
#include <algorithm>

#include "backend/cluster/net/wire_impl.h"

namespace openrt::cluster {
namespace {

constexpr double attempt = 8;                        // seconds until an attempt has failed
constexpr double firstPause = 0.1, longestPause = 2; // seconds between attempts
constexpr int byeMilliseconds = 500;
// Limits on messages read from one peer before the next one's turn.
constexpr size_t mostAtOnce = 64, bytesAtOnce = size_t(64) << 20;

} // namespace

void Wire::Impl::startCall(Call& call, double now) {
  call.deadline = now + attempt;
  if (call.address.numeric()) return dial(call, call.address, now);
  call.lookup = std::make_unique<Lookup>(call.address);
}

void Wire::Impl::dial(Call& call, const Address& address, double now) {
  const std::string& serverKey = call.address.key.empty() ? keys.publicKey : call.address.key;
  try {
    call.socket.emplace(makeSocket(context, zmq::socket_type::dealer, keys, serverKey));
    call.monitor.emplace(context, *call.socket, !keys.empty());
    call.socket->connect(address.endpoint());
  } catch (const zmq::error_t& e) { failCall(call, e.what(), now); }
}

void Wire::Impl::updateCalls(double now) {
  std::erase_if(calls, [](const Call& call) { return call.over; });
  for (Call& call : calls) {
    if (call.lookup && call.lookup->ready()) {
      std::string why;
      const std::optional<Address> found = call.lookup->result(why);
      call.lookup.reset();
      if (found)
        dial(call, *found, now);
      else
        failCall(call, "the name cannot be looked up: " + why, now);
    } else if (!call.socket && !call.lookup && now >= call.next) {
      startCall(call, now);
    } else if (!call.peer && (call.socket || call.lookup) && now > call.deadline) {
      failCall(call, "there is no answer; trying again", now);
    }
  }
}

void Wire::Impl::readCall(Call& call, double now) {
  using Kind = ConnectionEvent::Kind;
  std::string end; // why the connection ended; empty while it is open
  while (end.empty()) {
    const std::optional<ConnectionEvent> h = call.monitor->next();
    if (!h) break;
    if (h->kind == Kind::connected) call.fd = h->fd;
    if (h->kind == Kind::failed) end = h->why;
    if (h->kind == Kind::closed) end = "there is no answer; trying again";
    if (h->kind == Kind::disconnected) end = "the connection was closed";
    if (h->kind != Kind::opened || call.peer) continue;
    call.failures = 0;
    call.joined = now;
    call.lastFailure.clear();
    call.peer = call.once ? call.once : ++lastPeer;
    PeerState& peer = peers[call.peer];
    peer.id = call.peer;
    peer.call = &call;
    peer.fd = call.fd;
    peer.address = call.address.shown();
    peer.lastReceivedAt = now;
    peer.joinReported = true;
    pushEvent(Event::Kind::joined, peer.id, peer.address);
    sendTo(peer, encode(0, message::Beat{.sent = now}), now); // tells the other side that we exist
    peer.beatSentAt = now;
  }
  size_t bytes = 0;
  for (size_t n = 0; call.peer && ((n < mostAtOnce && bytes < bytesAtOnce) || !end.empty()); n++) {
    Frames frames;
    int fd = -1;
    std::string address;
    bool tooMany = false;
    if (!readFrames(*call.socket, frames, fd, address, tooMany)) break;
    bytes += bytesOf(frames);
    handleMessage(peers.at(call.peer), std::move(frames), tooMany, now);
    if (!call.socket) return; // the peer was closed
  }
  if (end.empty()) return;
  if (call.peer)
    leave(peers.at(call.peer), end, now);
  else
    failCall(call, end, now);
}

void Wire::Impl::hangUp(Call& call, double delay, bool sayBye) {
  call.monitor.reset();
  if (call.socket && sayBye) call.socket->set(zmq::sockopt::linger, byeMilliseconds);
  call.socket.reset();
  call.lookup.reset();
  call.peer = 0;
  call.fd = -1;
  call.next = steadySeconds() + delay;
  call.over = call.once != 0;
}

void Wire::Impl::failCall(Call& call, const std::string& why, double) {
  const double pause =
      std::min(longestPause, firstPause * double(uint64_t(1) << std::min(call.failures, 10u)));
  call.failures++;
  hangUp(call, pause, false);
  if (call.once) return pushEvent(Event::Kind::left, call.once, why);
  if (call.lastFailure == why) return;
  call.lastFailure = why;
  pushEvent(Event::Kind::refused, 0, call.address.shown() + ": " + why);
}

} // namespace openrt::cluster

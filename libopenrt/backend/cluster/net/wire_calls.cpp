// wire_calls.cpp: those whom the Wire calls: from the name to a connection that speaks, and again
// after every loss. Each attempt has a socket of its own. [wire]
#include <algorithm>

#include "backend/cluster/net/wire_impl.h"

namespace openrt::cluster {
namespace {

constexpr double attempt = 8;                        // seconds until one has failed
constexpr double firstPause = 0.1, longestPause = 2; // between them
constexpr int byeMilliseconds = 500;
constexpr size_t mostAtOnce = 64,
                 bytesAtOnce = size_t(64)
                               << 20; // messages of one peer before it is another one's turn

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

void Wire::Impl::keepCalls(double now) {
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
      failCall(call, "nobody answers; trying again", now);
    }
  }
}

void Wire::Impl::readCall(Call& call, double now) {
  using Kind = Happening::Kind;
  std::string end; // of the connection; empty: it goes on
  while (end.empty()) {
    const std::optional<Happening> h = call.monitor->next();
    if (!h) break;
    if (h->kind == Kind::connected) call.fd = h->fd;
    if (h->kind == Kind::failed) end = h->why;
    if (h->kind == Kind::closed) end = "nobody answers; trying again";
    if (h->kind == Kind::disconnected) end = "the connection was closed";
    if (h->kind != Kind::opened || call.peer) continue;
    call.failures = 0;
    call.joined = now;
    call.told.clear();
    PeerState& peer = peers[++lastPeer];
    peer.id = call.peer = lastPeer;
    peer.call = &call;
    peer.fd = call.fd;
    peer.address = call.address.shown();
    peer.heard = now;
    peer.met = true;
    push(Event::Kind::joined, peer.id, peer.address);
    sendTo(peer, encode(0, message::Beat{now, false}), now); // so that the other side knows of us
    peer.asked = now;
  }
  size_t bytes = 0;
  for (size_t n = 0; call.peer && ((n < mostAtOnce && bytes < bytesAtOnce) || !end.empty()); n++) {
    Frames frames;
    int fd = -1;
    std::string address;
    bool tooMany = false;
    if (!readFrames(*call.socket, frames, fd, address, tooMany)) break;
    bytes += bytesOf(frames);
    take(peers.at(call.peer), std::move(frames), tooMany, now);
    if (!call.socket) return; // it was hung up
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
  call.next = steadyNow() + delay;
}

void Wire::Impl::failCall(Call& call, const std::string& why, double) {
  const double pause =
      std::min(longestPause, firstPause * double(uint64_t(1) << std::min(call.failures, 10u)));
  call.failures++;
  hangUp(call, pause, false);
  if (call.told == why) return;
  call.told = why;
  push(Event::Kind::refused, 0, call.address.shown() + ": " + why);
}

} // namespace openrt::cluster

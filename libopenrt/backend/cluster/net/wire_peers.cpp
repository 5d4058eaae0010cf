// wire_peers.cpp: serves the peers: their messages, their heartbeats, and the socket of the
// callers. The connection of a caller cannot be closed from here (ZeroMQ has no such call), so
// messages of a blocked caller are ignored. [wire]
#include <algorithm>
#include <cmath>
#include <system_error>

#include "backend/cluster/net/seal.h"
#include "backend/cluster/net/wire_impl.h"
#include "messages_generated.h"

namespace openrt::cluster {
namespace {

constexpr int maxBad = 3;
// Limits on what is read before another socket's turn.
constexpr size_t mostAtOnce = 64, bytesAtOnce = size_t(64) << 20;
constexpr size_t smallFrame = 4096; // smaller frames are copied instead of handed over
constexpr size_t maxFormer = 4096;
// Seconds after which the round trip is measured although there is traffic.
constexpr double measureAgain = 1;
// Seconds after which a peer that has left is told so again.
constexpr double tellAgain = 1;

// Makes a ZeroMQ message. Large frames are handed over without a copy and freed after sending.
zmq::message_t messageOf(std::vector<std::byte>&& frame) {
  if (frame.size() <= smallFrame) return zmq::message_t(frame.data(), frame.size());
  auto* owned = new std::vector<std::byte>(std::move(frame));
  return zmq::message_t(
      owned->data(), owned->size(),
      [](void*, void* hint) { delete static_cast<std::vector<std::byte>*>(hint); }, owned);
}

} // namespace

Wire::Impl::PeerState* Wire::Impl::find(Peer peer) {
  const auto found = peers.find(peer);
  return found == peers.end() ? nullptr : &found->second;
}

void Wire::Impl::listen(const std::string& where) {
  const Address address = Address::parse(where);
  listenSocket.emplace(makeSocket(context, zmq::socket_type::router, keys, ""));
  listenMonitor.emplace(context, *listenSocket, !keys.empty());
  try {
    listenSocket->bind(address.endpoint());
  } catch (const zmq::error_t& e) {
    throw std::system_error(e.num(), std::generic_category(),
                            "cannot listen at " + address.shown());
  }
}

void Wire::Impl::watchCallers() {
  while (const std::optional<ConnectionEvent> h = listenMonitor->next()) {
    if (h->kind == ConnectionEvent::Kind::failed)
      refused("a connection to " + shownEndpoint(listenSocket->get(zmq::sockopt::last_endpoint)) +
              ": " + h->why);
    if (h->kind != ConnectionEvent::Kind::disconnected) continue;
    const auto found = callersByFd.find(h->fd);
    if (found == callersByFd.end()) continue;
    closing.push_back(found->second);
    callersByFd.erase(found);
  }
}

// Reads the closed connections first, then the messages. So all messages sent before a close count,
// but none of a new connection that got the same file descriptor.
void Wire::Impl::readCallers(double now) {
  watchCallers();
  size_t bytes = 0;
  bool drained = false;
  for (size_t n = 0; n < mostAtOnce && bytes < bytesAtOnce && !drained; n++) {
    zmq::message_t route;
    if (!listenSocket->recv(route, zmq::recv_flags::dontwait)) {
      drained = true;
      break;
    }
    Frames frames;
    int fd = -1;
    std::string address;
    bool tooMany = false;
    if (!route.more() || !readFrames(*listenSocket, frames, fd, address, tooMany)) continue;
    bytes += bytesOf(frames);
    handleMessage(caller(route.to_string(), fd, address, now), std::move(frames), tooMany, now);
  }
  if (!drained) return;
  for (Peer id : std::exchange(closing, {}))
    if (PeerState* peer = find(id)) {
      if (!peer->hasLeft && peer->joinReported)
        pushEvent(Event::Kind::left, id, "the connection was closed");
      forget(id);
    }
}

Wire::Impl::PeerState& Wire::Impl::caller(const std::string& route, int fd,
                                          const std::string& address, double now) {
  if (const auto found = routes.find(route); found != routes.end()) {
    PeerState& known = peers.at(found->second);
    if (known.fd == fd) return known;
    closing.push_back(known.id); // another connection uses the same routing id
  }
  watchCallers(); // reports the earlier owner of this descriptor first
  PeerState& peer = peers[++lastPeer];
  peer.id = lastPeer;
  peer.route = route;
  peer.fd = fd;
  peer.address = address.empty() ? "this machine" : address;
  peer.lastReceivedAt = now;
  routes[route] = peer.id;
  if (fd >= 0) callersByFd[fd] = peer.id;
  return peer;
}

// Reads one message; the routing id, if any, has been read before. Returns false if there is none.
bool Wire::Impl::readFrames(zmq::socket_t& socket, Frames& frames, int& fd, std::string& address,
                            bool& tooMany) {
  for (bool more = true; more;) {
    zmq::message_t part;
    if (!socket.recv(part, zmq::recv_flags::dontwait)) return !frames.empty();
    more = part.more();
    if (frames.empty()) {
      fd = zmq_msg_get(part.handle(), ZMQ_SRCFD);
      if (const char* place = zmq_msg_gets(part.handle(), "Peer-Address"))
        address = shownEndpoint(place);
    }
    if (frames.size() > limits::frames) { // the seal is the extra frame
      tooMany = true;
      continue;
    }
    const auto* data = part.data<std::byte>();
    frames.emplace_back(data, data + part.size());
  }
  return true;
}

void Wire::Impl::handleMessage(PeerState& peer, Frames&& frames, bool tooMany, double now) {
  if (peer.hasLeft) {
    if (now - peer.byeSentAt > tellAgain)
      sayBye(peer, "this side sent nothing for too long; say Hello again", now);
    return;
  }
  peer.lastReceivedAt = now;
  peer.traffic.received += bytesOf(frames);
  peer.messagesReceived++;
  uint8_t kind = 0;
  if (tooMany) return countBad(peer, "too many frames", now);
  if (!unseal(frames, peer.messagesReceived))
    return block(peer, "a message was lost, repeated or damaged on the way", now);
  if (std::string why = verifyHeader(frames[0], kind); !why.empty())
    return countBad(peer, why, now);
  if (!std::exchange(peer.joinReported, true))
    pushEvent(Event::Kind::joined, peer.id, peer.address);
  if (wire::Any(kind) != wire::Any::Beat && wire::Any(kind) != wire::Any::Bye) {
    Event& event = events.emplace_back();
    event.kind = Event::Kind::message;
    event.peer = peer.id;
    event.frames = std::move(frames);
    return;
  }
  Message message;
  if (std::string why = decode(std::move(frames), message); !why.empty())
    return countBad(peer, why, now);
  if (const auto* bye = std::get_if<message::Bye>(&message.body))
    return leave(peer, bye->why, now, true);
  const auto& beat = std::get<message::Beat>(message.body);
  if (!beat.answer) {
    sendTo(peer, encode(0, message::Beat{.sent = beat.sent, .answer = true}), now);
  } else if (const double way = now - beat.sent; way >= 0 && way < 600) {
    constexpr double fresh = 0.2;
    peer.traffic.latency =
        peer.latencyMeasuredAt == 0 ? way : peer.traffic.latency * (1 - fresh) + way * fresh;
    peer.latencyMeasuredAt = now;
  }
}

void Wire::Impl::countBad(PeerState& peer, const std::string& why, double now) {
  if (++peer.badOnes < maxBad) return;
  block(peer, "three invalid messages, the last one: " + why, now);
}

void Wire::Impl::block(PeerState& peer, const std::string& why, double now) {
  sayBye(peer, why, now);
  if (!peer.joinReported) refused(peer.address + ": " + why);
  leave(peer, why, now);
}

bool Wire::Impl::sendTo(PeerState& peer, Frames&& frames, double now) {
  zmq::socket_t& socket = peer.call ? *peer.call->socket : *listenSocket;
  seal(frames, peer.messagesSent + 1);
  const uint64_t bytes = bytesOf(frames);
  const auto flags = [&](size_t i) {
    return zmq::send_flags::dontwait |
           (i + 1 < frames.size() ? zmq::send_flags::sndmore : zmq::send_flags::none);
  };
  try {
    zmq::message_t header(frames[0].data(), frames[0].size());
    if (peer.call ? !socket.send(header, flags(0))
                  : !socket.send(zmq::buffer(peer.route),
                                 zmq::send_flags::dontwait | zmq::send_flags::sndmore)) {
      frames.pop_back();
      return false;
    }
    if (!peer.call) socket.send(header, flags(0));
    for (size_t i = 1; i < frames.size(); i++)
      socket.send(messageOf(std::move(frames[i])), flags(i)); // follows the first frame
    // The connection is lost; the monitor will report it.
  } catch (const zmq::error_t&) { return false; }
  peer.messagesSent++;
  peer.traffic.sent += bytes;
  peer.lastSentAt = now;
  return true;
}

void Wire::Impl::sayBye(PeerState& peer, const std::string& why, double now) {
  sendTo(peer, encode(0, message::Bye{.why = why}), now);
  peer.byeSentAt = now;
}

// Ends a peer, because it has left or because this side thinks so. A caller that is still connected
// is remembered, so that it can be told if it sends again.
void Wire::Impl::leave(PeerState& peer, const std::string& why, double now, bool bye) {
  constexpr double again = 0.1, shunned = 4, afterJunk = 5, soon = 10; // seconds
  if (peer.hasLeft) return;
  if (peer.joinReported) pushEvent(Event::Kind::left, peer.id, why);
  if (!peer.call) {
    peer.hasLeft = true;
    if (bye) peer.byeSentAt = now + shunned; // it knows that it has left
    return;
  }
  Call& call = *peer.call;
  const bool junk = peer.badOnes >= maxBad;
  // A peer that ends may be called again at once. One that refuses us is called less and less
  // often.
  call.endedSoon = bye && now - call.joined < soon ? std::min(call.endedSoon + 1, 10u) : 0;
  forget(peer.id);
  hangUp(call,
         junk             ? afterJunk
         : call.endedSoon ? std::min(shunned, again * std::pow(4.0, call.endedSoon - 1))
                          : again,
         junk);
}

void Wire::Impl::forget(Peer peer) {
  const auto found = peers.find(peer);
  if (found == peers.end()) return;
  const PeerState& state = found->second;
  former[peer] = state.traffic;
  if (former.size() > maxFormer) former.erase(former.begin());
  if (const auto route = routes.find(state.route); route != routes.end() && route->second == peer)
    routes.erase(route);
  if (const auto fd = callersByFd.find(state.fd); fd != callersByFd.end() && fd->second == peer)
    callersByFd.erase(fd);
  peers.erase(found);
}

void Wire::Impl::checkPeers(double now) {
  std::vector<PeerState*> silent;
  for (auto& [id, peer] : peers) {
    if (peer.hasLeft) continue;
    const bool measure = now - std::max(peer.beatSentAt, peer.latencyMeasuredAt) >= measureAgain;
    if (now - peer.lastSentAt >= heartbeat || measure) {
      sendTo(peer, encode(0, message::Beat{.sent = now}), now);
      peer.beatSentAt = now;
    }
    peer.flow.look(peer.fd, now, silence);
    if (now - peer.lastReceivedAt > silence && !peer.flow.flowing()) silent.push_back(&peer);
  }
  char text[64];
  for (PeerState* peer : silent) {
    std::snprintf(text, sizeof text, "it sent nothing for %.2g s", now - peer->lastReceivedAt);
    leave(*peer, text, now);
  }
}

} // namespace openrt::cluster

// wire_peers.cpp: peers: what they say, whether they live, and the socket of those who call by
// themselves. A caller's connection cannot be closed by us (ZeroMQ has no such call): one that is
// shut out is not listened to any more. [wire]
#include <algorithm>
#include <cmath>
#include <system_error>

#include "backend/cluster/net/seal.h"
#include "backend/cluster/net/wire_impl.h"
#include "messages_generated.h"

namespace openrt::cluster {
namespace {

constexpr int mostBad = 3;
constexpr size_t mostAtOnce = 64,
                 bytesAtOnce = size_t(64) << 20; // that are read before it is another socket's turn
constexpr size_t smallFrame = 4096;              // copied, not handed over
constexpr size_t mostFormer = 4096;
constexpr double measureAgain =
    1; // seconds after which the way there and back is measured though there is traffic
constexpr double tellAgain = 1; // seconds after which one that has left is told so again

// A frame as ZeroMQ's; large ones are handed over, and freed when they are sent.
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
  door.emplace(makeSocket(context, zmq::socket_type::router, keys, ""));
  doorMonitor.emplace(context, *door, !keys.empty());
  try {
    door->bind(address.endpoint());
  } catch (const zmq::error_t& e) {
    throw std::system_error(e.num(), std::generic_category(),
                            "cannot listen at " + address.shown());
  }
}

void Wire::Impl::watchCallers() {
  while (const std::optional<Happening> h = doorMonitor->next()) {
    if (h->kind == Happening::Kind::failed)
      refused("somebody who calls " + shownEndpoint(door->get(zmq::sockopt::last_endpoint)) + ": " +
              h->why);
    if (h->kind != Happening::Kind::disconnected) continue;
    const auto found = callersByFd.find(h->fd);
    if (found == callersByFd.end()) continue;
    closing.push_back(found->second);
    callersByFd.erase(found);
  }
}

// First who has gone, then what there is to read: so all that somebody has sent before it went
// counts, but not that of the next one who happens to have the same number of a file.
void Wire::Impl::readCallers(double now) {
  watchCallers();
  size_t bytes = 0;
  bool drained = false;
  for (size_t n = 0; n < mostAtOnce && bytes < bytesAtOnce && !drained; n++) {
    zmq::message_t route;
    if (!door->recv(route, zmq::recv_flags::dontwait)) {
      drained = true;
      break;
    }
    Frames frames;
    int fd = -1;
    std::string address;
    bool tooMany = false;
    if (!route.more() || !readFrames(*door, frames, fd, address, tooMany)) continue;
    bytes += bytesOf(frames);
    take(caller(route.to_string(), fd, address, now), std::move(frames), tooMany, now);
  }
  if (!drained) return;
  for (Peer id : std::exchange(closing, {}))
    if (PeerState* peer = find(id)) {
      if (!peer->gone && peer->met) push(Event::Kind::left, id, "the connection was closed");
      forget(id);
    }
}

Wire::Impl::PeerState& Wire::Impl::caller(const std::string& route, int fd,
                                          const std::string& address, double now) {
  if (const auto found = routes.find(route); found != routes.end()) {
    PeerState& known = peers.at(found->second);
    if (known.fd == fd) return known;
    closing.push_back(known.id); // another connection that gives itself the same name
  }
  watchCallers(); // whoever had this file before has been told of by now
  PeerState& peer = peers[++lastPeer];
  peer.id = lastPeer;
  peer.route = route;
  peer.fd = fd;
  peer.address = address.empty() ? "this machine" : address;
  peer.heard = now;
  routes[route] = peer.id;
  if (fd >= 0) callersByFd[fd] = peer.id;
  return peer;
}

// One message; of a socket that names senders the name has been read. False: there is none.
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
    if (frames.size() > limits::frames) { // and the seal
      tooMany = true;
      continue;
    }
    const auto* data = part.data<std::byte>();
    frames.emplace_back(data, data + part.size());
  }
  return true;
}

void Wire::Impl::take(PeerState& peer, Frames&& frames, bool tooMany, double now) {
  if (peer.gone) {
    if (now - peer.told > tellAgain)
      sayBye(peer, "this side was not heard of for too long; say Hello again", now);
    return;
  }
  peer.heard = now;
  peer.traffic.received += bytesOf(frames);
  peer.messagesReceived++;
  uint8_t kind = 0;
  if (tooMany) return countBad(peer, "too many frames", now);
  if (!unseal(frames, peer.messagesReceived))
    return shutOut(peer, "a message was lost, repeated or damaged on the way", now);
  if (std::string why = verifyHeader(frames[0], kind); !why.empty())
    return countBad(peer, why, now);
  if (!std::exchange(peer.met, true)) push(Event::Kind::joined, peer.id, peer.address);
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
    sendTo(peer, encode(0, message::Beat{beat.sent, true}), now);
  } else if (const double way = now - beat.sent; way >= 0 && way < 600) {
    constexpr double fresh = 0.2;
    peer.traffic.latency =
        peer.measured == 0 ? way : peer.traffic.latency * (1 - fresh) + way * fresh;
    peer.measured = now;
  }
}

void Wire::Impl::countBad(PeerState& peer, const std::string& why, double now) {
  if (++peer.badOnes < mostBad) return;
  shutOut(peer, "three messages that are none, the last one: " + why, now);
}

void Wire::Impl::shutOut(PeerState& peer, const std::string& why, double now) {
  sayBye(peer, why, now);
  if (!peer.met) refused(peer.address + ": " + why);
  leave(peer, why, now);
}

bool Wire::Impl::sendTo(PeerState& peer, Frames&& frames, double now) {
  zmq::socket_t& socket = peer.call ? *peer.call->socket : *door;
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
      socket.send(messageOf(std::move(frames[i])), flags(i)); // goes where the first went
  } catch (const zmq::error_t&) { return false; } // no way there any more: the monitor tells
  peer.messagesSent++;
  peer.traffic.sent += bytes;
  peer.said = now;
  return true;
}

void Wire::Impl::sayBye(PeerState& peer, const std::string& why, double now) {
  sendTo(peer, encode(0, message::Bye{why}), now);
  peer.told = now;
}

// By itself or because we think so. A caller that is still connected is kept in mind, so that it
// can be told if it comes to life.
void Wire::Impl::leave(PeerState& peer, const std::string& why, double now, bool bye) {
  constexpr double again = 0.1, shunned = 4, afterJunk = 5, soon = 10; // seconds
  if (peer.gone) return;
  if (peer.met) push(Event::Kind::left, peer.id, why);
  if (!peer.call) {
    peer.gone = true;
    if (bye) peer.told = now + shunned; // it knows
    return;
  }
  Call& call = *peer.call;
  const bool junk = peer.badOnes >= mostBad;
  // Who ends may come again at once; who does not want us is not to be asked all the time.
  call.byes = bye && now - call.joined < soon ? std::min(call.byes + 1, 10u) : 0;
  forget(peer.id);
  hangUp(call,
         junk        ? afterJunk
         : call.byes ? std::min(shunned, again * std::pow(4.0, call.byes - 1))
                     : again,
         junk);
}

void Wire::Impl::forget(Peer peer) {
  const auto found = peers.find(peer);
  if (found == peers.end()) return;
  const PeerState& state = found->second;
  former[peer] = state.traffic;
  if (former.size() > mostFormer) former.erase(former.begin());
  if (const auto route = routes.find(state.route); route != routes.end() && route->second == peer)
    routes.erase(route);
  if (const auto fd = callersByFd.find(state.fd); fd != callersByFd.end() && fd->second == peer)
    callersByFd.erase(fd);
  peers.erase(found);
}

void Wire::Impl::keepPeers(double now) {
  std::vector<PeerState*> silent;
  for (auto& [id, peer] : peers) {
    if (peer.gone) continue;
    const bool measure = now - std::max(peer.asked, peer.measured) >= measureAgain;
    if (now - peer.said >= heartbeat || measure) {
      sendTo(peer, encode(0, message::Beat{now, false}), now);
      peer.asked = now;
    }
    peer.flow.look(peer.fd, now, silence);
    if (now - peer.heard > silence && !peer.flow.flowing()) silent.push_back(&peer);
  }
  char text[64];
  for (PeerState* peer : silent) {
    std::snprintf(text, sizeof text, "nothing was heard of it for %.2g s", now - peer->heard);
    leave(*peer, text, now);
  }
}

} // namespace openrt::cluster

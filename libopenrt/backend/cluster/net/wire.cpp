// wire.cpp: the event loop of the Wire: waits, runs the calls (wire_calls.cpp) and the peers
// (wire_peers.cpp), and returns events. The owner's thread; wake() from any.
#include "backend/cluster/net/wire.h"

#include <algorithm>
#include <stdexcept>

#include "backend/cluster/net/wire_impl.h"
#include "shortage.h"

namespace openrt::cluster {
namespace {

constexpr int byeMilliseconds = 500; // limit for sending the last message

std::string remedy(const std::string& what) {
  return what +
         " is not this machine's loopback, so keys are needed: make one with \"openrt-worker "
         "--new-key FILE\", copy it to all machines, and give --key FILE (key=FILE) on both sides";
}

void checkAddress(const Address& address, const KeyRing& keys) {
  if (keys.empty() && !address.loopback()) throw std::runtime_error(remedy(address.shown()));
  if (keys.empty() && !address.key.empty())
    throw std::runtime_error(address.shown() + ": the public key of the other side needs a key on "
                                               "this side, too: give --key FILE (key=FILE)");
}

} // namespace

Wire::Impl::Impl(const WireOptions& options)
    : keys(options.keys), heartbeat(options.heartbeat), silence(options.silence),
      context(makeContext()) {
  for (const std::string& text : options.connect) addCall(text);
  if (!keys.empty() && !options.listen.empty()) authenticator.emplace(context, keys);
  if (!options.listen.empty()) {
    checkAddress(Address::parse(options.listen), keys);
    listen(options.listen);
  }
}

Wire::Impl::Call& Wire::Impl::addCall(const std::string& text) {
  Address address = Address::parse(text);
  checkAddress(address, keys);
  if (address.port == 0 && !address.ipc)
    throw std::runtime_error(address.shown() +
                             ": the port cannot be 0; it is 0 only for listening");
  Call& call = calls.emplace_back();
  call.address = std::move(address);
  return call;
}

Wire::Impl::~Impl() {
  const double now = steadySeconds();
  for (auto& [id, peer] : peers)
    if (!peer.hasLeft) sayBye(peer, "the other side has ended", now);
  listenMonitor.reset();
  if (listenSocket) listenSocket->set(zmq::sockopt::linger, byeMilliseconds);
  for (Call& call : calls) {
    call.monitor.reset();
    if (call.socket && call.peer) call.socket->set(zmq::sockopt::linger, byeMilliseconds);
  }
}

void Wire::Impl::pushEvent(Event::Kind kind, Peer peer, std::string text) {
  Event& event = events.emplace_back();
  event.kind = kind;
  event.peer = peer;
  event.text = std::move(text);
}

// Reports a refusal at most once in a while and only for a limited number of texts, because anyone
// may try to connect.
void Wire::Impl::refused(const std::string& text) {
  constexpr double again = 10;
  constexpr size_t crowd = 100;
  const double now = steadySeconds();
  std::erase_if(refusals, [&](const auto& entry) { return now - entry.second > again; });
  if (refusals.size() < crowd && refusals.emplace(text, now).second)
    pushEvent(Event::Kind::refused, 0, text);
}

// Does what depends on time: calls, heartbeats, silent peers.
void Wire::Impl::runTimers(double now) {
  if (now - timersRunAt < heartbeat / 4) return;
  // This side was busy; what arrived meanwhile has not been read.
  if (now - timersRunAt > silence / 2)
    for (auto& [id, peer] : peers)
      peer.lastReceivedAt = std::max(peer.lastReceivedAt, now - silence / 2);
  timersRunAt = now;
  updateCalls(now);
  checkPeers(now);
}

void Wire::Impl::poll(double seconds) {
  std::vector<zmq_pollitem_t> items{{nullptr, wakeUp.fd(), ZMQ_POLLIN, 0}};
  const auto add = [&](void* socket) {
    items.push_back({socket, 0, ZMQ_POLLIN, 0});
    return items.size() - 1;
  };
  const size_t atAuthenticator = authenticator ? add(authenticator->socket().handle()) : 0;
  const size_t atListenSocket = listenSocket ? add(listenSocket->handle()) : 0;
  const size_t atListenMonitor = listenSocket ? add(listenMonitor->socket().handle()) : 0;
  std::vector<std::pair<Call*, size_t>> atCalls;
  for (Call& call : calls) {
    if (!call.socket) continue;
    atCalls.emplace_back(&call, add(call.socket->handle()));
    add(call.monitor->socket().handle());
  }
  if (zmq_poll(items.data(), int(items.size()), long(std::ceil(std::max(0.0, seconds) * 1000))) <=
      0)
    return; // also after a signal
  const double now = steadySeconds();
  if (items[0].revents && wakeUp.clear()) pushEvent(Event::Kind::woken, 0, {});
  if (authenticator && items[atAuthenticator].revents)
    while (authenticator->answer([this](const std::string& text) { refused(text); })) {}
  if (listenSocket && (items[atListenSocket].revents || items[atListenMonitor].revents))
    readCallers(now);
  for (const auto& [call, at] : atCalls)
    if (items[at].revents || items[at + 1].revents) readCall(*call, now);
}

Event Wire::Impl::receive(double seconds) {
  const double until = steadySeconds() + std::max(0.0, seconds);
  for (bool polled = false;; polled = true) {
    const double now = steadySeconds();
    runTimers(now);
    if (!events.empty()) {
      Event event = std::move(events.front());
      events.pop_front();
      return event;
    }
    if (polled && now >= until) return {};
    poll(closing.empty() ? std::min(until, timersRunAt + heartbeat / 4) - now : 0);
    if (!closing.empty()) readCallers(steadySeconds());
  }
}

Wire::Wire(const WireOptions& options) {
  try {
    impl_ = std::make_unique<Impl>(options);
  } catch (const zmq::error_t& e) {
    const std::system_error error(e.num(), std::generic_category(), "ZeroMQ");
    if (isShortage(error)) throw error;
    throw std::runtime_error(std::string("ZeroMQ: ") + e.what());
  }
}

Wire::~Wire() = default;

Event Wire::receive(double seconds) { return impl_->receive(seconds); }

bool Wire::send(Peer peer, Frames&& frames) {
  Impl::PeerState* state = impl_->find(peer);
  return state && !state->hasLeft && !frames.empty() &&
         impl_->sendTo(*state, std::move(frames), steadySeconds());
}

Peer Wire::call(const std::string& address) {
  Impl::Call& call = impl_->addCall(address);
  const Peer peer = call.once = ++impl_->lastPeer;
  impl_->startCall(call, steadySeconds());
  return peer;
}

void Wire::close(Peer peer, const std::string& why) {
  constexpr double again = 5;
  Impl::PeerState* state = impl_->find(peer);
  if (!state || state->hasLeft) return;
  impl_->sayBye(*state, why, steadySeconds());
  if (state->call) {
    Impl::Call& call = *state->call;
    impl_->forget(peer);
    impl_->hangUp(call, again, true);
  } else {
    state->hasLeft = true;
  }
}

void Wire::bad(Peer peer, const std::string& why) {
  if (Impl::PeerState* state = impl_->find(peer); state && !state->hasLeft)
    impl_->countBad(*state, why, steadySeconds());
}

void Wire::pace(double heartbeat, double silence) {
  impl_->heartbeat = heartbeat;
  impl_->silence = silence;
}

std::string Wire::address() const {
  if (!impl_->listenSocket) return {};
  return shownEndpoint(impl_->listenSocket->get(zmq::sockopt::last_endpoint));
}

void Wire::wake() { impl_->wakeUp.call(); }

Wire::Traffic Wire::traffic(Peer peer) const {
  if (const Impl::PeerState* state = impl_->find(peer)) return state->traffic;
  const auto found = impl_->former.find(peer);
  return found == impl_->former.end() ? Traffic() : found->second;
}

} // namespace openrt::cluster

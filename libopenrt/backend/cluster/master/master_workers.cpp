// master_workers.cpp: how remote workers join, get the arrays they lack, and leave.
#include <algorithm>
#include <cstdio>

#include "backend/cluster/master/master_state.h"
#include "backend/cluster/net/addresses.h"
#include "backend/cluster/net/greeting.h"

namespace openrt::cluster {
namespace {
constexpr uint32_t maxStrikes = 3;     // invalid messages before a worker is refused
constexpr uint32_t mostThreads = 4096; // threads of a worker
constexpr size_t maxGone = 256;        // departed workers that are remembered
constexpr size_t maxSaid = 1000;
constexpr const char* reloadedWhy =
    "the master has reloaded shader libraries and now renders alone";

// Returns the address at which other workers reach a worker that shares arrays: the host by which
// the master knows it, and the port that it has named. Empty: it shares none.
// near: the host is this machine's loopback.
std::string shareAddress(const std::string& known, const message::Hello& hello, bool& near) {
  constexpr size_t keyLength = 40;
  if (hello.share == 0 || (!hello.shareKey.empty() && hello.shareKey.size() != keyLength))
    return {};
  try {
    Address address = Address::parse(known);
    if (address.ipc) return {};
    near = address.loopback();
    address.port = hello.share;
    return address.shown() + (hello.shareKey.empty() ? "" : "=" + hello.shareKey);
  } catch (const std::runtime_error&) { return {}; }
}
} // namespace

void Master::Impl::log(int level, const std::string& text) const {
  if (options.local.log)
    options.local.log(level, ("cluster: " + text).c_str(), options.local.logUser);
}

void Master::Impl::logOnce(int level, const std::string& text) {
  if (loggedTexts.size() < maxSaid && loggedTexts.insert(text).second) log(level, text);
}

Remote* Master::Impl::remoteOf(WorkerId id) {
  if (id == localId) return &here;
  const auto found = peers.find(id);
  return found == peers.end() ? nullptr : &remotes.at(found->second);
}

// A reserve joins after a grace period, because remote workers need some time to answer.
void Master::Impl::joinLocal(double now) {
  if (hereJoined || !core) return;
  const bool reserve = options.localThreads == 0;
  if (reserve && !everJoined && now < firstCommit + options.grace) return;
  if (reserve && !everJoined && options.require == 0)
    log(2, "no worker has answered yet: this process continues alone");
  scheduler.join(localId, core->threads(), true, now, reserve);
  hereJoined = true;
}

// Refuses all workers. Shader libraries that are loaded again keep their parameter numbers from
// version to version. A worker that has not seen all versions would confuse the parameters, and one
// that has does not load its own libraries again.
void Master::Impl::refuseAllWorkers(double now) {
  reloaded = true;
  for (const auto& [id, peer] : std::unordered_map<WorkerId, Peer>(peers))
    refuse(peer, reloadedWhy, now);
}

void Master::Impl::hello(Remote& remote, message::Hello&& hello, double now) {
  if (remote.welcome) { // a restarted worker should use a new connection
    const Peer peer = remote.peer;
    strike(remote, "a second Hello", now);
    if (!remotes.contains(peer)) return;
    depart(remote, now);
  }
  remote.host = hello.host;
  if (hello.threads < 1 || hello.threads > mostThreads)
    return refuse(remote.peer, "the worker has " + std::to_string(hello.threads) + " threads", now);
  if (reloaded) return refuse(remote.peer, reloadedWhy, now);
  if (const std::string differing = difference(hello, options.self, options.tolerant);
      !differing.empty())
    return refuse(remote.peer, differing, now);
  remote.welcome = true;
  remote.facts.threads = hello.threads;
  remote.id = nextWorker++;
  remote.session = nextSession++;
  remote.sent = remote.furthest = 0;
  peers[remote.id] = remote.peer;
  everJoined = true;
  loggedAlone = false;
  message::Welcome welcome = usualWelcome(remote.session);
  welcome.isa = canUse(hello, options.self.isa) ? options.self.isa : hello.isa;
  log(1, "worker " + remote.name() + " has joined: " + std::to_string(remote.facts.threads) +
             (remote.facts.threads == 1 ? " thread, " : " threads, ") + welcome.isa);
  queueMessage(remote, std::move(welcome));
  scheduler.join(remote.id, remote.facts.threads, false, now);
  bool near = false;
  const std::string address = shareAddress(remote.address, hello, near);
  distribution.join(remote.id, address, near);
}

void Master::Impl::depart(Remote& remote, double now) {
  waiting.erase(remote.peer);
  goneSent += remote.facts.bytesSent;
  goneReceived += remote.facts.bytesReceived;
  if (remote.welcome) {
    RTworker last = describe(remote, false);
    last.lost += scheduler.tally(remote.id).out;
    gone.push_back(last);
    if (gone.size() > maxGone) gone.erase(gone.begin());
    peers.erase(remote.id);
    scheduler.leave(remote.id, now);
    distribution.leave(remote.id);
  }
  remote.welcome = false;
  remote.outbox.clear();
  remote.offered.clear();
  remote.out.clear();
  remote.merging.clear();
  remote.facts = {};
}

void Master::Impl::strike(Remote& remote, const std::string& what, double now) {
  logOnce(2, "worker " + remote.name() + " has sent an invalid message: " + what);
  if (++remote.strikes >= maxStrikes)
    refuse(remote.peer, "it sends invalid messages: " + what, now);
}

void Master::Impl::refuse(Peer peer, const std::string& why, double now) {
  const auto found = remotes.find(peer);
  if (found == remotes.end()) return;
  lastRefusal = found->second.name() + ": " + why;
  logOnce(2, "worker " + found->second.name() + " is refused: " + why);
  depart(found->second, now);
  remotes.erase(found);
  if (options.close) options.close(peer, why);
}

void Master::Impl::queueMessage(Remote& remote, message::Body&& body) {
  remote.outbox.add(encode(remote.session, std::move(body)));
  waiting.insert(remote.peer);
}

bool Master::Impl::deliver(Remote& remote, Frames&& frames) {
  const size_t bytes = bytesOf(frames);
  if (!send(remote.peer, std::move(frames))) return false;
  remote.facts.bytesSent += bytes;
  return true;
}

void Master::Impl::flush(Remote& remote) {
  const bool idle = remote.outbox.flush(
      remote.session, [&](Frames&& frames) { return deliver(remote, std::move(frames)); });
  if (idle) waiting.erase(remote.peer); // pack() makes a worker that waits for it active again
}

void Master::Impl::need(Remote& remote, const message::Need& need, double now) {
  const auto offered = remote.offered.find(need.epoch);
  if (offered == remote.offered.end())
    return strike(remote, "it needs arrays of a scene that it was not sent", now);
  std::map<Hash, OfferPtr> offers;
  for (OfferPtr& offer : offered->second) offers.emplace(offer->hash, std::move(offer));
  remote.offered.erase(offered);
  for (const Hash& hash : need.arrays) {
    const auto found = offers.find(hash);
    if (found == offers.end())
      return strike(remote, "it needs an array that it was not offered", now);
    distribution.need(remote.id, found->second, now);
    offers.erase(found); // each array is sent once
  }
  for (const auto& [hash, offer] : offers) distribution.has(remote.id, offer);
  sendArrays(now);
}

void Master::Impl::got(Remote& remote, const message::Got& got, double now) {
  if (got.failed)
    distribution.failed(remote.id, got.arrays);
  else
    distribution.got(remote.id, got.arrays, got.kept, now);
}

// Begins the transfers that are due: of each worker, those from the same other worker together.
void Master::Impl::sendArrays(double now) {
  std::map<std::pair<WorkerId, WorkerId>, message::Source> sources;
  for (const Distribution::Transfer& transfer : distribution.transfers(now)) {
    Remote* remote = remoteOf(transfer.to);
    if (!remote) continue; // it has left
    if (transfer.from == Distribution::master) {
      sendArray(*remote, transfer.offer, now);
      continue;
    }
    message::Source& source = sources[{transfer.to, transfer.from}];
    source.address = distribution.addressOf(transfer.from);
    source.arrays.push_back({0, transfer.offer->array->size(), transfer.offer->hash});
  }
  for (auto& [between, source] : sources) queueMessage(*remoteOf(between.first), std::move(source));
}

void Master::Impl::sendArray(Remote& remote, const OfferPtr& offer, double now) {
  remote.outbox.add(offer);
  waiting.insert(remote.peer);
  if (offer->ready || offer->packRequested) return;
  offer->packRequested = true;
  const auto then = [this, offer](double) {
    offer->ready = true;
    for (auto& [peer, other] : remotes) // workers that wait for it
      if (!other.outbox.empty()) waiting.insert(peer);
  };
  if (options.background) {
    options.background([offer] { offer->pack(); }, then);
  } else {
    offer->pack();
    then(now);
  }
}

RTworker Master::Impl::describe(const Remote& remote, bool isAlive) const {
  RTworker w = remote.facts;
  w.size = sizeof(w);
  std::snprintf(w.name, sizeof w.name, "%s", remote.name().c_str());
  const WorkerTally& tally = scheduler.tally(remote.id);
  w.alive = isAlive;
  w.jobs = tally.jobs;
  w.late = tally.late;
  w.lost = tally.lost;
  w.busySeconds = tally.busy;
  w.latency = tally.latency;
  return w;
}

} // namespace openrt::cluster

// master_frames.cpp: who prepares what, how jobs go out and results come home, and how a frame
// ends.
#include <algorithm>
#include <utility>

#include "backend/cluster/master/frame_source.h"
#include "backend/cluster/master/master_state.h"
#include "render/frame/result_codec.h"

namespace openrt::cluster {
namespace {

std::string plural(uint32_t n, const char* what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

std::string whatOf(const Prepared& p) {
  return plural(uint32_t(p.stats.triangles), "triangle") + ", transport " +
         std::to_string(p.frame.transport) + (p.facts.camera ? "" : ", no camera") +
         (p.facts.lamps ? ", paths from lamps" : "");
}

bool same(const Prepared& a, const Prepared& b) {
  return a.facts.camera == b.facts.camera && a.facts.lamps == b.facts.lamps &&
         a.frame.transport == b.frame.transport && a.stats.triangles == b.stats.triangles &&
         a.stats.uniqueTriangles == b.stats.uniqueTriangles &&
         a.stats.rejectedInstances == b.stats.rejectedInstances &&
         a.stats.unreachedLights == b.stats.unreachedLights &&
         a.stats.transportLeavesOut == b.stats.transportLeavesOut;
}

} // namespace

FrameEntry* Master::Impl::unfinished(Epoch epoch) {
  const auto found = frames.find(epoch);
  return found == frames.end() || found->second.state.over ? nullptr : &found->second;
}

Epoch Master::Impl::oldest() const {
  for (const auto& [epoch, entry] : frames)
    if (!entry.state.over) return epoch;
  return 0;
}

// The scene of an epoch, with all that a worker has missed, and the order to prepare it.
void Master::Impl::bring(WorkerId worker, Epoch epoch) {
  Remote* remote = remoteOf(worker);
  if (!remote) return;
  const std::vector<SceneLog::Step> steps = scenes.steps(remote->sent, epoch);
  for (const SceneLog::Step& step : steps) {
    const bool prepare = step.epoch == epoch;
    if (worker == hereId) {
      core->scene(step.epoch, step.parcel->commit, step.whole, prepare);
      continue;
    }
    message::Scene scene;
    scene.epoch = step.epoch;
    scene.whole = step.whole;
    scene.prepare = prepare;
    scene.arrays = step.parcel->arrays;
    scene.libraries = step.parcel->libraries;
    scene.edits = step.parcel->edits;
    remote->offered[step.epoch] = step.parcel->offers;
    say(*remote, std::move(scene));
  }
  if (steps.empty() || steps.back().epoch != epoch) {
    if (worker == hereId)
      core->prepare(epoch);
    else
      say(*remote, message::Prepare{epoch});
  }
  remote->sent = epoch;
  remote->furthest = std::max(remote->furthest, epoch);
}

void Master::Impl::ready(WorkerId worker, const std::string& who, Epoch epoch,
                         const FrameFacts& facts, uint32_t transport, const RTstats& stats,
                         double now) {
  FrameEntry* entry = unfinished(epoch);
  if (!entry) return scheduler.ready(worker, epoch, now);
  Prepared prepared;
  prepared.facts = facts;
  prepared.stats = stats;
  prepared.frame = entry->settings;
  prepared.frame.transport = uint8_t(transport);
  if (entry->state.work && !agree(*entry, worker, who, prepared, now)) return;
  scheduler.ready(worker, epoch, now);
  entry->all.insert(worker);
  if (entry->state.work) return;
  uint32_t crew = hereJoined && options.localThreads > 0 ? here.threads : 0;
  for (const auto& [id, peer] : peers) crew += remotes.at(peer).threads;
  entry->who = who;
  entry->state.prepared = prepared;
  entry->state.work = std::make_shared<FrameWork>(prepared.frame, facts, std::max(crew, 1u));
  scheduler.frame(epoch, std::make_shared<FrameSource>(entry->state.work), now);
  taken(epoch); // there may be nothing to do
}

// Everybody must have found the same in the scene. Who differs goes; it is the others if this
// process is the one that differs.
bool Master::Impl::agree(FrameEntry& entry, WorkerId worker, const std::string& who,
                         const Prepared& prepared, double now) {
  if (same(entry.state.prepared, prepared)) return true;
  const std::string both = who + " has found " + whatOf(prepared) + ", " + entry.who + " " +
                           whatOf(entry.state.prepared);
  if (worker != hereId) {
    refuse(peers.at(worker), "another scene: " + both, now);
    return false;
  }
  for (WorkerId other : std::set<WorkerId>(entry.all))
    if (const auto found = peers.find(other); found != peers.end())
      refuse(found->second, "another scene: " + both, now);
  for (auto& [epoch, candidate] : frames) {
    if (&candidate != &entry) continue;
    scheduler.end(epoch);
    entry.state.work = nullptr; // what they have made of it is of no use
    entry.all.clear();
    scheduler.announce(epoch, now);
  }
  return true;
}

void Master::Impl::result(Remote& remote, message::Result&& message, double now) {
  if (auto out = remote.out.find(message.epoch); out != remote.out.end() && out->second > 0)
    out->second--;
  const Job* job = scheduler.find(remote.id, message.epoch, message.lease);
  FrameEntry* entry = unfinished(message.epoch);
  if (!job || !entry || !entry->state.work) { // too late
    scheduler.done(remote.id, message.epoch, message.lease, message.seconds, now);
    return;
  }
  if (!remote.arriving.insert(message.lease).second) return; // it says so twice
  const auto arrival = std::make_shared<Arrival>();
  arrival->worker = remote.id;
  arrival->epoch = message.epoch;
  arrival->job = {message.lease, *job};
  arrival->result.counters.camera = message.camera;
  arrival->result.counters.shadow = message.shadow;
  arrival->result.counters.secondary = message.secondary;
  if (options.local.shaders)
    arrival->result.counters.faults = faultsFrom(message.faults, *options.local.shaders);
  arrival->result.seconds = message.seconds;
  arrival->message = std::move(message);
  arrive(*entry, arrival, now);
}

void Arrival::merge() {
  if (worker != hereId) {
    unreadable = unpack(message);
    const Tile tile = job.job.kind == Job::Kind::samples ? work->tile(job.job.number) : Tile{};
    fits = unreadable.empty() && decodeResult(frame, job.job, tile, message.bytes, result);
    message = {};
  }
  if (fits) first = work->take(job.job, std::move(result));
  result.sums = {};
  result.light = {}; // memory is given back here, not by the master's thread
}

// What others may do at the same time: the picture does not depend on who comes first.
void Master::Impl::arrive(FrameEntry& entry, const std::shared_ptr<Arrival>& arrival, double now) {
  arrival->work = entry.state.work;
  arrival->frame = entry.state.prepared.frame;
  entry.arriving++;
  const auto merge = [arrival]() noexcept {
    try {
      arrival->merge();
    } catch (...) { arrival->failure = std::current_exception(); }
  };
  const auto then = [this, arrival](double later) { arrived(*arrival, later); };
  if (options.results) return options.results(merge, then);
  merge();
  then(now);
}

void Master::Impl::arrived(const Arrival& a, double now) {
  if (a.failure) std::rethrow_exception(a.failure);
  jobsSince++;
  if (const auto found = frames.find(a.epoch); found != frames.end()) found->second.arriving--;
  Remote* remote = remoteOf(a.worker);
  if (remote) remote->arriving.erase(a.job.lease);
  if (!a.fits) {
    if (a.unreadable.empty()) scheduler.failed(a.worker, a.epoch, a.job.lease, now);
    if (remote && a.unreadable.empty()) strike(*remote, "a result that is none of its job", now);
    if (remote && !a.unreadable.empty())
      refuse(remote->peer, "a message that cannot be read: " + a.unreadable, now);
    return taken(a.epoch);
  }
  scheduler.done(a.worker, a.epoch, a.job.lease, a.result.seconds, now);
  if (a.first) {
    const RayCounters& rays = a.result.counters;
    if (remote && a.worker != hereId) remote->rays += rays.camera + rays.shadow + rays.secondary;
    (a.worker == hereId ? jobsHere : jobsRemote)++;
  }
  taken(a.epoch);
}

void Master::Impl::taken(Epoch epoch) {
  FrameEntry* entry = unfinished(epoch);
  if (!entry || !entry->complete()) return;
  end(epoch);
  settle();
}

// Jobs of it that are still out are of no use. They are taken back together with those of all
// earlier frames, once these are over.
void Master::Impl::end(Epoch epoch) {
  frames.at(epoch).state.over = true;
  scheduler.end(epoch);
  const Epoch first = oldest(), until = first ? first - 1 : std::max(epoch, scenes.last());
  const auto takeBack = [until](Remote& remote) {
    bool any = false;
    for (auto out = remote.out.begin(); out != remote.out.end() && out->first <= until;
         out = remote.out.erase(out))
      any |= out->second > 0;
    return any;
  };
  if (core && takeBack(here)) core->drop(until);
  for (const auto& [id, peer] : peers)
    if (Remote& remote = remotes.at(peer); takeBack(remote)) say(remote, message::Drop{until});
}

void Master::Impl::fail(Epoch epoch, const std::string& why, bool missing) {
  FrameEntry* entry = unfinished(epoch);
  if (!entry) return;
  entry->state.failure = why.empty() ? "it cannot be made" : why;
  entry->state.missing = missing;
  if (entry->state.work) entry->state.work->cancel();
  end(epoch);
  settle();
}

// Which scenes may still be asked for: those from the oldest unfinished frame on.
void Master::Impl::settle() {
  const Epoch first = oldest(), now = first ? first : scenes.last();
  scenes.settle(now);
  Epoch had = now;
  for (const auto& [id, peer] : peers)
    if (const Epoch sent = remotes.at(peer).sent; sent != 0) had = std::min(had, sent);
  if (core && here.sent != 0) had = std::min(had, here.sent);
  scenes.trim(had);
}

uint32_t Master::Impl::able() const {
  const Epoch epoch = oldest();
  const auto can = [&](const auto& peer) { return scheduler.usable(peer.first, epoch); };
  return uint32_t(std::count_if(peers.begin(), peers.end(), can));
}

// Workers that come and go without doing anything are too few workers all the time.
bool Master::Impl::enough(double now) {
  const uint32_t can = options.require == 0 ? 0 : able();
  if (can >= options.require) {
    if (options.require == 0 || oldest() == 0 || scheduler.progressed(oldest()) > fewSince)
      fewSince = std::numeric_limits<double>::infinity();
    if (alive() == 0 && everJoined && !saidAlone && core && oldest() != 0) {
      saidAlone = true;
      log(2, "all workers have gone: this process goes on alone");
    }
    return true;
  }
  if (oldest() == 0) {
    fewSince = std::numeric_limits<double>::infinity();
    return false;
  }
  fewSince = std::min(fewSince, now);
  if (now < fewSince + options.patience) return false;
  const std::string why =
      plural(options.require, "worker") + (options.require == 1 ? " is" : " are") + " needed, " +
      (alive() == 1 ? "there is 1" : "there are " + std::to_string(alive())) +
      (can == alive() ? "" : " (" + std::to_string(can) + " that can make this picture)") +
      (lastRefusal.empty() ? "" : "; refused was " + lastRefusal);
  while (const Epoch epoch = oldest()) fail(epoch, why, true);
  fewSince = std::numeric_limits<double>::infinity();
  return false;
}

void Master::Impl::handOut(double now) {
  WorkerId worker = 0;
  Epoch epoch = 0;
  bool moved = false;
  for (; scheduler.move(now, worker, epoch); moved = true) {
    if (worker == hereId && scheduler.stuck(epoch))
      logOnce(2, "the workers that are there get nowhere: this process helps");
    else if (worker == hereId && options.localThreads == 0 && alive() > 0 && able() == 0)
      logOnce(2, "none of the workers can make this picture: this process goes on alone");
    bring(worker, epoch);
  }
  if (moved) settle();
  while (handSomeOut(now)) {}
}

// Few messages, each with all that one worker gets; but they leave before the last of thousands of
// threads has its job.
bool Master::Impl::handSomeOut(double now) {
  constexpr size_t most = 512;
  std::map<std::pair<WorkerId, Epoch>, std::vector<LeasedJob>> jobs;
  Handout out;
  size_t count = 0;
  for (; count < most && scheduler.next(now, out); count++)
    jobs[{out.worker, out.epoch}].push_back(out.job);
  for (auto& [to, list] : jobs) {
    Remote* remote = remoteOf(to.first);
    if (!remote) continue;
    remote->out[to.second] += uint32_t(list.size());
    if (to.first == hereId) {
      core->work(to.second, list);
      continue;
    }
    say(*remote, message::Jobs{to.second, std::move(list)});
    flush(*remote);
  }
  return count == most;
}

} // namespace openrt::cluster

// master_frames.cpp: sends scenes and jobs, merges results and ends frames.
#include <algorithm>
#include <utility>

#include "backend/cluster/master/frame_source.h"
#include "backend/cluster/master/master_state.h"
#include "render/frame/result_codec.h"
#include "scene/sums_error.h"

namespace openrt::cluster {
namespace {

std::string plural(uint32_t n, const char* what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

std::string whatOf(const Prepared& p) {
  return plural(uint32_t(p.stats.scene.triangles), "triangle") + ", transport " +
         std::to_string(p.frame.transport) + (p.facts.camera ? "" : ", no camera") +
         (p.facts.lamps ? ", paths from lamps" : "");
}

bool same(const Prepared& a, const Prepared& b) {
  return a.facts.camera == b.facts.camera && a.facts.lamps == b.facts.lamps &&
         a.frame.transport == b.frame.transport &&
         a.stats.scene.triangles == b.stats.scene.triangles &&
         a.stats.scene.uniqueTriangles == b.stats.scene.uniqueTriangles &&
         a.stats.rejected.instances == b.stats.rejected.instances &&
         a.stats.transport.unreachedLights == b.stats.transport.unreachedLights &&
         a.stats.transport.leavesOut == b.stats.transport.leavesOut;
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

// Sends the scene of an epoch, with every commit the worker has missed, and the order to prepare
// it.
void Master::Impl::sendScene(WorkerId worker, Epoch epoch) {
  Remote* remote = remoteOf(worker);
  if (!remote) return;
  const std::vector<SceneLog::Step> steps = scenes.steps(remote->sent, epoch);
  for (const SceneLog::Step& step : steps) {
    const bool prepare = step.epoch == epoch;
    if (worker == localId) {
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
    queueMessage(*remote, std::move(scene));
  }
  if (steps.empty() || steps.back().epoch != epoch) {
    if (worker == localId)
      core->prepare(epoch);
    else
      queueMessage(*remote, message::Prepare{.epoch = epoch});
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
  entry->preparedWorkers.insert(worker);
  if (entry->state.work) return;
  uint32_t totalThreads = hereJoined && options.localThreads > 0 ? here.facts.threads : 0;
  for (const auto& [id, peer] : peers) totalThreads += remotes.at(peer).facts.threads;
  entry->preparedBy = who;
  entry->state.prepared = prepared;
  try {
    FrameFacts known = facts;
    known.guide = FrameFacts::unknownGuide; // workers do not tell
    entry->state.work =
        std::make_shared<FrameWork>(prepared.frame, known, std::max(totalThreads, 1u), entry->kept);
  } catch (const SumsError& error) {
    entry->state.sumsWrong = true;
    return fail(epoch, error.what(), false);
  }
  scheduler.frame(epoch, std::make_shared<FrameSource>(entry->state.work), now);
  endIfComplete(epoch); // there may be no jobs at all
}

// All workers must report the same facts about the scene. A worker that differs is refused. If the
// local worker differs, the remote ones are refused.
bool Master::Impl::agree(FrameEntry& entry, WorkerId worker, const std::string& who,
                         const Prepared& prepared, double now) {
  if (same(entry.state.prepared, prepared)) return true;
  const std::string both = who + " has found " + whatOf(prepared) + ", " + entry.preparedBy + " " +
                           whatOf(entry.state.prepared);
  if (worker != localId) {
    refuse(peers.at(worker), "it prepared another scene: " + both, now);
    return false;
  }
  for (WorkerId other : std::set<WorkerId>(entry.preparedWorkers))
    if (const auto found = peers.find(other); found != peers.end())
      refuse(found->second, "it prepared another scene: " + both, now);
  for (auto& [epoch, candidate] : frames) {
    if (&candidate != &entry) continue;
    scheduler.end(epoch);
    entry.state.work = nullptr; // their results are of no use
    entry.preparedWorkers.clear();
    scheduler.announce(epoch, now);
  }
  return true;
}

void Master::Impl::result(Remote& remote, message::Result&& message, double now) {
  if (auto out = remote.out.find(message.epoch); out != remote.out.end() && out->second > 0)
    out->second--;
  const Job* job = scheduler.find(remote.id, message.epoch, message.lease);
  FrameEntry* entry = unfinished(message.epoch);
  if (!job || !entry || !entry->state.work) { // the result came too late
    scheduler.done(remote.id, message.epoch, message.lease, message.seconds, now);
    return;
  }
  if (!remote.merging.insert(message.lease).second) return; // duplicate message
  const auto incoming = std::make_shared<IncomingResult>();
  incoming->worker = remote.id;
  incoming->epoch = message.epoch;
  incoming->job = {message.lease, *job};
  incoming->result.counters.camera = message.camera;
  incoming->result.counters.shadow = message.shadow;
  incoming->result.counters.secondary = message.secondary;
  if (options.local.shaders)
    incoming->result.counters.faults = faultsFrom(message.faults, *options.local.shaders);
  incoming->result.seconds = message.seconds;
  incoming->message = std::move(message);
  startMerge(*entry, incoming, now);
}

void IncomingResult::merge() {
  if (worker != localId) {
    unreadable = unpack(message);
    const Tile tile = job.job.kind == Job::Kind::samples ? work->tile(job.job.number) : Tile{};
    fits = unreadable.empty() && decodeResult(frame, job.job, tile, message.bytes, result);
    message = {};
  }
  if (fits) first = work->take(job.job, std::move(result));
  result.sums = {};
  result.hits = {};
  // Frees the memory on this thread, to relieve the master's thread.
  result.light = {};
}

// Starts merging a result, on any thread: the picture does not depend on the order of results.
void Master::Impl::startMerge(FrameEntry& entry, const std::shared_ptr<IncomingResult>& incoming,
                              double now) {
  incoming->work = entry.state.work;
  incoming->frame = entry.state.prepared.frame;
  entry.merging++;
  const auto merge = [incoming]() noexcept {
    try {
      incoming->merge();
    } catch (...) { incoming->failure = std::current_exception(); }
  };
  const auto then = [this, incoming](double later) { finishMerge(*incoming, later); };
  if (options.results) return options.results(merge, then);
  merge();
  then(now);
}

void Master::Impl::finishMerge(const IncomingResult& a, double now) {
  if (a.failure) std::rethrow_exception(a.failure);
  jobsSince++;
  if (const auto found = frames.find(a.epoch); found != frames.end()) found->second.merging--;
  Remote* remote = remoteOf(a.worker);
  if (remote) remote->merging.erase(a.job.lease);
  if (!a.fits) {
    if (a.unreadable.empty()) scheduler.failed(a.worker, a.epoch, a.job.lease, now);
    if (remote && a.unreadable.empty()) strike(*remote, "the result does not fit its job", now);
    if (remote && !a.unreadable.empty())
      refuse(remote->peer, "a message cannot be read: " + a.unreadable, now);
    return endIfComplete(a.epoch);
  }
  scheduler.done(a.worker, a.epoch, a.job.lease, a.result.seconds, now);
  if (a.first) {
    const RayCounters& rays = a.result.counters;
    if (remote && a.worker != localId)
      remote->facts.rays += rays.camera + rays.shadow + rays.secondary;
    (a.worker == localId ? jobsHere : jobsRemote)++;
  }
  endIfComplete(a.epoch);
}

void Master::Impl::endIfComplete(Epoch epoch) {
  FrameEntry* entry = unfinished(epoch);
  if (!entry || !entry->complete()) return;
  end(epoch);
  settle();
}

// Ends a frame. Its outstanding jobs are dropped together with those of all earlier frames, once
// these are over.
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
    if (Remote& remote = remotes.at(peer); takeBack(remote))
      queueMessage(remote, message::Drop{.epoch = until});
}

void Master::Impl::fail(Epoch epoch, const std::string& why, bool missing) {
  FrameEntry* entry = unfinished(epoch);
  if (!entry) return;
  entry->state.failure = why.empty() ? "the frame cannot be rendered" : why;
  entry->state.missing = missing;
  if (entry->state.work) entry->state.work->cancel();
  end(epoch);
  settle();
}

// Drops the scenes that no worker can ask for any more: those before the oldest unfinished frame.
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

// Returns true if there are enough workers. Workers that join and leave without a result count as
// too few workers all the time.
bool Master::Impl::hasEnoughWorkers(double now) {
  const uint32_t can = options.require == 0 ? 0 : able();
  if (can >= options.require) {
    if (options.require == 0 || oldest() == 0 || scheduler.lastProgressAt(oldest()) > fewSince)
      fewSince = std::numeric_limits<double>::infinity();
    if (alive() == 0 && everJoined && !loggedAlone && core && oldest() != 0) {
      loggedAlone = true;
      log(2, "all workers have left: this process continues alone");
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
      (can == alive() ? "" : " (" + std::to_string(can) + " can make this picture)") +
      (lastRefusal.empty() ? "" : "; a worker was refused: " + lastRefusal);
  while (const Epoch epoch = oldest()) fail(epoch, why, true);
  fewSince = std::numeric_limits<double>::infinity();
  return false;
}

void Master::Impl::handOut(double now) {
  WorkerId worker = 0;
  Epoch epoch = 0;
  bool moved = false;
  for (; scheduler.move(now, worker, epoch); moved = true) {
    if (worker == localId && scheduler.stuck(epoch))
      logOnce(2, "the connected workers make no progress: this process helps");
    else if (worker == localId && options.localThreads == 0 && alive() > 0 && able() == 0)
      logOnce(2, "none of the workers can make this picture: this process continues alone");
    sendScene(worker, epoch);
  }
  if (moved) settle();
  while (handSomeOut(now)) {}
}

// Hands out up to `most` jobs. Each worker gets one message with all of its jobs. The limit makes
// the messages leave before the last of thousands of threads has its job.
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
    if (to.first == localId) {
      core->work(to.second, list);
      continue;
    }
    queueMessage(*remote, message::Jobs{.epoch = to.second, .jobs = std::move(list)});
    flush(*remote);
  }
  return count == most;
}

} // namespace openrt::cluster

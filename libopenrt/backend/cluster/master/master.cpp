// master.cpp: the master's event handlers. Workers: master_workers.cpp; frames: master_frames.cpp.
#include "backend/cluster/master/master.h"

#include <cmath>

#include "backend/cluster/master/master_state.h"
#include "scene/quality.h"
#include "scene/transports.h"

namespace openrt::cluster {
namespace {

uint64_t largestResultOf(const edit::FrameSettingsT& frame) {
  constexpr uint64_t beside = 4096;
  const uint64_t hits = requiredSums(frame).names ? HitCounts::mostNames * sizeof(HitCount) : 0,
                 tile = uint64_t(largestTile) * largestTile * (sizeof(PixelSums) + hits);
  // Run-length encoded zeros are shorter than this.
  const uint64_t light = uint64_t(frame.width) * frame.height * 3 * sizeof(float);
  return std::max(tile, light) + beside;
}

} // namespace

Master::Impl::Impl(const MasterOptions& o, Send s, WorkerCore* h)
    : options(o), send(std::move(s)), core(h), scheduler(o.schedule), scenes(o.local.shaders),
      nextSession(o.session) {
  here.facts.threads = h ? h->threads() : 0;
  here.host = "here";
}

Master::Master(const MasterOptions& options, Send send, WorkerCore* here)
    : impl_(std::make_unique<Impl>(options, std::move(send), here)) {}
Master::~Master() = default;

void Master::joined(Peer peer, const std::string& address, double) {
  Remote& remote = impl_->remotes[peer];
  remote.peer = peer;
  remote.address = address;
}

void Master::left(Peer peer, const std::string& why, double now) {
  const auto found = impl_->remotes.find(peer);
  if (found == impl_->remotes.end()) return;
  Remote& remote = found->second;
  if (remote.welcome) impl_->log(2, "worker " + remote.name() + " has left: " + why);
  impl_->depart(remote, now);
  impl_->remotes.erase(found);
}

void Master::message(Peer peer, Frames&& frames, double now) {
  const auto found = impl_->remotes.find(peer);
  // The worker has left; another one does its jobs.
  if (found == impl_->remotes.end()) return;
  Remote& remote = found->second;
  remote.facts.bytesReceived += bytesOf(frames);
  Message message;
  if (const std::string wrong = decodePacked(std::move(frames), message, impl_->largestResult);
      // The intended message is unknown.
      !wrong.empty())
    return impl_->refuse(peer, "a message cannot be read: " + wrong, now);
  const bool greeting = std::holds_alternative<message::Hello>(message.body);
  // The message belongs to a session that has ended.
  if (!greeting && (!remote.welcome || message.session != remote.session)) return;
  struct {
    Impl& m;
    Remote& remote;
    double now;
    void operator()(message::Hello& hello) const { m.hello(remote, std::move(hello), now); }
    void operator()(message::Need& need) const { m.need(remote, need, now); }
    void operator()(message::Got& got) const { m.got(remote, got, now); }
    void operator()(message::Ready& ready) const {
      if (ready.epoch > remote.furthest || ready.transport == RT_TRANSPORT_AUTO ||
          !isTransport(ready.transport))
        return m.strike(remote, "it cannot have prepared this scene", now);
      // The worker has all arrays of these scenes.
      remote.offered.erase(remote.offered.begin(), remote.offered.upper_bound(ready.epoch));
      m.ready(remote.id, remote.name(), ready.epoch, ready.facts, ready.transport, ready.stats,
              now);
    }
    void operator()(message::Failed& failed) const {
      m.logOnce(2, "worker " + remote.name() + ": " + failed.why);
      m.lastRefusal = remote.name() + ": " + failed.why;
      remote.sent = 0; // it may have any part of the scene
      remote.offered.erase(remote.offered.begin(), remote.offered.upper_bound(failed.epoch));
      remote.out.erase(failed.epoch);
      m.scheduler.unable(remote.id, failed.epoch, now);
    }
    void operator()(message::Result& result) const { m.result(remote, std::move(result), now); }
    void operator()(message::Log& log) const {
      if (remote.logged++ < limits::logLines)
        m.log(log.level, "worker " + remote.name() + ": " + log.text);
    }
  } const handler{*impl_, remote, now};
  if (!dispatch<Sender::worker>(message.body, handler))
    impl_->strike(remote, "only masters send this message", now);
}

void Master::localReady(Epoch epoch, const Prepared& prepared, double now) {
  impl_->ready(localId, "here", epoch, prepared.facts, prepared.frame.transport, prepared.stats,
               now);
}

// A frame that the local worker cannot render fails. Remote workers could not render it either.
void Master::localFailed(Epoch epoch, const std::string& why, double now) {
  Impl& m = *impl_;
  m.fail(epoch, why, false);
  m.here.sent = 0; // it starts anew with the next frame, which may succeed
  if (!m.hereJoined) return;
  m.scheduler.leave(localId, now);
  m.hereJoined = false;
  m.joinLocal(now);
}

void Master::localDone(Epoch epoch, const LeasedJob& job, JobResult&& result, double now) {
  Impl& m = *impl_;
  if (auto out = m.here.out.find(epoch); out != m.here.out.end() && out->second > 0) out->second--;
  m.here.facts.rays += result.counters.camera + result.counters.shadow + result.counters.secondary;
  FrameEntry* entry = m.unfinished(epoch);
  if (!entry || !entry->state.work || !m.scheduler.find(localId, epoch, job.lease)) {
    m.scheduler.done(localId, epoch, job.lease, result.seconds, now);
    return;
  }
  const auto incoming = std::make_shared<IncomingResult>();
  incoming->epoch = epoch;
  incoming->job = job;
  incoming->result = std::move(result);
  m.startMerge(*entry, incoming, now);
}

void Master::commit(Epoch epoch, std::shared_ptr<const Commit> commit, bool frame, double now,
                    const KeepSums& kept) {
  Impl& m = *impl_;
  m.firstCommit = std::min(m.firstCommit, now);
  for (const auto& entry : commit->edits.edits)
    if (entry && entry->any.AsReloadShaders()) m.refuseAllWorkers(now);
  m.scenes.add(epoch, std::move(commit));
  if (frame) {
    FrameEntry& entry = m.frames[epoch];
    entry.settings = m.scenes.frame();
    entry.kept = kept;
    m.largestResult = std::max(m.largestResult, largestResultOf(entry.settings));
    m.joinLocal(now);
    m.scheduler.announce(epoch, now);
  }
  m.settle();
}

void Master::cancel(Epoch epoch, double) {
  Impl& m = *impl_;
  for (auto& [number, entry] : m.frames) {
    if (number > epoch || entry.state.over) continue;
    if (!entry.state.work) { // a picture without any result
      entry.state.prepared.frame = entry.settings;
      if (entry.settings.transport == RT_TRANSPORT_AUTO)
        entry.state.prepared.frame.transport = RT_TRANSPORT_DIRECT;
      entry.state.work =
          std::make_shared<FrameWork>(entry.state.prepared.frame, FrameFacts{true, false}, 1);
    }
    entry.state.work->cancel();
    m.end(number);
  }
  m.settle();
}

double Master::advance(double now) {
  Impl& m = *impl_;
  m.joinLocal(now);
  double next = std::numeric_limits<double>::infinity();
  bool ended = false;
  // Frames with a time limit end by themselves.
  for (auto& [epoch, entry] : m.frames)
    if (!entry.state.over && entry.complete()) {
      m.end(epoch);
      ended = true;
    }
  if (ended) m.settle();
  if (m.hasEnoughWorkers(now)) {
    m.handOut(now);
    next = m.scheduler.wake(now);
  } else if (m.oldest() != 0) {
    next = m.fewSince + m.options.patience;
  }
  m.sendArrays(now);
  for (Peer peer : std::set<Peer>(m.waiting)) {
    Remote& remote = m.remotes.at(peer);
    m.flush(remote);
    if (remote.outbox.overfull()) m.refuse(peer, "it does not read the messages sent to it", now);
  }
  if (!m.waiting.empty()) next = std::min(next, now + 0.001); // the queue may have room again
  if (!m.hereJoined && m.core && std::isfinite(m.firstCommit))
    next = std::min(next, m.firstCommit + m.options.grace);
  return std::max(next, now);
}

void Master::busy(double seconds) {
  constexpr double memory = 5000; // time constant of the average, in jobs
  Impl& m = *impl_;
  if (m.jobsSince == 0) return; // only scenes and other messages
  const double keep = std::exp(-m.jobsSince / memory);
  m.busySeconds = m.busySeconds * keep + seconds;
  m.busyJobs = m.busyJobs * keep + m.jobsSince;
  m.jobsSince = 0;
  m.scheduler.pace(m.busySeconds / m.busyJobs);
}

bool Master::sendSceneToLocal() {
  Impl& m = *impl_;
  const Epoch last = m.scenes.last();
  if (!m.core || last == 0) return false;
  if (const Epoch first = m.oldest(); first != 0 && first < last) return false;
  for (const SceneLog::Step& step : m.scenes.steps(m.here.sent, last))
    m.core->scene(step.epoch, step.parcel->commit, step.whole, false);
  m.here.sent = last;
  return true;
}

Master::FrameState Master::frame(Epoch epoch) const {
  const auto found = impl_->frames.find(epoch);
  return found == impl_->frames.end() ? FrameState() : found->second.state;
}

void Master::forget(Epoch epoch) {
  if (const auto found = impl_->frames.find(epoch);
      found != impl_->frames.end() && found->second.state.over)
    impl_->frames.erase(found);
}

Master::Totals Master::totals() const {
  Totals t;
  t.cluster = {.workers = impl_->alive(),
               .tilesRemote = impl_->jobsRemote,
               .tilesLocal = impl_->jobsHere,
               .reissued = impl_->scheduler.reissued(),
               .duplicates = impl_->scheduler.duplicates(),
               .bytesSent = impl_->goneSent,
               .bytesReceived = impl_->goneReceived};
  t.threads = impl_->options.localThreads;
  for (const auto& [peer, remote] : impl_->remotes) {
    t.cluster.bytesSent += remote.facts.bytesSent;
    t.cluster.bytesReceived += remote.facts.bytesReceived;
    if (remote.welcome) t.threads += remote.facts.threads;
  }
  return t;
}

std::vector<RTworker> Master::workers() const {
  std::vector<RTworker> result;
  if (impl_->core) result.push_back(impl_->describe(impl_->here, true));
  result.insert(result.end(), impl_->gone.begin(), impl_->gone.end());
  std::map<WorkerId, const Remote*> present;
  for (const auto& [id, peer] : impl_->peers) present[id] = &impl_->remotes.at(peer);
  for (const auto& [id, remote] : present) result.push_back(impl_->describe(*remote, true));
  return result;
}

} // namespace openrt::cluster

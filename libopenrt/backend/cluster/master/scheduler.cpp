// scheduler.cpp: keeps the leases, which say which worker has which job, and what happens to the
// job when the worker finishes it, fails or is lost.
#include "backend/cluster/master/scheduler.h"

#include <algorithm>

#include "backend/cluster/master/scheduler_state.h"

namespace openrt::cluster {

Frame* Scheduler::Impl::frame(Epoch epoch) {
  const auto it = frames.find(epoch);
  return it == frames.end() ? nullptr : &it->second;
}

Worker* Scheduler::Impl::worker(WorkerId id) {
  const auto it = workers.find(id);
  return it == workers.end() ? nullptr : &it->second;
}

void Scheduler::Impl::eraseDeadline(Frame& f, uint64_t id, const OutstandingJob& outstanding) {
  f.deadlines.erase({outstanding.deadline, id});
  f.noMoreCopies.erase({outstanding.deadline, id});
}

void Scheduler::Impl::forget(Frame& f, Lease lease, bool lost) {
  const auto it = f.leases.find(lease);
  const LeaseRecord record = it->second;
  f.leases.erase(it);
  if (Worker* w = worker(record.worker)) {
    w->leases.erase({f.epoch, lease});
    w->tally.out = uint32_t(w->leases.size());
    if (lost && record.outstanding) w->tally.lost++;
  }
  const auto outstanding = f.outstandingJobs.find(record.outstanding);
  if (outstanding == f.outstandingJobs.end()) return;
  outstanding->second.holders.erase(lease);
  if (!outstanding->second.holders.empty()) return;
  f.work->giveBack(outstanding->second.job);
  if (outstanding->second.seconds > 0) {
    f.unassignedUnits += outstanding->second.units;
    f.unassignedSeconds += outstanding->second.seconds;
  }
  f.mayHaveJobs = true;
  eraseDeadline(f, record.outstanding, outstanding->second);
  f.outstandingJobs.erase(outstanding);
}

void Scheduler::Impl::forgetAll(Worker& w, Epoch until) {
  while (!w.leases.empty() && w.leases.begin()->first < until)
    forget(frames.at(w.leases.begin()->first), w.leases.begin()->second, true);
  mayMove = true;
}

void Scheduler::Impl::leave(Worker& w) {
  forgetAll(w, ~Epoch(0));
  leaveGroup(w);
  reserves -= w.reserve;
  workers.erase(w.id);
}

void Scheduler::Impl::recordFailure(Worker& w) {
  if (w.tally.blocked || ++w.tally.failed < options.maxFailed) return;
  updateTotals(w, -1);
  w.tally.blocked = true;
  forgetAll(w, ~Epoch(0));
}

void Scheduler::Impl::end(Frame& f) {
  if (f.costs.jobs() > 0) costs = f.costs;
  if (f.light.jobs() > 0) light = f.light;
  tileCosts = std::move(f.tileCosts);
  if (f.costs.jobs() > 0) frameSeconds = f.costs.seconds() + f.light.seconds();
  for (const auto& [lease, record] : f.leases) {
    Worker* w = worker(record.worker);
    w->leases.erase({f.epoch, lease});
    w->tally.out = uint32_t(w->leases.size());
    rank(*w);
  }
  const Epoch epoch = f.epoch;
  frames.erase(epoch);
  if (const auto g = groups.find(epoch); g != groups.end() && g->second.members.empty())
    groups.erase(g);
  mayMove = true;
}

bool Scheduler::Impl::done(Frame& f, Lease lease, double seconds, double now) {
  const auto it = f.leases.find(lease);
  const LeaseRecord record = it->second;
  f.leases.erase(it);
  Worker& w = *worker(record.worker);
  w.leases.erase({f.epoch, lease});
  w.tally.out = uint32_t(w.leases.size());
  // A worker cannot have computed longer than it held the job.
  if (now > record.since) seconds = std::min(seconds, now - record.since);
  w.tally.busy += std::max(seconds, 0.0);
  w.lastResultAt = now;
  if (w.recentLate > 0) w.recentLate--;
  const double beyond = std::max(now - record.since - seconds, 0.0);
  if (w.tally.jobs + w.tally.late == 0 || (record.onFreeThread && beyond < w.tally.latency))
    w.tally.latency = beyond; // queued jobs only lengthen the round trip
  else if (record.onFreeThread)
    w.tally.latency += (beyond - w.tally.latency) / 8;
  else
    w.tally.latency = std::min(w.tally.latency, beyond);
  if (!record.outstanding) {
    w.tally.late++;
    duplicates++;
    rank(w);
    return false;
  }
  f.lastProgressAt = now; // duplicate and useless results are no progress
  if (!w.pinned()) noRemoteResults = false;
  const auto outstanding = f.outstandingJobs.find(record.outstanding);
  const Job& job = outstanding->second.job;
  f.costsOf(job).add(outstanding->second.units, seconds);
  // The cost stays finite, whatever duration the worker reports.
  if (job.kind == Job::Kind::samples && job.number < f.tileCosts.size() && seconds > 0)
    f.tileCosts[job.number] = float(std::min(seconds, 1e6) / outstanding->second.units);
  for (const Lease other : outstanding->second.holders)
    if (other != lease) f.leases.at(other).outstanding = 0;
  eraseDeadline(f, record.outstanding, outstanding->second);
  f.outstandingJobs.erase(outstanding);
  w.tally.jobs++;
  if (record.speculative) w.tally.again++;
  f.mayHaveJobs = true; // jobs that waited for this result
  if (f.split == Split::frames) mayMove = true;
  rank(w);
  if (f.costs.jobs() + f.light.jobs() >= f.updateDeadlinesAt) {
    f.updateDeadlinesAt *= 2;
    for (auto& [id, other] : f.outstandingJobs) updateDeadline(f, id, other);
  }
  return true;
}

Scheduler::Scheduler(const SchedulerOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Scheduler::~Scheduler() = default;

void Scheduler::join(WorkerId worker, uint32_t threads, bool here, double now, bool reserve) {
  leave(worker, now);
  Worker& w = impl_->workers[worker];
  w.id = worker;
  w.threads = std::clamp(threads, 1u, 1u << 16);
  w.here = here;
  w.reserve = reserve;
  w.lastResultAt = now;
  impl_->reserves += w.reserve;
  impl_->joinGroup(w, 0, true);
}

void Scheduler::leave(WorkerId worker, double) {
  if (Worker* w = impl_->worker(worker)) impl_->leave(*w);
}

void Scheduler::announce(Epoch epoch, double now) {
  Impl& s = *impl_;
  if (s.frames.contains(epoch)) return;
  Frame& f = s.frames[epoch];
  f.epoch = epoch;
  f.lastProgressAt = now;
  f.split = s.splitOf();
  f.wholeTiles = s.options.split == Split::tiles;
  f.spread = s.options.split == Split::samples;
  f.costs = s.costs.ofNextFrame();
  f.light = s.light.ofNextFrame();
  s.mayMove = true;
  // Workers that have its scene already.
  if (const auto g = s.groups.find(epoch); g != s.groups.end())
    for (const WorkerId id : g->second.members) s.rank(s.workers.at(id));
}

void Scheduler::frame(Epoch epoch, std::shared_ptr<JobSource> work, double now) {
  announce(epoch, now);
  Frame& f = impl_->frames.at(epoch);
  f.work = std::move(work);
  f.mayHaveJobs = true;
  f.lastProgressAt = now;
  f.tilePixels = f.work->tiles() > 0 ? std::max(f.work->pixels(0), 1u) : 1;
  f.samplesPerPixel =
      std::max(f.work->undone() / (double(f.tilePixels) * std::max(f.work->tiles(), 1u)), 1.0);
  // The cost of a tile changes little from frame to frame.
  if (impl_->tileCosts.size() == f.work->tiles()) f.tileCosts = impl_->tileCosts;
  f.tileCosts.resize(f.work->tiles());
  impl_->orderTiles(f);
  impl_->mayMove = true;
}

void Scheduler::changed(Epoch epoch) {
  if (Frame* f = impl_->frame(epoch)) f->mayHaveJobs = f->work != nullptr;
}

void Scheduler::end(Epoch epoch) {
  if (Frame* f = impl_->frame(epoch)) impl_->end(*f);
}

bool Scheduler::move(double now, WorkerId& worker, Epoch& epoch) {
  return impl_->move(now, worker, epoch);
}

void Scheduler::ready(WorkerId worker, Epoch epoch, double now) {
  Worker* w = impl_->worker(worker);
  if (!w || epoch < w->epoch) return;
  if (epoch == w->epoch && !w->ready) {
    const double took = std::max(now - std::max(w->prepareSentAt, w->lastResultAt), 0.0);
    impl_->prepare += (took - impl_->prepare) / (impl_->prepare > 0 ? 8 : 1);
  }
  impl_->forgetAll(*w, epoch);
  impl_->joinGroup(*w, epoch, true);
}

void Scheduler::unable(WorkerId worker, Epoch epoch, double) {
  Worker* w = impl_->worker(worker);
  if (!w) return;
  if (w->epoch == epoch && !w->unable) {
    impl_->updateTotals(*w, -1);
    w->unable = true;
    w->ready = true; // for the next epoch
    impl_->updateTotals(*w, 1);
  }
  impl_->forgetAll(*w, epoch + 1);
  impl_->recordFailure(*w);
  impl_->joinGroup(*w, w->epoch, w->ready);
}

bool Scheduler::next(double now, Handout& out) { return impl_->next(now, out); }

bool Scheduler::done(WorkerId worker, Epoch epoch, Lease lease, double seconds, double now) {
  Frame* f = impl_->frame(epoch);
  if (!f) return false;
  const auto record = f->leases.find(lease);
  return record != f->leases.end() && record->second.worker == worker &&
         impl_->done(*f, lease, seconds, now);
}

void Scheduler::failed(WorkerId worker, Epoch epoch, Lease lease, double) {
  Frame* f = impl_->frame(epoch);
  if (!f) return;
  const auto record = f->leases.find(lease);
  if (record == f->leases.end() || record->second.worker != worker) return;
  impl_->forget(*f, lease, false);
  Worker& w = *impl_->worker(worker);
  impl_->recordFailure(w);
  impl_->joinGroup(w, w.epoch, w.ready);
}

const Job* Scheduler::find(WorkerId worker, Epoch epoch, Lease lease) const {
  const Frame* f = impl_->frame(epoch);
  if (!f) return nullptr;
  const auto record = f->leases.find(lease);
  if (record == f->leases.end() || record->second.worker != worker || !record->second.outstanding)
    return nullptr;
  return &f->outstandingJobs.at(record->second.outstanding).job;
}

uint32_t Scheduler::able(Epoch epoch) const {
  uint32_t count = 0;
  for (const auto& [id, w] : impl_->workers)
    count += !w.tally.blocked && (w.epoch < epoch || (w.epoch == epoch && !w.unable));
  return count;
}

void Scheduler::pace(double secondsOfJob) { impl_->pace = std::clamp(secondsOfJob, 0.0, 1e-4); }

double Scheduler::wake(double now) const {
  // Interval at which a late job that no worker can take is checked again.
  constexpr double breath = 0.005;
  double when = impl_->stuckAt();
  for (const auto& [epoch, f] : impl_->frames) {
    const auto g = impl_->groups.find(epoch);
    if (g == impl_->groups.end()) continue;
    const bool needsPinned = !f.needsPinned && impl_->pinnedWorkers > 0 && g->second.pinned.empty();
    const auto& pinned = g->second.pinned;
    const bool here = std::any_of(pinned.begin(), pinned.end(), [&](WorkerId id) {
      return impl_->workers.at(id).idleKey < never;
    });
    if (!f.deadlines.empty() && (needsPinned || !g->second.idle.empty()))
      when = std::min(when, std::max(f.deadlines.begin()->first, now + breath));
    if (!f.noMoreCopies.empty() && (needsPinned || here))
      when = std::min(when, std::max(f.noMoreCopies.begin()->first, now + breath));
  }
  return when;
}

bool Scheduler::usable(WorkerId worker, Epoch epoch) const {
  const Worker* w = impl_->worker(worker);
  return w && !w->tally.blocked && !(w->unable && w->epoch == epoch);
}

double Scheduler::lastProgressAt(Epoch epoch) const {
  const Frame* f = impl_->frame(epoch);
  return f ? f->lastProgressAt : 0;
}

bool Scheduler::stuck(Epoch epoch) const {
  const Frame* f = impl_->frame(epoch);
  return f && f->stuck;
}

double Scheduler::lateAfter(Epoch epoch) const {
  Frame* f = impl_->frame(epoch);
  if (!f || f->costs.median() <= 0) return never;
  OutstandingJob usual;
  usual.units = f->lastUnits > 0 ? f->lastUnits : f->tilePixels * f->samplesPerPixel;
  return impl_->lateLimit(*f, usual);
}

const WorkerTally& Scheduler::tally(WorkerId worker) const {
  static const WorkerTally none{};
  const Worker* w = impl_->worker(worker);
  return w ? w->tally : none;
}

uint64_t Scheduler::reissued() const { return impl_->reissued; }
uint64_t Scheduler::duplicates() const { return impl_->duplicates; }

Split Scheduler::split(Epoch epoch) const {
  const Frame* f = impl_->frame(epoch);
  if (!f) return impl_->options.split;
  return f->split == Split::frames ? Split::frames
         : f->spread               ? Split::samples
         : f->wholeTiles           ? Split::tiles
                                   : Split::automatic;
}

} // namespace openrt::cluster

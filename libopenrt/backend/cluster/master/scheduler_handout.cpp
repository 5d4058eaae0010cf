// scheduler_handout.cpp: decides which worker gets which job, how large the job is and when it is
// late. Jobs are large while much work is left and small towards the end (factoring: S. Hummel, E.
// Schonberg, L. Flynn, "Factoring: a method for scheduling parallel loops", CACM 35(8), 1992). Late
// jobs are copied to idle threads (J. Dean, S. Ghemawat, "MapReduce", OSDI 2004, 3.6).
#include <algorithm>
#include <bit>
#include <cmath>

#include "backend/cluster/master/scheduler_state.h"

namespace openrt::cluster {

namespace {
constexpr uint32_t minSamples = 32; // samples below which a tile is not divided (frame_work.h)
constexpr double mostInFlight = 4;  // jobs, or bundles of jobs, per thread
constexpr double largestBundle = 64;
// Jobs are made long enough that the master is busy for at most 1/1.75 of the time.
constexpr double masterHeadroom = 1.75;
// Seconds of work that a worker keeps waiting when it reports a result, besides its link.
constexpr double turnaround = 8e-3;
constexpr double minWaiting = 0.25; // jobs per thread waiting behind the running one
constexpr double mixedUntil = 0.7;  // part of the frame's work in which cheap tiles are mixed
// A tile may cost this many times the average: one in 32 may cost as much as all the others.
constexpr double maxTileCostRatio = 32;
constexpr double parts = 4; // a job is one of this many parts of the work left for a thread
} // namespace

void Scheduler::Impl::orderTiles(Frame& f) {
  const uint32_t tiles = f.work->tiles();
  if (std::find(f.tileCosts.begin(), f.tileCosts.end(), 0.0f) != f.tileCosts.end()) return;
  std::vector<uint32_t> order(tiles);
  std::vector<float> cost(tiles);
  for (uint32_t i = 0; i < tiles; i++) {
    const float pixels = float(f.work->pixels(i));
    order[i] = i;
    cost[i] = f.tileCosts[i] * pixels;
    f.unassignedUnits += pixels;
    f.unassignedSeconds += cost[i];
  }
  const double samples = f.work->undone() / std::max(f.unassignedUnits, 1.0);
  f.unassignedUnits *= samples;
  f.unassignedSeconds *= samples;
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return cost[a] > cost[b]; });
  // Tiles that take less time than a job should are not kept for the end, because the master would
  // have to hand out too many of them at once.
  const double least = std::max(options.shortest, masterHeadroom * pace * threads) / samples;
  const auto cheap =
      std::find_if(order.begin(), order.end(), [&](uint32_t tile) { return cost[tile] < least; });
  const size_t expensive = size_t(cheap - order.begin());
  std::vector<uint32_t> mixed;
  mixed.reserve(tiles);
  size_t next = expensive;
  double given = 0;
  for (size_t i = 0; i < expensive; i++) {
    mixed.push_back(order[i]);
    given += cost[order[i]] * samples;
    const double share = std::min(given / (mixedUntil * f.unassignedSeconds), 1.0);
    while (double(next - expensive) < share * double(tiles - expensive))
      mixed.push_back(order[next++]);
  }
  mixed.insert(mixed.end(), order.begin() + ptrdiff_t(next), order.end());
  f.work->order(std::move(mixed));
}

double Scheduler::Impl::usualJobSeconds(const Frame& f) const {
  if (f.lastSeconds > 0) return f.lastSeconds;
  const double units = f.lastUnits > 0
                           ? f.lastUnits
                           : f.tilePixels * std::min(f.samplesPerPixel, double(minSamples));
  return f.costs.mean() * units;
}

double Scheduler::Impl::jobsPerBundle(const Frame& f) const {
  const double usual = usualJobSeconds(f);
  return usual > 0 ? std::clamp(std::floor(options.shortest / usual), 1.0, largestBundle) : 1;
}

double Scheduler::Impl::threadsFor(Epoch epoch) const {
  const auto own = groups.find(epoch);
  const Frame& f = frames.at(epoch);
  uint32_t all = own == groups.end() ? 0 : own->second.threads;
  if (f.split != Split::frames) // workers of earlier epochs are still to come
    for (auto g = groups.begin(); g != groups.end() && g->first < epoch; ++g)
      all += g->second.threads;
  return std::max(all, 1u);
}

double Scheduler::Impl::queueDepth(const Frame& f) const {
  const double together = jobsPerBundle(f);
  const double left =
      (f.lastSeconds > 0 ? f.remainingSeconds() / f.lastSeconds
                         : f.work->undone() /
                               (f.lastUnits > 0 ? f.lastUnits : f.tilePixels * f.samplesPerPixel)) /
      threadsFor(f.epoch); // jobs per thread
  double most = std::clamp(options.inFlight, 1u, uint32_t(mostInFlight));
  // With few waiting jobs, other workers get theirs sooner.
  if (f.lastSeconds > 0)
    most = std::min(most, 1 + std::max(minWaiting, turnaround / f.lastSeconds));
  return std::clamp(std::ceil(left / together), 1.0, most) * together;
}

uint32_t Scheduler::Impl::maxSamplesOf(const Frame& f, const Worker& w) const {
  if (f.wholeTiles || f.samplesPerPixel <= minSamples) return ~0u;
  double samples = minSamples;
  if (f.spread) {
    samples = f.samplesPerPixel / std::max(usable, 1u);
  } else if (f.costs.known()) {
    const double left = f.remainingSeconds() / threadsFor(f.epoch);
    // A slow link gets larger jobs, because the number of jobs in flight is limited.
    const double least = std::max({options.shortest, w.tally.latency / (mostInFlight - 1),
                                   masterHeadroom * pace * threadsFor(f.epoch)});
    const double seconds = std::clamp(left / parts, least, std::max(options.longest, least));
    const double tileCost = f.tileCost(f.work->upcoming());
    if (tileCost > 0)
      samples = seconds / tileCost / f.tilePixels;
    else
      // The cost of the next tile is unknown. An expensive tile must not take longer than half of
      // what is left, nor much longer than the frame if all its work lies in a few of the tiles.
      samples = std::min(
          {seconds / f.costs.mean() / f.tilePixels,
           std::max(left / 2, least) / f.costs.expensive() / f.tilePixels,
           f.samplesPerPixel * f.work->tiles() / (maxTileCostRatio * threadsFor(f.epoch))});
  }
  if (samples >= f.samplesPerPixel) return ~0u;
  return std::bit_floor(std::max(uint32_t(samples), minSamples));
}

Worker* Scheduler::Impl::leastLoaded(const Frame& f, Group& g) {
  const double most = queueDepth(f), cap = mostInFlight * jobsPerBundle(f);
  while (!g.byLoad.empty()) {
    const auto [key, id] = *g.byLoad.begin();
    if (key >= most) return nullptr;
    Worker& w = workers.at(id);
    if (w.tally.out < w.effectiveThreads() * cap && !mustWait(f, g, w)) return &w;
    g.byLoad.erase(g.byLoad.begin()); // until the worker's state changes
    w.loadKey = never;
  }
  return nullptr;
}

void Scheduler::Impl::issue(Frame& f, Worker& w, uint64_t id, bool speculative, double now,
                            Handout& out) {
  OutstandingJob& outstanding = f.outstandingJobs.at(id);
  const Lease lease = ++lastLease;
  outstanding.since = now;
  outstanding.queuePosition = 1 + std::floor(w.tally.out / double(w.threads));
  outstanding.linkLatency = w.tally.latency;
  outstanding.holders.insert(lease);
  f.leases[lease] = {w.id, id, now, speculative, w.tally.out < w.threads};
  w.leases.insert({f.epoch, lease});
  w.tally.out = uint32_t(w.leases.size());
  updateDeadline(f, id, outstanding);
  rank(w);
  out = {w.id, f.epoch, {lease, outstanding.job}, speculative};
}

double Scheduler::Impl::lateLimit(Frame& f, const OutstandingJob& outstanding) {
  const double median = f.costsOf(outstanding.job).median();
  if (median <= 0) return options.stuck;
  const double usual = outstanding.seconds > 0 ? outstanding.seconds : median * outstanding.units;
  return std::max(options.patience * (usual * outstanding.queuePosition + outstanding.linkLatency),
                  options.soonest);
}

void Scheduler::Impl::updateDeadline(Frame& f, uint64_t id, OutstandingJob& outstanding) {
  eraseDeadline(f, id, outstanding);
  outstanding.deadline = outstanding.since + lateLimit(f, outstanding);
  if (outstanding.deadline < never)
    (outstanding.copies < options.maxCopies ? f.deadlines : f.noMoreCopies)
        .insert({outstanding.deadline, id});
}

bool Scheduler::Impl::reissue(Frame& f, Group& g, double now, Handout& out) {
  while (!g.idle.empty() && !f.deadlines.empty()) {
    const auto [deadline, id] = *f.deadlines.begin();
    if (deadline > now) return false;
    OutstandingJob& outstanding = f.outstandingJobs.at(id);
    updateDeadline(f, id, outstanding);
    if (outstanding.deadline > now) continue;
    const auto has = [&](WorkerId w) {
      return std::any_of(outstanding.holders.begin(), outstanding.holders.end(),
                         [&](Lease l) { return f.leases.at(l).worker == w; });
    };
    // At most four are passed over.
    const auto idle = std::find_if(g.idle.begin(), g.idle.end(), [&](const auto& entry) {
      return !has(entry.second) && !mustWait(f, g, workers.at(entry.second));
    });
    if (idle == g.idle.end()) return false;
    // A holder without any result since it got the job gets a smaller share.
    for (const Lease l : outstanding.holders)
      if (Worker& w = workers.at(f.leases.at(l).worker); w.lastResultAt < outstanding.since) {
        w.recentLate = std::min(w.recentLate + 1, 8u);
        rank(w);
      }
    outstanding.copies++;
    reissued++;
    issue(f, workers.at(idle->second), id, true, now, out);
    return true;
  }
  return false;
}

// Gives the local worker, which cannot be lost, a job that many workers have had without a result.
// In a stuck frame it gets any job that others have, whatever its expected duration.
bool Scheduler::Impl::reissueLocally(Frame& f, Group& g, double now, Handout& out) {
  for (const WorkerId id : g.pinned) {
    Worker& w = workers.at(id);
    if (w.idleKey == never || mustWait(f, g, w)) continue;
    const auto takes = [&](const auto& late) {
      const auto& holders = f.outstandingJobs.at(late.second).holders;
      return (f.stuck || late.first <= now) &&
             std::none_of(holders.begin(), holders.end(),
                          [&](Lease l) { return f.leases.at(l).worker == id; });
    };
    auto found = std::find_if(f.noMoreCopies.begin(), f.noMoreCopies.end(), takes);
    if (found == f.noMoreCopies.end()) {
      if (!f.stuck) continue;
      found = std::find_if(f.deadlines.begin(), f.deadlines.end(), takes);
      if (found == f.deadlines.end()) continue;
    }
    const uint64_t outstanding = found->second; // issue() changes the set
    reissued++;
    issue(f, w, outstanding, true, now, out);
    return true;
  }
  return false;
}

bool Scheduler::Impl::next(double now, Handout& out) {
  for (auto& [epoch, f] : frames) {
    const auto it = groups.find(epoch);
    if (!f.work || it == groups.end()) continue;
    Group& g = it->second;
    Worker* w = f.mayHaveJobs ? leastLoaded(f, g) : nullptr;
    Job job;
    if (w && f.work->next(job, maxSamplesOf(f, *w)) == FrameWork::Next::job) {
      OutstandingJob& outstanding = f.outstandingJobs[++lastOutstanding];
      outstanding.job = job;
      const bool ofLight = job.kind == Job::Kind::light;
      outstanding.units =
          std::max(1.0, double(job.count) * (ofLight ? 1 : f.work->pixels(job.number)));
      if (!ofLight) {
        outstanding.seconds = f.tileCost(job.number) * outstanding.units;
        f.lastUnits = outstanding.units;
        f.lastSeconds = outstanding.seconds;
        if (outstanding.seconds > 0) {
          f.unassignedUnits = std::max(f.unassignedUnits - outstanding.units, 0.0);
          f.unassignedSeconds = std::max(f.unassignedSeconds - outstanding.seconds, 0.0);
        }
      }
      issue(f, *w, lastOutstanding, false, now, out);
      if (f.exhausted()) mayMove = true;
      return true;
    }
    if (w) { // a worker has room, but there is no job
      f.mayHaveJobs = false;
      mayMove = true;
    }
    if (reissue(f, g, now, out) || reissueLocally(f, g, now, out)) return true;
    if (!f.needsPinned && pinnedWorkers > 0 && g.pinned.empty() && f.firstLate() <= now)
      f.needsPinned = mayMove = true; // this is done once, for the local worker
  }
  return false;
}

} // namespace openrt::cluster

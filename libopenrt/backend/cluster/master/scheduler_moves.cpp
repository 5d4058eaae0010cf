// scheduler_moves.cpp: decides which worker prepares which scene. Workers form groups by the epoch
// that they have or prepare. They leave a group one at a time once its frame has no more jobs.
// Workers in the master's process are pinned to the oldest unfinished frame. If there are none, the
// last worker of a group stays until its frame is over, because lost jobs must be done by some
// worker.
#include <algorithm>
#include <utility>

#include "backend/cluster/master/scheduler_state.h"

namespace openrt::cluster {

void Scheduler::Impl::updateTotals(const Worker& w, int sign) {
  if (w.tally.blocked) return;
  if (w.pinned()) pinnedWorkers += uint32_t(sign);
  if (w.reserve) return;
  usable += uint32_t(sign);
  threads += uint32_t(sign) * w.threads;
  if (!w.unable) groups[w.epoch].threads += uint32_t(sign) * w.threads;
}

void Scheduler::Impl::leaveGroup(Worker& w) {
  const auto it = groups.find(w.epoch);
  if (it == groups.end() || it->second.members.erase(w.id) == 0) return;
  updateTotals(w, -1);
  Group& g = it->second;
  g.movable.erase(w.id);
  g.pinned.erase(w.id);
  g.byLoad.erase({w.loadKey, w.id});
  g.idle.erase({w.idleKey, w.id});
  w.loadKey = w.idleKey = never;
  if (g.able.erase(w.id) && g.able.empty()) rankPinned(w.epoch); // now the reserve works
  if (g.members.empty() && !frames.contains(w.epoch)) groups.erase(it);
  mayMove = true;
}

void Scheduler::Impl::joinGroup(Worker& w, Epoch epoch, bool ready) {
  leaveGroup(w);
  if (epoch != w.epoch) w.unable = false;
  w.epoch = epoch;
  w.ready = ready;
  Group& g = groups[epoch];
  g.members.insert(w.id);
  if (w.pinned())
    g.pinned.insert(w.id);
  else if (ready && !w.tally.blocked)
    g.movable.insert(w.id);
  if (!w.pinned() && ready && w.usable()) g.able.insert(w.id);
  updateTotals(w, 1);
  rank(w);
  mayMove = true;
}

void Scheduler::Impl::rank(Worker& w) {
  const auto it = groups.find(w.epoch);
  if (it == groups.end()) return;
  Group& g = it->second;
  g.byLoad.erase({w.loadKey, w.id});
  g.idle.erase({w.idleKey, w.id});
  w.loadKey = w.idleKey = never;
  const Frame* f = frame(w.epoch);
  if (!f || !w.ready || !w.usable()) return;
  const double share = w.tally.out / w.effectiveThreads(), usual = usualJobSeconds(*f);
  // Jobs that are on the link while a thread would be idle.
  const double hidden =
      usual > 0 ? std::min(std::round(w.tally.latency / usual), 3 * jobsPerBundle(*f)) : 0;
  w.loadKey = share - hidden;
  g.byLoad.insert({w.loadKey, w.id});
  if (share < 1) {
    w.idleKey = share;
    g.idle.insert({w.idleKey, w.id});
  }
}

void Scheduler::Impl::rankPinned(Epoch epoch) {
  if (const auto g = groups.find(epoch); g != groups.end())
    for (const WorkerId id : std::set<WorkerId>(g->second.pinned)) rank(workers.at(id));
}

bool Scheduler::Impl::mustWait(const Frame& f, const Group& g, const Worker& w) const {
  return w.reserve && !f.stuck && !g.able.empty();
}

Split Scheduler::Impl::splitOf() const {
  if (options.split == Split::frames) return Split::frames;
  const double inFlight = double(frames.size()), n = usable;
  if (options.split != Split::automatic || inFlight < 3 || n < 2 || prepare <= 0 ||
      frameSeconds <= 0)
    return Split::tiles;
  const double alone = frameSeconds * n / threads; // seconds of one worker per frame
  return (prepare + alone) / std::min(n, inFlight) < 0.9 * (prepare + alone / n) ? Split::frames
                                                                                 : Split::tiles;
}

bool Scheduler::Impl::worthHelping(const Frame& f) const {
  if (!f.work || f.exhausted()) return false;
  const auto g = groups.find(f.epoch);
  const double at = g == groups.end() ? 0 : g->second.threads;
  return at == 0 || f.work->undone() * f.costs.mean() / at > 2 * prepare;
}

// Returns the epoch to which a worker without jobs in `epoch` moves; 0: it stays.
Epoch Scheduler::Impl::nextEpoch(Epoch epoch) {
  Epoch help = 0;
  for (auto it = frames.upper_bound(epoch); it != frames.end(); ++it) {
    const Frame& f = it->second;
    if (f.exhausted()) continue;
    if (f.split != Split::frames) return f.epoch;
    const auto g = groups.find(f.epoch);
    if (g == groups.end() || g->second.members.size() == g->second.pinned.size()) return f.epoch;
    if (help == 0 && worthHelping(f)) help = f.epoch;
  }
  return help;
}

Epoch Scheduler::Impl::nextEpochOfPinned(const Worker& w) {
  if (frames.empty() || w.tally.blocked || !w.ready) return 0;
  const Frame& f = frames.begin()->second; // oldest frame
  if (f.epoch <= w.epoch) return 0;
  if (f.stuck) return f.epoch;
  uint32_t others = 0; // threads that can render it
  for (auto g = groups.begin(); g != groups.end() && g->first <= f.epoch; ++g)
    others += g->second.threads;
  if (others > 0 && w.here && !w.reserve) others -= w.unable ? 0 : w.threads;
  if (others == 0) return w.reserve && f.exhausted() && !f.needsPinned ? 0 : f.epoch;
  if (w.reserve) return 0;
  if (f.split != Split::frames || f.needsPinned) return f.epoch;
  const auto g = groups.find(f.epoch);
  return g == groups.end() || g->second.threads == 0 || worthHelping(f) ? f.epoch : 0;
}

double Scheduler::Impl::stuckAt() const {
  if (pinnedWorkers == 0 || frames.empty() || frames.begin()->second.stuck) return never;
  return frames.begin()->second.lastProgressAt + options.stuck;
}

// A frame after a stuck one is treated as stuck at once, as long as no remote result comes.
void Scheduler::Impl::checkProgress(double now) {
  if (frames.empty() || pinnedWorkers == 0) return;
  Frame& f = frames.begin()->second;
  if (std::exchange(checkedEpoch, f.epoch) != f.epoch)
    f.lastProgressAt = std::max(f.lastProgressAt, now);
  if (f.stuck || !(noRemoteResults || now >= f.lastProgressAt + options.stuck)) return;
  f.stuck = noRemoteResults = mayMove = true;
  rankPinned(f.epoch);
}

bool Scheduler::Impl::move(double now, WorkerId& worker, Epoch& epoch) {
  checkProgress(now);
  if (!mayMove) return false;
  const auto go = [&](WorkerId id, Epoch to) {
    Worker& w = workers.at(id);
    w.prepareSentAt = now;
    joinGroup(w, to, false);
    worker = id;
    epoch = to;
    return true;
  };
  for (const auto& [at, g] : groups) {
    for (const WorkerId id : g.pinned)
      if (const Epoch to = nextEpochOfPinned(workers.at(id))) return go(id, to);
    if (g.movable.empty()) continue;
    const Frame* f = frame(at);
    if (f && (!f->exhausted() || (pinnedWorkers == 0 && g.members.size() == 1))) continue;
    if (const Epoch to = nextEpoch(at)) return go(*g.movable.begin(), to);
  }
  mayMove = false;
  return false;
}

} // namespace openrt::cluster

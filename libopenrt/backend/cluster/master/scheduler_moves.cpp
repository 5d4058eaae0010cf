// scheduler_moves.cpp: which worker prepares which scene. Workers stand in groups, by the epoch
// that they have or prepare; a group moves on when its frame has nothing more to give, one worker
// at a time. Those in the master's process are tied to the oldest unfinished frame; without any of
// them the last one of a group stays until its frame is over: somebody must be able to do what is
// lost.
#include <algorithm>
#include <utility>

#include "backend/cluster/master/scheduler_state.h"

namespace openrt::cluster {

void Scheduler::Impl::weigh(const Worker& w, int sign) {
  if (w.tally.blocked) return;
  if (w.tied()) rescuers += uint32_t(sign);
  if (w.reserve) return;
  usable += uint32_t(sign);
  threads += uint32_t(sign) * w.threads;
  if (!w.unable) groups[w.epoch].threads += uint32_t(sign) * w.threads;
}

void Scheduler::Impl::depart(Worker& w) {
  const auto it = groups.find(w.epoch);
  if (it == groups.end() || it->second.members.erase(w.id) == 0) return;
  weigh(w, -1);
  Group& g = it->second;
  g.movable.erase(w.id);
  g.tied.erase(w.id);
  g.room.erase({w.roomKey, w.id});
  g.idle.erase({w.idleKey, w.id});
  w.roomKey = w.idleKey = never;
  if (g.able.erase(w.id) && g.able.empty()) sortTied(w.epoch); // a reserve has its turn
  if (g.members.empty() && !frames.contains(w.epoch)) groups.erase(it);
  moves = true;
}

void Scheduler::Impl::enter(Worker& w, Epoch epoch, bool ready) {
  depart(w);
  if (epoch != w.epoch) w.unable = false;
  w.epoch = epoch;
  w.ready = ready;
  Group& g = groups[epoch];
  g.members.insert(w.id);
  if (w.tied())
    g.tied.insert(w.id);
  else if (ready && !w.tally.blocked)
    g.movable.insert(w.id);
  if (!w.tied() && ready && w.usable()) g.able.insert(w.id);
  weigh(w, 1);
  sort(w);
  moves = true;
}

void Scheduler::Impl::sort(Worker& w) {
  const auto it = groups.find(w.epoch);
  if (it == groups.end()) return;
  Group& g = it->second;
  g.room.erase({w.roomKey, w.id});
  g.idle.erase({w.idleKey, w.id});
  w.roomKey = w.idleKey = never;
  const Frame* f = frame(w.epoch);
  if (!f || !w.ready || !w.usable()) return;
  const double share = w.tally.out / w.hands(), usual = secondsOf(*f);
  // What is on its way while a thread would wait for it.
  const double hidden =
      usual > 0 ? std::min(std::round(w.tally.latency / usual), 3 * bundle(*f)) : 0;
  w.roomKey = share - hidden;
  g.room.insert({w.roomKey, w.id});
  if (share < 1) {
    w.idleKey = share;
    g.idle.insert({w.idleKey, w.id});
  }
}

void Scheduler::Impl::sortTied(Epoch epoch) {
  if (const auto g = groups.find(epoch); g != groups.end())
    for (const WorkerId id : std::set<WorkerId>(g->second.tied)) sort(workers.at(id));
}

bool Scheduler::Impl::waits(const Frame& f, const Group& g, const Worker& w) const {
  return w.reserve && !f.stuck && !g.able.empty();
}

Split Scheduler::Impl::splitOf() const {
  if (options.split == Split::frames) return Split::frames;
  const double inFlight = double(frames.size()), n = usable;
  if (options.split != Split::automatic || inFlight < 3 || n < 2 || prepare <= 0 ||
      frameSeconds <= 0)
    return Split::tiles;
  const double alone = frameSeconds * n / threads; // of one worker for a frame
  return (prepare + alone) / std::min(n, inFlight) < 0.9 * (prepare + alone / n) ? Split::frames
                                                                                 : Split::tiles;
}

bool Scheduler::Impl::worthHelping(const Frame& f) const {
  if (!f.work || f.exhausted()) return false;
  const auto g = groups.find(f.epoch);
  const double at = g == groups.end() ? 0 : g->second.threads;
  return at == 0 || f.work->undone() * f.costs.mean() / at > 2 * prepare;
}

// Of a worker that has nothing more to do in an epoch; 0: it stays.
Epoch Scheduler::Impl::target(Epoch epoch) {
  Epoch help = 0;
  for (auto it = frames.upper_bound(epoch); it != frames.end(); ++it) {
    const Frame& f = it->second;
    if (f.exhausted()) continue;
    if (f.split != Split::frames) return f.epoch;
    const auto g = groups.find(f.epoch);
    if (g == groups.end() || g->second.members.size() == g->second.tied.size()) return f.epoch;
    if (help == 0 && worthHelping(f)) help = f.epoch;
  }
  return help;
}

Epoch Scheduler::Impl::targetOfTied(const Worker& w) {
  if (frames.empty() || w.tally.blocked || !w.ready) return 0;
  const Frame& f = frames.begin()->second; // the oldest one
  if (f.epoch <= w.epoch) return 0;
  if (f.stuck) return f.epoch;
  uint32_t others = 0; // that can do it
  for (auto g = groups.begin(); g != groups.end() && g->first <= f.epoch; ++g)
    others += g->second.threads;
  if (others > 0 && w.here && !w.reserve) others -= w.unable ? 0 : w.threads;
  if (others == 0) return w.reserve && f.exhausted() && !f.rescue ? 0 : f.epoch;
  if (w.reserve) return 0;
  if (f.split != Split::frames || f.rescue) return f.epoch;
  const auto g = groups.find(f.epoch);
  return g == groups.end() || g->second.threads == 0 || worthHelping(f) ? f.epoch : 0;
}

double Scheduler::Impl::stuckAt() const {
  if (rescuers == 0 || frames.empty() || frames.begin()->second.stuck) return never;
  return frames.begin()->second.progressed + options.stuck;
}

// A picture after one that was stuck does not wait again, as long as nothing comes from elsewhere.
void Scheduler::Impl::watch(double now) {
  if (frames.empty() || rescuers == 0) return;
  Frame& f = frames.begin()->second;
  if (std::exchange(watched, f.epoch) != f.epoch) f.progressed = std::max(f.progressed, now);
  if (f.stuck || !(helpless || now >= f.progressed + options.stuck)) return;
  f.stuck = helpless = moves = true;
  sortTied(f.epoch);
}

bool Scheduler::Impl::move(double now, WorkerId& worker, Epoch& epoch) {
  watch(now);
  if (!moves) return false;
  const auto go = [&](WorkerId id, Epoch to) {
    Worker& w = workers.at(id);
    w.asked = now;
    enter(w, to, false);
    worker = id;
    epoch = to;
    return true;
  };
  for (const auto& [at, g] : groups) {
    for (const WorkerId id : g.tied)
      if (const Epoch to = targetOfTied(workers.at(id))) return go(id, to);
    if (g.movable.empty()) continue;
    const Frame* f = frame(at);
    if (f && (!f->exhausted() || (rescuers == 0 && g.members.size() == 1))) continue;
    if (const Epoch to = target(at)) return go(*g.movable.begin(), to);
  }
  moves = false;
  return false;
}

} // namespace openrt::cluster

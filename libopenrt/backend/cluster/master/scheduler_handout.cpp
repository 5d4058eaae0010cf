// scheduler_handout.cpp: which job goes to whom, how large it is, and when it is late. Jobs are
// large as long as much is left and small towards the end (factoring: S. Hummel, E. Schonberg, L.
// Flynn, "Factoring: a method for scheduling parallel loops", CACM 35(8), 1992); late ones are
// given to idle threads as well, as in J. Dean, S. Ghemawat, "MapReduce", OSDI 2004, 3.6.
#include <algorithm>
#include <bit>
#include <cmath>

#include "backend/cluster/master/scheduler_state.h"

namespace openrt::cluster {

namespace {
constexpr uint32_t fewest = 32;    // samples: a tile's are not divided further (frame_work.h)
constexpr double mostInFlight = 4; // jobs for a thread, or bundles of them
constexpr double largestBundle = 64;
constexpr double spare =
    1.75; // of the master's time for a job: it is busy for at most so many times less
constexpr double turnaround =
    8e-3; // for which a worker has something to do when it has told of a job, but for its link
constexpr double leastWaiting = 0.25; // jobs for a thread behind that which it does
constexpr double mixedUntil = 0.7;    // of a frame's work
constexpr double unequal = 32;        // of so many tiles one may cost as much as all
constexpr double parts = 4;           // of what is left for a thread, a job is one of so many
} // namespace

void Scheduler::Impl::plan(Frame& f) {
  const uint32_t tiles = f.work->tiles();
  if (std::find(f.places.begin(), f.places.end(), 0.0f) != f.places.end()) return;
  std::vector<uint32_t> order(tiles);
  std::vector<float> cost(tiles);
  for (uint32_t i = 0; i < tiles; i++) {
    const float pixels = float(f.work->pixels(i));
    order[i] = i;
    cost[i] = f.places[i] * pixels;
    f.aheadUnits += pixels;
    f.aheadSeconds += cost[i];
  }
  const double samples = f.work->undone() / std::max(f.aheadUnits, 1.0);
  f.aheadUnits *= samples;
  f.aheadSeconds *= samples;
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return cost[a] > cost[b]; });
  // Those that take less time than a job should are no use at the end, where the master would be
  // asked for too many of them.
  const double least = std::max(options.shortest, spare * pace * threads) / samples;
  const auto cheap =
      std::find_if(order.begin(), order.end(), [&](uint32_t tile) { return cost[tile] < least; });
  const size_t dear = size_t(cheap - order.begin());
  std::vector<uint32_t> mixed;
  mixed.reserve(tiles);
  size_t next = dear;
  double given = 0;
  for (size_t i = 0; i < dear; i++) {
    mixed.push_back(order[i]);
    given += cost[order[i]] * samples;
    const double share = std::min(given / (mixedUntil * f.aheadSeconds), 1.0);
    while (double(next - dear) < share * double(tiles - dear)) mixed.push_back(order[next++]);
  }
  mixed.insert(mixed.end(), order.begin() + ptrdiff_t(next), order.end());
  f.work->order(std::move(mixed));
}

double Scheduler::Impl::secondsOf(const Frame& f) const {
  if (f.lastSeconds > 0) return f.lastSeconds;
  const double units =
      f.lastUnits > 0 ? f.lastUnits : f.tilePixels * std::min(f.perPixel, double(fewest));
  return f.costs.mean() * units;
}

double Scheduler::Impl::bundle(const Frame& f) const {
  const double usual = secondsOf(f);
  return usual > 0 ? std::clamp(std::floor(options.shortest / usual), 1.0, largestBundle) : 1;
}

double Scheduler::Impl::threadsFor(Epoch epoch) const {
  const auto own = groups.find(epoch);
  const Frame& f = frames.at(epoch);
  uint32_t all = own == groups.end() ? 0 : own->second.threads;
  if (f.split != Split::frames) // those of earlier epochs are still to come
    for (auto g = groups.begin(); g != groups.end() && g->first < epoch; ++g)
      all += g->second.threads;
  return std::max(all, 1u);
}

double Scheduler::Impl::level(const Frame& f) const {
  const double together = bundle(f);
  const double left =
      (f.lastSeconds > 0
           ? f.left() / f.lastSeconds
           : f.work->undone() / (f.lastUnits > 0 ? f.lastUnits : f.tilePixels * f.perPixel)) /
      threadsFor(f.epoch); // jobs for a thread
  double most = std::clamp(options.inFlight, 1u, uint32_t(mostInFlight));
  if (f.lastSeconds > 0)
    most = std::min(most,
                    1 + std::max(leastWaiting, turnaround / f.lastSeconds)); // others begin sooner
  return std::clamp(std::ceil(left / together), 1.0, most) * together;
}

uint32_t Scheduler::Impl::largest(const Frame& f, const Worker& w) const {
  if (f.wholeTiles || f.perPixel <= fewest) return ~0u;
  double samples = fewest;
  if (f.spread) {
    samples = f.perPixel / std::max(usable, 1u);
  } else if (f.costs.known()) {
    const double left = f.left() / threadsFor(f.epoch);
    // A slow link is worth larger jobs: no more of them are in flight.
    const double least = std::max({options.shortest, w.tally.latency / (mostInFlight - 1),
                                   spare * pace * threadsFor(f.epoch)});
    const double seconds = std::clamp(left / parts, least, std::max(options.longest, least));
    const double place = f.place(f.work->upcoming());
    if (place > 0)
      samples = seconds / place / f.tilePixels;
    else // nobody knows what the next tile costs: one of the dear ones must not take longer than
         // half of what is left, nor much longer than the frame if all of its work lies in a few of
         // the tiles
      samples = std::min({seconds / f.costs.mean() / f.tilePixels,
                          std::max(left / 2, least) / f.costs.dear() / f.tilePixels,
                          f.perPixel * f.work->tiles() / (unequal * threadsFor(f.epoch))});
  }
  if (samples >= f.perPixel) return ~0u;
  return std::bit_floor(std::max(uint32_t(samples), fewest));
}

Worker* Scheduler::Impl::roomiest(const Frame& f, Group& g) {
  const double most = level(f), cap = mostInFlight * bundle(f);
  while (!g.room.empty()) {
    const auto [key, id] = *g.room.begin();
    if (key >= most) return nullptr;
    Worker& w = workers.at(id);
    if (w.tally.out < w.hands() * cap && !waits(f, g, w)) return &w;
    g.room.erase(g.room.begin()); // until something happens to it
    w.roomKey = never;
  }
  return nullptr;
}

void Scheduler::Impl::hand(Frame& f, Worker& w, uint64_t id, bool again, double now, Handout& out) {
  Flight& flight = f.flights.at(id);
  const Lease lease = ++lastLease;
  flight.since = now;
  flight.turns = 1 + std::floor(w.tally.out / double(w.threads));
  flight.link = w.tally.latency;
  flight.holders.insert(lease);
  f.leases[lease] = {w.id, id, now, again, w.tally.out < w.threads};
  w.leases.insert({f.epoch, lease});
  w.tally.out = uint32_t(w.leases.size());
  rekey(f, id, flight);
  sort(w);
  out = {w.id, f.epoch, {lease, flight.job}, again};
}

double Scheduler::Impl::span(Frame& f, const Flight& flight) {
  const double median = f.costsOf(flight.job).median();
  if (median <= 0) return options.stuck;
  const double usual = flight.seconds > 0 ? flight.seconds : median * flight.units;
  return std::max(options.patience * (usual * flight.turns + flight.link), options.soonest);
}

void Scheduler::Impl::rekey(Frame& f, uint64_t id, Flight& flight) {
  unschedule(f, id, flight);
  flight.deadline = flight.since + span(f, flight);
  if (flight.deadline < never)
    (flight.again < options.mostAgain ? f.deadlines : f.spent).insert({flight.deadline, id});
}

bool Scheduler::Impl::reissue(Frame& f, Group& g, double now, Handout& out) {
  while (!g.idle.empty() && !f.deadlines.empty()) {
    const auto [deadline, id] = *f.deadlines.begin();
    if (deadline > now) return false;
    Flight& flight = f.flights.at(id);
    rekey(f, id, flight);
    if (flight.deadline > now) continue;
    const auto has = [&](WorkerId w) {
      return std::any_of(flight.holders.begin(), flight.holders.end(),
                         [&](Lease l) { return f.leases.at(l).worker == w; });
    };
    const auto idle = std::find_if(
        g.idle.begin(), g.idle.end(), [&](const auto& entry) { // at most four are passed over
          return !has(entry.second) && !waits(f, g, workers.at(entry.second));
        });
    if (idle == g.idle.end()) return false;
    for (const Lease l : flight.holders) // one that has not even been heard of since gets less
      if (Worker& w = workers.at(f.leases.at(l).worker); w.heard < flight.since) {
        w.slips = std::min(w.slips + 1, 8u);
        sort(w);
      }
    flight.again++;
    reissued++;
    hand(f, workers.at(idle->second), id, true, now, out);
    return true;
  }
  return false;
}

// Gives the worker here, which cannot be lost, a job that many workers have had and none has
// answered; in a frame that is stuck any job that others have, however long they were expected to
// take.
bool Scheduler::Impl::reissueHere(Frame& f, Group& g, double now, Handout& out) {
  for (const WorkerId id : g.tied) {
    Worker& w = workers.at(id);
    if (w.idleKey == never || waits(f, g, w)) continue;
    const auto takes = [&](const auto& late) {
      const auto& holders = f.flights.at(late.second).holders;
      return (f.stuck || late.first <= now) &&
             std::none_of(holders.begin(), holders.end(),
                          [&](Lease l) { return f.leases.at(l).worker == id; });
    };
    auto found = std::find_if(f.spent.begin(), f.spent.end(), takes);
    if (found == f.spent.end()) {
      if (!f.stuck) continue;
      found = std::find_if(f.deadlines.begin(), f.deadlines.end(), takes);
      if (found == f.deadlines.end()) continue;
    }
    const uint64_t flight = found->second; // hand() changes the set
    reissued++;
    hand(f, w, flight, true, now, out);
    return true;
  }
  return false;
}

bool Scheduler::Impl::next(double now, Handout& out) {
  for (auto& [epoch, f] : frames) {
    const auto it = groups.find(epoch);
    if (!f.work || it == groups.end()) continue;
    Group& g = it->second;
    Worker* w = f.maybe ? roomiest(f, g) : nullptr;
    Job job;
    if (w && f.work->next(job, largest(f, *w)) == FrameWork::Next::job) {
      Flight& flight = f.flights[++lastFlight];
      flight.job = job;
      const bool ofLight = job.kind == Job::Kind::light;
      flight.units = std::max(1.0, double(job.count) * (ofLight ? 1 : f.work->pixels(job.number)));
      if (!ofLight) {
        flight.seconds = f.place(job.number) * flight.units;
        f.lastUnits = flight.units;
        f.lastSeconds = flight.seconds;
        if (flight.seconds > 0) {
          f.aheadUnits = std::max(f.aheadUnits - flight.units, 0.0);
          f.aheadSeconds = std::max(f.aheadSeconds - flight.seconds, 0.0);
        }
      }
      hand(f, *w, lastFlight, false, now, out);
      if (f.exhausted()) moves = true;
      return true;
    }
    if (w) { // there is a place, but no job
      f.maybe = false;
      moves = true;
    }
    if (reissue(f, g, now, out) || reissueHere(f, g, now, out)) return true;
    if (!f.rescue && rescuers > 0 && g.tied.empty() && f.firstLate() <= now)
      f.rescue = moves = true; // once, by who is here
  }
  return false;
}

} // namespace openrt::cluster

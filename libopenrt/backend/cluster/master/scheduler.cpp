// scheduler.cpp: Leases: who has which job, and what becomes of it when that
// worker is done, fails or is lost.
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

void Scheduler::Impl::unschedule(Frame& f, uint64_t id, const Flight& flight) {
  f.deadlines.erase({flight.deadline, id});
  f.spent.erase({flight.deadline, id});
}

void Scheduler::Impl::forget(Frame& f, Lease lease, bool lost) {
  const auto it = f.leases.find(lease);
  const Held held = it->second;
  f.leases.erase(it);
  if (Worker* w = worker(held.worker)) {
    w->leases.erase({f.epoch, lease});
    w->tally.out = uint32_t(w->leases.size());
    if (lost && held.flight) w->tally.lost++;
  }
  const auto flight = f.flights.find(held.flight);
  if (flight == f.flights.end()) return;
  flight->second.holders.erase(lease);
  if (!flight->second.holders.empty()) return;
  f.work->giveBack(flight->second.job);
  if (flight->second.seconds > 0) {
    f.aheadUnits += flight->second.units;
    f.aheadSeconds += flight->second.seconds;
  }
  f.maybe = true;
  unschedule(f, held.flight, flight->second);
  f.flights.erase(flight);
}

void Scheduler::Impl::forgetAll(Worker& w, Epoch until) {
  while (!w.leases.empty() && w.leases.begin()->first < until)
    forget(frames.at(w.leases.begin()->first), w.leases.begin()->second, true);
  moves = true;
}

void Scheduler::Impl::leave(Worker& w) {
  forgetAll(w, ~Epoch(0));
  depart(w);
  reserves -= w.reserve;
  workers.erase(w.id);
}

void Scheduler::Impl::strike(Worker& w) {
  if (w.tally.blocked || ++w.tally.failed < options.mostFailed) return;
  weigh(w, -1);
  w.tally.blocked = true;
  forgetAll(w, ~Epoch(0));
}

void Scheduler::Impl::end(Frame& f) {
  if (f.costs.jobs() > 0) costs = f.costs;
  if (f.light.jobs() > 0) light = f.light;
  places = std::move(f.places);
  if (f.costs.jobs() > 0) frameSeconds = f.costs.seconds() + f.light.seconds();
  for (const auto& [lease, held] : f.leases) {
    Worker* w = worker(held.worker);
    w->leases.erase({f.epoch, lease});
    w->tally.out = uint32_t(w->leases.size());
    sort(*w);
  }
  const Epoch epoch = f.epoch;
  frames.erase(epoch);
  if (const auto g = groups.find(epoch); g != groups.end() && g->second.members.empty())
    groups.erase(g);
  moves = true;
}

bool Scheduler::Impl::done(Frame& f, Lease lease, double seconds, double now) {
  const auto it = f.leases.find(lease);
  const Held held = it->second;
  f.leases.erase(it);
  Worker& w = *worker(held.worker);
  w.leases.erase({f.epoch, lease});
  w.tally.out = uint32_t(w.leases.size());
  if (now > held.since)
    seconds = std::min(seconds, now - held.since); // who says more has not told the truth
  w.tally.busy += std::max(seconds, 0.0);
  w.heard = now;
  if (w.slips > 0) w.slips--;
  const double beyond = std::max(now - held.since - seconds, 0.0);
  if (w.tally.jobs + w.tally.late == 0 || (held.direct && beyond < w.tally.latency))
    w.tally.latency = beyond; // what waits in queues only makes it longer
  else if (held.direct)
    w.tally.latency += (beyond - w.tally.latency) / 8;
  else
    w.tally.latency = std::min(w.tally.latency, beyond);
  if (!held.flight) {
    w.tally.late++;
    duplicates++;
    sort(w);
    return false;
  }
  f.progressed = now; // what was done before, or is of no use, is no progress
  if (!w.tied()) helpless = false;
  const auto flight = f.flights.find(held.flight);
  const Job& job = flight->second.job;
  f.costsOf(job).add(flight->second.units, seconds);
  if (job.kind == Job::Kind::samples && job.number < f.places.size() && seconds > 0)
    f.places[job.number] =
        float(std::min(seconds, 1e6) / flight->second.units); // finite, whatever a worker says
  for (const Lease other : flight->second.holders)
    if (other != lease) f.leases.at(other).flight = 0;
  unschedule(f, held.flight, flight->second);
  f.flights.erase(flight);
  w.tally.jobs++;
  if (held.again) w.tally.again++;
  f.maybe = true; // what waited for this one
  if (f.split == Split::frames) moves = true;
  sort(w);
  if (f.costs.jobs() + f.light.jobs() >= f.rekeyAt) {
    f.rekeyAt *= 2;
    for (auto& [id, other] : f.flights) rekey(f, id, other);
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
  w.heard = now;
  impl_->reserves += w.reserve;
  impl_->enter(w, 0, true);
}

void Scheduler::leave(WorkerId worker, double) {
  if (Worker* w = impl_->worker(worker)) impl_->leave(*w);
}

void Scheduler::announce(Epoch epoch, double now) {
  Impl& s = *impl_;
  if (s.frames.contains(epoch)) return;
  Frame& f = s.frames[epoch];
  f.epoch = epoch;
  f.progressed = now;
  f.split = s.splitOf();
  f.wholeTiles = s.options.split == Split::tiles;
  f.spread = s.options.split == Split::samples;
  f.costs = s.costs.ofNextFrame();
  f.light = s.light.ofNextFrame();
  s.moves = true;
  if (const auto g = s.groups.find(epoch); g != s.groups.end()) // who has its scene already
    for (const WorkerId id : g->second.members) s.sort(s.workers.at(id));
}

void Scheduler::frame(Epoch epoch, std::shared_ptr<JobSource> work, double now) {
  announce(epoch, now);
  Frame& f = impl_->frames.at(epoch);
  f.work = std::move(work);
  f.maybe = true;
  f.progressed = now;
  f.tilePixels = f.work->tiles() > 0 ? std::max(f.work->pixels(0), 1u) : 1;
  f.perPixel =
      std::max(f.work->undone() / (double(f.tilePixels) * std::max(f.work->tiles(), 1u)), 1.0);
  if (impl_->places.size() == f.work->tiles()) f.places = impl_->places; // costs lie where they lay
  f.places.resize(f.work->tiles());
  impl_->plan(f);
  impl_->moves = true;
}

void Scheduler::changed(Epoch epoch) {
  if (Frame* f = impl_->frame(epoch)) f->maybe = f->work != nullptr;
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
    const double took = std::max(now - std::max(w->asked, w->heard), 0.0);
    impl_->prepare += (took - impl_->prepare) / (impl_->prepare > 0 ? 8 : 1);
  }
  impl_->forgetAll(*w, epoch);
  impl_->enter(*w, epoch, true);
}

void Scheduler::unable(WorkerId worker, Epoch epoch, double) {
  Worker* w = impl_->worker(worker);
  if (!w) return;
  if (w->epoch == epoch && !w->unable) {
    impl_->weigh(*w, -1);
    w->unable = true;
    w->ready = true; // for the next one
    impl_->weigh(*w, 1);
  }
  impl_->forgetAll(*w, epoch + 1);
  impl_->strike(*w);
  impl_->enter(*w, w->epoch, w->ready);
}

bool Scheduler::next(double now, Handout& out) { return impl_->next(now, out); }

bool Scheduler::done(WorkerId worker, Epoch epoch, Lease lease, double seconds, double now) {
  Frame* f = impl_->frame(epoch);
  if (!f) return false;
  const auto held = f->leases.find(lease);
  return held != f->leases.end() && held->second.worker == worker &&
         impl_->done(*f, lease, seconds, now);
}

void Scheduler::failed(WorkerId worker, Epoch epoch, Lease lease, double) {
  Frame* f = impl_->frame(epoch);
  if (!f) return;
  const auto held = f->leases.find(lease);
  if (held == f->leases.end() || held->second.worker != worker) return;
  impl_->forget(*f, lease, false);
  Worker& w = *impl_->worker(worker);
  impl_->strike(w);
  impl_->enter(w, w.epoch, w.ready);
}

const Job* Scheduler::find(WorkerId worker, Epoch epoch, Lease lease) const {
  const Frame* f = impl_->frame(epoch);
  if (!f) return nullptr;
  const auto held = f->leases.find(lease);
  if (held == f->leases.end() || held->second.worker != worker || !held->second.flight)
    return nullptr;
  return &f->flights.at(held->second.flight).job;
}

uint32_t Scheduler::able(Epoch epoch) const {
  uint32_t count = 0;
  for (const auto& [id, w] : impl_->workers)
    count += !w.tally.blocked && (w.epoch < epoch || (w.epoch == epoch && !w.unable));
  return count;
}

void Scheduler::pace(double secondsOfJob) { impl_->pace = std::clamp(secondsOfJob, 0.0, 1e-4); }

double Scheduler::wake(double now) const {
  constexpr double breath =
      0.005; // a late job that nobody can take yet is looked at again after this
  double when = impl_->stuckAt();
  for (const auto& [epoch, f] : impl_->frames) {
    const auto g = impl_->groups.find(epoch);
    if (g == impl_->groups.end()) continue;
    const bool rescue = !f.rescue && impl_->rescuers > 0 && g->second.tied.empty();
    const auto& tied = g->second.tied;
    const bool here = std::any_of(tied.begin(), tied.end(), [&](WorkerId id) {
      return impl_->workers.at(id).idleKey < never;
    });
    if (!f.deadlines.empty() && (rescue || !g->second.idle.empty()))
      when = std::min(when, std::max(f.deadlines.begin()->first, now + breath));
    if (!f.spent.empty() && (rescue || here))
      when = std::min(when, std::max(f.spent.begin()->first, now + breath));
  }
  return when;
}

bool Scheduler::usable(WorkerId worker, Epoch epoch) const {
  const Worker* w = impl_->worker(worker);
  return w && !w->tally.blocked && !(w->unable && w->epoch == epoch);
}

double Scheduler::progressed(Epoch epoch) const {
  const Frame* f = impl_->frame(epoch);
  return f ? f->progressed : 0;
}

bool Scheduler::stuck(Epoch epoch) const {
  const Frame* f = impl_->frame(epoch);
  return f && f->stuck;
}

double Scheduler::lateAfter(Epoch epoch) const {
  Frame* f = impl_->frame(epoch);
  if (!f || f->costs.median() <= 0) return never;
  Flight usual;
  usual.units = f->lastUnits > 0 ? f->lastUnits : f->tilePixels * f->perPixel;
  return impl_->span(*f, usual);
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

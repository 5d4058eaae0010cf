// cluster_scheduler_random.cpp: Tests the scheduler with random event sequences. Each sample of
// each frame is merged exactly once, every frame ends, no worker has more jobs than allowed, and no
// lease is left over. rapidcheck generates the events as a list of numbers and shrinks it when a
// rule breaks.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <set>

#include "unit/cluster_fake_work.h"

using namespace openrt;
using namespace openrt::cluster;

namespace {

// One run: workers join and leave; results come late, twice, never or broken.
struct RandomRun {
  explicit RandomRun(Split split) : b({.split = split, .shortest = 0}) {}
  struct Machine {
    uint32_t threads;
    Epoch preparing = 0, ready = 0;
  };
  Bench b;
  std::map<WorkerId, Machine> machines;
  std::map<Lease, Handout> out; // held by a worker, as far as the worker knows
  std::vector<Handout> past;
  WorkerId lastWorker = 0;
  Epoch lastEpoch = 0;
  std::set<Lease> seen;
  bool aMasterHere = false;

  void join(uint32_t threads, bool here) {
    machines[++lastWorker] = {threads};
    b.s.join(lastWorker, threads, here && !aMasterHere, b.now);
    aMasterHere |= here;
  }
  void leave(WorkerId w) {
    b.s.leave(w, b.now);
    machines.erase(w);
    std::erase_if(out, [&](const auto& entry) { // some of its results still arrive
      if (entry.second.worker == w) past.push_back(entry.second);
      return entry.second.worker == w;
    });
  }
  void begin() {
    if (b.work.size() >= 5) return;
    lastEpoch++;
    b.frame(lastEpoch, 1 + lastEpoch % 3 * 4, 16, lastEpoch % 2 ? 8 : 160);
  }
  void end(Epoch epoch) {
    b.s.end(epoch);
    b.work.erase(epoch);
  }
  void deliver(const Handout& h, double seconds) {
    const bool live = b.work.contains(h.epoch);
    const bool first =
        live ? b.done(h, seconds) : b.s.done(h.worker, h.epoch, h.job.lease, seconds, b.now);
    RC_ASSERT(live || !first);
    past.push_back(h);
    out.erase(h.job.lease);
    if (first && b.work.at(h.epoch)->over()) end(h.epoch);
  }
  void settle() {
    WorkerId w;
    Epoch e;
    while (b.s.move(b.now, w, e)) {
      Machine& m = machines.at(w);
      RC_ASSERT(e > m.ready && e > m.preparing && b.work.contains(e) && !b.s.tally(w).blocked);
      m.preparing = e;
    }
    Handout h;
    while (b.s.next(b.now, h)) {
      RC_ASSERT(machines.contains(h.worker));
      const Machine& m = machines.at(h.worker);
      RC_ASSERT(m.ready == h.epoch && m.preparing <= m.ready && !b.s.tally(h.worker).blocked);
      RC_ASSERT(seen.insert(h.job.lease).second);
      RC_ASSERT(b.s.tally(h.worker).out <= 4 * m.threads);
      for (const auto& [lease, other] : out)
        RC_ASSERT(
            !(other.worker == h.worker && other.epoch == h.epoch && other.job.job == h.job.job));
      out[h.job.lease] = h;
    }
    for (const auto& [id, m] : machines) {
      uint32_t count = 0;
      for (const auto& [lease, other] : out)
        count += other.worker == id && b.work.contains(other.epoch) && other.epoch >= m.ready;
      RC_ASSERT(b.s.tally(id).out <= count);
    }
  }
  void prepared(WorkerId w) {
    Machine& m = machines.at(w);
    if (m.preparing <= m.ready) return;
    m.ready = m.preparing;
    b.s.ready(w, m.ready, b.now);
  }
  template <class Map> auto pick(Map& map, uint32_t which) {
    return std::next(map.begin(), ptrdiff_t(which % map.size()));
  }

  void step(uint32_t number) {
    const uint32_t what = number % 20, which = number / 20 % 1000;
    const double amount = double(number / 20000 % 1000) / 1000;
    if (what == 0) join(1 + which % 4, which % 5 == 0);
    if (what == 1 && !machines.empty()) leave(pick(machines, which)->first);
    if (what == 2) begin();
    if (what >= 3 && what <= 5 && !machines.empty()) prepared(pick(machines, which)->first);
    if (what >= 6 && what <= 12 && !out.empty()) deliver(Handout(pick(out, which)->second), amount);
    if (what == 13 && !past.empty()) { // a repeated result, or one of a lost lease
      const Handout h = past[which % past.size()];
      const bool again = b.s.done(h.worker, h.epoch, h.job.lease, amount, b.now);
      RC_ASSERT(!again);
    }
    if (what == 14) RC_ASSERT(!b.s.done(which, which % 7, 1000000 + number, amount, b.now));
    if (what == 15) b.now += amount;
    if (what == 16) b.now += 100 * amount;
    if (what == 17 && !out.empty()) {
      const Handout h = pick(out, which)->second;
      b.s.failed(h.worker, h.epoch, h.job.lease, b.now);
      past.push_back(h);
      out.erase(h.job.lease);
    }
    if (what == 18 && !machines.empty() && which % 3 == 0) {
      const auto m = pick(machines, which);
      if (m->second.preparing > m->second.ready) b.s.unable(m->first, m->second.preparing, b.now);
    }
    if (what == 19 && which % 10 == 0 && !b.work.empty()) end(b.work.begin()->first); // cancelled
    settle();
  }

  void finish() {
    begin();
    aMasterHere = false;
    join(2, true); // a worker that does all its jobs
    for (int i = 0; i < 20000 && !b.work.empty(); i++) {
      settle();
      b.now += 0.01;
      for (const auto& [id, m] : std::map(machines)) prepared(id);
      if (!out.empty()) deliver(Handout(out.begin()->second), 0.01);
    }
    RC_ASSERT(b.work.empty()); // every frame has ended, and take() has counted every sample
    for (const auto& [id, m] : machines) RC_ASSERT(b.s.tally(id).out == 0);
  }

  // The other workers stop doing anything; only the worker in this process continues. No frame may
  // wait longer than the rule says.
  void finishAlone(bool reserve) {
    begin();
    const WorkerId here = ++lastWorker;
    machines[here] = {2};
    b.s.join(here, 2, true, b.now, reserve);
    constexpr double step = 0.01, promised = 10, soon = 1;
    double progressed = b.now;
    for (int i = 0; i < 20000 && !b.work.empty(); i++) {
      settle();
      b.now += step;
      prepared(here);
      const auto mine = std::find_if(out.begin(), out.end(),
                                     [&](const auto& o) { return o.second.worker == here; });
      if (mine != out.end()) {
        deliver(Handout(mine->second), step);
        progressed = b.now;
      }
      RC_ASSERT(b.now < progressed + promised + soon);
    }
    RC_ASSERT(b.work.empty());
  }
};

enum class End { all, here, reserve };

void run(Split split, End end, const std::vector<uint32_t>& numbers) {
  RandomRun t(split);
  t.aMasterHere = end != End::all;
  for (const uint32_t n : numbers) t.step(n);
  if (end == End::all)
    t.finish();
  else
    t.finishAlone(end == End::reserve);
}

void check(Split split, End end = End::all) {
  const bool held = rc::check([=] {
    const auto length = *rc::gen::inRange<size_t>(0, 400);
    run(split, end,
        *rc::gen::container<std::vector<uint32_t>>(length,
                                                   rc::gen::inRange<uint32_t>(0, 20000000)));
  });
  EXPECT_TRUE(held);
}

} // namespace

TEST(SchedulerRandom, automatic) { check(Split::automatic); }
TEST(SchedulerRandom, tiles) { check(Split::tiles); }
TEST(SchedulerRandom, samples) { check(Split::samples); }
TEST(SchedulerRandom, frames) { check(Split::frames); }

TEST(SchedulerRandom, onlyTheOneHereWorks) {
  for (const Split split : {Split::automatic, Split::samples, Split::frames})
    check(split, End::here);
}
TEST(SchedulerRandom, onlyTheReserveWorks) {
  for (const Split split : {Split::automatic, Split::samples, Split::frames})
    check(split, End::reserve);
}

TEST(SchedulerRandom, theSameCallsTheSameAnswers) {
  const auto answers = [] {
    RandomRun t(Split::automatic);
    uint32_t x = 12345;
    for (int i = 0; i < 3000; i++) t.step((x = x * 1664525 + 1013904223) >> 4);
    std::vector<std::pair<WorkerId, Lease>> all;
    for (const Handout& h : t.past) all.push_back({h.worker, h.job.lease});
    return all;
  };
  EXPECT_EQ(answers(), answers());
}

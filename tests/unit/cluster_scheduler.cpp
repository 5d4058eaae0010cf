// cluster_scheduler.cpp: one test for each rule of scheduler.h. Time is a number; no test waits.
// Longer than 500 lines because the tests share one rig.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "unit/cluster_fake_work.h"

using namespace openrt;
using namespace openrt::cluster;

namespace {

std::map<WorkerId, uint32_t> byWorker(const std::vector<Handout>& all) {
  std::map<WorkerId, uint32_t> counts;
  for (const Handout& h : all) counts[h.worker]++;
  return counts;
}

} // namespace

TEST(Scheduler, threeJobsForEachThreadAreInFlight) {
  Bench b;
  b.frame(1, 1000);
  b.workers(1, 2, 4);
  EXPECT_EQ(byWorker(b.handOut()), (std::map<WorkerId, uint32_t>{{1, 12}, {2, 12}}));
  EXPECT_TRUE(b.handOut().empty());
  EXPECT_TRUE(b.done(b.out[0]));
  const auto more = b.handOut();
  ASSERT_EQ(more.size(), 1u);
  EXPECT_EQ(more[0].worker, b.out[0].worker); // the worker that returned a job gets the next one
}

TEST(Scheduler, littleWorkIsSharedEvenly) {
  Bench b;
  b.frame(1, 8);
  b.workers(1, 4, 2);
  EXPECT_EQ(byWorker(b.handOut()), (std::map<WorkerId, uint32_t>{{1, 2}, {2, 2}, {3, 2}, {4, 2}}));
}

// The worker that is ready first does not take all jobs.
TEST(Scheduler, thoseWhoAreStillPreparingAreWaitedFor) {
  Bench b;
  b.frame(1, 8);
  for (WorkerId w = 1; w <= 4; w++) b.s.join(w, 2, false, 0);
  b.s.ready(1, 1, 0);
  EXPECT_EQ(b.handOut().size(), 2u);
}

TEST(Scheduler, aSlowLinkHasMoreInFlightUpToFour) {
  Bench b;
  b.frame(1, 100000);
  b.workers(1, 2, 4);
  for (const Handout& h : b.handOut()) { // jobs of 10 ms; results of worker 2 arrive 20 ms later
    b.now = h.worker == 2 ? 0.05 : 0.01;
    b.done(h, 0.01);
  }
  b.now = 0.05;
  const auto counts = byWorker(b.handOut());
  EXPECT_EQ(counts.at(1), 12u);
  EXPECT_EQ(counts.at(2), 16u);
  EXPECT_NEAR(b.s.tally(2).latency, 0.04, 1e-9);
}

// At 20 microseconds each, three jobs per thread would be nothing.
TEST(Scheduler, cheapJobsCountTogether) {
  Bench b;
  b.frame(1, 100000);
  b.workers(1, 1, 2);
  for (const Handout& h : b.handOut()) b.done(h, 20e-6);
  EXPECT_EQ(b.handOut().size(), 2u * 3 * 64); // a bundle holds at most 64 jobs
}

TEST(Scheduler, samplesAreDividedByCostAndFinerTowardsTheEnd) {
  Bench b;
  b.frame(1, 64, 256, 4096);
  b.workers(1, 4, 2);
  std::vector<uint32_t> sizes;
  std::vector<Handout> queue = b.handOut();
  for (size_t i = 0; i < queue.size(); i++) {
    b.now += 1e-6 * 256 * queue[i].job.job.count;
    const uint32_t count = queue[i].job.job.count;
    sizes.push_back(count);
    EXPECT_TRUE(count == 4096 || (count >= 32 && (count & (count - 1)) == 0));
    b.done(queue[i], 1e-6 * 256 * count);
    const auto more = b.handOut();
    queue.insert(queue.end(), more.begin(), more.end());
  }
  EXPECT_TRUE(b.work[1]->over());
  EXPECT_EQ(sizes.front(), 32u); // nothing is known about the cost yet
  EXPECT_EQ(*std::max_element(sizes.begin(), sizes.end()), 512u); // 0.25 s
  EXPECT_EQ(sizes.back(), 32u);                                   // 8 ms
}

TEST(Scheduler, aFrameBeginsWithTheCostOfTheOneBefore) {
  Bench b;
  b.frame(1, 64, 256, 64);
  b.workers(1, 1, 2);
  while (!b.work[1]->over())
    for (const Handout& h : b.handOut()) b.done(h, 1e-6 * 256 * h.job.job.count);
  b.s.end(1);
  b.frame(2, 64, 256, 4096);
  b.prepare();
  EXPECT_EQ(b.handOut().front().job.job.count, 512u); // 0.25 s
}

TEST(Scheduler, splitByTilesDividesNoSamplesAndBySamplesAlways) {
  Bench tiles({.split = Split::tiles});
  tiles.frame(1, 64, 64, 4096);
  tiles.workers(1, 4, 1);
  for (const Handout& h : tiles.handOut()) EXPECT_EQ(h.job.job.count, 4096u);
  EXPECT_EQ(tiles.s.split(1), Split::tiles);
  Bench samples({.split = Split::samples});
  samples.frame(1, 64, 64, 4096);
  samples.workers(1, 4, 1);
  std::set<WorkerId> ofFirstTile;
  for (const Handout& h : samples.handOut()) {
    EXPECT_EQ(h.job.job.count, 1024u);
    if (h.job.job.number == 0) ofFirstTile.insert(h.worker);
  }
  EXPECT_EQ(ofFirstTile.size(), 4u); // all workers share each tile
}

TEST(Scheduler, aLateJobIsHandedOutAgainToAnIdleWorkerThreeTimesAtMost) {
  Bench b;
  b.frame(1, 6);
  b.workers(1, 6, 1);
  const auto all = b.handOut();
  ASSERT_EQ(all.size(), 6u);
  EXPECT_EQ(b.s.lateAfter(1), INFINITY);
  EXPECT_EQ(b.s.wake(0), INFINITY);
  b.now = 1;
  for (size_t i = 1; i < 6; i++) b.done(all[i], 1);
  EXPECT_TRUE(b.handOut().empty());
  const double late = b.s.lateAfter(1);
  EXPECT_NEAR(late, 2, 0.2); // twice the median
  EXPECT_NEAR(b.s.wake(b.now), late, 1e-6);
  std::set<WorkerId> has{all[0].worker};
  for (int i = 0; i < 3; i++) {
    b.now += late + 0.1;
    const auto again = b.handOut();
    ASSERT_EQ(again.size(), 1u);
    EXPECT_TRUE(again[0].again);
    EXPECT_EQ(again[0].job.job, all[0].job.job);
    EXPECT_TRUE(has.insert(again[0].worker).second); // another worker each time
  }
  b.now += 100;
  EXPECT_TRUE(b.handOut().empty());
  EXPECT_EQ(b.s.wake(b.now), INFINITY);
  EXPECT_EQ(b.s.reissued(), 3u);
  EXPECT_TRUE(b.done(b.out.back(), 1));
  EXPECT_EQ(b.s.tally(b.out.back().worker).again, 1u);
  EXPECT_FALSE(b.done(all[0], 1)); // late
  EXPECT_EQ(b.s.duplicates(), 1u);
  EXPECT_EQ(b.s.tally(all[0].worker).late, 1u);
  EXPECT_TRUE(b.work[1]->over());
}

TEST(Scheduler, whatWaitsBehindOtherJobsIsLateLater) {
  Bench b;
  b.frame(1, 100, 64, 16);
  b.workers(1, 1, 1);
  for (int i = 0; i < 10; i++) {
    const auto h = b.handOut();
    b.done(b.out[i], 1);
  }
  b.workers(2, 1, 1); // joins later and sees the queue
  b.work[1]->round(0);
  const double began = b.now;
  b.now = began + 2.2;
  auto again = b.handOut();
  // The first of its two jobs had another one before it in the queue when it was issued.
  EXPECT_EQ(again.size(), 0u);
  b.now = began + 7;
  again = b.handOut();
  EXPECT_EQ(again.size(), 1u); // an idle thread takes one of them, not all
}

TEST(Scheduler, aLostWorkersJobsAreGivenOutBeforeOthers) {
  Bench b;
  b.frame(1, 1000);
  b.workers(1, 2, 2);
  const auto all = b.handOut();
  b.s.leave(1, b.now);
  EXPECT_EQ(b.work[1]->given, 6u);
  EXPECT_EQ(b.s.tally(1).lost, 0u); // the worker is forgotten
  for (const Handout& h : all)
    EXPECT_EQ(b.s.find(h.worker, 1, h.job.lease) == nullptr, h.worker == 1);
  b.workers(3, 1, 2);
  std::set<uint32_t> lost, taken;
  for (const Handout& h : all)
    if (h.worker == 1) lost.insert(h.job.job.number);
  for (const Handout& h : b.handOut()) taken.insert(h.job.job.number);
  EXPECT_EQ(taken, lost);
  EXPECT_FALSE(b.done(all[0])); // a result that the lost worker still sends
}

TEST(Scheduler, aCopyOfALostWorkersJobIsEnough) {
  Bench b;
  b.frame(1, 2);
  b.workers(1, 2, 1);
  const auto all = b.handOut();
  b.now = 1;
  b.done(all[1], 1);
  b.now = 10;
  ASSERT_EQ(b.handOut().size(), 1u);
  b.s.leave(all[0].worker, b.now);
  EXPECT_EQ(b.work[1]->given, 0u); // the other worker has a copy of it
  EXPECT_TRUE(b.done(b.out.back()));
  EXPECT_TRUE(b.work[1]->over());
}

TEST(Scheduler, threeFailuresAndAWorkerGetsNothingMore) {
  Bench b;
  b.frame(1, 1000);
  b.workers(1, 2, 1);
  for (int i = 0; i < 3; i++) {
    b.handOut();
    const auto mine =
        std::find_if(b.out.rbegin(), b.out.rend(), [&](const Handout& h) { return h.worker == 1; });
    b.s.failed(1, 1, mine->job.lease, b.now);
  }
  EXPECT_TRUE(b.s.tally(1).blocked);
  EXPECT_EQ(b.s.tally(1).failed, 3u);
  EXPECT_EQ(b.s.tally(1).out, 0u);
  EXPECT_EQ(b.s.able(1), 1u);
  for (int i = 0; i < 100 && !b.work[1]->over(); i++)
    for (const Handout& h : b.handOut()) {
      EXPECT_EQ(h.worker, 2u);
      b.done(h);
    }
  b.s.end(1);
  b.frame(2, 10);
  EXPECT_EQ(b.prepare(), std::vector<WorkerId>{2});
}

TEST(Scheduler, whoCannotPrepareAFrameMayTryTheNext) {
  Bench b;
  b.frame(1, 1000);
  b.workers(1, 2, 1);
  b.handOut();
  b.s.unable(1, 1, b.now);
  EXPECT_EQ(b.s.tally(1).out, 0u);
  EXPECT_EQ(b.s.able(1), 1u);
  for (const Handout& h : b.handOut()) EXPECT_EQ(h.worker, 2u);
  b.s.end(1);
  b.frame(2, 10);
  EXPECT_EQ(b.prepare().size(), 2u);
  EXPECT_EQ(byWorker(b.handOut()).size(), 2u);
}

TEST(Scheduler, aWorkerThatLetsAllWaitGetsLess) {
  Bench b({.maxCopies = 3});
  FakeWork& work = b.frame(1, 100000);
  work.round(16);
  b.workers(1, 2, 8);
  for (const Handout& h : b.handOut()) // only the second worker answers
    if (h.worker == 2) b.done(h, 0.01);
  work.round(0); // no new jobs: the second worker gets copies of the late ones
  for (int i = 0; i < 40; i++) {
    b.now += 1;
    for (const Handout& h : b.handOut())
      if (h.worker == 2) b.done(h, 0.01);
  }
  EXPECT_EQ(b.s.tally(1).out, 24u);
  EXPECT_EQ(b.s.reissued(), 24u);
  work.round(16);
  for (const Handout& h : b.out)
    if (h.worker == 1) { // the first worker wakes up and sends one result
      b.done(h, 0.01);
      break;
    }
  for (const Handout& h : b.handOut()) EXPECT_EQ(h.worker, 2u);
}

TEST(Scheduler, unknownLeasesAreDropped) {
  Bench b;
  b.frame(1, 10);
  b.workers(1, 2, 1);
  const auto all = b.handOut();
  EXPECT_FALSE(b.s.done(3, 1, all[0].job.lease, 1, 1));
  // The lease belongs to the other worker.
  EXPECT_FALSE(b.s.done(3 - all[0].worker, 1, all[0].job.lease, 1, 1));
  EXPECT_FALSE(b.s.done(all[0].worker, 2, all[0].job.lease, 1, 1));
  EXPECT_FALSE(b.s.done(all[0].worker, 1, 12345, 1, 1));
  EXPECT_TRUE(b.done(all[0]));
  EXPECT_FALSE(b.done(all[0]));
  b.s.end(1);
  EXPECT_FALSE(b.s.done(all[1].worker, 1, all[1].job.lease, 1, 1));
  EXPECT_EQ(b.s.tally(1).out + b.s.tally(2).out, 0u);
}

TEST(Scheduler, theNextFrameIsHandedOutBeforeTheLastJobComesHome) {
  Bench b;
  b.frame(1, 8);
  b.frame(2, 100);
  b.workers(1, 2, 4);
  const auto first = b.handOut();
  EXPECT_EQ(byWorker(first), (std::map<WorkerId, uint32_t>{{1, 4}, {2, 4}}));
  for (const Handout& h : first) EXPECT_EQ(h.epoch, 1u);
  // Worker 2 stays with frame 1 in case jobs are lost.
  EXPECT_EQ(b.prepare(), std::vector<WorkerId>{1});
  const auto second = b.handOut();
  EXPECT_FALSE(second.empty());
  for (const Handout& h : second)
    EXPECT_EQ(std::pair(h.worker, h.epoch), (std::pair<WorkerId, Epoch>(1, 2)));
  for (const Handout& h : first)
    // Worker 1 called ready() before, so it no longer works on frame 1.
    EXPECT_FALSE(h.worker == 1 && b.done(h));
  EXPECT_TRUE(b.handOut().empty()); // the remaining jobs are as many as worker 2 already has
  for (const Handout& h : first) b.done(h);
  EXPECT_EQ(byWorker(b.handOut()), (std::map<WorkerId, uint32_t>{{2, 4}}));
}

TEST(Scheduler, theOneHereStaysAtTheOldestUnfinishedFrame) {
  Bench b;
  b.frame(1, 8);
  b.frame(2, 100);
  b.s.join(9, 2, true, 0);
  b.workers(1, 2, 4);
  b.handOut();
  WorkerId w;
  Epoch e;
  std::set<WorkerId> moved;
  while (b.s.move(b.now, w, e)) {
    moved.insert(w);
    EXPECT_EQ(e, 2u);
  }
  // Their jobs of the first frame finish before they are ready.
  EXPECT_EQ(moved, (std::set<WorkerId>{1, 2}));
  for (const Handout& h : b.out) EXPECT_TRUE(b.done(h));
  b.s.end(1);
  EXPECT_EQ(b.prepare(), std::vector<WorkerId>{9});
}

TEST(Scheduler, aReserveWorksOnlyIfNobodyElseCan) {
  Bench b;
  b.s.announce(1, 0);
  b.s.join(9, 2, true, 0, true);
  b.s.join(1, 2, false, 0);
  EXPECT_EQ(b.prepare(), std::vector<WorkerId>{1});
  b.frame(1, 100);
  for (const Handout& h : b.handOut()) EXPECT_EQ(h.worker, 1u);
  b.s.leave(1, 0);
  EXPECT_EQ(b.prepare(), std::vector<WorkerId>{9});
  EXPECT_EQ(byWorker(b.handOut()), (std::map<WorkerId, uint32_t>{{9, 6}}));
  b.workers(2, 1, 2);
  for (const Handout& h : b.handOut()) EXPECT_EQ(h.worker, 2u);
  b.done(b.out[6]); // a job of the reserve
  EXPECT_TRUE(b.handOut().empty());
}

TEST(Scheduler, aReserveHelpsIfNothingComesOfTheOthers) {
  Bench b;
  b.s.announce(1, 0);
  b.s.join(9, 2, true, 0, true);
  b.s.join(1, 2, false, 0);
  WorkerId w;
  Epoch e;
  EXPECT_TRUE(b.s.move(0, w, e) && w == 1); // worker 1 never answers
  EXPECT_EQ(b.s.wake(b.now), 10);
  b.now = 9.9;
  EXPECT_TRUE(b.prepare().empty());
  EXPECT_FALSE(b.s.stuck(1));
  b.now = 10;
  EXPECT_EQ(b.prepare(), std::vector<WorkerId>{9});
  EXPECT_TRUE(b.s.stuck(1));
  b.frame(1, 3);
  for (int i = 0; i < 3; i++)
    for (const Handout& h : b.handOut()) {
      EXPECT_EQ(h.worker, 9u);
      EXPECT_TRUE(b.done(h));
    }
  EXPECT_TRUE(b.work[1]->over());
}

TEST(Scheduler, aReserveTakesOverJobsThatNeverComeHome) {
  Bench b;
  b.s.announce(1, 0);
  b.s.join(9, 2, true, 0, true);
  b.frame(1, 3);
  b.workers(1, 1, 2);
  EXPECT_EQ(byWorker(b.handOut()), (std::map<WorkerId, uint32_t>{{1, 2}}));
  b.now = 10;
  EXPECT_EQ(b.prepare(), std::vector<WorkerId>{9});
  uint32_t again = 0;
  for (int i = 0; i < 3; i++)
    for (const Handout& h : b.handOut()) {
      EXPECT_EQ(h.worker, 9u);
      EXPECT_TRUE(b.done(h));
      again += h.again;
    }
  EXPECT_EQ(again, 2u);
  EXPECT_TRUE(b.work[1]->over());
}

TEST(Scheduler, joiningInMidFrame) {
  Bench b;
  b.frame(1, 100);
  b.workers(1, 1, 1);
  for (int i = 0; i < 5; i++) {
    b.handOut();
    b.done(b.out[size_t(i)]);
  }
  b.workers(2, 3, 1);
  EXPECT_EQ(byWorker(b.handOut()), (std::map<WorkerId, uint32_t>{{1, 1}, {2, 3}, {3, 3}, {4, 3}}));
}

TEST(Scheduler, framesAreOneWorkersEach) {
  Bench b({.split = Split::frames});
  for (Epoch e = 1; e <= 5; e++) b.s.announce(e, 0);
  for (WorkerId w = 1; w <= 4; w++) b.s.join(w, 2, false, 0);
  EXPECT_EQ(b.prepare().size(), 4u);
  for (Epoch e = 1; e <= 5; e++) b.frame(e, 20);
  b.prepare();
  std::map<Epoch, std::set<WorkerId>> who;
  for (const Handout& h : b.handOut()) who[h.epoch].insert(h.worker);
  EXPECT_EQ(who.size(), 4u); // the fifth frame waits
  for (const auto& [epoch, workers] : who) EXPECT_EQ(workers.size(), 1u);
  // The worker of frame 1 is done and takes frame 5.
  for (size_t i = 0; i < b.out.size(); i++)
    if (b.out[i].epoch == 1) {
      b.done(b.out[i]);
      b.handOut();
    }
  ASSERT_TRUE(b.work[1]->over());
  b.s.end(1);
  EXPECT_EQ(b.prepare().size(), 1u);
  for (const Handout& h : b.handOut()) EXPECT_EQ(h.epoch, 5u);
}

TEST(Scheduler, othersHelpAtTheEndOfFrames) {
  Bench b({.split = Split::frames});
  b.frame(1, 4);
  b.frame(2, 1000);
  b.workers(1, 2, 1);
  for (size_t i = 0; i < 20; i++) { // costs are known, and much of the second frame is left
    b.handOut();
    if (i < b.out.size() && b.out[i].epoch == 1) b.done(b.out[i], 1);
  }
  for (size_t i = 0; i < b.out.size() && !b.work[1]->over(); i++)
    if (b.out[i].epoch == 1) {
      b.done(b.out[i], 1);
      b.handOut();
    }
  b.s.end(1);
  for (const Handout& h : b.out)
    if (h.epoch == 2) {
      b.done(h, 1);
      break;
    }
  EXPECT_EQ(b.prepare(), std::vector<WorkerId>{1});
  std::set<WorkerId> who;
  for (const Handout& h : b.handOut()) who.insert(h.worker);
  EXPECT_TRUE(who.contains(1));
}

TEST(Scheduler, automaticMakesFramesWhenPreparingCostsMost) {
  for (const double prepare : {0.001, 10.0}) {
    Bench b;
    for (WorkerId w = 1; w <= 4; w++) b.s.join(w, 4, false, 0);
    b.s.announce(1, 0);
    WorkerId w;
    Epoch e;
    std::vector<WorkerId> asked;
    while (b.s.move(0, w, e)) asked.push_back(w);
    b.now = prepare;
    for (const WorkerId a : asked) b.s.ready(a, 1, b.now);
    b.frame(1, 64);
    for (size_t i = 0; i == 0 || i < b.out.size(); i++) {
      b.handOut();
      b.done(b.out[i], 0.1);
    }
    ASSERT_TRUE(b.work[1]->over());
    b.s.end(1);
    for (e = 2; e < 8; e++) b.s.announce(e, b.now);
    EXPECT_EQ(b.s.split(2), Split::automatic); // few frames were in flight
    EXPECT_EQ(b.s.split(7), prepare > 1 ? Split::frames : Split::automatic);
  }
}

TEST(Scheduler, aCancelledFrameIsForgotten) {
  Bench b;
  b.frame(1, 100);
  b.workers(1, 2, 2);
  b.handOut();
  b.s.end(1);
  EXPECT_EQ(b.s.tally(1).out, 0u);
  EXPECT_EQ(b.work[1].use_count(), 1);
  b.frame(2, 100);
  EXPECT_EQ(b.prepare().size(), 2u);
  EXPECT_EQ(b.handOut().size(), 12u);
}

// Rounds: progressive frames, pilots.
TEST(Scheduler, roundsThatWaitAreNotTheEnd) {
  Bench b;
  b.frame(1, 4, 64, 64).round(32);
  b.frame(2, 100);
  b.workers(1, 2, 2);
  const auto first = b.handOut();
  EXPECT_EQ(first.size(), 4u);
  EXPECT_TRUE(b.prepare().empty());
  b.work[1]->round(64);
  EXPECT_TRUE(b.done(first[0]));
  EXPECT_EQ(b.handOut().size(), 1u);
}

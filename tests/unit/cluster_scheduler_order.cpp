// cluster_scheduler_order.cpp: Tests how the scheduler uses measured costs: the order of tiles, the
// length of jobs, and the number of queued jobs.
#include <gtest/gtest.h>

#include "unit/cluster_fake_work.h"

using namespace openrt;
using namespace openrt::cluster;

namespace {

// Finishes frame 1, in which tile n takes seconds[n], and begins frame 2.
void afterAFrameOf(Bench& b, const std::vector<double>& seconds, uint32_t threads,
                   uint32_t samples = 1024) {
  b.frame(1, uint32_t(seconds.size()), 64, samples);
  b.workers(1, 1, threads);
  while (!b.work[1]->over())
    for (const Handout& h : b.handOut())
      b.done(h, seconds[h.job.job.number] / samples * h.job.job.count);
  b.s.end(1);
  b.frame(2, uint32_t(seconds.size()), 64, samples);
  b.prepare();
}

TEST(SchedulerOrder, whatCostsMostIsDoneFirst) {
  Bench b;
  afterAFrameOf(b, {.5, .1, 3, .2, 1, .4}, 1);
  std::vector<uint32_t> order;
  while (!b.work[2]->over())
    for (const Handout& h : b.handOut()) {
      if (order.empty() || order.back() != h.job.job.number) order.push_back(h.job.job.number);
      b.done(h, 1e-3 * h.job.job.count);
    }
  EXPECT_EQ(order, (std::vector<uint32_t>{2, 4, 0, 5, 3, 1}));
}

// Their jobs would be shorter than the master has time for.
TEST(SchedulerOrder, cheapTilesAreNotLeftForTheEnd) {
  Bench b;
  b.s.pace(0.01);
  std::vector<double> seconds(40, .001);
  for (size_t i = 0; i < 20; i++) seconds[2 * i] = 1;
  afterAFrameOf(b, seconds, 2);
  std::vector<uint32_t> order;
  while (!b.work[2]->over())
    for (const Handout& h : b.handOut()) {
      if (h.job.job.first == 0) order.push_back(h.job.job.number);
      b.done(h, 1e-3 * h.job.job.count);
    }
  ASSERT_EQ(order.size(), 40u);
  for (size_t i = 34; i < 40; i++) EXPECT_EQ(order[i] % 2, 0u) << i;
  for (size_t i = 0, cheap = 0; i < 20; i++)
    EXPECT_LE(cheap += order[i] % 2, i); // they are not all at the beginning either
}

TEST(SchedulerOrder, noMoreJobsThanThereIsTimeFor) {
  const auto smallest = [&](double pace) { // samples in the smallest job
    Bench b;
    b.s.pace(pace);
    afterAFrameOf(b, std::vector<double>(64, .25), 512);
    uint32_t least = ~0u;
    while (!b.work[2]->over())
      for (const Handout& h : b.handOut()) {
        b.done(h, .25 / 1024 * h.job.job.count);
        least = std::min(least, h.job.job.count);
      }
    return least;
  };
  EXPECT_EQ(smallest(1e-6), 32u);
  // 62 ms; issuing one job to each of 512 threads takes the master 51 ms
  EXPECT_EQ(smallest(1e-4), 256u);
}

// A job queued behind others could be done by another worker.
TEST(SchedulerOrder, longJobsNeedNoQueue) {
  Bench b;
  afterAFrameOf(b, std::vector<double>(400, .2), 16, 32);
  EXPECT_EQ(b.handOut().size(), 16u + 4u);
}

} // namespace

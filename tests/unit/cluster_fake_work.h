// cluster_fake_work.h: the work of a frame without a picture, and workers without processes, for
// tests of the scheduler. Every sample of every tile is counted, so that a sample merged twice or
// never is noticed.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "backend/cluster/master/scheduler.h"

namespace openrt::cluster {

class FakeWork final : public JobSource {
 public:
  FakeWork(uint32_t tiles, uint32_t pixels, uint32_t samples)
      : pixels_(pixels), samples_(samples), next_(tiles), taken_(tiles) {
    for (auto& t : taken_) t.assign(samples, 0);
    undone_ = double(tiles) * pixels * samples;
  }
  FrameWork::Next next(Job& job, uint32_t largest) override {
    if (over()) return FrameWork::Next::over;
    if (!back_.empty()) {
      job = back_.back();
      back_.pop_back();
      undone_ -= double(job.count) * pixels_;
      return FrameWork::Next::job;
    }
    const uint32_t end = std::min(samples_, until);
    while (tile_ < next_.size() && next_[at(tile_)] >= end) tile_++;
    if (tile_ == next_.size()) return FrameWork::Next::wait;
    uint32_t& from = next_[at(tile_)];
    job = Job{};
    job.number = at(tile_);
    job.first = from;
    job.count = std::min(largest, end - from);
    from += job.count;
    undone_ -= double(job.count) * pixels_;
    return FrameWork::Next::job;
  }
  void giveBack(const Job& job) override {
    back_.push_back(job);
    given++;
    undone_ += double(job.count) * pixels_;
  }
  double undone() const override { return undone_; }
  uint32_t tiles() const override { return uint32_t(next_.size()); }
  uint32_t pixels(uint32_t) const override { return pixels_; }
  void order(std::vector<uint32_t> tiles) override { order_ = std::move(tiles); }
  uint32_t upcoming() const override {
    size_t tile = tile_;
    while (tile < next_.size() && next_[at(tile)] >= std::min(samples_, until)) tile++;
    return back_.empty() && tile < next_.size() ? at(tile) : uint32_t(next_.size());
  }

  void take(const Job& job) {
    for (uint32_t i = job.first; i < job.first + job.count; i++)
      ASSERT_EQ(taken_[job.number][i]++, 0) << job.number << " " << i;
    done_ += job.count;
  }
  bool over() const { return done_ == uint64_t(samples_) * taken_.size(); }

  // Issues only the first `samples` samples of each tile from now on.
  void round(uint32_t samples) {
    until = samples;
    tile_ = 0;
  }

  uint32_t given = 0; // jobs that were given back

 private:
  uint32_t at(size_t tile) const { return order_.empty() ? uint32_t(tile) : order_[tile]; }
  uint32_t pixels_, samples_;
  std::vector<uint32_t> next_, order_;
  std::vector<std::vector<uint8_t>> taken_;
  std::vector<Job> back_;
  uint32_t until = ~0u;
  size_t tile_ = 0;
  uint64_t done_ = 0;
  double undone_ = 0;
};

// A scheduler, frames of fake work, and the jobs issued.
struct Bench {
  explicit Bench(const SchedulerOptions& options = {}) : s(options) {}
  Scheduler s;
  double now = 0;
  std::map<Epoch, std::shared_ptr<FakeWork>> work;
  std::vector<Handout> out;

  FakeWork& frame(Epoch epoch, uint32_t tiles, uint32_t pixels = 64, uint32_t samples = 16) {
    work[epoch] = std::make_shared<FakeWork>(tiles, pixels, samples);
    s.frame(epoch, std::shared_ptr<JobSource>(work[epoch]), now);
    return *work[epoch];
  }
  void workers(WorkerId first, uint32_t count, uint32_t threads, bool here = false) {
    for (uint32_t i = 0; i < count; i++) s.join(first + i, threads, here, now);
    prepare();
  }
  // Lets every worker that has to prepare finish immediately. Returns their ids.
  std::vector<WorkerId> prepare() {
    std::vector<WorkerId> moved;
    WorkerId w;
    Epoch e;
    while (s.move(now, w, e)) {
      s.ready(w, e, now);
      moved.push_back(w);
    }
    return moved;
  }
  std::vector<Handout> handOut() {
    std::vector<Handout> all;
    Handout h;
    while (s.next(now, h)) all.push_back(h);
    out.insert(out.end(), all.begin(), all.end());
    return all;
  }
  bool done(const Handout& h, double seconds = 0.01) {
    const Job* job = s.find(h.worker, h.epoch, h.job.lease);
    EXPECT_TRUE(!job || *job == h.job.job);
    const bool first = s.done(h.worker, h.epoch, h.job.lease, seconds, now);
    EXPECT_LE(first, job != nullptr);
    if (first) work.at(h.epoch)->take(h.job.job);
    return first;
  }
};

} // namespace openrt::cluster

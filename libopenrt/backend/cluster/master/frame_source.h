// frame_source.h: adapts a frame's work (FrameWork) to the scheduler's JobSource. It is separate
// from scheduler.h so that the scheduler can be linked without the renderer. Used by the master;
// one thread.
#pragma once

#include <utility>

#include "backend/cluster/master/scheduler.h"

namespace openrt::cluster {

class FrameSource final : public JobSource {
 public:
  explicit FrameSource(std::shared_ptr<FrameWork> work) : work_(std::move(work)) {}
  FrameWork::Next next(Job& job, uint32_t largest) override { return work_->next(job, largest); }
  void giveBack(const Job& job) override { work_->giveBack(job); }
  double undone() const override { return work_->undone(); }
  uint32_t tiles() const override { return work_->tiles(); }
  void order(std::vector<uint32_t> tiles) override { work_->order(std::move(tiles)); }
  uint32_t upcoming() const override { return work_->upcoming(); }
  uint32_t pixels(uint32_t tile) const override {
    const Tile t = work_->tile(tile);
    return (t.x1 - t.x0) * (t.y1 - t.y0);
  }

 private:
  std::shared_ptr<FrameWork> work_;
};

inline void Scheduler::frame(Epoch epoch, std::shared_ptr<FrameWork> work, double now) {
  frame(epoch, std::shared_ptr<JobSource>(std::make_shared<FrameSource>(std::move(work))), now);
}

} // namespace openrt::cluster

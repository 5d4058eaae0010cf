// renderer.cpp: the render threads. The picture does not depend on which thread does which job
// (frame_work.h).
#include "render/frame/renderer.h"

#include <algorithm>
#include <bit>
#include <exception>
#include <stdexcept>

#include "render/frame/job_runner.h"
#include "shortage.h"
#include "start_threads.h"
#include "steady_clock.h"

namespace openrt {
namespace {

// Returns the maximum number of samples of a job: small enough that a picture with few tiles keeps
// all threads busy until its end.
uint32_t largestJob(const edit::FrameSettingsT& frame, uint32_t tiles, uint32_t threads) {
  constexpr uint32_t jobsOfThread = 8;
  if (threads < 2 || tiles >= jobsOfThread * threads) return ~0u;
  return std::max(uint32_t(uint64_t(frame.samples) * tiles / (jobsOfThread * threads)),
                  fewestOfLeaves);
}

} // namespace

Frame::Frame(std::shared_ptr<const RenderScene> scene, uint32_t threads, const KeepSums& kept)
    : scene_(std::move(scene)), work_(scene_->frame, factsOf(*scene_), threads, kept),
      started_(steadySeconds()) {
  work_.onChange([this] {
    {
      std::lock_guard lock(mutex_);
      changes_++;
    }
    changed_.notify_all();
  });
  const uint32_t tiles = std::max(work_.tiles(), 1u),
                 largest = largestJob(scene_->frame, tiles, threads);
  const uint64_t jobs =
      uint64_t(tiles) * std::max(scene_->frame.samples / std::max(largest, 1u), 1u);
  startThreads(threads_, size_t(std::min<uint64_t>(threads, jobs)),
               [this, largest](size_t) { work(largest); });
}

Frame::~Frame() {
  cancel();
  wait();
}

void Frame::cancel() {
  cancelled_ = true;
  {
    std::lock_guard lock(mutex_);
    changes_++;
  }
  changed_.notify_all();
}

void Frame::wait() {
  if (threads_.empty()) return;
  for (auto& thread : threads_) thread.join();
  threads_.clear();
  if (cancelled_) work_.cancel();
  const RayCounters counters = work_.counters();
  counters.faults.report(scene_->host.logCallback, scene_->host.logUser, counters.camera);
}

void Frame::work(uint32_t largest) {
  try {
    JobRunner runner(scene_);
    Job job;
    JobResult result;
    while (!cancelled_) {
      uint64_t seen = 0;
      {
        std::lock_guard lock(mutex_);
        seen = changes_;
      }
      const FrameWork::Next next = work_.next(job, largest);
      if (next == FrameWork::Next::over) break;
      if (next == FrameWork::Next::job) {
        if (runner.run(job, cancelled_, result)) work_.take(job, std::move(result));
        continue;
      }
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return changes_ != seen; });
    }
    std::lock_guard lock(mutex_);
    seconds_ = std::max(seconds_, steadySeconds() - started_);
  } catch (...) {
    {
      std::lock_guard lock(mutex_);
      failure_ = std::current_exception();
    }
    cancel();
  }
}

void Frame::throwFailure() const {
  if (!failure_) return;
  try {
    std::rethrow_exception(failure_);
  } catch (const std::exception& e) {
    if (isShortage(e)) throw;
    throw std::runtime_error(std::string("rendering failed: ") + e.what());
  }
}

} // namespace openrt

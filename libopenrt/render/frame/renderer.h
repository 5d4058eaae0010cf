// renderer.h: a frame in flight on threads of this process. The threads take jobs until none is
// left or the frame is cancelled.
#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "render/frame/frame_work.h"
#include "render/frame/threads.h"
#include "render/render_scene.h"

namespace openrt {

class Frame {
 public:
  // Starts rendering at once. The scene must not change until the frame is waited for.
  Frame(std::shared_ptr<const RenderScene> scene, uint32_t threads, const KeepSums& kept = {});
  ~Frame(); // cancels and waits
  void wait();
  void cancel();                                                // [any]
  float progress() const { return work_.progress(); }           // [any]
  bool snapshot(uint32_t channel, std::span<float> out) const { // [any]
    return work_.snapshot(channel, out);
  }
  // Valid after wait().
  const FrameWork& work() const { return work_; }
  double seconds() const { return seconds_; }
  // Throws why the frame has failed; nothing if it succeeded.
  void throwFailure() const;

 private:
  void work(uint32_t largest);
  std::shared_ptr<const RenderScene> scene_;
  FrameWork work_;
  std::atomic<bool> cancelled_{false};
  std::vector<std::thread> threads_;
  std::mutex mutex_; // guards everything below
  std::condition_variable changed_;
  uint64_t changes_ = 0;
  std::exception_ptr failure_;
  double seconds_ = 0, started_ = 0;
};

} // namespace openrt

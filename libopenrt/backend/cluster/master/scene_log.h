// scene_log.h: Keeps the commits that workers may still need, and the scene at the oldest of them.
// A worker that joins in the middle of a frame gets the scene of that frame; if the frame has
// RT_MOTION, that of the frame before in the same view (RT_VIEW) and the commits since. If other
// views take turns with it, the worker gets the last frame of each of them in the same way. One
// thread.
#pragma once

#include <deque>

#include "backend/cluster/master/parcel.h"
#include "backend/cluster/worker/worker_core.h"
#include "scene/scene.h"

namespace openrt::cluster {

class SceneLog {
 public:
  explicit SceneLog(const ShaderRegistry* shaders) : packer_(shaders) {}

  void add(Epoch epoch, std::shared_ptr<const Commit> commit);
  // No worker asks for the scene of an earlier epoch from now on.
  void settle(Epoch epoch);
  // All workers have the commits up to `epoch`; they can be dropped.
  void trim(Epoch epoch);

  struct Step {
    Epoch epoch = 0;
    ParcelPtr parcel;
    bool whole = false;
  };
  // Returns the steps, in order, that bring a worker from the scene of epoch `has` (0: none) to
  // that of `wanted`, which must not be settled.
  std::vector<Step> steps(Epoch has, Epoch wanted);
  Epoch last() const { return log_.empty() ? base_ : log_.back().epoch; }
  const edit::FrameSettingsT& frame() const { return frame_; } // settings of the last commit

 private:
  // Limits on the commits kept for workers that lag behind.
  static constexpr size_t maxCommits = 256, maxBytes = size_t(64) << 20;
  struct Entry {
    Epoch epoch = 0;
    ParcelPtr parcel;
  };
  struct Frame {
    Epoch epoch = 0;
    uint32_t view = 0;
    bool motion = false; // it has RT_MOTION
  };
  // Returns the latest scene that a worker may begin with if it is to render the frame of `epoch`.
  Epoch baseFor(Epoch epoch) const;
  void dropFirst();
  void dropFrames(Epoch epoch);

  Packer packer_;
  std::deque<Entry> log_;
  std::deque<Frame> frames_; // the last ones
  size_t bytes_ = 0;
  // scene_ is the scene at base_; commits up to gone_ are no longer in the log.
  Scene scene_;
  Epoch base_ = 0, gone_ = 0;
  ParcelPtr whole_; // scene_ as one commit; null until it is needed
  edit::FrameSettingsT frame_;
};

} // namespace openrt::cluster

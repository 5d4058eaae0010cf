// scene_log.h: the commits that workers may still need, and the scene as it was at the oldest of
// them, so that one who joins in the middle of a frame gets the scene of that frame. One thread's.
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
  // All workers have what is up to here: it need not be kept.
  void trim(Epoch epoch);

  struct Step {
    Epoch epoch = 0;
    ParcelPtr parcel;
    bool whole = false;
  };
  // What brings somebody who has the scene of epoch `has` (0: none) to that of `wanted`, in order.
  // wanted: not settled.
  std::vector<Step> steps(Epoch has, Epoch wanted);
  Epoch last() const { return log_.empty() ? base_ : log_.back().epoch; }
  const edit::FrameSettingsT& frame() const { return frame_; } // of the last commit

 private:
  static constexpr size_t mostCommits = 256, mostBytes = size_t(64)
                                                         << 20; // kept for those who lag behind
  struct Entry {
    Epoch epoch = 0;
    ParcelPtr parcel;
  };
  void dropFirst();

  Packer packer_;
  std::deque<Entry> log_;
  size_t bytes_ = 0;
  Scene scene_;               // at base_
  Epoch base_ = 0, gone_ = 0; // gone_: commits up to here are not in the log
  ParcelPtr whole_;           // scene_ as one commit; null: not made
  edit::FrameSettingsT frame_;
};

} // namespace openrt::cluster

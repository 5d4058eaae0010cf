// history.h: what has changed in a scene since the last frame of each view (RT_VIEW), for
// RT_MOTION. Scene::apply() tells it what it changes. It costs what has changed, and nothing while
// no frame has the channel. The local backend owns one beside its scene. The motion that a view has
// follows from the commits since its last frame alone, so every backend that has applied the commit
// of a frame and all since that of the view's frame before it finds the same motion.
#pragma once

#include <cstdint>
#include <unordered_map>

#include "scene/scene.h"
#include "scene/view_history.h"

namespace openrt {

// A view that has had none of the last frames, this many of all views together, begins anew. So a
// cluster need not keep older scenes for workers that join.
constexpr uint64_t maxFramesBetween = 32;

class SceneHistory {
 public:
  // Scene::apply() calls these. Between begin() and finish(), if records(), it tells what it is
  // about to change.
  void begin(const Commit& commit);
  bool records() const { return records_; }
  void changeInstance(uint32_t id, const Instance& before);
  void addInstance(uint32_t id);
  void changeObject(uint32_t id, const FormerGeometries& before);
  void addObject(uint32_t id);
  void finish(const Scene& scene, const Commit& commit);
  // Notes that no frame has shown the last commit, although one was to follow it. Its changes then
  // count for the frame of the next commit.
  void skipFrame() { framed_ = false; }

  // Returns the number of the current frame; it grows with each frame.
  uint64_t number() const { return number_; }
  // Returns the number of the frame before in the view of the current frame; 0: there was none.
  uint64_t numberBefore() const { return current().last; }
  // Returns whether the current frame has the channel.
  bool watches() const { return current().watches; }
  // Returns true if the current frame has the channel and anything may have moved or is new.
  bool any() const { return watches() && current().history.any(); }
  // Returns what has changed since the frame before in the view of the current frame.
  const ViewHistory& view() const { return current().history; }

 private:
  struct View {
    ViewHistory history;
    bool watches = false; // its last frame has RT_MOTION, or the current one if that is its own
    uint64_t last = 0;    // number of its last frame before the current one
  };
  const View& current() const;
  // Calls f with the history of each view that notes the changes of a commit.
  template <class F> void forEachWatching(const F& f);

  std::unordered_map<uint32_t, View> views_;
  uint32_t view_ = 0; // that of the current frame
  uint64_t number_ = 1;
  bool framed_ = false;  // a frame followed the last commit
  bool records_ = false; // any view notes what changes
};

} // namespace openrt

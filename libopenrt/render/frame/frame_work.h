// frame_work.h: what of a frame is to be done, and the picture that comes of it. Gives jobs out in
// an order that shows something soon, takes what they have made in any order, and merges it in a
// fixed one: the picture is the same bytes whoever did what. Knows nothing of threads, machines and
// time (but for frames with a time limit). All functions [any].
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "render/film/film.h"
#include "render/frame/job.h"
#include "render/frame/tiles.h"
#include "scene/scene.h"

namespace openrt {

// What the work depends on beside the settings of the frame. The same wherever the scene is
// prepared.
struct FrameFacts {
  bool camera = false; // something can be seen
  bool lamps = false;  // paths from lamps are followed, too
};

class FrameWork {
 public:
  // settings: with the transport that was chosen. crew: threads that work on it, about; it decides
  // nothing of the picture.
  FrameWork(const edit::FrameSettingsT& settings, const FrameFacts& facts, uint32_t crew);
  ~FrameWork();

  enum class Next : uint8_t {
    job,
    wait, // for jobs that are out
    over
  };
  // The next job that nobody has. largest: samples of a pixel that it should have at most; a tile's
  // samples are given out in aligned blocks of powers of two then, at least 32.
  Next next(Job& job, uint32_t largest = ~0u);
  // All tiles' numbers, in the order in which they are to be given out. Before the first job; a
  // frame that shows something early keeps its own order.
  void order(std::vector<uint32_t> tiles);
  uint32_t upcoming()
      const; // the tile whose samples next() gives out, if it gives any; tiles(): that is open
  // A job that comes back undone; it is given out again, before others.
  void giveBack(const Job& job);
  // What has become of a job that was given out. True the first time; what comes a second time is
  // dropped.
  bool take(const Job& job, JobResult&& result);
  // No more jobs, those that are out do not count: the picture holds what is finished.
  void cancel();
  bool over() const; // all has been taken, or cancelled
  // Called (by whoever gives or takes) after there may be something new for those who got `wait`,
  // who then ask again: once for all that have waited.
  void onChange(std::function<void()> changed);

  uint32_t tiles() const; // of the picture
  double undone() const;  // pixels times samples that nobody has yet, about
  Tile tile(uint32_t number) const;
  float progress() const;
  bool snapshot(uint32_t channel, std::span<float> out) const;
  const Film& film() const; // once over
  RayCounters counters() const;
  void describeError(RTstats& stats) const;  // once over
  void describeLedger(RTstats& stats) const; // once over

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace openrt

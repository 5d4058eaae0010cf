// frame_work.h: the work of one frame: hands out jobs in an order that shows a picture early, takes
// their results in any order, and merges them in a fixed order, so the picture has the same bytes
// whoever did which job. It knows nothing of threads, machines and time (except for frames with a
// time limit). All functions [any].
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

// Properties of the scene that the work depends on besides the frame's settings. They are the same
// wherever the scene is prepared.
struct FrameFacts {
  bool camera = false; // the scene has a camera
  bool lamps = false;  // light tracing is needed
};

class FrameWork {
 public:
  // settings: with the transport that was chosen. threadCount: approximate number of threads that
  // work on the frame; it has no influence on the picture.
  FrameWork(const edit::FrameSettingsT& settings, const FrameFacts& facts, uint32_t threadCount);
  ~FrameWork();

  enum class Next : uint8_t {
    job,
    wait, // nothing can be handed out until outstanding jobs are done
    over
  };
  // Hands out the next job. largest: preferred maximum of samples per pixel; the samples of a tile
  // are then handed out in aligned blocks of powers of two, at least 32.
  Next next(Job& job, uint32_t largest = ~0u);
  // Sets the order in which tiles are handed out: the numbers of all tiles. Call before the first
  // job. A frame that shows early results keeps its own order.
  void order(std::vector<uint32_t> tiles);
  uint32_t upcoming() const; // Returns the tile that next() will hand out; tiles() if that is open.
  // Takes back a job that was not done; it is handed out again before others.
  void giveBack(const Job& job);
  // Takes the result of a job that was handed out. Returns true the first time; repeated results
  // are dropped.
  bool take(const Job& job, JobResult&& result);
  // Stops handing out jobs and drops outstanding ones; the picture keeps what is finished.
  void cancel();
  bool over() const; // whether all results were taken, or the frame was cancelled
  // Sets a callback for threads that got `wait` and should call next() again. It is called from the
  // thread that hands out or takes a job, once for all waiting threads.
  void onChange(std::function<void()> changed);

  uint32_t tiles() const; // number of tiles of the picture
  double undone() const;  // approximate amount of work not handed out: pixels times samples
  Tile tile(uint32_t number) const;
  float progress() const;
  bool snapshot(uint32_t channel, std::span<float> out) const;
  const Film& film() const; // valid once over() is true
  RayCounters counters() const;
  void describeError(RTstats& stats) const;  // valid once over() is true
  void describeLedger(RTstats& stats) const; // valid once over() is true

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

} // namespace openrt

// renderer.h: a frame in flight: threads that take tiles from a counter until none is left or the frame is cancelled.
#pragma once

#include <atomic>
#include <barrier>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "render/film.h"
#include "render/light_image.h"
#include "render/render_scene.h"
#include "render/rounds.h"
#include "render/tile.h"

namespace openrt {

class LightTracer;

// Threads the process may use: affinity and, where there is one, the control group's quota.
uint32_t availableThreads();

class Frame {
 public:
  // Starts at once. The scene must stay as it is until the frame is waited for.
  Frame(std::shared_ptr<const RenderScene> scene, uint32_t threads);
  ~Frame(); // cancels and waits
  void wait();
  void cancel() { cancelled_ = true; } // [any]
  float progress() const;              // [any]
  // The finished tiles of one channel, of a frame in rounds what they have by now, nothing elsewhere; false if there is no such
  // channel or no room. [any]
  bool snapshot(uint32_t channel, std::span<float> out) const;
  const Film& film() const { return film_; }
  const RayCounters& counters() const { return counters_; } // after wait()
  // The error of the whole picture into its statistics; after wait().
  void describeError(RTstats& stats) const;
  // What the picture leaves out on purpose; after wait().
  void describeLedger(RTstats& stats) const;
  double seconds() const { return seconds_; }
  const std::string& failure() const { return failure_; } // empty: none

 private:
  void work();
  void traceLight(std::optional<LightTracer>& tracer);
  void renderTile(TileRenderer& renderer, uint32_t number);
  void endRound() noexcept; // by one thread, while the others wait
  void wantParts();
  void wantEarly();
  Tile tile(uint32_t number) const;
  std::shared_ptr<const RenderScene> scene_;
  Film film_;
  std::vector<Ledger> ledgers_;            // by tile
  std::unique_ptr<Rounds> rounds_;         // null: one round
  std::unique_ptr<LightImage> light_;      // null: no paths from lamps
  std::unique_ptr<LightImage> early_;      // few paths of no consequence: shown while those that count are not there; null: none
  const LightImage* shownLight_ = nullptr; // by the coming round
  std::unique_ptr<std::barrier<>> lit_;
  std::atomic<uint32_t> nextPart_{0}, nextEarly_{0};
  uint32_t partsWanted_ = 0, earlyWanted_ = 0,
           earlyPaths_ = 0;                    // before the coming round; written by one thread while the others wait
  std::atomic<uint64_t> lightPaths_{0};        // followed so far
  uint32_t partPaths_ = 0;                     // of each part
  std::atomic<bool> over_{false};              // written by endRound()
  uint32_t edge_, columns_, tiles_, crew_ = 1; // crew_: threads
  std::atomic<uint32_t> next_{0}, done_{0};
  std::atomic<bool> cancelled_{false};
  std::unique_ptr<std::atomic<bool>[]> finished_; // by tile: its pixels may be read
  struct EndRound {
    Frame* frame;
    void operator()() noexcept { frame->endRound(); }
  };
  std::unique_ptr<std::barrier<EndRound>> barrier_;
  std::vector<std::thread> threads_;
  std::mutex mutex_; // counters_, failure_, seconds_
  RayCounters counters_;
  std::string failure_;
  double seconds_ = 0, started_ = 0;
};

} // namespace openrt

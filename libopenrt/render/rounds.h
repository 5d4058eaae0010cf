// rounds.h: how a frame is made that goes over the whole picture several times: what each round adds to a tile, and when the last
// one is over. Two kinds: with a time limit (as many replicates as there is time for, docs/decisions/0018), and progressive ones,
// which take the samples of an ordinary frame in doubling portions (docs/decisions/0025). Owned by a Frame.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "render/film.h"
#include "render/ledger.h"
#include "render/sampler.h"
#include "scene/scene.h"

namespace openrt {

class TileRenderer;

class Rounds {
 public:
  // Null: the frame is made in one go. light: with paths from lamps. now: seconds of the clock that endRound() and progress() are
  // told, too.
  static std::unique_ptr<Rounds> of(const edit::FrameSettingsT& frame, uint32_t tiles, bool light, double now);
  Rounds(const edit::FrameSettingsT& frame, uint32_t tiles, bool light, double now);

  // This round's part of a tile. [render] each tile by one thread
  void render(TileRenderer& renderer, const Tile& tile, uint32_t number, Ledger& ledger);
  // All tiles have had theirs: false if that was the last round. By one thread, while the others wait.
  bool endRound(double now);
  bool timed() const { return timed_; }
  // How much of what paths from lamps make the coming round is to show, 0 to 1. Timed frames have all of it before.
  double lightShare() const;
  float progress(double now) const; // [any]

  std::mutex film; // held where pixels are stored: they are read meanwhile, and stored again

 private:
  bool endTimed(double now);
  bool endProgressive();
  Replicates replicates(uint32_t number) const;

  const edit::FrameSettingsT& frame_;
  const bool light_, timed_;
  bool pilot_;
  std::vector<std::vector<std::byte>> kept_; // by tile: sums (TileRenderer)
  std::vector<uint32_t> wanted_;             // by tile: samples; known after the pilot
  Replicates replicates_;                    // of all tiles, if timed
  uint32_t first_ = 0, samples_ = 1;         // of the round
  uint32_t most_ = 0;                        // that any tile wants
  double started_, began_;                   // the frame, the round
  std::atomic<uint64_t> done_{0}, all_{0};   // samples a pixel of all tiles, pilots included
  std::atomic<bool> over_{false};
};

} // namespace openrt

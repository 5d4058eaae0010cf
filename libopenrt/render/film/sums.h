// sums.h: statistics of a pixel's samples, gathered in double while they are taken, and how those
// of blocks of samples become one (docs/decisions/0028). The sums of any samples are the same bytes
// however these were divided into jobs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "render/film/ledger.h"
#include "render/path/sampler.h"
#include "scene/scene.h"

namespace openrt {

// What a frame's channels need to be gathered; the rest of the sums means nothing.
struct Gathering {
  bool spread = false;  // first, delta, delta2
  bool surface = false; // normal, albedo
  bool error = false;   // all
};
Gathering gatheringOf(const edit::FrameSettingsT& frame);

struct PixelSums { // of one pixel, samples added in their order
  double rgba[4] = {};
  float depth = 0, position[3] = {}, name = 0; // of sample 0
  uint32_t samples = 0;
  double first[3] = {}, delta[3] = {},
         delta2[3] = {}; // sums of (x - first) and its square: no cancellation
  double normal[3] = {}, albedo[3] = {};
  // Over the complete replicates: sums of their delta, of its square, cube and fourth power.
  double closed[3] = {}, closed2[3] = {}, closed3[3] = {}, closed4[3] = {};
  double grey[3] = {}; // sums of (red + green + blue - first)^2, ^3 and ^4; see addTails()
  float largest[3] = {};
  uint32_t replicates = 0; // complete ones
  bool random = false;     // a path has taken a random decision

  void add(const float radiance[3], float alpha) {
    for (int k = 0; k < 3; k++) {
      if (samples == 0) first[k] = radiance[k];
      const double d = radiance[k] - first[k];
      delta[k] += d;
      delta2[k] += d * d;
      rgba[k] += radiance[k];
    }
    rgba[3] += alpha;
    samples++;
  }
  void addColor(const float radiance[3],
                float alpha) { // instead of add(), where nobody asks for the spread
    for (int k = 0; k < 3; k++) rgba[k] += radiance[k];
    rgba[3] += alpha;
    samples++;
  }
  // After add(), where somebody asks for the error.
  void addTails(const float radiance[3]) {
    double grey1 = 0;
    for (int k = 0; k < 3; k++) {
      grey1 += radiance[k] - first[k];
      largest[k] = largest[k] < radiance[k] ? radiance[k] : largest[k];
    }
    const double grey2 = grey1 * grey1;
    grey[0] += grey2;
    grey[1] += grey2 * grey1;
    grey[2] += grey2 * grey2;
  }
  void closeReplicate();
  // Adds the samples that follow; a replicate that they complete is closed.
  void merge(const PixelSums& later, const Gathering& gathering, const Replicates& replicates);
};

// Empties sums for so many pixels.
void startSums(std::vector<PixelSums>& sums, size_t pixels, const Gathering& gathering);

// Samples of all pixels of a tile.
struct SumBlock {
  uint32_t first = 0, count = 0;
  std::vector<PixelSums> sums; // row by row
  Ledger ledger;
  uint32_t end() const { return first + count; }
  void append(const SumBlock& later, const Gathering& gathering, const Replicates& replicates);
};

// Frames of so many samples are made of leaves and may be made in rounds; of fewer, small waves
// would cost too much.
inline constexpr uint32_t fewestOfLeaves = 32;
// Samples that are always gathered in one go: [0,1) [1,2) [2,4) ... [16,32) [32,64) [64,96) ...;
// this one's end.
uint32_t leafEnd(uint32_t first, uint32_t end, uint32_t samplesOfFrame);
// Two aligned blocks that become one as soon as both are there.
inline bool siblings(uint32_t first, uint32_t count, uint32_t laterFirst, uint32_t laterCount) {
  return count == laterCount && (count & (count - 1)) == 0 && first + count == laterFirst &&
         first % (2 * count) == 0;
}
// The largest block from here that a job of at most so many samples (32 or more) may be.
uint32_t blockFrom(uint32_t first, uint32_t end, uint32_t largest);

// The blocks of one tile that are there, in any order; only what the frame gathers is kept. One
// thread at a time.
class TileSums {
 public:
  // The block becomes as large as it can with those that are there, which then are gone.
  void join(SumBlock& block, const Gathering& gathering, const Replicates& replicates);
  void keep(const SumBlock& block, const Gathering& gathering);
  uint32_t reach(
      const SumBlock* block) const; // samples from 0 on without a gap; block: not kept, may be null
  // These, one after the other from the left. Null: none, else block or out.
  const SumBlock* fold(const SumBlock* block, SumBlock& out, const Gathering& gathering,
                       const Replicates& replicates) const;
  void clear() { kept_ = {}; }
  bool empty() const { return kept_.empty(); }

 private:
  struct Kept {
    uint32_t first, count;
    Ledger ledger;
    std::vector<std::byte> bytes;
  };
  static void unpack(const Kept& from, SumBlock& to, const Gathering& gathering);
  std::vector<Kept> kept_; // by first
};

} // namespace openrt

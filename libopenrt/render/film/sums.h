// sums.h: statistics of a pixel's samples, accumulated in double, and how the sums of sample blocks
// are merged (docs/decisions/0028). The result has the same bytes however the samples were divided
// into jobs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "render/film/hit_counts.h"
#include "render/film/ledger.h"
#include "render/wave/sampler.h"
#include "scene/channels.h"
#include "scene/scene.h"

namespace openrt {

// Tells which sums the channels of a frame need; the other fields of PixelSums are undefined.
struct RequiredSums {
  bool spread = false; // true if first, delta and delta2 are needed
  bool error = false;  // true if all sums are needed
  bool names = false;  // true if the names of hits are counted
  // Numbers of elements of firstValues and of valueSums that are needed.
  uint32_t firstValues = 0, valueSums = 0;
};
RequiredSums requiredSums(const edit::FrameSettingsT& frame);

// Sums of one pixel, samples added in order. Sums that most frames need come first: a frame touches
// only as much of each pixel as its channels need.
struct PixelSums {
  double rgba[4] = {};
  uint32_t samples = 0;
  // The channels from ChannelSource::firstSample and from ChannelSource::mean, by
  // ChannelInfo::place: the values of sample 0, and the sums of the values of all samples.
  float firstValues[placesOf(ChannelSource::firstSample)] = {};
  double valueSums[placesOf(ChannelSource::mean)] = {};
  // Sums of (x - first) and of its square. The difference avoids cancellation.
  double first[3] = {}, delta[3] = {}, delta2[3] = {};
  // Over the complete replicates: sums of their delta, and of its square, cube and fourth power.
  double closed[3] = {}, closed2[3] = {}, closed3[3] = {}, closed4[3] = {};
  double grey[3] = {}; // sums of (red + green + blue - first)^2, ^3 and ^4; see addTails()
  float largest[3] = {};
  uint32_t replicates = 0; // number of complete replicates
  uint8_t random = 0; // RandomPath bits (wave/random_numbers.h) of all paths; not 0: one has taken
                      // a random decision

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
  // Replaces add() if the frame does not need the variance.
  void addColor(const float radiance[3], float alpha) {
    for (int k = 0; k < 3; k++) rgba[k] += radiance[k];
    rgba[3] += alpha;
    samples++;
  }
  // Adds the higher moments of a sample for the error estimate. Call after add().
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
  // Merges the sums of the samples that follow these; closes a replicate that they complete.
  void merge(const PixelSums& later, const RequiredSums& required, const Replicates& replicates);
};

// Clears the sums of the given number of pixels.
void startSums(std::vector<PixelSums>& sums, size_t pixels, const RequiredSums& required);

// The rays that were traced, and the hits at which a shader returned numbers that are not finite.
struct RayTotals {
  uint64_t camera = 0, shadow = 0, secondary = 0, faults = 0;
  void add(const RayTotals& more) {
    camera += more.camera;
    shadow += more.shadow;
    secondary += more.secondary;
    faults += more.faults;
  }
};

// Sums of consecutive samples of all pixels of a tile.
struct SumBlock {
  uint32_t first = 0, count = 0;
  std::vector<PixelSums> sums; // by pixel, row by row
  Ledger ledger;
  RayTotals rays;
  HitCounts hits;
  uint32_t end() const { return first + count; }
  void append(const SumBlock& later, const RequiredSums& required, const Replicates& replicates);
};

// Frames of at least this many samples are made of leaves and may be made in rounds. In smaller
// frames the small waves of leaves would cost too much.
inline constexpr uint32_t fewestOfLeaves = 32;
// Returns the end of the leaf that starts at `first`. The samples of a leaf are always taken
// together: [0,1) [1,2) [2,4) ... [16,32) [32,64) [64,96) ...
uint32_t leafEnd(uint32_t first, uint32_t end, uint32_t samplesOfFrame);
// Returns whether two aligned blocks are siblings, which are merged as soon as both exist.
inline bool siblings(uint32_t first, uint32_t count, uint32_t laterFirst, uint32_t laterCount) {
  return count == laterCount && (count & (count - 1)) == 0 && first + count == laterFirst &&
         first % (2 * count) == 0;
}
// Returns the size of the largest block from `first` that a job of at most `largest` samples (32 or
// more) may take.
uint32_t blockFrom(uint32_t first, uint32_t end, uint32_t largest);
// Does the same for frames whose sums are kept: the block is one of the tree, so that it can be
// used again in a longer frame, or beside blocks that exist already. `first` begins a leaf.
uint32_t treeBlockFrom(uint32_t first, uint32_t end, uint32_t largest, uint32_t samplesOfFrame);

// The finished blocks of one tile, in any order of arrival. Stores only the sums that the frame
// needs. One thread at a time.
class TileSums {
 public:
  // Merges the block with all its stored siblings and removes them.
  void join(SumBlock& block, const RequiredSums& required, const Replicates& replicates);
  void keep(const SumBlock& block, const RequiredSums& required);
  // Returns the number of samples from 0 on without a gap. block: a block that is not stored but is
  // counted as well; may be null.
  uint32_t reach(const SumBlock* block) const;
  // Merges the gapless blocks from the left. Returns `block` or `out`, or null if there is none.
  const SumBlock* fold(const SumBlock* block, SumBlock& out, const RequiredSums& required,
                       const Replicates& replicates) const;
  void clear() { kept_ = {}; }
  bool empty() const { return kept_.empty(); }
  // Calls `use` for each stored block, in the order of their samples.
  void forEach(const RequiredSums& required,
               const std::function<void(const SumBlock& block)>& use) const;

 private:
  struct StoredBlock {
    uint32_t first, count;
    Ledger ledger;
    RayTotals rays;
    HitCounts hits;
    std::vector<std::byte> bytes;
  };
  static void unpack(const StoredBlock& from, SumBlock& to, const RequiredSums& required);
  std::vector<StoredBlock> kept_; // sorted by first
};

} // namespace openrt

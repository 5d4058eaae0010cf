// frame_schedule.h: the order in which the jobs of a frame are handed out, and which jobs are
// outstanding. There are three kinds of frames:
// * frames made tile by tile;
// * frames with a time limit, made in rounds over the picture of one replicate each
//   (docs/decisions/0018);
// * progressive frames, which take the samples of an ordinary frame in doubling portions
//   (docs/decisions/0025).
// Part of FrameWork, called under its lock.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "render/frame/frame_work.h"

namespace openrt {

// The blocks of samples that a frame continues from, by tile and replicates.
class KnownBlocks {
 public:
  void add(uint32_t tile, const Replicates& replicates, uint32_t first, uint32_t count);
  // Returns the size of the block that begins at a sample; 0 if there is none.
  uint32_t countAt(uint32_t tile, const Replicates& replicates, uint32_t first) const;
  // Returns where the first block behind a sample begins; ~0u if there is none.
  uint32_t nextAfter(uint32_t tile, const Replicates& replicates, uint32_t first) const;
  // Returns the end of the block that has begun before a sample and contains it; or the sample.
  uint32_t endOf(uint32_t tile, const Replicates& replicates, uint32_t at) const;

 private:
  using Ranges = std::map<uint32_t, uint32_t>; // count by first sample
  std::map<std::tuple<uint32_t, uint32_t, uint32_t>, Ranges> tiles_;
  const Ranges* find(uint32_t tile, const Replicates& replicates) const;
};

class FrameSchedule {
 public:
  // now: seconds of a steady clock, here and below; used only with a time limit.
  FrameSchedule(const edit::FrameSettingsT& frame, const FrameFacts& facts, const TileGrid& grid,
                uint32_t threadCount, double now);

  enum class Stage : uint8_t {
    light,  // a part of light tracing
    early,  // a few light paths for display until the real ones are done
    pilot,  // pilot samples: they decide how many samples are needed and are thrown away
    samples // samples of the picture
  };
  struct OutstandingJob { // a job that was handed out and is not done
    Job job;
    Stage stage = Stage::samples;
    uint32_t until = 0;   // total number of samples of the tile in this stage
    bool further = false; // not the first pilot of the tile
    uint32_t round = 0;
    bool back = false; // returned by its worker; waits to be handed out again
  };

  // Sets the order of the tiles. Only before the first job, and only for frames that are not shown
  // before they are finished.
  void order(std::vector<uint32_t> tiles);
  // The sums of the frame are kept: jobs are blocks of the tree, and known blocks are handed out as
  // they are. `lightParts` parts of light tracing are done. Only before the first job.
  void keep(KnownBlocks known, uint32_t lightParts);
  // Returns the tile that next() will hand out; the number of tiles if there is none or it is not
  // known yet.
  uint32_t upcoming() const;
  // Hands out the next job. Returns false if no job is available now.
  bool next(Job& job, uint32_t largest, double now);
  // Takes a finished job off the outstanding ones. Returns nullopt if it is not outstanding.
  std::optional<OutstandingJob> claim(const Job& job);
  // Counts a job as done. Call after its result was merged.
  void done(const OutstandingJob& out, double now);
  void giveBack(const Job& job);
  // Counts a tile whose first pilot is done. Returns true for the last one.
  bool firstPilotDone() { return --unpiloted_ == 0; }
  // Sets the number of samples of a tile, as the pilots decided.
  void decided(uint32_t tile, uint32_t wanted);
  // Schedules a further pilot of `samples` for a tile.
  void addPilot(uint32_t tile, uint32_t samples);
  // Call when all parts of light tracing are complete.
  void lightComplete() { lightComplete_ = true; }
  bool over() const; // Returns whether all jobs were handed out and are done.

  bool rounds() const { return rounds_; } // the picture is shown before it is finished
  bool timed() const { return timed_; }
  uint32_t earlyParts() const { return earlyParts_; }
  double undone() const { return undone_; }
  float progress(double now) const;

 private:
  struct Key {
    uint8_t kind;
    uint32_t number, first, seed;
    bool operator==(const Key&) const = default;
  };
  struct KeyHash {
    size_t operator()(const Key& k) const { return hash(hash(k.number, k.first), k.seed + k.kind); }
  };
  static Key keyOf(const Job& job) {
    return {uint8_t(job.kind), job.number, job.first, job.replicates.seed};
  }
  static double costOf(const TileGrid& grid, const Job& job);
  void give(const OutstandingJob& out, Job& job, double now);
  bool nextLight(Job& job, double now);
  bool nextTile(Job& job, uint32_t largest, double now);
  void giveBlock(Job& job, OutstandingJob out, uint32_t tile, uint32_t& from, uint32_t end,
                 uint32_t largest, double now);
  uint32_t endOf(uint32_t tile) const;
  uint32_t tileAt(uint32_t place) const { return order_.empty() ? place : order_[place]; }
  Replicates replicatesOfTile(uint32_t tile) const;
  uint32_t beginOf(uint32_t tile) const;
  void skipTiles();
  bool endRound(double now);
  bool endTimed(double now);
  bool endProgressive();
  void wantLight();
  void wantMoreLight();
  uint32_t timedSamples(double took, double left) const;

  std::optional<KnownBlocks> known_; // none: sums are not kept
  const edit::FrameSettingsT frame_;
  const TileGrid grid_;
  const uint32_t tiles_;
  const bool lamps_, timed_, rounds_;
  bool pilot_; // with rounds: all tiles are in the pilot stage; otherwise: tiles have pilots
  bool lightComplete_ = false, ended_ = false;
  const uint32_t pilotSamples_;
  std::vector<uint32_t> wanted_; // samples by tile; known after the pilot
  // undecided_: tiles that pilots have not decided. unpiloted_: tiles whose first pilot is not
  // done.
  uint32_t undecided_, unpiloted_;
  std::vector<uint32_t> order_;      // empty: in the order of their numbers
  uint32_t nextTile_ = 0, from_ = 0; // position in the order
  struct Ready {
    uint32_t tile, from, pilot; // pilot: samples of a further pilot; 0: samples of the picture
  };
  // Tiles that need a further pilot; without rounds also the tiles that are decided.
  std::deque<Ready> ready_;
  // Without rounds: number of tiles that may be started before light tracing is complete; their
  // sums are kept.
  uint32_t ahead_;
  // Rounds.
  // most_: largest number of samples that a tile needs
  uint32_t round_ = 0, first_ = 0, samples_ = 0, most_ = 0;
  uint32_t outNow_ = 0, outBefore_ = 0; // outstanding tile jobs of this round, and of earlier ones
  Replicates replicates_;               // replicates of all tiles in timed frames
  double started_, began_;              // start times of the frame and of the round
  bool begun_ = false;
  // Light.
  // parts_: number of parts that are made in any case; timed frames add parts as rounds go on.
  uint32_t parts_ = 0, nextPart_ = 0, partsUntil_ = 0, partPaths_ = 0, nextEarly_ = 0,
           earlyUntil_ = 0, earlyPaths_ = 0;
  const uint32_t earlyParts_;

  std::unordered_map<Key, OutstandingJob, KeyHash> outstanding_;
  std::deque<Key> back_;
  // Amounts of work: pixels times samples, plus the number of light paths.
  double undone_ = 0, done_ = 0, all_ = 0;
};

} // namespace openrt

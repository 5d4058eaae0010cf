// frame_schedule.h: in which order the jobs of a frame are given out, and which are out. Three
// kinds of frames: made tile by tile; with a time limit, in rounds over the picture, of one
// replicate each (docs/decisions/0018); progressive ones, which take the samples of an ordinary
// frame in doubling portions (docs/decisions/0025). Part of FrameWork, under its lock.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <unordered_map>
#include <vector>

#include "render/frame/frame_work.h"

namespace openrt {

class FrameSchedule {
 public:
  // now: seconds of a steady clock, here and below; looked at only with a time limit.
  FrameSchedule(const edit::FrameSettingsT& frame, const FrameFacts& facts, const TileGrid& grid,
                uint32_t crew, double now);

  enum class Stage : uint8_t {
    light,  // that counts
    early,  // few paths of no consequence: shown while those that count are not there
    pilot,  // samples that do not count: they tell how many are needed
    samples // that count
  };
  struct Out { // a job that is given out
    Job job;
    Stage stage = Stage::samples;
    uint32_t until = 0;   // samples that the tile gets altogether, in this stage
    bool further = false; // a pilot that is not the first one
    uint32_t round = 0;
    bool back = false; // nobody has it
  };

  // Tiles in another order than their numbers'; of a frame that is not shown before it is finished,
  // and not begun.
  void order(std::vector<uint32_t> tiles);
  uint32_t upcoming() const; // the tile that next() comes to; their number: none, or it is open
  bool next(Job& job, uint32_t largest, double now); // false: not now
  std::optional<Out> claim(const Job& job);          // it has been done; none: it is not out
  void done(const Out& out, double now);             // and what it has made is where it belongs
  void giveBack(const Job& job);
  bool firstPilotDone() { return --unpiloted_ == 0; } // of a tile; true: of all of them
  void decided(uint32_t tile, uint32_t wanted);       // by pilots
  void pilotAgain(uint32_t tile, uint32_t samples);   // instead: a further pilot of so many
  void lit() { lit_ = true; }                         // all of the light is in
  bool over() const;                                  // everything has been given out and is done

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
  void give(const Out& out, Job& job, double now);
  bool nextLight(Job& job, double now);
  bool nextTile(Job& job, uint32_t largest, double now);
  void giveBlock(Job& job, Out out, uint32_t tile, uint32_t& from, uint32_t end, uint32_t largest,
                 double now);
  uint32_t endOf(uint32_t tile) const;
  uint32_t tileAt(uint32_t place) const { return order_.empty() ? place : order_[place]; }
  void skipTiles();
  bool endRound(double now);
  bool endTimed(double now);
  bool endProgressive();
  void wantLight();

  const edit::FrameSettingsT frame_;
  const TileGrid grid_;
  const uint32_t tiles_;
  const bool lamps_, timed_, rounds_;
  bool pilot_; // stage of all tiles in rounds; else tiles have pilots
  bool lit_ = false, ended_ = false;
  const uint32_t pilotSamples_;
  std::vector<uint32_t> wanted_; // by tile: samples; known after the pilot
  uint32_t undecided_,
      unpiloted_; // tiles without an answer of pilots; with a first pilot that is not done
  std::vector<uint32_t> order_;      // empty: by their numbers
  uint32_t nextTile_ = 0, from_ = 0; // place in the order
  struct Ready {
    uint32_t tile, from, pilot; // pilot: samples of a further one; 0: those that count
  };
  std::deque<Ready>
      ready_;      // tiles that need a further pilot; not in rounds: tiles that are decided, too
  uint32_t ahead_; // not in rounds: tiles that may be begun as long as light is missing, their sums
                   // are kept
  // Rounds.
  uint32_t round_ = 0, first_ = 0, samples_ = 0, most_ = 0; // most_: samples that any tile wants
  uint32_t outNow_ = 0, outBefore_ = 0; // tiles of this round, of earlier ones, that are out
  Replicates replicates_;               // of all tiles, if timed
  double started_, began_;              // the frame, the round
  bool begun_ = false;
  // Light.
  uint32_t nextPart_ = 0, partsUntil_ = 0, partPaths_ = 0, nextEarly_ = 0, earlyUntil_ = 0,
           earlyPaths_ = 0;
  const uint32_t earlyParts_;

  std::unordered_map<Key, Out, KeyHash> out_;
  std::deque<Key> back_;
  double undone_ = 0, done_ = 0, all_ = 0; // pixels times samples, paths
};

} // namespace openrt

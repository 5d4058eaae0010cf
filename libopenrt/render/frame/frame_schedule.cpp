// frame_schedule.cpp: the schedule. The samples of a picture depend only on the settings and on the
// pilots, and with a time limit also on the time. They never depend on who does which job.
#include "render/frame/frame_schedule.h"

#include <algorithm>
#include <bit>

#include "render/film/error.h"
#include "render/film/light_image.h"
#include "render/film/pilots.h"
#include "render/wave/light_stride.h"

namespace openrt {
namespace {

// Largest number of samples of a progressive round, so that the picture keeps improving everywhere.
constexpr uint32_t mostOfRound = 32;
constexpr uint32_t pilotSeed = 0x70696c6f, furtherSeed = 0x66757274, lightSeed = 0x6c616d70,
                   earlySeed = 0x6561726c;
constexpr double bytesAhead = 64 << 20; // memory for sums that wait for light tracing

bool makesRounds(const edit::FrameSettingsT& frame) {
  return frame.timeLimit > 0 ? frame.samples > 1
                             : frame.progressive && frame.samples >= fewestOfLeaves;
}

// Returns how many light paths a pixel gets at most where its number of camera paths is open. Their
// error falls with the root of their number: 64 are for a target of 5 % and for a time limit.
double openLightPaths(float targetError) {
  constexpr double paths = 64, target = .05;
  const double finer = targetError > 0 ? std::max(1.0, target / double(targetError)) : 1;
  return paths * finer * finer;
}

// Returns how many light paths go with one sample of the picture, where one goes with a camera path
// (RenderScene::lightPathsOfCameraPath): as many as camera paths that get light, and for sensors at
// least as many as for 16x16 of them, because the light of few sensors is no easier to find.
double lightPathsOfSample(const edit::FrameSettingsT& frame) {
  constexpr double fewestSensors = 256;
  const uint32_t stride = lightStrideOf(frame);
  return std::max(double(frame.width) * frame.height / (stride * stride),
                  frame.measure ? fewestSensors : 1.0);
}

// Returns the number of light paths. If the number of camera paths is open, at most
// openLightPaths() per pixel; with a time limit more may follow.
uint32_t lightPathsOf(const edit::FrameSettingsT& frame) {
  const bool open = frame.targetError > 0 || frame.timeLimit > 0;
  const double samples = frame.samples,
               paths = lightPathsOfSample(frame) *
                       (open ? std::min(samples, openLightPaths(frame.targetError)) : samples);
  return uint32_t(std::min(paths, 4e9));
}

// Parts of timed frames have at least this many paths, because there may be very many parts.
constexpr uint32_t fewestOfTimedPart = 2048;

} // namespace

void KnownBlocks::add(uint32_t tile, const Replicates& replicates, uint32_t first, uint32_t count) {
  tiles_[{tile, replicates.seed, replicates.shift}][first] = count;
}

const KnownBlocks::Ranges* KnownBlocks::find(uint32_t tile, const Replicates& replicates) const {
  const auto found = tiles_.find({tile, replicates.seed, replicates.shift});
  return found == tiles_.end() ? nullptr : &found->second;
}

uint32_t KnownBlocks::countAt(uint32_t tile, const Replicates& replicates, uint32_t first) const {
  const Ranges* ranges = find(tile, replicates);
  const auto found = ranges ? ranges->find(first) : Ranges::const_iterator{};
  return ranges && found != ranges->end() ? found->second : 0;
}

uint32_t KnownBlocks::nextAfter(uint32_t tile, const Replicates& replicates, uint32_t first) const {
  const Ranges* ranges = find(tile, replicates);
  if (!ranges) return ~0u;
  const auto found = ranges->upper_bound(first);
  return found == ranges->end() ? ~0u : found->first;
}

uint32_t KnownBlocks::endOf(uint32_t tile, const Replicates& replicates, uint32_t at) const {
  const Ranges* ranges = find(tile, replicates);
  if (!ranges) return at;
  const auto behind = ranges->lower_bound(at);
  if (behind == ranges->begin()) return at;
  const auto& [first, count] = *std::prev(behind);
  return std::max(at, first + count);
}

FrameSchedule::FrameSchedule(const edit::FrameSettingsT& frame, const FrameFacts& facts,
                             const TileGrid& grid, uint32_t threadCount, double now)
    : frame_(frame), grid_(grid), tiles_(facts.camera ? grid.count() : 0),
      lamps_(facts.lamps && tiles_ > 0), timed_(frame.timeLimit > 0 && makesRounds(frame)),
      rounds_(makesRounds(frame)), pilotSamples_(firstPilotOf(frame, timed_)),
      wanted_(tiles_, frame.samples), started_(now), began_(now),
      // A variance needs at least two parts.
      earlyParts_(std::clamp(threadCount + 1, 2u, LightImage::parts)) {
  pilot_ = pilotSamples_ > 0;
  undecided_ = unpiloted_ = pilot_ ? tiles_ : 0;
  most_ = frame.samples;
  samples_ = timed_ ? pilotSamples_ : rounds_ ? 1 : frame.samples;
  const double ahead = bytesAhead / (double(sizeof(PixelSums)) * grid.edge() * grid.edge());
  ahead_ = std::max(uint32_t(ahead), 4 * threadCount);
  all_ = double(grid.pixels()) * (double(frame.samples) + pilotSamples_);
  if (lamps_) {
    parts_ = LightImage::partsOf(frame);
    partPaths_ = lightPathsOf(frame) / parts_ + 1;
    if (timed_) partPaths_ = std::max(partPaths_, fewestOfTimedPart);
    earlyPaths_ =
        frame.width * frame.height / 2 / earlyParts_ + 1; // altogether half a path per pixel
    all_ += double(parts_) * partPaths_;
  }
  undone_ = all_;
  ended_ = tiles_ == 0;
  wantLight();
}

double FrameSchedule::costOf(const TileGrid& grid, const Job& job) {
  return job.kind == Job::Kind::light ? job.count
                                      : double(job.count) * double(grid.at(job.number).pixels());
}

void FrameSchedule::give(const OutstandingJob& out, Job& job, double now) {
  if (!begun_ && (out.job.kind == Job::Kind::samples || !pilot_)) {
    begun_ = true;
    began_ = now;
  }
  job = out.job;
  if (out.stage != Stage::early) undone_ -= costOf(grid_, job);
  if (job.kind == Job::Kind::samples) outNow_++;
  OutstandingJob& entry = outstanding_[keyOf(job)] = out;
  entry.round = round_;
}

void FrameSchedule::order(std::vector<uint32_t> tiles) {
  if (!rounds_ && nextTile_ == 0 && from_ == 0 && tiles.size() == tiles_) order_ = std::move(tiles);
}

void FrameSchedule::keep(KnownBlocks known, uint32_t lightParts) {
  known_ = std::move(known);
  nextPart_ = std::min(lightParts, parts_);
  done_ += double(nextPart_) * partPaths_;
  undone_ -= double(nextPart_) * partPaths_;
  wantLight();
}

uint32_t FrameSchedule::upcoming() const {
  if (!back_.empty() || nextEarly_ < earlyUntil_ || nextPart_ < partsUntil_) return tiles_;
  return !ready_.empty() ? ready_.front().tile : nextTile_ < tiles_ ? tileAt(nextTile_) : tiles_;
}

bool FrameSchedule::next(Job& job, uint32_t largest, double now) {
  while (!back_.empty()) {
    const auto found = outstanding_.find(back_.front());
    back_.pop_front();
    if (found == outstanding_.end() || !found->second.back) continue;
    found->second.back = false;
    job = found->second.job;
    if (found->second.stage != Stage::early) undone_ -= costOf(grid_, job);
    return true;
  }
  do {
    if (nextLight(job, now) || nextTile(job, largest, now)) return true;
  } while (endRound(now));
  return false;
}

bool FrameSchedule::nextLight(Job& job, double now) {
  OutstandingJob out;
  out.job.kind = Job::Kind::light;
  if (nextEarly_ < earlyUntil_) {
    out.stage = Stage::early;
    out.job.number = nextEarly_++;
    out.job.count = earlyPaths_;
    out.job.replicates.seed = hash(frame_.seed, earlySeed + out.job.number);
  } else if (nextPart_ < partsUntil_) {
    out.stage = Stage::light;
    out.job.number = nextPart_++;
    out.job.count = partPaths_;
    out.job.replicates.seed = hash(frame_.seed, lightSeed + out.job.number);
  } else {
    return false;
  }
  give(out, job, now);
  return true;
}

// Hands out the next block of a tile's samples, up to the end of its round, and advances `from`.
void FrameSchedule::giveBlock(Job& job, OutstandingJob out, uint32_t tile, uint32_t& from,
                              uint32_t end, uint32_t largest, double now) {
  const bool pilot = out.stage == Stage::pilot;
  out.job.number = tile;
  out.job.first = from;
  out.job.centred = out.until == 1 && !frame_.jitter && (pilot || !rounds_);
  if (pilot)
    out.job.replicates = replicatesOf(
        frame_, out.until, hash(frame_.seed, out.further ? furtherSeed + out.until : pilotSeed));
  else
    out.job.replicates = timed_ ? replicates_ : replicatesOf(frame_, out.until, frame_.seed);
  if (!known_) {
    out.job.count = blockFrom(from, end, largest);
  } else if (!(out.job.count = known_->countAt(tile, out.job.replicates, from))) {
    const uint32_t gap = std::min(end, known_->nextAfter(tile, out.job.replicates, from));
    out.job.count = treeBlockFrom(from, gap, largest, frame_.samples);
  }
  from += out.job.count;
  give(out, job, now);
}

bool FrameSchedule::nextTile(Job& job, uint32_t largest, double now) {
  const bool dark = lamps_ && !lightComplete_;
  if (timed_ && dark) return false;
  OutstandingJob out;
  if (!ready_.empty()) {
    Ready& ready = ready_.front();
    out.until = ready.pilot ? ready.pilot : wanted_[ready.tile];
    out.further = ready.pilot > 0;
    if (out.further) out.stage = Stage::pilot;
    giveBlock(job, out, ready.tile, ready.from, out.until, largest, now);
    if (ready.from >= out.until) ready_.pop_front();
    return true;
  }
  if (nextTile_ >= tiles_ || (!rounds_ && dark && nextTile_ >= ahead_)) return false;
  const uint32_t tile = tileAt(nextTile_);
  out.until = pilot_ ? pilotSamples_ : wanted_[tile];
  if (pilot_) out.stage = Stage::pilot;
  giveBlock(job, out, tile, from_, endOf(tile), largest, now);
  skipTiles();
  return true;
}

// Returns the end of a tile's samples in this round.
uint32_t FrameSchedule::endOf(uint32_t tile) const {
  const uint32_t all = pilot_ ? pilotSamples_ : wanted_[tile];
  return rounds_ ? std::min(first_ + samples_, all) : all;
}

// Returns the replicates of a tile's samples, or of its first pilot in the stage of pilots.
Replicates FrameSchedule::replicatesOfTile(uint32_t tile) const {
  return pilot_ ? replicatesOf(frame_, pilotSamples_, hash(frame_.seed, pilotSeed))
                : replicatesOf(frame_, wanted_[tile], frame_.seed);
}

// Returns the first sample of a tile in this round: known blocks may reach over several rounds.
uint32_t FrameSchedule::beginOf(uint32_t tile) const {
  return known_ && first_ > 0 ? known_->endOf(tile, replicatesOfTile(tile), first_) : first_;
}

// Advances to the next tile that has samples left in this round.
void FrameSchedule::skipTiles() {
  while (nextTile_ < tiles_ && from_ >= endOf(tileAt(nextTile_))) {
    nextTile_++;
    from_ = nextTile_ < tiles_ ? beginOf(tileAt(nextTile_)) : first_;
  }
}

std::optional<FrameSchedule::OutstandingJob> FrameSchedule::claim(const Job& job) {
  const auto found = outstanding_.find(keyOf(job));
  if (found == outstanding_.end() || !(found->second.job == job)) return std::nullopt;
  const OutstandingJob out = found->second;
  outstanding_.erase(found);
  if (out.back && out.stage != Stage::early) undone_ -= costOf(grid_, job);
  return out;
}

void FrameSchedule::done(const OutstandingJob& out, double now) {
  if (out.job.kind == Job::Kind::samples) (out.round == round_ ? outNow_ : outBefore_)--;
  if (out.stage != Stage::early) done_ += costOf(grid_, out.job);
  while (nextTile_ >= tiles_ && endRound(now)) {}
}

void FrameSchedule::giveBack(const Job& job) {
  const auto found = outstanding_.find(keyOf(job));
  if (found == outstanding_.end() || !(found->second.job == job) || found->second.back) return;
  found->second.back = true;
  back_.push_back(found->first);
  if (found->second.stage != Stage::early) undone_ += costOf(grid_, job);
}

void FrameSchedule::decided(uint32_t tile, uint32_t wanted) {
  const double saved = double(frame_.samples - wanted) * double(grid_.at(tile).pixels());
  undone_ -= saved;
  all_ -= saved;
  wanted_[tile] = wanted;
  undecided_--;
  if (!rounds_) ready_.push_back({tile, 0, 0});
}

void FrameSchedule::addPilot(uint32_t tile, uint32_t samples) {
  const double more = double(samples) * double(grid_.at(tile).pixels());
  undone_ += more;
  all_ += more;
  ready_.push_back({tile, 0, samples});
}

bool FrameSchedule::over() const {
  const bool given = rounds_ ? ended_ : nextTile_ >= tiles_ && ready_.empty() && undecided_ == 0;
  return given && outstanding_.empty() && outNow_ + outBefore_ == 0 &&
         (!lamps_ || (nextPart_ == partsUntil_ && lightComplete_));
}

// Starts the next round. Returns false if there is none, or if it must wait.
bool FrameSchedule::endRound(double now) {
  if (!rounds_ || ended_ || nextTile_ < tiles_) return false;
  const bool decides = pilot_ && first_ + samples_ >= pilotSamples_;
  // Jobs of at most two successive rounds are outstanding, so that the picture improves everywhere.
  if (outBefore_ > 0 || ((timed_ || decides) && outNow_ > 0) || (decides && undecided_ > 0))
    return false;
  ended_ = !(timed_ ? endTimed(now) : endProgressive());
  if (ended_) return false;
  if (earlyUntil_ == 0 && partsUntil_ == 0 && !lightComplete_)
    earlyUntil_ = lamps_ ? earlyParts_ : 0; // the first round is shown without light paths
  wantLight();
  outBefore_ = outNow_;
  outNow_ = 0;
  round_++;
  nextTile_ = 0;
  from_ = beginOf(tileAt(0));
  skipTiles();
  return true;
}

// Prepares the next timed round. Whether there is one depends only on the time and on the pilot,
// which is not part of the picture.
bool FrameSchedule::endTimed(double now) {
  const double took = now - began_, left = double(frame_.timeLimit) - (now - started_);
  bool more = true;
  if (pilot_) {
    replicates_ = {frame_.seed, uint32_t(std::bit_width(timedSamples(took, left))) - 1};
    most_ = *std::max_element(wanted_.begin(), wanted_.end());
    pilot_ = false;
  } else {
    first_ += samples_;
    // With less time left, the next round would overshoot the limit by more than this one falls
    // short of it.
    more = left >= took / 2;
  }
  samples_ = std::min(replicates_.size(), frame_.samples - std::min(first_, frame_.samples));
  begun_ = false;
  return more && first_ < most_;
}

// Returns the samples of a timed round, of which about sixteen fill the time that is left. The
// first light paths are done; later ones are as many as camera paths. took: time of the pilot's
// samples.
uint32_t FrameSchedule::timedSamples(double took, double left) const {
  const double camera = std::max(took, 1e-9) / samples_;
  double samples = left / camera;
  if (lamps_) {
    const double known = double(parts_) * partPaths_ / lightPathsOfSample(frame_),
                 light = std::max(began_ - started_, 0.0) / known;
    if (samples > known) samples = (left + known * light) / (camera + light);
  }
  const uint32_t most = std::max(frame_.samples / 16, 1u);
  return uint32_t(std::clamp(samples / 16, 1.0, double(most)));
}

// Prepares the next progressive round. Rounds consist of leaves (sums.h), so the picture's bytes
// equal those of an ordinary frame.
bool FrameSchedule::endProgressive() {
  first_ += samples_;
  if (pilot_ && first_ >= pilotSamples_) {
    most_ = *std::max_element(wanted_.begin(), wanted_.end());
    pilot_ = false;
    first_ = 0;
    samples_ = pilotSamples_; // a smaller first round would look noisier than the pilot
  } else
    samples_ = std::clamp(first_, 1u, mostOfRound);
  const uint32_t all = pilot_ ? pilotSamples_ : most_;
  samples_ = std::min(samples_, all - std::min(first_, all));
  return first_ < most_;
}

// Releases parts of light tracing. In progressive frames the parts are made gradually, like the
// samples. The early display affects neither the finished picture, which has all parts, nor the
// result of a pilot.
void FrameSchedule::wantLight() {
  if (!lamps_) return;
  const uint32_t all = pilot_ ? pilotSamples_ : most_;
  const bool whole = !rounds_ || timed_ || first_ + samples_ >= all;
  const auto share = uint32_t(double(first_) / most_ * parts_);
  if (whole)
    partsUntil_ = std::max(partsUntil_, parts_);
  else
    partsUntil_ = std::clamp(share, std::max(partsUntil_, nextPart_), parts_);
  if (timed_ && !pilot_) wantMoreLight();
}

// Releases the light paths of a timed round, so that they are as many as camera paths. Without them
// a longer time would not make caustics better.
void FrameSchedule::wantMoreLight() {
  const double samples = double(first_) + samples_,
               wanted = samples * lightPathsOfSample(frame_) / partPaths_;
  const auto until = uint32_t(std::min(wanted, double(LightImage::mostParts)));
  if (until <= partsUntil_) return;
  const double more = double(until - partsUntil_) * partPaths_;
  undone_ += more;
  all_ += more;
  partsUntil_ = until;
}

float FrameSchedule::progress(double now) const {
  if (over()) return 1;
  const double part =
      timed_ ? (now - started_) / double(frame_.timeLimit) : done_ / std::max(all_, 1.0);
  return std::min(float(part), 0.99f);
}

} // namespace openrt

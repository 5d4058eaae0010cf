// frame_work.cpp: merging of results. Locks: `mutex` guards the schedule and the outstanding jobs.
// Each tile has a lock for its sums and its place in the film, so that several threads merge and
// store tiles at once. A tile's lock is never taken while `mutex` is held.
// Longer than 500 lines because all of it works on one state under these locks.
#include "render/frame/frame_work.h"

#include <algorithm>
#include <cstdio>
#include <deque>
#include <map>
#include <mutex>
#include <shared_mutex>
#include <tuple>

#include "render/film/error.h"
#include "render/film/light_image.h"
#include "render/film/pilots.h"
#include "render/flush_denormals.h"
#include "render/frame/frame_schedule.h"
#include "render/frame/frame_sums.h"
#include "render/frame/result_codec.h"
#include "render/wave/light_stride.h"
#include "scene/quality.h"
#include "steady_clock.h"

namespace openrt {
namespace {

using Stage = FrameSchedule::Stage;

ErrorMap::Kind errorsOf(const edit::FrameSettingsT& frame) {
  // The middle of a pixel has no edge that could cut its corner (ErrorMap::doubtConstants).
  if (wantsError(frame)) return frame.measure ? ErrorMap::Kind::summary : ErrorMap::Kind::full;
  return frame.samples > 1 && (frame.channels & RT_VARIANCE) ? ErrorMap::Kind::summary
                                                             : ErrorMap::Kind::none;
}

struct TileState {
  std::mutex mutex;
  TileSums sums; // sums of tiles that are incomplete or wait for light tracing
  Ledger ledger;
  bool shown = false;
  // Where sums are kept: the blocks of complete stages, the replicates of the stage in `sums`, and
  // whether that stage is complete, so that its blocks are in `done`.
  std::vector<KeptBlock> done;
  Replicates replicates;
  bool waits = false;
};

RayTotals totalsOf(const RayCounters& counters) {
  return {counters.camera, counters.shadow, counters.secondary,
          counters.faults.count(Fault::notFinite)};
}

LightImage::Kept keptOf(const edit::FrameSettingsT& frame, bool errors) {
  return !errors                             ? LightImage::Kept::means
         : poolingOf(frame) == Pooling::none ? LightImage::Kept::sensors
                                             : LightImage::Kept::pixels;
}

} // namespace

struct FrameWork::Impl {
  Impl(const edit::FrameSettingsT& f, const FrameFacts& frameFacts, uint32_t threadCount,
       const KeepSums& keepSums)
      : frame(f), facts(frameFacts), kept(keepSums), grid(frame),
        count(facts.camera ? grid.count() : 0), required(requiredSums(frame)),
        film(frame.width, frame.height, frame.channels, errorsOf(frame)),
        tiles(std::make_unique<TileState[]>(count)),
        schedule(frame, facts, grid, threadCount, steadySeconds()) {
    if (frame.targetError > 0 && count > 0)
      pilots = std::make_unique<Pilots>(frame, grid, schedule.timed());
    if (!facts.lamps || count == 0) return;
    const LightImage::Kept keeps = keptOf(frame, !film.errors().empty());
    const uint32_t parts = LightImage::partsOf(frame);
    light = std::make_unique<LightImage>(frame.width, frame.height, parts, keeps);
    lightRays.resize(parts);
    if (schedule.rounds())
      early = std::make_unique<LightImage>(frame.width, frame.height, schedule.earlyParts(), keeps);
  }

  bool lightComplete() const { return !light || light->complete(); }
  bool fits(const Job& job, const JobResult& result) const;
  void addSamples(const FrameSchedule::OutstandingJob& out, JobResult& result);
  void addLight(const FrameSchedule::OutstandingJob& out, JobResult& result);
  void finish(const FrameSchedule::OutstandingJob& out, const SumBlock& all, TileState& state);
  void store(const Tile& tile, const SumBlock& block, const Replicates& replicates, bool show,
             const FrameSchedule::OutstandingJob* pilot = nullptr);
  void decide(const FrameSchedule::OutstandingJob& pilot, const std::vector<PilotPixel>& pixels,
              const std::vector<PixelError>& errors);
  void apply(uint32_t tile, const Pilots::Decision& decision);
  double pathsOf(uint32_t tile) const {
    return double(tiles[tile].ledger.samples) * double(grid.at(tile).pixels());
  }
  void judgeErrors();
  void showAllLight();
  void advance();
  void finishWaitingTiles();
  void notifyChange();
  void resume();
  void add(const RayTotals& rays);
  RTerrorStats errorStats() const; // the error of the picture, once over
  bool findKnown(const Job& job, KeptBlock& block);
  void keepBlock(TileState& state, const SumBlock& block) const;
  KeptBlock encoded(const SumBlock& block, const Replicates& replicates) const;
  void develop(const FrameSums& sums);

  const edit::FrameSettingsT frame;
  const FrameFacts facts;
  KeepSums kept;
  const TileGrid grid;
  const uint32_t count; // tiles
  const RequiredSums required;
  Film film;
  mutable std::shared_mutex ending; // exclusive while the picture as a whole is evaluated
  double unmet = 0;                 // RTerrorStats.unmet, once over
  std::unique_ptr<TileState[]> tiles;
  std::unique_ptr<LightImage> light, early; // null if there is no light tracing
  std::unique_ptr<Pilots> pilots;           // null without a target error

  mutable std::mutex mutex; // guards everything below
  FrameSchedule schedule;
  std::deque<FrameSchedule::OutstandingJob> waiting; // complete tiles that wait for light tracing
  uint32_t busy = 0;                                 // threads that are merging a result
  bool cancelled = false, finishing = false, over = false, waited = false;
  RayCounters counters;
  uint64_t faultsBefore = 0; // shader faults of the jobs that the frame continues from
  // Where sums are kept: rays by part of light tracing, and the blocks that are not used yet.
  std::vector<RayTotals> lightRays;
  RayTotals lightRaysBefore;
  std::map<std::tuple<uint32_t, uint32_t, uint32_t, uint32_t>, KeptBlock> known;
  std::function<void()> changed;
};

bool FrameWork::Impl::fits(const Job& job, const JobResult& result) const {
  if (job.kind == Job::Kind::light)
    return result.light.size() == size_t(frame.width) * frame.height * 3;
  return job.number < count && result.sums.size() == grid.at(job.number).pixels();
}

// Writes the tile's samples so far, a block, plus the light paths so far, to the film (if `show`).
// pilot: a complete pilot that decides on the number of samples; else null.
void FrameWork::Impl::store(const Tile& tile, const SumBlock& block, const Replicates& replicates,
                            bool show, const FrameSchedule::OutstandingJob* pilot) {
  const std::vector<PixelSums>& sums = block.sums;
  std::vector<LightSums> lights;
  if (light && light->added() > 1)
    light->read(tile, lights);
  else if (early && early->complete())
    early->read(tile, lights);
  const bool lamps = !lights.empty();
  // Only pixels without light of their own show light paths then, so that callers can tell the two
  // apart and use all light paths of a block.
  const bool strides = lightStrideOf(frame) > 1;
  std::vector<PixelError> errors;
  if (!film.errors().empty()) {
    errors.resize(sums.size());
    if (required.error)
      tileErrors(tile.width(), sums, replicates, errors, poolingOf(frame));
    else
      for (size_t i = 0; i < sums.size(); i++) errors[i] = independentError(sums[i]);
  }
  std::vector<PilotPixel> pilotPixels(pilot ? sums.size() : 0);
  size_t i = 0;
  for (uint32_t y = tile.y0; y < tile.y1; y++)
    for (uint32_t x = tile.x0; x < tile.x1; x++, i++) {
      PixelError* error = errors.empty() ? nullptr : &errors[i];
      if (pilot)
        pilotPixels[i] = pilotPixel(errors[i], lamps ? &lights[i] : nullptr);
      else if (error && lamps)
        openrt::addLight(lights[i], *error);
      const bool adds = lamps && !(strides && sums[i].samples > 0);
      if (show) film.store(x, y, sums[i], adds ? &lights[i] : nullptr, error);
    }
  if (show) film.storeHits(tile, block.hits, sums);
  if (pilot) decide(*pilot, pilotPixels, errors);
}

// Decides on the tile's next samples. Called under the tile's lock.
void FrameWork::Impl::decide(const FrameSchedule::OutstandingJob& pilot,
                             const std::vector<PilotPixel>& pixels,
                             const std::vector<PixelError>& errors) {
  const uint32_t tile = pilot.job.number;
  if (pilot.further) {
    const Pilots::Decision decision = pilots->decide(tile, pixels, pilot.until);
    std::lock_guard lock(mutex);
    apply(tile, decision);
    return;
  }
  pilots->note(tile, pixels, errors);
  {
    std::lock_guard lock(mutex);
    if (!schedule.firstPilotDone()) return;
  }
  // No other thread uses the pilots now.
  const std::vector<Pilots::Decision> decisions = pilots->decideAll();
  std::lock_guard lock(mutex);
  for (uint32_t i = 0; i < count; i++) apply(i, decisions[i]);
}

// Passes a pilot's decision to the schedule. Called under `mutex`.
void FrameWork::Impl::apply(uint32_t tile, const Pilots::Decision& decision) {
  if (decision.pilot)
    schedule.addPilot(tile, decision.samples);
  else
    schedule.decided(tile, decision.samples);
}

// Finishes a stage of a tile whose samples and light paths are complete. Called under the tile's
// lock.
void FrameWork::Impl::finish(const FrameSchedule::OutstandingJob& out, const SumBlock& all,
                             TileState& state) {
  const bool pilot = out.stage == Stage::pilot,
             show = !pilot || (schedule.rounds() && !out.further);
  const bool decides = pilot && pilots;
  store(grid.at(out.job.number), all, out.job.replicates, show, decides ? &out : nullptr);
  state.shown |= show;
  if (!pilot) state.ledger = all.ledger;
  if (!pilot || decides) return;
  std::lock_guard lock(mutex); // the pilot only measured the time
  schedule.decided(out.job.number, frame.samples);
}

void FrameWork::Impl::addSamples(const FrameSchedule::OutstandingJob& out, JobResult& result) {
  const Job& job = out.job;
  TileState& state = tiles[job.number];
  std::lock_guard tileLock(state.mutex);
  SumBlock block{job.first,
                 job.count,
                 std::move(result.sums),
                 result.ledger,
                 kept.keep ? totalsOf(result.counters) : RayTotals(),
                 std::move(result.hits)};
  block.rays.faults += result.faultsBefore;
  SumBlock room;
  state.replicates = job.replicates;
  state.sums.join(block, required, job.replicates);
  const uint32_t reach = state.sums.reach(&block);
  const bool complete = reach == out.until;
  const bool showsParts = schedule.rounds() && !out.further;
  const SumBlock* all =
      complete || showsParts ? state.sums.fold(&block, room, required, job.replicates) : nullptr;
  if (complete && kept.keep) {
    state.sums.forEach(required, [&](const SumBlock& one) { keepBlock(state, one); });
    keepBlock(state, block);
  }
  if (complete && lightComplete()) {
    finish(out, *all, state);
    state.sums.clear();
  } else {
    if (all && showsParts) {
      store(grid.at(job.number), *all, job.replicates, true);
      state.shown = true;
      if (out.stage == Stage::samples) state.ledger = all->ledger;
    }
    if (complete) state.sums.clear();
    state.sums.keep(complete ? *all : block, required);
    state.waits = complete;
    if (complete) {
      std::lock_guard lock(mutex);
      waiting.push_back(out);
    }
  }
  result.sums = std::move(block.sums); // its memory is reused for the next job
}

// --- Kept sums ---

KeptBlock FrameWork::Impl::encoded(const SumBlock& block, const Replicates& replicates) const {
  KeptBlock out{replicates, block.first, block.count, block.rays, nullptr};
  JobResult result;
  result.sums = block.sums;
  result.hits = block.hits;
  result.ledger = block.ledger;
  out.bytes =
      std::make_shared<const std::vector<std::byte>>(encodeResult(frame, jobOf(0, out), result));
  return out;
}

// Keeps a block of a complete stage. Called under the tile's lock.
void FrameWork::Impl::keepBlock(TileState& state, const SumBlock& block) const {
  state.done.push_back(encoded(block, state.replicates));
}

void FrameWork::Impl::add(const RayTotals& rays) {
  counters.camera += rays.camera;
  counters.shadow += rays.shadow;
  counters.secondary += rays.secondary;
  faultsBefore += rays.faults;
}

// Takes the results that the frame continues from. Called before the first job.
void FrameWork::Impl::resume() {
  if (frame.timeLimit > 0) throw SumsError("sums of a frame with a time limit cannot be kept");
  KnownBlocks blocks;
  uint32_t parts = 0;
  if (const FrameSums* from = kept.from.get()) {
    checkContinues(*from, frame, facts, kept.identity);
    const SeedSums& sums = from->seeds[0];
    for (uint32_t tile = 0; tile < count; tile++)
      for (const KeptBlock& block : sums.tiles[tile]) {
        if (!isBlockOf(block, from->frame.samples, frame.samples)) continue;
        blocks.add(tile, block.replicates, block.first, block.count);
        known[{tile, block.replicates.seed, block.replicates.shift, block.first}] = block;
      }
    // The number of light paths depends on the samples.
    if (light && from->frame.samples == frame.samples && sums.light.added > 0) {
      if (!light->restore(sums.light)) throw SumsError("the kept sums are damaged");
      parts = sums.light.added;
      lightRaysBefore = sums.lightRays;
      add(sums.lightRays);
    }
  }
  kept.from = nullptr;
  schedule.keep(std::move(blocks), parts);
  if (parts > 0 && light->complete()) schedule.lightComplete();
}

// Finds the block of a job among those that the frame continues from. Returns false if there is
// none. Called under `mutex`.
bool FrameWork::Impl::findKnown(const Job& job, KeptBlock& block) {
  if (known.empty() || job.kind != Job::Kind::samples) return false;
  const auto found = known.find({job.number, job.replicates.seed, job.replicates.shift, job.first});
  if (found == known.end() || found->second.count != job.count) return false;
  block = found->second;
  return true;
}

// Makes the picture of condensed sums.
void FrameWork::Impl::develop(const FrameSums& sums) {
  const FlushDenormals flush;
  if (!sums.condensed || sums.seeds.empty()) throw SumsError("the sums are not those of a picture");
  if (light) {
    LightImage::State all = sums.seeds[0].light;
    for (size_t i = 1; i < sums.seeds.size(); i++)
      LightImage::merge(all, sums.seeds[i].light, keptOf(frame, !film.errors().empty()));
    if (!light->restore(all, true)) throw SumsError("the sums are damaged");
    early = nullptr;
  }
  for (uint32_t tile = 0; tile < count; tile++) {
    SumBlock all;
    for (const SeedSums& seeds : sums.seeds) {
      SumBlock next;
      decodeSeeds(sums.frame, grid.at(tile), seeds, seeds.tiles[tile].at(0), next);
      if (all.sums.empty())
        all = std::move(next);
      else
        all.append(next, required, seeds.tiles[tile].at(0).replicates);
    }
    store(grid.at(tile), all, sums.seeds[0].tiles[tile].at(0).replicates, true);
    tiles[tile].ledger = all.ledger;
    tiles[tile].shown = true;
    add(all.rays);
  }
  for (const SeedSums& seeds : sums.seeds) add(seeds.lightRays);
  judgeErrors();
  over = true;
}

void FrameWork::Impl::addLight(const FrameSchedule::OutstandingJob& out, JobResult& result) {
  if (kept.keep && out.stage == Stage::light) {
    std::lock_guard lock(mutex);
    lightRays[out.job.number] = totalsOf(result.counters);
  }
  (out.stage == Stage::early ? early : light)->add(out.job.number, std::move(result.light));
  if (!light->complete()) return;
  std::lock_guard lock(mutex);
  schedule.lightComplete();
}

// Finishes tiles that have waited for light tracing. May run on several threads at once.
void FrameWork::Impl::finishWaitingTiles() {
  if (!lightComplete()) return;
  std::unique_lock lock(mutex);
  while (!waiting.empty() && !cancelled) {
    const FrameSchedule::OutstandingJob out = waiting.front();
    waiting.pop_front();
    busy++;
    lock.unlock();
    {
      TileState& state = tiles[out.job.number];
      std::lock_guard tileLock(state.mutex);
      SumBlock all;
      state.sums.fold(nullptr, all, required, out.job.replicates);
      finish(out, all, state);
      state.sums.clear();
      state.waits = false;
    }
    lock.lock();
    busy--;
  }
}

// Evaluates the errors of the finished picture as a whole.
void FrameWork::Impl::judgeErrors() {
  film.finishErrors();
  if (film.errors().empty()) return;
  double paths = 0;
  Ledger whole;
  for (uint32_t i = 0; i < count; i++) {
    paths += pathsOf(i);
    whole.add(tiles[i].ledger);
  }
  unmet = whole.missedRadiance(whole, paths);
  // Whether a tile is trusted depends on the emitters that its own paths have hit. Paths elsewhere
  // in the picture may have hit another lamp.
  for (uint32_t i = 0; i < count; i++) {
    const Ledger& tile = tiles[i].ledger;
    film.addMissing(grid.at(i), tile.missedByTile(pathsOf(i)),
                    tile.missedRadiance(whole, pathsOf(i)));
  }
}

// Writes the tiles of a frame with a time limit again. When they were stored, light paths of their
// round may have been missing.
void FrameWork::Impl::showAllLight() {
  for (uint32_t i = 0; i < count; i++) {
    TileState& state = tiles[i];
    std::lock_guard tileLock(state.mutex);
    SumBlock all;
    if (state.sums.fold(nullptr, all, required, state.replicates))
      store(grid.at(i), all, state.replicates, true);
  }
}

// Finishes waiting tiles, and the frame if nothing is left to do. Called after each change.
void FrameWork::Impl::advance() {
  finishWaitingTiles();
  bool last = false, more = false; // more: light paths may have come after the tiles were stored
  {
    std::lock_guard lock(mutex);
    last = !finishing && busy == 0 && (cancelled || (schedule.over() && waiting.empty()));
    finishing |= last;
    more = last && !cancelled && light && schedule.timed();
  }
  if (last) {
    {
      std::unique_lock alone(ending);
      if (more) showAllLight();
      judgeErrors();
    }
    std::lock_guard lock(mutex);
    over = true;
  }
  notifyChange();
}

void FrameWork::Impl::notifyChange() {
  std::function<void()> call;
  {
    std::lock_guard lock(mutex);
    if (!waited && !over) return;
    waited = false;
    call = changed;
  }
  if (call) call();
}

FrameWork::FrameWork(const edit::FrameSettingsT& settings, const FrameFacts& facts,
                     uint32_t threadCount, const KeepSums& kept)
    : impl_(std::make_unique<Impl>(settings, facts, threadCount, kept)) {
  if (kept.keep) impl_->resume();
  impl_->advance();
}

FrameWork::FrameWork(const FrameSums& sums)
    : impl_(std::make_unique<Impl>(sums.frame, sums.facts, 1, KeepSums())) {
  impl_->develop(sums);
}

FrameWork::~FrameWork() = default;

FrameWork::Next FrameWork::next(Job& job, uint32_t largest) {
  Impl& m = *impl_;
  std::unique_lock lock(m.mutex);
  if (!m.waiting.empty() && m.lightComplete()) {
    lock.unlock();
    const FlushDenormals flush;
    m.advance();
    lock.lock();
  }
  KeptBlock block;
  while (!m.over && !m.cancelled && m.schedule.next(job, largest, steadySeconds())) {
    if (!m.findKnown(job, block)) return Next::job;
    lock.unlock();
    JobResult result;
    if (!decodeResult(m.frame, job, m.grid.at(job.number), *block.bytes, result))
      throw SumsError("the kept sums are damaged");
    result.counters.camera = block.rays.camera;
    result.counters.shadow = block.rays.shadow;
    result.counters.secondary = block.rays.secondary;
    result.faultsBefore = block.rays.faults;
    take(job, std::move(result));
    lock.lock();
    m.known.erase({job.number, job.replicates.seed, job.replicates.shift, job.first});
  }
  if (m.over) return Next::over;
  m.waited = true;
  return Next::wait;
}

void FrameWork::order(std::vector<uint32_t> tiles) {
  std::lock_guard lock(impl_->mutex);
  impl_->schedule.order(std::move(tiles));
}

uint32_t FrameWork::upcoming() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->schedule.upcoming();
}

void FrameWork::giveBack(const Job& job) {
  {
    std::lock_guard lock(impl_->mutex);
    impl_->schedule.giveBack(job);
  }
  impl_->notifyChange();
}

bool FrameWork::take(const Job& job, JobResult&& result) {
  Impl& m = *impl_;
  std::optional<FrameSchedule::OutstandingJob> out;
  {
    std::lock_guard lock(m.mutex);
    if (m.cancelled || !m.fits(job, result)) return false;
    out = m.schedule.claim(job);
    if (!out) return false;
    m.busy++;
    m.counters.faults.add(result.counters.faults);
    // The rays of early light depend on the number of threads. They would make the statistics of a
    // frame that is continued differ from those of one that was not interrupted.
    RayTotals rays = totalsOf(result.counters);
    rays.faults = result.faultsBefore;
    if (!m.kept.keep || out->stage != Stage::early) m.add(rays);
  }
  const FlushDenormals flush;
  if (job.kind == Job::Kind::light)
    m.addLight(*out, result);
  else
    m.addSamples(*out, result);
  {
    std::lock_guard lock(m.mutex);
    m.schedule.done(*out, steadySeconds());
    m.busy--;
  }
  m.advance();
  return true;
}

void FrameWork::cancel() {
  {
    std::lock_guard lock(impl_->mutex);
    impl_->cancelled = true;
  }
  impl_->advance();
}

bool FrameWork::over() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->over;
}

void FrameWork::onChange(std::function<void()> changed) {
  std::lock_guard lock(impl_->mutex);
  impl_->changed = std::move(changed);
}

uint32_t FrameWork::tiles() const { return impl_->count; }
Tile FrameWork::tile(uint32_t number) const { return impl_->grid.at(number); }

double FrameWork::undone() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->cancelled ? 0 : impl_->schedule.undone();
}

float FrameWork::progress() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->over ? 1.0f : impl_->schedule.progress(steadySeconds());
}

bool FrameWork::snapshot(uint32_t channel, std::span<float> out) const {
  std::shared_lock notEnding(impl_->ending);
  if (!impl_->film.clear(channel, out)) return false;
  // Locks one tile at a time, so that merging threads do not wait for long.
  for (uint32_t i = 0; i < impl_->count; i++) {
    std::lock_guard lock(impl_->tiles[i].mutex);
    if (impl_->tiles[i].shown) impl_->film.copy(channel, tile(i), out);
  }
  return true;
}

const Film& FrameWork::film() const { return impl_->film; }

std::shared_ptr<FrameSums> FrameWork::sums() const {
  const Impl& m = *impl_;
  if (!m.kept.keep) return nullptr;
  auto out = std::make_shared<FrameSums>();
  out->frame = m.frame;
  out->facts = m.facts;
  out->identity = m.kept.identity;
  SeedSums& sums = out->seeds.emplace_back();
  sums.first = m.frame.seed;
  // Blocks that wait to be handed out go before those that are done: no block may get lost between.
  std::map<uint32_t, std::vector<KeptBlock>> waiting;
  {
    std::lock_guard lock(m.mutex);
    out->complete = m.over && !m.cancelled;
    for (const auto& [key, block] : m.known) waiting[std::get<0>(key)].push_back(block);
  }
  sums.tiles.resize(m.count);
  for (uint32_t i = 0; i < m.count; i++) {
    TileState& state = m.tiles[i];
    std::lock_guard lock(state.mutex);
    std::vector<KeptBlock>& blocks = sums.tiles[i] = state.done;
    if (!state.waits)
      state.sums.forEach(m.required, [&](const SumBlock& one) {
        blocks.push_back(m.encoded(one, state.replicates));
      });
    const auto overlaps = [&](const KeptBlock& block) {
      return std::any_of(blocks.begin(), blocks.end(), [&](const KeptBlock& b) {
        return b.replicates == block.replicates && b.first < block.first + block.count &&
               block.first < b.first + b.count;
      });
    };
    for (KeptBlock& block : waiting[i])
      if (!overlaps(block)) blocks.push_back(std::move(block));
  }
  if (m.light) {
    sums.light = m.light->state();
    std::lock_guard lock(m.mutex);
    sums.lightRays = m.lightRaysBefore;
    for (uint32_t i = 0; i < std::min<size_t>(sums.light.added, m.lightRays.size()); i++)
      sums.lightRays.add(m.lightRays[i]);
  }
  return out;
}

RayCounters FrameWork::counters() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->counters;
}

void FrameWork::describe(RTstats& stats) const {
  stats.error = impl_->errorStats();
  Ledger all;
  for (uint32_t i = 0; i < impl_->count; i++) all.addMean(impl_->tiles[i].ledger);
  const double pixels = std::max(double(impl_->grid.pixels()), 1.0);
  const std::lock_guard lock(impl_->mutex);
  const RayCounters& rays = impl_->counters;
  stats.rays = {rays.camera, rays.shadow, rays.secondary};
  stats.leftOut = {all.cutByDepth / pixels, all.cutByEnergy / pixels, all.clipped / pixels,
                   rays.faults.count(Fault::notFinite) + impl_->faultsBefore};
}

RTerrorStats FrameWork::Impl::errorStats() const {
  RTerrorStats stats{};
  const bool known = !film.errors().empty();
  if (known) stats = film.errors().summary();
  stats.level = 0.95;
  if (!known) return stats;
  stats.unmet = unmet;
  const bool many = schedule.timed() || replicatesOf(frame, frame.samples, 0).many();
  std::snprintf(stats.method, sizeof stats.method, "%s",
                many ? "replicated nets, Student's t" : "sample variance");
  return stats;
}

} // namespace openrt

// renderer.cpp: tiles on demand. The picture does not depend on which thread renders which tile.
#include "render/renderer.h"

#include <sched.h>
#include <xmmintrin.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>

#include "render/light_tracer.h"

namespace openrt {
namespace {

ErrorMap::Kind errorsOf(const edit::FrameSettingsT& frame) {
  if (wantsError(frame)) return ErrorMap::Kind::full;
  return frame.samples > 1 && (frame.channels & RT_VARIANCE) ? ErrorMap::Kind::summary : ErrorMap::Kind::none;
}

// As many paths from lamps as from the camera; where the number of these is open, at most a few for each pixel.
uint32_t lightPathsOf(const edit::FrameSettingsT& frame) {
  constexpr uint32_t mostOfOpen = 64;
  const bool open = frame.targetError > 0 || frame.timeLimit > 0;
  const double paths = double(frame.width) * frame.height * (open ? std::min(frame.samples, mostOfOpen) : frame.samples);
  return uint32_t(std::min(paths, 4e9));
}

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// CPUs' worth of time a control group (version 2) grants, 0 if it does not limit.
double groupQuota() {
  FILE* file = std::fopen("/sys/fs/cgroup/cpu.max", "re");
  if (!file) return 0;
  double quota = 0, period = 0;
  const int read = std::fscanf(file, "%lf %lf", &quota, &period); // "max 100000" reads nothing
  std::fclose(file);
  return read == 2 && period > 0 ? quota / period : 0;
}

} // namespace

uint32_t availableThreads() {
  cpu_set_t set;
  CPU_ZERO(&set);
  uint32_t count = sched_getaffinity(0, sizeof set, &set) == 0 ? uint32_t(CPU_COUNT(&set)) : std::thread::hardware_concurrency();
  if (const double quota = groupQuota(); quota > 0) count = std::min(count, uint32_t(std::ceil(quota)));
  return std::max(count, 1u);
}

Frame::Frame(std::shared_ptr<const RenderScene> scene, uint32_t threads)
    : scene_(std::move(scene)), film_(scene_->frame.width, scene_->frame.height, scene_->frame.channels, errorsOf(scene_->frame)),
      edge_(scene_->frame.tile ? scene_->frame.tile : tileEdge(scene_->frame.samples, film_.width(), film_.height())),
      columns_((film_.width() + edge_ - 1) / edge_), tiles_(columns_ * ((film_.height() + edge_ - 1) / edge_)), started_(now()) {
  if (!scene_->camera.shader.shaderClass) tiles_ = 0; // nothing is seen without a camera
  finished_ = std::make_unique<std::atomic<bool>[]>(tiles_);
  ledgers_.resize(tiles_);
  rounds_ = Rounds::of(scene_->frame, tiles_, scene_->lightSources != nullptr, started_);
  crew_ = std::min(threads, std::max(tiles_, 1u));
  barrier_ = std::make_unique<std::barrier<EndRound>>(crew_, EndRound{this});
  if (scene_->lightSources && tiles_ > 0) {
    light_ = std::make_unique<LightImage>(film_.width(), film_.height());
    partPaths_ = lightPathsOf(scene_->frame) / LightImage::parts + 1;
    lit_ = std::make_unique<std::barrier<>>(crew_);
    wantParts();
  }
  for (uint32_t i = 0; i < crew_; i++) threads_.emplace_back([this] { work(); });
}

Frame::~Frame() {
  cancel();
  wait();
}

void Frame::wait() {
  if (threads_.empty()) return;
  for (auto& thread : threads_) thread.join();
  threads_.clear();
  counters_.faults.report(scene_->host.logCallback, scene_->host.logUser);
}

Tile Frame::tile(uint32_t number) const {
  const uint32_t x = number % columns_ * edge_, y = number / columns_ * edge_;
  return {x, y, std::min(x + edge_, film_.width()), std::min(y + edge_, film_.height())};
}

bool Frame::snapshot(uint32_t channel, std::span<float> out) const {
  if (!film_.clear(channel, out)) return false;
  for (uint32_t i = 0; i < tiles_; i++) {
    if (!finished_[i].load(std::memory_order_acquire)) continue;
    std::unique_lock<std::mutex> lock; // for each tile: those who store the next one do not wait for long
    if (rounds_) lock = std::unique_lock(rounds_->film);
    film_.copy(channel, tile(i), out);
  }
  return true;
}

float Frame::progress() const {
  if (rounds_) return rounds_->progress(now());
  const float tiles = tiles_ ? float(done_.load()) / float(tiles_) : 1.0f;
  if (!light_) return tiles;
  constexpr float lightShare = 0.4f; // of the work, about
  return lightShare * float(lightPaths_.load()) / (float(partPaths_) * LightImage::parts) + (1 - lightShare) * tiles;
}

void Frame::renderTile(TileRenderer& renderer, uint32_t number) {
  if (rounds_)
    rounds_->render(renderer, tile(number), number, ledgers_[number]);
  else
    renderer.render(tile(number)), ledgers_[number].add(renderer.ledger());
  if (cancelled_) return; // perhaps given up
  finished_[number].store(true, std::memory_order_release);
  done_++;
}

void Frame::endRound() noexcept {
  over_ = !rounds_ || cancelled_ || !rounds_->endRound(now());
  if (!over_) {
    next_ = 0;
    wantEarly();
    return wantParts();
  }
  std::unique_lock<std::mutex> lock;
  if (rounds_) lock = std::unique_lock(rounds_->film);
  film_.finishErrors();
}

// In rounds light comes by and by, as many parts at a time as keep all threads busy. What of it is shown early does not matter
// for the finished picture, which has all parts.
void Frame::wantParts() {
  if (!light_) return;
  constexpr uint32_t all = LightImage::parts;
  const double share = rounds_ ? rounds_->lightShare() : 1;
  uint32_t wanted = uint32_t(share * all);
  if (wanted < all) wanted = wanted / crew_ * crew_;
  nextPart_ = partsWanted_;
  partsWanted_ = std::clamp(wanted, partsWanted_, all);
  shownLight_ = partsWanted_ > 1 ? light_.get() : early_.get();
}

// The first round has gone without light from lamps: the next shows what a few paths find.
void Frame::wantEarly() {
  if (!light_ || early_ || partsWanted_ > 0) return;
  early_ = std::make_unique<LightImage>(film_.width(), film_.height());
  earlyWanted_ = crew_ + 1;                                  // of one part nobody knows the variance
  const uint32_t paths = film_.width() * film_.height() / 2; // half as many as a sample of the camera
  earlyPaths_ = paths / earlyWanted_ + 1;
  nextEarly_ = 0;
}

void Frame::describeError(RTstats& stats) const {
  stats.errorLevel = 0.95;
  if (film_.errors().empty()) return;
  const ErrorSummary s = film_.errors().summary();
  stats.errorMean = s.mean, stats.errorMeanInterval = s.meanInterval;
  stats.errorHalfWidth = s.halfWidth, stats.errorP99 = s.p99;
  stats.errorPixels = s.pixels, stats.errorTrusted = s.trusted;
  const bool many = (rounds_ && rounds_->timed()) || replicatesOf(scene_->frame, scene_->frame.samples, 0).many();
  std::snprintf(stats.errorMethod, sizeof stats.errorMethod, "%s", many ? "replicated nets, Student's t" : "sample variance");
}

void Frame::describeLedger(RTstats& stats) const {
  Ledger all;
  for (const Ledger& l : ledgers_) all.addMean(l);
  const double pixels = std::max(double(film_.width()) * film_.height(), 1.0);
  stats.cutByDepth = all.cutByDepth / pixels, stats.cutByEnergy = all.cutByEnergy / pixels;
  stats.clipped = all.clipped / pixels;
}

// A picture of paths from lamps, part by part.
void Frame::traceLight(std::optional<LightTracer>& tracer) {
  const auto trace = [&](LightImage& image, uint32_t part, uint32_t paths, uint32_t seed, std::atomic<uint64_t>& done) {
    if (!tracer) tracer.emplace(*scene_, *scene_->lightSources);
    tracer->trace(paths, hash(scene_->frame.seed, seed + part), done, cancelled_);
    image.add(part, tracer->picture(), cancelled_);
  };
  std::atomic<uint64_t> unheeded{0};
  for (uint32_t i; !cancelled_ && (i = nextEarly_++) < earlyWanted_;) trace(*early_, i, earlyPaths_, 0x6561726cu, unheeded);
  for (uint32_t i; !cancelled_ && (i = nextPart_++) < partsWanted_;) trace(*light_, i, partPaths_, 0x6c616d70u, lightPaths_);
}

void Frame::work() {
  _mm_setcsr(_mm_getcsr() | 0x8040); // flush denormals to zero, as the ray kernels want it
  bool lit = !light_;
  try {
    std::optional<LightTracer> tracer;
    TileRenderer renderer(*scene_, film_, rounds_ ? &rounds_->film : nullptr);
    renderer.stopAt(cancelled_);
    do {
      if (light_) {
        lit = false;
        traceLight(tracer);
        lit = true;
        lit_->arrive_and_wait();
        renderer.useLight(shownLight_);
      }
      for (uint32_t i; !cancelled_ && (i = next_++) < tiles_;) renderTile(renderer, i);
      barrier_->arrive_and_wait();
    } while (!over_);
    std::lock_guard lock(mutex_);
    counters_.camera += renderer.counters().camera;
    counters_.shadow += renderer.counters().shadow + (tracer ? tracer->counters().shadow : 0);
    counters_.secondary += renderer.counters().secondary + (tracer ? tracer->counters().secondary : 0);
    counters_.faults.add(renderer.counters().faults);
    seconds_ = std::max(seconds_, now() - started_);
  } catch (const std::exception& e) {
    cancelled_ = true;
    if (!lit) lit_->arrive_and_drop();
    barrier_->arrive_and_drop();
    std::lock_guard lock(mutex_);
    failure_ = e.what();
  }
}

} // namespace openrt

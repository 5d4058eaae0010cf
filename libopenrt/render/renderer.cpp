// renderer.cpp: tiles on demand. The picture does not depend on which thread renders which tile.
#include "render/renderer.h"

#include <sched.h>
#include <xmmintrin.h>

#include <algorithm>
#include <bit>
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
      edge_(tileEdge(scene_->frame.samples)), columns_((film_.width() + edge_ - 1) / edge_),
      tiles_(columns_ * ((film_.height() + edge_ - 1) / edge_)), started_(now()) {
  if (!scene_->camera.shader.shaderClass) tiles_ = 0; // nothing is seen without a camera
  finished_ = std::make_unique<std::atomic<bool>[]>(tiles_);
  ledgers_.resize(tiles_);
  if (scene_->frame.timeLimit > 0 && scene_->frame.samples > 1 && tiles_ > 0) {
    rounds_ = std::make_unique<Rounds>();
    rounds_->sums.resize(tiles_);
    rounds_->wanted.resize(tiles_);
    rounds_->samples = scene_->frame.targetError > 0 ? std::min(32u, scene_->frame.samples) : 1;
    rounds_->began = started_;
  }
  const uint32_t count = std::min(threads, std::max(tiles_, 1u));
  barrier_ = std::make_unique<std::barrier<EndRound>>(count, EndRound{this});
  if (scene_->lightSources && tiles_ > 0) {
    light_ = std::make_unique<LightImage>(film_.width(), film_.height());
    partPaths_ = lightPathsOf(scene_->frame) / LightImage::parts + 1;
    lit_ = std::make_unique<std::barrier<>>(count);
  }
  for (uint32_t i = 0; i < count; i++) threads_.emplace_back([this] { work(); });
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
  std::unique_lock<std::mutex> lock;
  if (rounds_) lock = std::unique_lock(rounds_->film);
  for (uint32_t i = 0; i < tiles_; i++)
    if (finished_[i].load(std::memory_order_acquire)) film_.copy(channel, tile(i), out);
  return true;
}

float Frame::progress() const {
  if (rounds_) return over_.load() ? 1.0f : std::min(float((now() - started_) / double(scene_->frame.timeLimit)), 0.99f);
  const float tiles = tiles_ ? float(done_.load()) / float(tiles_) : 1.0f;
  if (!light_) return tiles;
  constexpr float lightShare = 0.4f; // of the work, about
  return lightShare * float(lightPaths_.load()) / (float(partPaths_) * LightImage::parts) + (1 - lightShare) * tiles;
}

void Frame::renderTile(TileRenderer& renderer, uint32_t number) {
  if (!rounds_)
    renderer.render(tile(number)), ledgers_[number].add(renderer.ledger());
  else if (rounds_->pilot)
    rounds_->wanted[number] = renderer.pilot(tile(number), rounds_->samples);
  else if (rounds_->wanted[number] > rounds_->first) {
    renderer.renderRound(tile(number), rounds_->sums[number], rounds_->replicates, rounds_->first, rounds_->samples);
    ledgers_[number].add(renderer.ledger());
  }
  if (cancelled_) return; // perhaps given up
  finished_[number].store(true, std::memory_order_release);
  done_++;
}

// Whether there is a further round depends on the time alone and on the pilot, which is no part of the picture.
void Frame::endRound() noexcept {
  const edit::FrameSettingsT& settings = scene_->frame;
  if (!rounds_ || cancelled_) {
    film_.finishErrors();
    over_ = true;
    return;
  }
  Rounds& r = *rounds_;
  const double time = now(), took = time - r.began, left = double(settings.timeLimit) - (time - started_);
  if (r.pilot) {
    // About sixteen rounds fill the time that is left.
    const double samples = left / 16 / std::max(took, 1e-9) * r.samples;
    const uint32_t most = std::max(settings.samples / 16, 1u);
    r.replicates = {settings.seed, uint32_t(std::bit_width(uint32_t(std::clamp(samples, 1.0, double(most))))) - 1};
    r.pilot = false;
  } else {
    r.first += r.samples;
    over_ = left < took / 2; // the next one would end nearer to the limit than this one by going beyond it
  }
  const uint32_t wanted = *std::max_element(r.wanted.begin(), r.wanted.end());
  if (r.first >= wanted) over_ = true;
  if (over_) return film_.finishErrors();
  r.samples = std::min(r.replicates.size(), settings.samples - r.first);
  r.began = time;
  next_ = 0;
}

void Frame::describeError(RTstats& stats) const {
  stats.errorLevel = 0.95;
  if (film_.errors().empty()) return;
  const ErrorSummary s = film_.errors().summary();
  stats.errorMean = s.mean, stats.errorMeanInterval = s.meanInterval;
  stats.errorHalfWidth = s.halfWidth, stats.errorP99 = s.p99;
  stats.errorPixels = s.pixels, stats.errorTrusted = s.trusted;
  const bool many = rounds_ || replicatesOf(scene_->frame, scene_->frame.samples, 0).many();
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
void Frame::traceLight() {
  LightTracer tracer(*scene_, *scene_->lightSources);
  for (uint32_t i; !cancelled_ && (i = nextPart_++) < LightImage::parts;) {
    tracer.trace(partPaths_, hash(scene_->frame.seed, 0x6c616d70u + i), lightPaths_, cancelled_);
    light_->add(i, tracer.picture(), cancelled_);
  }
  std::lock_guard lock(mutex_);
  counters_.shadow += tracer.counters().shadow;
  counters_.secondary += tracer.counters().secondary;
}

void Frame::work() {
  _mm_setcsr(_mm_getcsr() | 0x8040); // flush denormals to zero, as the ray kernels want it
  bool lit = !light_;
  try {
    if (light_) {
      traceLight();
      lit = true;
      lit_->arrive_and_wait();
    }
    TileRenderer renderer(*scene_, film_, rounds_ ? &rounds_->film : nullptr, light_.get());
    renderer.stopAt(cancelled_);
    do {
      for (uint32_t i; !cancelled_ && (i = next_++) < tiles_;) renderTile(renderer, i);
      barrier_->arrive_and_wait();
    } while (!over_);
    std::lock_guard lock(mutex_);
    counters_.camera += renderer.counters().camera;
    counters_.shadow += renderer.counters().shadow;
    counters_.secondary += renderer.counters().secondary;
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

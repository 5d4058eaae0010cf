// renderer.cpp: tiles on demand. The picture does not depend on which thread renders which tile.
#include "render/renderer.h"

#include <sched.h>
#include <xmmintrin.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>

namespace openrt {
namespace {

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
    : scene_(std::move(scene)), film_(scene_->frame.width, scene_->frame.height, scene_->frame.channels),
      edge_(tileEdge(scene_->frame.samples)), columns_((film_.width() + edge_ - 1) / edge_),
      tiles_(columns_ * ((film_.height() + edge_ - 1) / edge_)), started_(now()) {
  if (!scene_->camera.shader.shaderClass) tiles_ = 0; // nothing is seen without a camera
  finished_ = std::make_unique<std::atomic<bool>[]>(tiles_);
  for (uint32_t i = 0; i < std::min(threads, std::max(tiles_, 1u)); i++) threads_.emplace_back([this] { work(); });
}

Frame::~Frame() {
  cancel();
  wait();
}

void Frame::wait() {
  for (auto& thread : threads_) thread.join();
  threads_.clear();
}

Tile Frame::tile(uint32_t number) const {
  const uint32_t x = number % columns_ * edge_, y = number / columns_ * edge_;
  return {x, y, std::min(x + edge_, film_.width()), std::min(y + edge_, film_.height())};
}

bool Frame::snapshot(uint32_t channel, std::span<float> out) const {
  if (!film_.clear(channel, out)) return false;
  for (uint32_t i = 0; i < tiles_; i++)
    if (finished_[i].load(std::memory_order_acquire)) film_.copy(channel, tile(i), out);
  return true;
}

float Frame::progress() const { return tiles_ ? float(done_.load()) / float(tiles_) : 1.0f; }

void Frame::work() {
  _mm_setcsr(_mm_getcsr() | 0x8040); // flush denormals to zero, as the ray kernels want it
  try {
    TileRenderer renderer(*scene_, film_);
    for (uint32_t i; !cancelled_ && (i = next_++) < tiles_;) {
      renderer.render(tile(i));
      finished_[i].store(true, std::memory_order_release);
      done_++;
    }
    std::lock_guard lock(mutex_);
    counters_.camera += renderer.counters().camera;
    counters_.shadow += renderer.counters().shadow;
    counters_.secondary += renderer.counters().secondary;
    seconds_ = std::max(seconds_, now() - started_);
  } catch (const std::exception& e) {
    cancelled_ = true;
    std::lock_guard lock(mutex_);
    failure_ = e.what();
  }
}

} // namespace openrt

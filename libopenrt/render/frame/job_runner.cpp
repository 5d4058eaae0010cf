// job_runner.cpp: execution of jobs. The samples of a job are taken leaf by leaf and merged as if
// each leaf were a job (sums.h).
#include "render/frame/job_runner.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "render/flush_denormals.h"
#include "render/frame/frame_work.h"
#include "render/path/light_tracer.h"
#include "render/path/photon_pass.h"
#include "render/path/tile.h"
#include "steady_clock.h"

namespace openrt {
namespace {} // namespace

FrameFacts factsOf(const RenderScene& scene) {
  return {.camera = scene.camera.shader.shaderClass != nullptr,
          .lamps = scene.lightSources || scene.showsGlossy,
          .guide = (scene.photonGuide || scene.lightPathFlux > 0 ? photonsOf(scene.frame) : 0) |
                   (scene.showsGlossy ? FrameFacts::glossyPaths : 0) |
                   (scene.connectsGlossy ? FrameFacts::connectedPaths : 0) |
                   (scene.sharesMirrors ? FrameFacts::sharedMirrors : 0) |
                   (scene.lightPathsOfCameraPath - 1) * FrameFacts::moreLightPaths};
}

struct JobRunner::Impl {
  explicit Impl(std::shared_ptr<const RenderScene> s)
      : scene(std::move(s)), grid(scene->frame), required(requiredSums(scene->frame)),
        tiles(*scene) {}

  // Throws if the frame has no such job; jobs may come from another machine.
  void check(const Job& job) const {
    const bool light = job.kind == Job::Kind::light;
    const FrameFacts facts = factsOf(*scene);
    const uint32_t most = std::max(scene->frame.samples, fewestOfLeaves);
    if (job.count == 0 || !facts.camera || (light && !facts.lamps) ||
        (!light && (job.number >= grid.count() || job.first >= most ||
                    job.count > most - job.first || job.replicates.shift > 31)))
      throw std::runtime_error("a job that this frame does not have");
  }

  bool samples(const Job& job, const std::atomic<bool>& stop, JobResult& result);
  bool light(const Job& job, const std::atomic<bool>& stop, JobResult& result);

  const std::shared_ptr<const RenderScene> scene;
  const TileGrid grid;
  const RequiredSums required;
  TileRenderer tiles;
  std::optional<LightTracer> lamps;
  std::vector<SumBlock> stack;
  std::vector<std::vector<PixelSums>> spare;
};

bool JobRunner::Impl::samples(const Job& job, const std::atomic<bool>& stop, JobResult& result) {
  const Tile tile = grid.at(job.number);
  spare.push_back(std::move(result.sums));
  // The stack still holds the blocks of a job that was given up: reuse their memory.
  for (SumBlock& left : stack) spare.push_back(std::move(left.sums));
  stack.clear();
  const auto append = [&](SumBlock& to, SumBlock& later) {
    to.append(later, required, job.replicates);
    spare.push_back(std::move(later.sums));
  };
  for (uint32_t at = job.first, end = job.first + job.count; at < end;) {
    SumBlock leaf{.first = at,
                  .count = leafEnd(at, end, scene->frame.samples) - at,
                  .sums = {},
                  .ledger = {},
                  .rays = {},
                  .hits = {}};
    if (!spare.empty()) {
      leaf.sums = std::move(spare.back());
      spare.pop_back();
    }
    startSums(leaf.sums, tile.pixels(), required);
    if (!tiles.render(tile, job.replicates, job.centred, leaf.first, leaf.count, leaf.sums, stop,
                      &leaf.hits))
      return false;
    leaf.ledger = tiles.ledger();
    at += leaf.count;
    while (!stack.empty() &&
           siblings(stack.back().first, stack.back().count, leaf.first, leaf.count)) {
      append(stack.back(), leaf);
      leaf = std::move(stack.back());
      stack.pop_back();
    }
    stack.push_back(std::move(leaf));
  }
  for (size_t i = 1; i < stack.size(); i++) append(stack[0], stack[i]);
  result.sums = std::move(stack[0].sums);
  result.hits = std::move(stack[0].hits);
  result.ledger = stack[0].ledger;
  stack.clear();
  return true;
}

bool JobRunner::Impl::light(const Job& job, const std::atomic<bool>& stop, JobResult& result) {
  if (!lamps) lamps.emplace(*scene);
  lamps->picture().swap(result.light);
  const bool done = lamps->trace(job.count, job.replicates.seed, stop);
  lamps->picture().swap(result.light);
  return done;
}

JobRunner::JobRunner(std::shared_ptr<const RenderScene> scene)
    : impl_(std::make_unique<Impl>(std::move(scene))) {}
JobRunner::~JobRunner() = default;

bool JobRunner::run(const Job& job, const std::atomic<bool>& stop, JobResult& result) {
  impl_->check(job);
  const FlushDenormals flush;
  const double began = steadySeconds();
  result.ledger = {};
  const bool light = job.kind == Job::Kind::light;
  const bool done = light ? impl_->light(job, stop, result) : impl_->samples(job, stop, result);
  if (light)
    result.sums.clear();
  else
    result.light.clear();
  result.counters = std::exchange(light ? impl_->lamps->counters() : impl_->tiles.counters(), {});
  result.seconds = steadySeconds() - began;
  return done;
}

} // namespace openrt

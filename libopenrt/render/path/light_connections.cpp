#include "render/path/light_connections.h"

#include <algorithm>
#include <utility>

#include "render/lights/light_path_weights.h"
#include "render/path/light_tracer.h"

namespace openrt {
namespace {

// Keeps the random numbers of these light paths apart from those of the camera paths.
constexpr uint32_t connectionPairs = 0x636f6e6eu;

// Returns whether a non-specular lobe has a weight at hit i.
bool scattersAt(const RtsBatch& batch, uint32_t i) {
  Vec3f ignored;
  return std::any_of(batch.lobes.begin(), batch.lobes.end(), [&](const RtsLobe& lobe) {
    return nonSpecularFunctions(lobe) && weightAt(lobe, i, ignored);
  });
}

// Returns connectionsAt() of hit i, and 0 where no path may go on to a light or no lobe answers.
float connectionsOf(const CameraPaths& paths, uint32_t i) {
  const RtsBatch& batch = paths.batch;
  const uint32_t lane = batch.order[i];
  const PathFlags flags = batch.states->flagsOf(lane);
  const float number = connectionsAt(batch.scene, flags, load(batch.states->throughput, lane));
  return number > 0 && isWithinDepth(flags, paths.level + 2, batch.scene.frame.depth) &&
                 scattersAt(batch, i)
             ? number
             : 0.0f;
}

} // namespace

LightConnections::LightConnections(const StageContext& context) : context_(context) {}
LightConnections::~LightConnections() = default;

void LightConnections::connect(const CameraPaths& paths, const LobeSampling& sampling,
                               const Boundaries& boundaries, const SentLight& sent) {
  const RtsBatch& batch = paths.batch;
  if (!batch.scene.connectsGlossy) return;
  Arena& arena = batch.arena;
  ArenaScope scope(arena);
  const uint32_t n = batch.points->hits.count;
  auto* connections = arena.take<float>(padded(n));
  for (uint32_t i = 0; i < n; i++) connections[i] = connectionsOf(paths, i);
  if (std::none_of(connections, connections + n, [](float number) { return number > 0; })) return;
  float* choice[2];
  sampling.random.draw(Decision::choice, arena, choice, connectionPairs);
  auto* hit = arena.take<uint32_t>(padded(n));
  PathSamples samples;
  samples.allocate(arena, padded(n));
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    if (!(choice[0][i] < connections[i])) continue;
    const uint32_t lane = batch.order[i], path = batch.states->path[lane];
    samples.key[count] = hash(paths.samples.key[path],
                              hash(connectionPairs + batch.states->branch[lane], paths.level + 1));
    samples.index[count] = paths.samples.index[path];
    hit[count++] = i;
  }
  if (count == 0) return;
  if (!tracer_) tracer_ = std::make_unique<LightTracer>(batch.scene);
  tracer_->connectTo({batch, boundaries, sent, paths.level, count, hit, gain_}, samples);
  const RayCounters counters = std::exchange(tracer_->counters(), {});
  context_.counters.secondary += counters.secondary;
  context_.counters.shadow += counters.shadow;
  context_.counters.faults.add(counters.faults);
}

} // namespace openrt

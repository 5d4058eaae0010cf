#include "render/path/path_tracer.h"

#include <algorithm>
#include <utility>

#include "render/lights/emitted.h"
#include "render/lights/environment.h"
#include "render/lights/lamps.h"
#include "render/lights/openings.h"
#include "render/path/accumulate.h"
#include "render/path/scatter_in_media.h"
#include "render/surface/sanitize_output.h"
#include "render/surface/surface_shader.h"
#include "shading/running.h"

namespace openrt {

// Keeps the sampler's pairs for shaders apart from those for the transports.
static constexpr uint32_t shaderPairs = 0x73686164;

PathTracer::PathTracer(const PathTracer& outer, const PathSamples& samples, uint32_t level)
    : tile_(outer.tile_), samples_(samples), level_(level), nesting_(outer.nesting_ + 1) {
  guided_.observe(outer.guided_.trial());
}

void PathTracer::begin(const PathSamples& samples) {
  samples_ = samples;
  level_ = 0;
}

void PathTracer::trace(Wave& wave, PixelSamples& found) {
  traceWave(wave, found);
  follow(wave, found);
}

// The portions have a fixed order, so that the sums of a path have one order.
void PathTracer::follow(Wave& wave, PixelSamples& found) {
  const uint32_t most = wave.rays.count;
  for (level_++; !next_.empty() || !guided_.empty(); level_++) {
    std::swap(queue_, next_);
    next_.clear();
    // The waves below start guided rays that meet the surfaces of the next level.
    guided_.follow(samples_, level_, found);
    queue_.cut(level_, scene_.frame.depth, tile_.ledger.cutByDepth);
    tile_.counters.secondary += queue_.size();
    for (size_t begin = 0; begin < queue_.size() && !stopped(); begin += most) {
      loadWave(queue_, begin, uint32_t(std::min<size_t>(most, queue_.size() - begin)), wave);
      traceWave(wave, found);
    }
  }
}

void PathTracer::traceWave(Wave& wave, PixelSamples& found) {
  ArenaScope scope(tile_.arena);
  findHits(context_, level_ == 0 ? WaveSource::camera : WaveSource::surfaces, wave);
  const SeenOpenings openings = meetOpenings(context_, wave);
  goToHits(context_, wave);
  addOpenings(context_, openings, wave, found);
  if (!scene_.mediumLights.empty()) scatterInMedia(*this, wave, found);
  addEnvironment(context_, wave, tile_.unsampled, found);
  const auto shade = shadings[size_t(traitsOf(scene_.frame.transport).shading)];
  forEachBucket(context_, wave, [&](const Points& points, const Bucket& bucket) {
    (this->*shade)(points, bucket, wave.states, found);
  });
}

void PathTracer::shadeByLobes(const Points& points, const Bucket& bucket, const PathStates& states,
                              PixelSamples& found) {
  if (bucket.shaderClass->surface)
    scatter(points, bucket, states, found);
  else
    shadeByShade(points, bucket, states, found);
}

void PathTracer::shadeByShade(const Points& points, const Bucket& bucket, const PathStates& states,
                              PixelSamples& found) {
  if (!bucket.shaderClass->shade) return scatter(points, bucket, states, found);
  Arena& arena = tile_.arena;
  const uint32_t size = padded(points.hits.count);
  RtsShading shaded{};
  for (int k = 0; k < 3; k++) {
    shaded.radiance[k] = arena.takeZero<float>(size);
    shaded.transmission[k] = arena.takeZero<float>(size);
    if (has(RT_ALBEDO)) shaded.albedo[k] = arena.takeZero<float>(size);
  }
  RtsBatch batch(context_, points, states);
  batch.lights.set = bucket.lightSet;
  batch.fog = bucket.fog;
  {
    ArenaScope inner(arena);
    const RunningShader running(*bucket.shaderClass);
    bucket.shaderClass->shade(&scene_.host, &batch, &points.hits, &shaded);
    sanitizeOutput(*bucket.shaderClass, batch, shaded);
  }
  addShading(pathsOf(batch), shaded, fogAt(batch), found);
}

// Returns where the light that surfaces send back is collected: their emission is the first part.
SentLight PathTracer::sentLight(const RtsBatch& batch, const RtsSurface& surface) const {
  SentLight sent{{surface.emission[0], surface.emission[1], surface.emission[2]}};
  const bool coats = has(RT_REFLECTION) && tracesPaths(scene_.frame.transport) &&
                     std::any_of(batch.lobes.begin(), batch.lobes.end(),
                                 [](const RtsLobe& lobe) { return lobe.coat != 0; });
  if (coats)
    for (auto& a : sent.coated) a = tile_.arena.takeZero<float>(padded(batch.points->hits.count));
  return sent;
}

// Shades surfaces that are described by lobes. The stages are those of docs/architecture.md, "One
// hit, stage by stage".
void PathTracer::scatter(const Points& points, const Bucket& bucket, const PathStates& states,
                         PixelSamples& found) {
  RtsBatch batch(context_, points, states);
  batch.lights.set = bucket.lightSet;
  batch.fog = bucket.fog;
  const RtsSurface surface = runSurfaceShader(batch, *bucket.shaderClass, has(RT_ALBEDO));
  sanitizeOutput(*bucket.shaderClass, batch, surface);
  const Boundaries boundaries = crossBoundaries(batch, *bucket.shaderClass);
  batch.crossing = boundaries.crossing;
  const Fog fog = fogAt(batch);
  batch.throughFog = fog.transmittance;
  weightEmission(batch, boundaries, tile_.unsampled, surface.emission);
  const SentLight sent = sentLight(batch, surface);
  addLamps(batch, sent);
  continueFromLobes(batch, boundaries, sent);
  addSurface(batch, surface, sent, boundaries, fog, found);
}

// Returns whether the depth limit leaves room for one more surface on the path of hit i.
bool PathTracer::goesOn(const RtsBatch& batch, uint32_t i) const {
  return isWithinDepth(batch.states->flagsOf(batch.order[i]), level_ + 1, scene_.frame.depth);
}

bool PathTracer::samplesEmitters(const RtsBatch& batch) const {
  if (!scene_.emitters->any()) return false;
  if (level_ < scene_.frame.depth) return true;
  for (uint32_t i = 0; i < batch.points->hits.count; i++)
    if (goesOn(batch, i)) return true;
  return false;
}

void PathTracer::continueFromLobes(const RtsBatch& batch, const Boundaries& boundaries,
                                   const SentLight& sent) {
  LobeSampling sampling;
  const bool path = tracesPaths(scene_.frame.transport);
  const bool emitters = path && samplesEmitters(batch);
  const uint32_t n = batch.points->hits.count;
  if (path) {
    sampling = drawChoices(
        batch, randomNumbersAt(samples_, *batch.states, batch.order, n, firstPair(), tile_.arena));
    sampleLobes(batch, sampling);
    if (emitters) allocateSelection(batch, sampling);
  }
  spawnRays(pathsOf(batch), sampling, boundaries);
  if (!emitters) return;
  if (level_ >= scene_.frame.depth)
    for (float* followed : sampling.selectionProbability)
      for (uint32_t i = 0; followed && i < n; i++)
        if (!goesOn(batch, i)) followed[i] = 0;
  sampleEmitters(batch, sampling, boundaries, sent);
  connections_.connect(pathsOf(batch), sampling, boundaries, sent);
  if (scene_.lightPathFlux > 0) addLightPathBound(pathsOf(batch), sampling, tile_.footprint);
  if (scene_.photonGuide) guided_.start(pathsOf(batch), sampling, boundaries);
}

void PathTracer::randomPoints(const RtsBatch& batch, uint32_t pair, float* const square[2]) const {
  Arena& arena = tile_.arena;
  ArenaScope scope(arena);
  const uint32_t n = batch.pointCount();
  auto *key = arena.take<uint32_t>(n), *index = arena.take<uint32_t>(n),
       *pairs = arena.take<uint32_t>(n);
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t lane = batch.order ? batch.order[i] : i;
    const uint32_t path = batch.order ? batch.states->path[lane] : i;
    const uint32_t place = batch.order ? firstPair() + batch.states->branch[lane] : 0;
    key[i] = samples_.key[path];
    index[i] = samples_.index[path];
    pairs[i] = hash(shaderPairs + pair, place);
    if (!tile_.centred || batch.order) samples_.markRandom(path);
  }
  samplePairs(n, key, pairs, 0, index, square[0], square[1]);
}

} // namespace openrt

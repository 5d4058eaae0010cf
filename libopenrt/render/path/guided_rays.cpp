#include "render/path/guided_rays.h"

#include <algorithm>
#include <cmath>

#include "render/lights/emitted.h"
#include "render/lights/environment.h"
#include "render/surface/continue_paths.h"
#include "render/surface/sanitize_output.h"
#include "render/surface/surface_shader.h"

namespace openrt {
namespace {

constexpr uint32_t raysInFlight = 4096;
// Keeps the random numbers of guided rays apart from those of the paths that send them.
constexpr uint32_t guidedPairs = 0x67756964u, guidedBranch = 0x72617973u;

// The hits of a batch that send a guided ray.
struct Guided {
  uint32_t count = 0;
  uint32_t* hit;       // index of the hit in the batch
  float* direction[3]; // unit
  float* pdf;          // with the share of the cell
  float* kept;         // probability of Russian roulette
  Vec3f* position;     // where the guide was asked
};

Guided sampleGuide(const RtsBatch& batch, const LobeSampling& sampling) {
  const RenderScene& scene = batch.scene;
  const Points& points = *batch.points;
  Arena& arena = batch.arena;
  const uint32_t n = points.hits.count;
  Guided out;
  out.hit = arena.take<uint32_t>(padded(n));
  out.pdf = arena.take<float>(padded(n));
  out.kept = arena.take<float>(padded(n));
  out.position = arena.take<Vec3f>(padded(n));
  for (auto& a : out.direction) a = arena.takeZero<float>(padded(n));
  ArenaScope scope(arena);
  float *choice[2], *place[2];
  sampling.random.draw(Decision::choice, arena, choice, guidedPairs);
  sampling.random.draw(Decision::direction, arena, place, guidedPairs);
  const uint32_t* transmits = transmitsByHit(batch);
  for (uint32_t i = 0; i < n; i++) {
    const RayState state = (*batch.states)[batch.order[i]];
    const bool scatters = std::any_of(
        std::begin(sampling.selectionProbability), std::end(sampling.selectionProbability),
        [i](const float* followed) { return followed && followed[i] > 0; });
    if (!scatters) continue;
    const Vec3f position = lightSampleContext(points, i, false).position;
    const uint32_t cell = guideCellAt(scene, state.flags, position);
    if (cell == PhotonGuide::none) continue;
    // The number of rays with the least variance at equal cost is proportional to what they carry.
    const float kept = std::min(1.0f, largest(state.throughput));
    if (choice[1][i] >= kept * scene.photonGuide->share(cell)) continue;
    Vec3f direction;
    const float pdf = scene.photonGuide->sample(cell, position, choice[0][i], place[0][i],
                                                place[1][i], direction);
    const bool front = dot(direction, load(points.hits.geometric, i)) > 0;
    if (!(pdf > 0) || (!front && !(transmits && transmits[i]))) continue;
    store(direction, out.direction, out.count);
    out.pdf[out.count] = pdf;
    out.kept[out.count] = kept;
    out.position[out.count] = position;
    out.hit[out.count++] = i;
  }
  return out;
}

struct Response {
  Vec3f light;    // from the hit to the guided ray: BSDF times MIS weight over pdf
  Vec3f unguided; // the part of `light` that BSDF sampling contributes as often
};

Response* responses(const RtsBatch& batch, const LobeSampling& sampling, const Guided& rays) {
  Arena& arena = batch.arena;
  auto* response = arena.take<Response>(rays.count);
  std::fill_n(response, rays.count, Response());
  ArenaScope scope(arena);
  const RtsHits& hits = batch.points->hits;
  LobeValues values(arena, rays.count, &batch);
  for (uint32_t l = 0; l < batch.lobes.size(); l++) {
    const float* followed = sampling.selectionProbability[l];
    if (!followed) continue;
    const RtsLobe& lobe = batch.lobes[l];
    values.evaluate(lobe, hits, rays.count, rays.hit, rays.direction);
    for (uint32_t r = 0; r < rays.count; r++) {
      const uint32_t i = rays.hit[r];
      const Vec3f direction = load(rays.direction, r);
      const bool front = dot(direction, load(hits.geometric, i)) > 0,
                 above = dot(direction, load(lobe.normal, i)) > 0;
      Vec3f weight;
      // The same directions as those of BSDF sampling.
      if (!(followed[i] > 0) || !weightAt(lobe, i, weight) || front != above ||
          (!front && !nonSpecularFunctions(lobe)->transmits))
        continue;
      const float bsdfPdf = followed[i] * values.pdf[r], pdf = rays.pdf[r] + bsdfPdf;
      const Vec3f light = weight * load(values.value, r) * (1 / pdf / rays.kept[r]);
      response[r].light += light;
      response[r].unguided += light * (bsdfPdf / pdf);
    }
  }
  return response;
}

} // namespace

bool isGuided(const RenderScene& scene, PathFlags path) {
  return !scene.lightSources || path.pathClass() == PathClass::specularFirst;
}

uint32_t guideCellAt(const RenderScene& scene, PathFlags path, const Vec3f& position) {
  if (!scene.photonGuide || !isGuided(scene, path)) return PhotonGuide::none;
  return scene.photonGuide->find(position);
}

void weightUnguided(const RtsBatch& batch, const Boundaries& boundaries) {
  const RenderScene& scene = batch.scene;
  const PathStates& states = *batch.states;
  if (!scene.photonGuide) return;
  const bool goesOn = boundaries.crossing ||
                      std::any_of(batch.lobes.begin(), batch.lobes.end(),
                                  [](const RtsLobe& lobe) { return !nonSpecularFunctions(lobe); });
  if (!goesOn) return;
  for (uint32_t i = 0; i < batch.points->hits.count; i++) {
    const uint32_t lane = batch.order[i];
    const float pdf = states.pdf[lane];
    if (!(pdf > 0)) continue;
    const Vec3f position = states.previousOf(lane).position;
    const uint32_t cell = guideCellAt(scene, states.flagsOf(lane), position);
    if (cell == PhotonGuide::none) continue;
    const Vec3f direction = load(batch.points->hits.direction, i);
    states.unguidedWeight[lane] = pdf / (pdf + scene.photonGuide->pdf(cell, position, direction));
  }
}

void GuidedRays::start(const CameraPaths& paths, const LobeSampling& sampling,
                       const Boundaries& boundaries) {
  const RtsBatch& batch = paths.batch;
  ArenaScope scope(batch.arena);
  const Guided rays = sampleGuide(batch, sampling);
  if (rays.count == 0) return;
  const Response* response = responses(batch, sampling, rays);
  for (uint32_t r = 0; r < rays.count; r++) {
    const uint32_t i = rays.hit[r];
    const Vec3f direction = load(rays.direction, r);
    RayState state = (*batch.states)[batch.order[i]];
    state.throughput *= response[r].light;
    if (batch.throughFog) state.throughput *= batch.throughFog[i];
    const float most = largest(state.throughput);
    if (!(most > 0) || !std::isfinite(most)) continue;
    state.travelled = batch.points->hits.distance[i];
    state.pdf = 0;
    state.previous = {rays.position[r], {}};
    state.unguidedWeight = largest(response[r].unguided) / largest(response[r].light);
    state.branch = hash(state.branch + guidedBranch, paths.level + 1);
    state.media = mediaTowards(*batch.points, i, direction, boundaries, state.media);
    state.flags.set(PathFlags::specularSinceDiffuseBit | PathFlags::passedUnsampledBit, false);
    state.flags.set(PathFlags::scatteredBit, true);
    state.flags.set(PathFlags::deflectedBit, true);
    if (trial_) trial_->send(batch.scene.photonGuide->find(rays.position[r]));
    queueRay(*batch.points, i, direction, state, next_);
  }
}

void GuidedRays::follow(const PathSamples& samples, uint32_t level, PixelSamples& found) {
  std::swap(queue_, next_);
  next_.clear();
  double ended = 0; // light that the rays of BSDF sampling would find, which count it
  queue_.cut(level, context_.scene.frame.depth, ended);
  context_.counters.secondary += queue_.size();
  const Stage stage{samples, level, found};
  for (size_t begin = 0; begin < queue_.size(); begin += raysInFlight) {
    ArenaScope scope(context_.arena);
    const auto n = uint32_t(std::min<size_t>(raysInFlight, queue_.size() - begin));
    Wave wave;
    wave.rays.allocate(context_.arena, n);
    loadWave(queue_, begin, n, wave);
    intersectWave(context_, WaveSource::surfaces, wave);
    forEachBucket(context_, wave, [&](const Points& points, const Bucket& bucket) {
      visit(stage, points, bucket, wave.states);
    });
    addSun(stage, wave);
  }
}

void GuidedRays::visit(const Stage& stage, const Points& points, const Bucket& bucket,
                       const PathStates& states) {
  // The light that `shade` lets through is not told here: BSDF sampling finds light behind such
  // surfaces.
  if (!bucket.shaderClass->surface) return;
  RtsBatch batch(context_, points, states);
  batch.lights.set = bucket.lightSet;
  const RtsSurface surface = runSurfaceShader(batch, *bucket.shaderClass);
  sanitizeOutput(*bucket.shaderClass, batch, surface);
  const Boundaries boundaries = crossBoundaries(batch, *bucket.shaderClass);
  addEmission(stage, batch, surface, boundaries);
  const RandomNumbers random =
      randomNumbersAt(stage.samples, states, points.order, points.hits.count,
                      pairAtLevel(1, stage.level), context_.arena);
  float* choice[2];
  random.draw(Decision::choice, context_.arena, choice);
  // The lobes are not sampled, so only specular samples exist.
  const BsdfSampleArrays samples(batch, {}, boundaries, TransportMode::radiance);
  Selection selection{.points = &points,
                      .choice = choice[0],
                      .survival = nullptr,
                      .throughput = states.throughput,
                      .onlySpecular = nullptr};
  selection.allocate(context_.arena);
  selectSamples(selection, samples);
  for (uint32_t i = 0; i < points.hits.count; i++) {
    if (boundaries.visibleAt(i)) {
      if (selection.number[i] != SampleArrays::lacking)
        spawnRay(batch, i, samples[selection.number[i]], selection.probability[i], boundaries);
      continue;
    }
    RayState passed = states[points.order[i]];
    passed.media = boundaries.crossing[i].behind;
    passed.flags.addPassage();
    queueRay(points, i, load(points.hits.direction, i), passed, next_);
  }
}

// Adds the light of a sky with a sun that rays see which have left the scene.
void GuidedRays::addSun(const Stage& stage, const Wave& wave) {
  const auto n = uint32_t(wave.missed.size());
  if (n == 0 || !context_.scene.emitters->hasSun()) return;
  ArenaScope scope(context_.arena);
  const SkyAlongRays sky = evaluateSky(context_, wave.rays, wave.missed.data(), n);
  for (uint32_t i = 0; i < n; i++) {
    const RayState state = wave.states[wave.missed[i]];
    if (state.flags.specularSinceDiffuse()) addLight(stage, state, load(sky.rgba, i));
  }
}

// radiance: at the end of a ray.
void GuidedRays::addLight(const Stage& stage, const RayState& state, const Vec3f& radiance) {
  Vec3f light = state.throughput * radiance;
  for (int k = 0; k < 3; k++)
    if (!std::isfinite(light[k])) light[k] = 0;
  stage.found.add(state.path, state.flags, light);
  if (trial_ && state.unguidedWeight > 0)
    trial_->meet(context_.scene.photonGuide->find(state.previous.position), light,
                 double(state.unguidedWeight));
}

void GuidedRays::addEmission(const Stage& stage, const RtsBatch& batch, const RtsSurface& surface,
                             const Boundaries& boundaries) {
  ArenaScope scope(context_.arena);
  const uint32_t count = batch.points->hits.count;
  auto* hit = context_.arena.take<uint32_t>(padded(count));
  const uint32_t n = listEmitting(surface.emission, count, hit);
  if (n == 0) return;
  for (uint32_t j = 0; j < n; j++) {
    const uint32_t i = hit[j];
    const RayState state = (*batch.states)[batch.order[i]];
    if (!state.flags.specularSinceDiffuse() || !boundaries.visibleAt(i) ||
        !startsLightPaths(batch, i))
      continue;
    addLight(stage, state, load(surface.emission, i));
  }
}

// Continues a path along one specular sample. probability: of its selection.
void GuidedRays::spawnRay(const RtsBatch& batch, uint32_t i, const SampleArrays& sample,
                          float probability, const Boundaries& boundaries) {
  const Points& points = *batch.points;
  const Vec3f direction = load(sample.direction, i);
  RayState state = (*batch.states)[batch.order[i]];
  state.throughput *= sample.weightAt(i) / probability;
  if (!std::isfinite(largest(state.throughput))) return;
  if (sample.colour) state.flags.setChannel(uint8_t(sample.colour));
  if (sample.deflected)
    state.flags.set(PathFlags::specularSinceDiffuseBit, true);
  else
    state.flags.addPassage();
  state.travelled = points.hits.distance[i];
  state.media = mediaTowards(points, i, direction, boundaries, state.media);
  if (trial_) trial_->send(context_.scene.photonGuide->find(state.previous.position));
  queueRay(points, i, direction, state, next_);
}

} // namespace openrt

#include "render/lights/emitted.h"

#include <algorithm>
#include <cmath>

#include "render/lights/environment.h"
#include "render/lights/light_path_weights.h"
#include "render/lights/sampled_points.h"
#include "render/lights/shadows.h"
#include "render/surface/surface_shader.h"
#include "render/wave/nearest_hits.h"

namespace openrt {

LightSampleContext lightSampleContext(const Points& points, uint32_t i, bool twoSided) {
  const Vec3f p = load(points.hits.position, i), n = load(points.hits.geometric, i);
  return {offsetPoint(p, n, points.error[i]), twoSided ? Vec3f() : n};
}

bool startsLightPaths(const RtsBatch& batch, uint32_t i) {
  const RayHits& hits = *batch.points->rayHits;
  const uint32_t lane = batch.order[i];
  return batch.scene.emitters->startsLightPaths(hits.record[lane], hits.primitive[lane],
                                                load(batch.points->hits.direction, i));
}

namespace {

// Returns the number of the emissive shape at hit i, or `none`.
uint32_t shapeAt(const RtsBatch& batch, uint32_t i) {
  const EmissiveShapes* shapes = batch.scene.emitters->shapes();
  const RayHits& hits = *batch.points->rayHits;
  const uint32_t lane = batch.order[i];
  return shapes ? shapes->find(hits.record[lane], hits.primitive[lane]) : EmissiveShapes::none;
}

// Returns whether a light path may start on the side of an emissive shape that hit i is on. A
// curved shape starts paths on both sides if both emit.
bool isStart(const RtsBatch& batch, uint32_t i, uint32_t shape) {
  const EmissiveShapes::Shape& s = (*batch.scene.emitters->shapes())[shape];
  return !s.curved() || (s.sides & (batch.points->hits.flags[i] & RTS_HIT_BACK ? 2 : 1));
}

// Returns the weight of a camera path that has found the emission of hit i, against light paths
// that come by way of mirrors and smooth glass.
float shareOfMirrors(const RtsBatch& batch, uint32_t i, uint32_t shape) {
  const uint32_t lane = batch.order[i];
  if (!canOnlyReachSky(batch.scene, batch.states->flagsOf(lane)) || !startsLightPaths(batch, i))
    return 1;
  if (!batch.scene.sharesMirrors || shape == EmissiveShapes::none) return 0;
  if (!isStart(batch, i, shape)) return 1;
  return cameraPathShare(mirrorPathRatio(batch.scene, shape, load(batch.points->hits.position, i),
                                         batch.states->lightPathRatio[lane]));
}

// Returns the ratio of pdfs of the path that has found the emission of hit i
// (light_path_weights.h). lightPdf: of light sampling at its last surface.
float lightPathRatioAt(const RtsBatch& batch, uint32_t i, uint32_t shape, float lightPdf) {
  const PathStates& states = *batch.states;
  const uint32_t lane = batch.order[i];
  if (!(states.glossyPdf[lane] > 0) || !startsLightPaths(batch, i)) return 0;
  if (!isStart(batch, i, shape)) return 0;
  return lightPathRatio(batch.scene, shape, load(batch.points->hits.position, i),
                        states.lightPathRatio[lane], states.glossyPdf[lane], lightPdf);
}

// Returns the MIS weights of the emission that rays have found at some hits.
float* emissionMisWeights(const RtsBatch& batch, const Boundaries& boundaries, const uint32_t* hit,
                          uint32_t n) {
  Arena& arena = batch.arena;
  const PathStates& states = *batch.states;
  auto *weight = arena.take<float>(n), *bsdfPdf = arena.take<float>(n),
       *lightPdf = arena.take<float>(padded(n));
  auto* place = arena.take<uint32_t>(n); // index into `weight` of each found shape
  FoundShapes found;
  found.allocate(arena, n);
  for (uint32_t j = 0; j < n; j++) {
    const uint32_t i = hit[j], lane = batch.order[i], shape = shapeAt(batch, i);
    weight[j] = boundaries.visibleAt(i) ? shareOfMirrors(batch, i, shape) : 0;
    if (states.flagsOf(lane).specularSinceDiffuse() && startsLightPaths(batch, i))
      weight[j] *= states.unguidedWeight[lane];
    if (weight[j] == 0 || !(states.pdf[lane] > 0 || states.glossyPdf[lane] > 0) ||
        shape == EmissiveShapes::none)
      continue;
    const uint32_t f = found.count++;
    const LightSampleContext from = states.previousOf(lane);
    store(from.position, found.position, f);
    store(from.normal, found.normal, f);
    store(load(batch.points->hits.direction, i), found.direction, f);
    found.shape[f] = shape;
    bsdfPdf[f] = states.pdf[lane];
    place[f] = j;
  }
  batch.scene.emitters->pdf(found, lightPdf);
  for (uint32_t f = 0; f < found.count; f++) {
    float& w = weight[place[f]];
    if (bsdfPdf[f] > 0)
      w = std::isfinite(lightPdf[f]) ? bsdfPdf[f] / (bsdfPdf[f] + lightPdf[f]) : 0.0f;
    w *= cameraPathShare(lightPathRatioAt(batch, hit[place[f]], found.shape[f], lightPdf[f]));
  }
  return weight;
}

} // namespace

void weightEmission(const RtsBatch& batch, const Boundaries& boundaries, UnsampledLights& unsampled,
                    float* const emission[3]) {
  Arena& arena = batch.arena;
  ArenaScope scope(arena);
  const uint32_t count = batch.points->hits.count;
  auto* hit = arena.take<uint32_t>(padded(count));
  const uint32_t n = listEmitting(emission, count, hit);
  if (n == 0) return;
  const float* weight = emissionMisWeights(batch, boundaries, hit, n);
  for (uint32_t j = 0; j < n; j++) {
    const uint32_t i = hit[j];
    const Vec3f found = load(emission, i);
    store(found * weight[j], emission, i);
    const uint32_t lane = batch.order[i];
    if (weight[j] > 0)
      unsampled.meet(batch.states->flagsOf(lane), found, batch.states->unguidedWeight[lane]);
  }
}

namespace {

// Returns by hit the largest probability that a lobe's sample is followed: light samples are wanted
// where it is above 0. Returns null if none is wanted.
const float* mostFollowed(const RtsBatch& batch, const LobeSampling& sampling) {
  const uint32_t n = batch.points->hits.count;
  const float* most = nullptr;
  for (const float* followed : sampling.selectionProbability) {
    if (!most) {
      most = followed;
    } else if (followed) {
      auto* both = batch.arena.take<float>(padded(n));
      for (uint32_t i = 0; i < n; i++) both[i] = std::max(most[i], followed[i]);
      most = both;
    }
  }
  return most && std::any_of(most, most + n, [](float p) { return p > 0; }) ? most : nullptr;
}

} // namespace

LightSamples chooseLightSamples(const RtsBatch& batch, const LobeSampling& sampling) {
  Arena& arena = batch.arena;
  const Points& points = *batch.points;
  const RtsHits& hits = points.hits;
  LightSamples out{};
  const float* wanted = mostFollowed(batch, sampling);
  if (!wanted) return out;
  out.allocate(arena, hits.count);
  ArenaScope scope(arena);
  float *pick[2], *place[2];
  sampling.random.draw(Decision::emitter, arena, pick);
  sampling.random.draw(Decision::place, arena, place);
  const LightPoints lightPoints{hits.count,
                                {hits.position[0], hits.position[1], hits.position[2]},
                                {hits.geometric[0], hits.geometric[1], hits.geometric[2]},
                                points.error,
                                transmitsByHit(batch),
                                pick[0],
                                place[0],
                                place[1],
                                wanted};
  SampledLights sampled;
  sampled.allocate(arena, hits.count);
  batch.scene.emitters->choose(lightPoints, pick[1], arena, sampled);
  startShadowRays(lightPoints, sampled, out);
  Rays& rays = out.rays;
  for (uint32_t r = 0; r < rays.count; r++)
    if (rays.tfar[r] < 0)
      rays.tfar[r] =
          shadowRayEnd(batch.scene, out[r], lightSampleContext(points, out.hit[r], false).position,
                       load(rays.org, r));
  return out;
}

void weightLightSamples(const RtsBatch& batch, const LobeSampling& sampling,
                        LightSamples& samples) {
  const Rays& rays = samples.rays;
  if (rays.count == 0) return;
  ArenaScope scope(batch.arena);
  LobeValues values(batch.arena, rays.count, &batch);
  bool more = false;
  for (uint32_t l = 0; l < batch.lobes.size(); l++) {
    const float* followed = sampling.selectionProbability[l];
    if (!followed) continue;
    values.evaluate(batch.lobes[l], batch.points->hits, rays.count, samples.hit, rays.dir);
    weightByLobe(batch.lobes[l], followed, values, more, samples,
                 cameraPathShares(batch, batch.lobes[l], values.pdf, samples));
    more = true;
  }
  removeUseless(samples);
}

namespace {

// Blocks the rays to shapes that may be hidden, or share their place with another surface, unless
// the sampled shape is the one that the kernel reports. origin: where the rays start, or where they
// have left the last surface that they have passed.
void blockUncertain(const StageContext& context, const LightSamples& samples,
                    const float* const origin[3], uint8_t* blocked) {
  const EmissiveShapes& shapes = *context.scene.emitters->shapes();
  if (!shapes.anyUncertain()) return;
  const Rays& rays = samples.rays;
  Arena& arena = context.arena;
  ArenaScope scope(arena);
  auto* lanes = arena.take<uint32_t>(rays.count);
  uint32_t n = 0;
  for (uint32_t r = 0; r < rays.count; r++) {
    const uint32_t shape = samples.shape[r];
    if (!blocked[r] && shape != EmissiveShapes::none && shapes[shape].uncertain) lanes[n++] = r;
  }
  if (n == 0) return;
  const Rays again = copyRays(rays, lanes, n, arena);
  for (uint32_t i = 0; i < n; i++) {
    const Vec3f start = load(origin, lanes[i]);
    const float passed = length(start - load(again.org, i));
    again.tfar[i] = (samples.distance[lanes[i]] - passed) * (1 + 0x1p-10f);
    store(start, again.org, i);
  }
  const RayHits found = findNearest(context, again, Coherence::incoherent);
  for (uint32_t i = 0; i < n; i++)
    blocked[lanes[i]] = found.record[i] == noHit ||
                        shapes.find(found.record[i], found.primitive[i]) != samples.shape[lanes[i]];
}

// Evaluates the emission at the sampled points of some rays by their shaders. Calls add(ray,
// light).
template <class Add> void shadeSampledPoints(const StageContext& context,
                                             const LightSamples& samples, const uint32_t* lanes,
                                             uint32_t n, const Add& add) {
  const RenderScene& scene = context.scene;
  const Rays& rays = samples.rays;
  Arena& arena = context.arena;
  ArenaScope scope(arena);
  RayHits seen;
  seen.allocate(arena, rays.count);
  for (uint32_t i = 0; i < n; i++) writeSampledHit(scene, samples[lanes[i]], rays, lanes[i], seen);
  const auto* travelled = arena.takeZero<float>(padded(rays.count));
  auto* sorted = arena.take<uint32_t>(n);
  for (const BucketRange& range : sortByBucket(scene, seen, lanes, n, sorted, arena)) {
    const RtsClass& shaderClass = *scene.buckets[range.bucket].shaderClass;
    const uint32_t m = range.end - range.begin;
    const Points points = makePoints(scene, rays, seen, sorted + range.begin, m, travelled, arena);
    RtsBatch inner(context);
    // A null tracer turns off random decisions of the shader, because the emission must be the one
    // that the sampling tables were built from.
    inner.tracer = nullptr;
    inner.points = &points;
    const RtsSurface surface = runSurfaceShader(inner, shaderClass);
    for (uint32_t i = 0; i < m; i++) add(sorted[range.begin + i], load(surface.emission, i));
  }
}

// Holds what shadow rays to emitters find in scenes where they pass something. Null: elsewhere.
struct SeenThrough {
  float* transmittance[3] = {};
  float* origin[3] = {}; // where each ray has left the last surface that it has passed
};

SeenThrough traceThrough(const RtsBatch& batch, const LightSamples& samples,
                         const Boundaries& boundaries, uint8_t* blocked) {
  Arena& arena = batch.arena;
  const uint32_t n = samples.rays.count;
  SeenThrough seen;
  for (int k = 0; k < 3; k++) {
    seen.transmittance[k] = arena.take<float>(n);
    std::fill_n(seen.transmittance[k], n, 1.0f);
    seen.origin[k] = arena.take<float>(n);
    std::copy_n(samples.rays.org[k], n, seen.origin[k]);
  }
  ArenaScope scope(arena);
  ShadowRays shadows = allocateShadowRays(batch.scene, n, arena, true);
  shadows.hit = samples.hit;
  shadows.lastOrigin = seen.origin;
  // Without media, most rays meet nothing, which one search tells.
  auto* lanes = arena.takeNumbers(n);
  uint32_t count = n;
  if (!shadows.media) {
    findBlocked(batch.scene, samples.rays, blocked);
    batch.counters.shadow += n;
    count = 0;
    for (uint32_t r = 0; r < n; r++)
      if (blocked[r]) lanes[count++] = r;
  }
  shadows.rays = copyRays(samples.rays, lanes, count, arena);
  for (uint32_t r = 0; r < count; r++) {
    const uint32_t ray = shadows.lane[r] = lanes[r], i = samples.hit[ray];
    if (shadows.media)
      shadows.media[r] = mediaTowards(*batch.points, i, load(samples.rays.dir, ray), boundaries,
                                      batch.states->media[batch.order[i]]);
  }
  traceTransmittance(batch, shadows, seen.transmittance);
  for (uint32_t r = 0; r < n; r++) blocked[r] = !(largest(load(seen.transmittance, r)) > 0);
  return seen;
}

uint32_t listUnblocked(uint32_t n, const uint8_t* blocked, uint32_t* rays) {
  uint32_t left = 0;
  for (uint32_t r = 0; r < n; r++)
    if (!blocked[r]) rays[left++] = r;
  return left;
}

// Light samples whose shadow rays are traced.
struct TracedSamples {
  const RtsBatch& batch;
  const Boundaries& boundaries;
  const LightSamples& samples;
  const SeenThrough& seen;
  const uint8_t* blocked;
};

// Adds the light of the samples that are not blocked to the hits (`radiance`), by their response.
void addSeen(const TracedSamples& traced, const float* const response[3],
             float* const radiance[3]) {
  const LightSamples& samples = traced.samples;
  const RtsBatch& batch = traced.batch;
  const StageContext& context = batch;
  const RenderScene& scene = context.scene;
  const EmissiveShapes& shapes = *scene.emitters->shapes();
  const Rays& rays = samples.rays;
  const uint32_t n = rays.count;
  Arena& arena = context.arena;
  ArenaScope scope(arena);
  const bool absorbs = !scene.shaders->media().empty();
  const float* const through[3] = {traced.seen.transmittance[0], traced.seen.transmittance[1],
                                   traced.seen.transmittance[2]};
  const auto add = [&](uint32_t ray, const Vec3f& light) {
    const uint32_t i = samples.hit[ray];
    Vec3f left = light;
    if (through[0]) {
      left *= load(through, ray);
    } else if (absorbs) { // absorption of the medium between hit and emitter
      const MediaStack& media =
          mediaTowards(*batch.points, i, load(rays.dir, ray), traced.boundaries,
                       batch.states->media[batch.order[i]]);
      absorb(mediumOf(media, scene.shaders->media()), std::min(samples.distance[ray], 1e30f),
             scene.shaders->media(), left);
    }
    for (int k = 0; k < 3; k++)
      if (std::isfinite(left[k])) radiance[k][i] += response[k][ray] * left[k];
  };
  auto *others = arena.take<uint32_t>(padded(n)), *toSky = arena.take<uint32_t>(n),
       *toShade = arena.take<uint32_t>(n);
  const uint32_t left =
      absorbs || through[0] || shapes.empty()
          ? listUnblocked(n, traced.blocked, others)
          : addOneRadiance(shapes.arrays(), samples, response, traced.blocked, radiance, others);
  uint32_t skies = 0, shaded = 0;
  for (uint32_t o = 0; o < left; o++) {
    const uint32_t r = others[o];
    if (samples.shape[r] == EmissiveShapes::none)
      toSky[skies++] = r;
    else if (const Vec3f* light = uniformRadiance(shapes[samples.shape[r]], load(rays.dir, r)))
      add(r, *light);
    else
      toShade[shaded++] = r;
  }
  if (skies) {
    const SkyAlongRays sky = evaluateSky(context, rays, toSky, skies);
    for (uint32_t i = 0; i < skies; i++) add(toSky[i], load(sky.rgba, i));
  }
  if (shaded) shadeSampledPoints(context, samples, toShade, shaded, add);
}

} // namespace

void sampleEmitters(const RtsBatch& batch, const LobeSampling& sampling,
                    const Boundaries& boundaries, const SentLight& sent) {
  const StageContext& context = batch;
  const RenderScene& scene = context.scene;
  Arena& arena = context.arena;
  ArenaScope scope(arena);
  LightSamples samples = chooseLightSamples(batch, sampling);
  if (sent.coated[0])
    for (auto& a : samples.coated) a = arena.takeZero<float>(padded(samples.rays.count));
  weightLightSamples(batch, sampling, samples);
  const Rays& rays = samples.rays;
  const uint32_t n = rays.count;
  if (n == 0) return;
  auto* blocked = arena.take<uint8_t>(padded(n));
  SeenThrough seen;
  if (scene.samplesPass) {
    seen = traceThrough(batch, samples, boundaries, blocked);
  } else {
    context.counters.shadow += n;
    findBlocked(scene, rays, blocked);
  }
  blockUncertain(context, samples, seen.origin[0] ? seen.origin : rays.org, blocked);
  const TracedSamples traced{batch, boundaries, samples, seen, blocked};
  addSeen(traced, samples.response, sent.radiance);
  if (sent.coated[0]) addSeen(traced, samples.coated, sent.coated);
}

} // namespace openrt

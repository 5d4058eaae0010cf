#include "render/path/light_tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/lights/light_path_weights.h"
#include "render/lights/luminance.h"
#include "render/medium/containing_media.h"
#include "render/path/camera_connections.h"
#include "render/path/light_path_ratios.h"
#include "render/surface/adjoint.h"
#include "render/surface/continue_paths.h"
#include "render/surface/surface_shader.h"
#include "shading/running.h"

namespace openrt {
namespace {

constexpr uint32_t pathsInFlight = 4096, rouletteFrom = 4;
// Keeps the paths by way of glossy surfaces apart from the others.
constexpr uint32_t glossySeed = 0x676c6f73u;

// Adds to light paths the passages of the camera paths that they are connected to.
void addPassages(const ConnectedSurfaces& surfaces, const PathStates& states, uint32_t n) {
  const RtsBatch& camera = surfaces.batch;
  for (uint32_t r = 0; r < n; r++) {
    const uint32_t lane = camera.order[surfaces.hit[states.path[r]]];
    PathFlags flags = states.flagsOf(r);
    flags.setPassages(camera.states->flagsOf(lane).passages());
    states.flags[r] = flags.bits;
  }
}

bool takesIrradiance(const RtsBatch& batch, uint32_t i) {
  return batch.irradiance && batch.irradiance[i];
}

} // namespace

LightTracer::LightTracer(const RenderScene& scene)
    : scene_(scene), cameraArea_(cameraArea(scene)), departures_(context_),
      sensors_(scene.frame.measure == RT_MEASURE_ILLUMINANCE ? SensorPlane::of(scene)
                                                             : std::nullopt) {}

bool LightTracer::trace(uint32_t paths, uint32_t seed, const std::atomic<bool>& stop) {
  picture_.assign(size_t(scene_.frame.width) * scene_.frame.height * 3, 0.0f);
  return (!scene_.lightSources ||
          traceFrom(*scene_.lightSources, paths * scene_.lightPathsOfCameraPath, seed, stop)) &&
         (!scene_.showsGlossy ||
          traceFrom(*scene_.glossySources,
                    (paths + camerasPerGlossyPath - 1) / camerasPerGlossyPath,
                    hash(seed, glossySeed), stop));
}

std::vector<LightPathFind> LightTracer::tryPaths(const LightSources& sources, uint32_t paths,
                                                 uint32_t seed, const std::atomic<bool>& stop) {
  std::vector<LightPathFind> finds;
  finds_ = &finds;
  traceFrom(sources, paths, seed, stop);
  finds_ = nullptr;
  return finds;
}

void LightTracer::connectTo(const ConnectedSurfaces& surfaces, const PathSamples& samples) {
  ArenaScope scope(arena_);
  sources_ = scene_.glossySources.get();
  surfaces_ = &surfaces;
  probes_ = 0;
  samples_ = samples;
  followPaths(surfaces.count);
  surfaces_ = nullptr;
}

bool LightTracer::traceFrom(const LightSources& sources, uint32_t paths, uint32_t seed,
                            const std::atomic<bool>& stop) {
  sources_ = &sources;
  seed_ = seed;
  scale_ = 1.0 / paths;
  probes_ = 0;
  for (uint32_t first = 0, n; first < paths; first += n) {
    if (stop) return false;
    n = std::min(pathsInFlight, paths - first);
    tracePaths(first, n);
  }
  return true;
}

std::vector<Photon> LightTracer::tracePhotons(const LightSources& sources, uint32_t paths,
                                              uint32_t seed, const std::atomic<bool>& stop) {
  std::vector<Photon> photons;
  sources_ = &sources;
  photons_ = &photons;
  seed_ = seed;
  probes_ = 0;
  for (uint32_t first = 0; first < paths && !stop; first += pathsInFlight)
    tracePaths(first, std::min(pathsInFlight, paths - first));
  photons_ = nullptr;
  return photons;
}

void LightTracer::tracePaths(uint32_t first, uint32_t n) {
  ArenaScope scope(arena_);
  samples_.allocate(arena_, n);
  for (uint32_t i = 0; i < n; i++) samples_.set(i, ~0u, seed_, first + i);
  followPaths(n);
}

// Follows the paths of the current samples.
void LightTracer::followPaths(uint32_t n) {
  level_ = 0;
  queue_.clear();
  departures_.start(*sources_, samples_, n, queue_);
  // The surface that the camera sees, or the sensor, counts as one more level; and so do all those
  // of a camera path, but for those that it passes straight on.
  const uint32_t others = surfaces_ ? surfaces_->level + 1 : 1;
  if (surfaces_) addPassages(*surfaces_, queue_.states(), uint32_t(queue_.size()));
  Wave wave;
  wave.rays.allocate(arena_, n);
  double ended = 0; // flux, of which nobody knows where it would have gone
  while (true) {
    queue_.cut(level_ + others, scene_.frame.depth, ended);
    if (queue_.empty()) break;
    next_.clear();
    counters_.secondary += queue_.size();
    loadWave(queue_, 0, uint32_t(queue_.size()), wave);
    traceWave(wave);
    std::swap(queue_, next_);
    level_++;
  }
}

void LightTracer::traceWave(Wave& wave) {
  ArenaScope scope(arena_);
  if (sensors_) findCrossings(wave);
  intersectWave(context_, level_ == 0 ? WaveSource::lamps : WaveSource::surfaces, wave);
  if (sensors_) addCrossings(wave);
  selectMet(wave);
  forEachBucket(context_, wave, [&](const Points& points, const Bucket& bucket) {
    if (bucket.shaderClass->surface)
      scatter(points, wave, bucket);
    else if (bucket.shaderClass->transmit)
      transmitRays(points, wave.states, *bucket.shaderClass);
  });
}

// Ends the paths that hit a surface first at which the sources do not aim. Adds up the lengths of
// the others.
void LightTracer::selectMet(Wave& wave) {
  size_t n = 0;
  for (const uint32_t lane : wave.met) {
    const Record& record = scene_.records[wave.hits.record[lane]];
    if (wave.states.flagsOf(lane).pathClass() == PathClass::undeflected &&
        !((*scene_.shaders)[record.shader].traits & RTS_TRANSPARENT) &&
        !LightSources::isTarget(scene_, record, sources_->kind()))
      continue;
    departures_.travel(wave.states.path[lane], wave.hits.t[lane]);
    wave.met[n++] = lane;
  }
  wave.met = wave.met.first(n);
}

// Continues paths through a surface that has `transmit` but no lobes: it attenuates light and does
// not scatter it.
void LightTracer::transmitRays(const Points& points, const PathStates& states,
                               const RtsClass& shaderClass) {
  const uint32_t n = points.hits.count;
  RtsBatch batch(context_);
  batch.points = &points;
  float* through[3];
  for (auto& a : through) a = arena_.takeZero<float>(padded(n));
  {
    const RunningShader running(shaderClass);
    shaderClass.transmit(&scene_.host, &batch, &points.hits, through);
  }
  for (uint32_t i = 0; i < n; i++) {
    RayState state = states[points.order[i]];
    state.throughput *= min(max(Vec3f(), load(through, i)), {1, 1, 1}); // NaN: opaque
    state.flags.addPassage();
    if (largest(state.throughput) > 0) push(points, i, state, load(points.hits.direction, i));
  }
}

// Counts the hits at which paths leave a body right behind their lamp, though the lamp is not in
// it. Only the first surface tells: further ones may belong to a body that the first one has
// opened.
void LightTracer::countNeverEntered(const Points& points, const Rays& rays,
                                    const Boundaries& boundaries, const RtsClass& shaderClass) {
  constexpr uint32_t mostProbes = 64; // lamps with extent have many origins
  if (level_ > 0 || !scene_.mediumLights.empty()) return;
  uint64_t left = 0;
  for (uint32_t i = 0; i < points.hits.count; i++) {
    const openrt::Crossing& c = boundaries.crossing[i];
    if (!c.unknown) continue;
    const Vec3f lamp = load(rays.org, points.order[i]);
    if (probes_ == 0 || !(lamp == probed_) || c.from != probedMedium_) {
      if (probes_ == mostProbes) continue;
      probes_++;
      probed_ = lamp;
      probedMedium_ = c.from;
      probedInside_ = isInMedium(scene_, lamp, c.from);
    }
    left += !probedInside_;
  }
  if (left) counters_.faults.add(shaderClass, Fault::neverEntered, left);
}

void LightTracer::scatter(const Points& points, const Wave& wave, const Bucket& bucket) {
  const RtsClass& shaderClass = *bucket.shaderClass;
  const PathStates& states = wave.states;
  const uint32_t n = points.hits.count;
  RtsBatch batch(context_, points, states);
  batch.fog = bucket.fog;
  runSurfaceShader(batch, shaderClass);
  const Boundaries boundaries = crossBoundaries(batch, shaderClass);
  if (boundaries.crossing) countNeverEntered(points, wave.rays, boundaries, shaderClass);
  const bool glossy = sources_->kind() == LightSources::Kind::glossy;
  if (glossy) dropLobes(batch);
  const RandomNumbers random = randomNumbersAt(
      samples_, states, points.order, n, pairAtLevel(uint32_t(LightPair::count), level_), arena_);
  bool scatters = false;
  for (uint32_t l = 0; l < batch.lobes.size(); l++)
    scatters |= nonSpecularFunctions(batch.lobes[l]) != nullptr;
  auto* deflected = arena_.take<uint32_t>(n); // hits of paths that have hit a mirror or boundary
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++)
    if (states.flagsOf(points.order[i]).pathClass() != PathClass::undeflected)
      deflected[count++] = i;
  LobeSampling sampling = drawChoices(batch, random);
  if ((count || glossy) && scatters) {
    for (uint32_t c = 0; c < count; c++)
      departures_.updateAttenuation(states.path[points.order[deflected[c]]]);
    if (photons_) {
      leavePhotons(points, states, deflected, count);
    } else {
      if (surfaces_)
        connectToSurfaces(batch);
      else if (!sensors_ && count)
        connect(batch, random, deflected, count);
      sampleLobes(batch, sampling);
    }
  }
  spawnRays(batch, sampling, boundaries);
}

// Leaves only those lobes of first surfaces that scatter paths by way of glossy surfaces, and those
// that let them pass straight.
void LightTracer::dropLobes(const RtsBatch& batch) const {
  for (uint32_t i = 0; i < batch.points->hits.count; i++) {
    if (batch.states->flagsOf(batch.order[i]).pathClass() != PathClass::undeflected) continue;
    const bool aimed = isAimedAt(batch, i);
    for (const RtsLobe& lobe : batch.lobes)
      if (lobe.kind != RTS_LOBE_TRANSPARENT &&
          !(aimed && nonSpecularFunctions(lobe) && isGlossy(lobe)))
        store(Vec3f(), lobe.weight, i);
  }
}

void LightTracer::leavePhotons(const Points& points, const PathStates& states, const uint32_t* hits,
                               uint32_t n) {
  for (uint32_t j = 0; j < n; j++) {
    const uint32_t i = hits[j], lane = points.order[i];
    const RayState state = states[lane];
    photons_->push_back({.position = load(points.hits.position, i),
                         .direction = -load(points.hits.direction, i),
                         .power = largest(state.throughput * departures_.attenuation(state.path)),
                         .last = points.rayHits->t[lane],
                         .total = departures_.length(state.path)});
  }
}

LightStarts LightTracer::startsOf(const RtsBatch& batch) const {
  const uint32_t n = batch.points->hits.count;
  auto** start = batch.arena.takeZero<const LightSources::LightRay*>(padded(n));
  for (uint32_t i = 0; i < n; i++)
    if (!batch.states->flagsOf(batch.order[i]).scattered())
      start[i] = &departures_.ray(batch.states->path[batch.order[i]]);
  return {*sources_, start};
}

// Returns whether camera paths make paths like those in flight, too.
bool LightTracer::shares() const {
  return sources_->kind() == LightSources::Kind::glossy || (scene_.sharesMirrors && !photons_);
}

// Spawns one ray from each hit. Its sample is selected without the flux of the path, which is not
// known before the first surface has been shaded. At the first surface only specular reflection and
// refraction count, or what dropLobes() has left.
void LightTracer::spawnRays(const RtsBatch& batch, const LobeSampling& sampling,
                            const Boundaries& boundaries) {
  const Points& points = *batch.points;
  const PathStates& states = *batch.states;
  const uint32_t n = points.hits.count;
  const bool glossy = sources_->kind() == LightSources::Kind::glossy;
  const LightStarts starts = startsOf(batch);
  auto* first = arena_.takeZero<uint32_t>(padded(n));
  for (uint32_t i = 0; i < n; i++)
    first[i] = states.flagsOf(points.order[i]).pathClass() == PathClass::undeflected;
  BsdfSampleArrays samples(batch, sampling, boundaries, TransportMode::importance);
  Selection selection{.points = &points,
                      .choice = sampling.choices[0],
                      .survival = level_ >= rouletteFrom ? sampling.choices[1] : nullptr,
                      .throughput = nullptr,
                      .onlySpecular = glossy ? nullptr : first};
  selection.allocate(arena_);
  selectSamples(selection, samples);
  uint32_t number = 0;
  for (SampleArrays& sample : samples) {
    if (shares() && sample.pdf)
      sample.lightPathRatio = countLightPaths(batch, sample, selection.number, number, starts);
    number++;
  }
  for (uint32_t i = 0; i < n; i++) {
    if (!boundaries.visibleAt(i)) {
      RayState passed = states[points.order[i]];
      passed.media = boundaries.crossing[i].behind;
      passed.flags.addPassage();
      push(points, i, passed, load(points.hits.direction, i));
    } else if (selection.number[i] != SampleArrays::lacking) {
      spawnRay(batch, i, samples[selection.number[i]],
               double(selection.probability[i]) * double(selection.survivalProbability[i]),
               boundaries);
    }
  }
}

// kept: probability that the sample is followed.
void LightTracer::spawnRay(const RtsBatch& batch, uint32_t i, const SampleArrays& sample,
                           double kept, const Boundaries& boundaries) {
  const Points& points = *batch.points;
  if (!sample.isConsistentAt(points.hits, i)) return;
  RayState state = (*batch.states)[batch.order[i]];
  const RtsLobe& lobe = *sample.lobe;
  const Vec3f direction = load(sample.direction, i);
  Vec3f weight = sample.weightAt(i);
  if (sample.pdf) {
    departures_.applyAttenuation(state);
    weight = weight / radianceScale(lobe, i, direction);
    weight *= departures_.irradianceFactor(state.path, takesIrradiance(batch, i));
    departures_.setScattered(state.path);
  }
  const float correction =
      sample.deflected ? adjointCorrection(lobe, points.hits, i, direction) : 1.0f;
  state.throughput *= Vec3f(Vec3d(weight * correction) / kept);
  if (sample.lightPathRatio) state.lightPathRatio *= sample.lightPathRatio[i];
  if (sample.colour) state.flags.setChannel(uint8_t(sample.colour));
  state.media = mediaTowards(points, i, direction, boundaries, state.media);
  if (!sample.deflected) state.flags.addPassage();
  if (sample.pdf) state.flags.set(PathFlags::scatteredBit, true);
  if (sample.deflected && state.flags.pathClass() == PathClass::undeflected) {
    if (!departures_.applyEmission(points, i, state)) return;
    state.flags.setClass(PathClass::specularFirst);
    const Vec3f& flux = state.throughput;
    largestFlux_ = std::max(largestFlux_, double(flux.x) + double(flux.y) + double(flux.z));
  }
  push(points, i, state, direction);
}

void LightTracer::push(const Points& points, uint32_t i, const RayState& state,
                       const Vec3f& direction) {
  if (largest(state.throughput) > 0 && std::isfinite(largest(state.throughput)))
    queueRay(points, i, direction, state, next_);
}

// Connects the hits with the surfaces of the camera paths.
void LightTracer::connectToSurfaces(const RtsBatch& batch) {
  ArenaScope scope(arena_);
  const uint32_t n = batch.points->hits.count;
  auto* hits = arena_.take<uint32_t>(padded(n));
  float* const flux[3] = {arena_.take<float>(padded(n)), arena_.take<float>(padded(n)),
                          arena_.take<float>(padded(n))};
  uint32_t count = 0;
  for (uint32_t i = 0; i < n; i++) {
    RayState state = (*batch.states)[batch.order[i]];
    if (state.flags.pathClass() == PathClass::undeflected &&
        !departures_.applyEmission(*batch.points, i, state))
      continue;
    store(state.throughput * departures_.attenuation(state.path), flux, count);
    hits[count++] = i;
  }
  connectVertices(*surfaces_, {batch, count, hits, flux, startsOf(batch)});
}

// Returns the ratios of pdfs for scatterToCamera(); null for paths that only light tracing makes.
const float* LightTracer::ratiosToCamera(const RtsBatch& batch, const CameraConnections& to) {
  if (!shares()) return nullptr;
  auto* ratio = arena_.takeZero<float>(padded(to.count));
  ArenaScope scope(arena_);
  const float first = firstRatio(scene_), *pixels = coveredPixels(batch, to.hit, to.count);
  for (uint32_t i = 0; i < to.count; i++) {
    const RayState state = (*batch.states)[batch.order[to.hit[i]]];
    const LightSources::LightRay& start = departures_.ray(state.path);
    if (start.shape == LightSources::none) {
      ratio[i] = std::numeric_limits<float>::infinity();
      continue;
    }
    if (pixels[i] > 0) ratio[i] = state.lightPathRatio * first / pixels[i];
    if (!state.flags.scattered())
      ratio[i] = mirrorPathRatio(scene_, start.shape, start.place.position, ratio[i]);
  }
  return ratio;
}

// Connects the hits with the camera and adds their light to the picture.
void LightTracer::connect(const RtsBatch& batch, const RandomNumbers& random, const uint32_t* hits,
                          uint32_t n) {
  ArenaScope scope(arena_);
  float *lens[2], *scattered[3];
  random.draw(Decision::lens, arena_, lens);
  for (auto& a : scattered) a = arena_.take<float>(padded(n));
  const CameraConnections to = projectToCamera(batch, hits, n, lens);
  if (finds_) return addFinds(batch, to);
  scatterToCamera(batch, to, ratiosToCamera(batch, to), scattered);
  traceToCamera(batch, to, scattered);
  const uint32_t width = scene_.frame.width;
  for (uint32_t i = 0; i < n; i++) {
    const float x = to.xy[0][i], y = to.xy[1][i];
    if (!isInPicture(to, i)) continue;
    const RayState state = (*batch.states)[batch.order[hits[i]]];
    const Vec3f attenuation = attenuationAt(batch, hits[i]);
    float* pixel = &picture_[3 * (size_t(y) * width + size_t(x))];
    for (int k = 0; k < 3; k++) {
      const double light =
          double(state.throughput[k]) * attenuation[k] * scattered[k][i] * cameraArea_ * scale_;
      if (std::isfinite(light)) pixel[k] += float(light);
    }
  }
}

// Returns the flux at hit i over that in the throughput of its path, by colour.
Vec3f LightTracer::attenuationAt(const RtsBatch& batch, uint32_t i) const {
  const uint32_t path = batch.states->path[batch.order[i]];
  return departures_.attenuation(path) *
         departures_.irradianceFactor(path, takesIrradiance(batch, i));
}

bool LightTracer::isInPicture(const CameraConnections& to, uint32_t i) const {
  const float x = to.xy[0][i], y = to.xy[1][i];
  return to.weight[i] > 0 && x >= 0 && y >= 0 && x < float(scene_.frame.width) &&
         y < float(scene_.frame.height);
}

// Adds what connections to the camera bring to the finds.
void LightTracer::addFinds(const RtsBatch& batch, const CameraConnections& to) {
  float *whole[3], *weighted[3], *seen[3];
  for (auto* group : {whole, weighted, seen})
    for (int k = 0; k < 3; k++) group[k] = arena_.take<float>(padded(to.count));
  scatterToCamera(batch, to, nullptr, whole);
  scatterToCamera(batch, to, ratiosToCamera(batch, to), weighted);
  for (int k = 0; k < 3; k++) std::copy_n(whole[k], to.count, seen[k]);
  traceToCamera(batch, to, seen);
  for (uint32_t i = 0; i < to.count; i++) {
    const Vec3f all = load(whole, i), shared = load(weighted, i);
    const double found = double(all.x + all.y + all.z);
    if (!(found > 0) || !isInPicture(to, i)) continue;
    const uint32_t h = to.hit[i], lane = batch.order[h];
    const Vec3d radiance =
        Vec3d(load(batch.states->throughput, lane) * attenuationAt(batch, h) * load(seen, i)) *
        cameraArea_;
    const double square = dot(radiance, radiance);
    if (std::isfinite(square))
      finds_->push_back({double(to.xy[0][i]), double(to.xy[1][i]),
                         radiance.x + radiance.y + radiance.z, square,
                         double(shared.x + shared.y + shared.z) / found});
  }
}

// Lists where rays of paths that a mirror or a boundary has turned cross the sensors, with the flux
// that is left there. The rays have not been traced yet: their throughput is that at their origins.
void LightTracer::findCrossings(const Wave& wave) {
  crossings_.clear();
  const std::span<const RtsMedium> media = scene_.shaders->media();
  for (uint32_t lane = 0; lane < wave.rays.count; lane++) {
    if (wave.states.flagsOf(lane).pathClass() == PathClass::undeflected) continue;
    const auto at = sensors_->crossing(load(wave.rays.org, lane), load(wave.rays.dir, lane));
    if (!at) continue;
    const RayState state = wave.states[lane];
    Vec3f flux = state.throughput;
    absorb(mediumOf(state.media, media), float(at->distance), media, flux);
    crossings_.push_back({lane, at->pixel, at->distance, flux});
  }
}

// Adds the crossings that no surface hides.
void LightTracer::addCrossings(const Wave& wave) {
  for (const Crossing& c : crossings_) {
    if (!(c.distance < double(wave.hits.t[c.lane]))) continue;
    const Vec3f attenuation = departures_.attenuationAfter(wave.states.path[c.lane], c.distance);
    const double lux = luminance(c.flux * attenuation) * scale_ / sensors_->cellArea();
    for (size_t k = 0; k < 3; k++) picture_[3 * size_t(c.pixel) + k] += float(lux);
  }
}

} // namespace openrt

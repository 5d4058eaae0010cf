// tile.cpp: the wave loop of TileRenderer. Every sum has a fixed order, so the pixels of a tile do
// not depend on who renders it.
#include "render/path/tile.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "render/path/paths.h"
#include "render/path/sampler.h"
#include "render/surface/surfaces.h"
#include "shading/running.h"

namespace openrt {

namespace {
constexpr uint32_t pathsInFlight = 4096;
} // namespace

TileRenderer::TileRenderer(const RenderScene& scene)
    : scene_(scene), width_(scene.frame.width), required_(requiredSums(scene.frame)),
      brightest_(scene.emitters.brightest()), brightestSky_(scene.emitters.brightestSky()) {}

void TileRenderer::begin(const Tile& tile) {
  if (tile == tile_) return;
  tile_ = tile;
  pixels_.clear();
  places_.clear();
  for (uint32_t by = tile.y0; by < tile.y1; by += 4)
    for (uint32_t bx = tile.x0; bx < tile.x1; bx += 4)
      for (uint32_t y = by; y < std::min(by + 4, tile.y1); y++)
        for (uint32_t x = bx; x < std::min(bx + 4, tile.x1); x++) {
          pixels_.push_back(y * width_ + x);
          places_.push_back((y - tile.y0) * tile.width() + x - tile.x0);
        }
}

// Where faces coincide, a ray's hit may depend on the other rays of its batch. So a leaf is always
// divided into the same waves.
bool TileRenderer::render(const Tile& tile, const Replicates& replicates, bool centred,
                          uint32_t first, uint32_t samples, std::span<PixelSums> sums,
                          const std::atomic<bool>& stop) {
  begin(tile);
  ledger_ = {};
  replicates_ = replicates;
  centred_ = centred;
  leaf_ = first;
  sums_ = sums;
  stop_ = &stop;
  ledger_.samples += samples;
  const uint32_t most =
      std::clamp(std::bit_floor(pathsInFlight / uint32_t(pixels_.size())), 1u, largestWave);
  for (uint32_t s = first, end = first + samples; s < end;) {
    if (stopped()) return false;
    const uint32_t n = std::min(most, end - s);
    wave(s, n);
    s += n;
  }
  return !stopped(); // a wave may have been interrupted
}

// Allocates working storage for n paths. film: whether to allocate also the arrays for the channels
// that describe the first surface.
void TileRenderer::allocate(Paths& paths, uint32_t n, bool film) {
  const uint32_t size = padded(n);
  paths.states.allocate(arena_, n);
  const auto optional = [&](uint32_t channel) {
    return film && has(channel) ? arena_.takeZero<float>(size) : nullptr;
  };
  for (int k = 0; k < 3; k++) {
    paths.radiance[k] = arena_.takeZero<float>(size);
    paths.normal[k] = optional(RT_NORMAL);
    paths.albedo[k] = optional(RT_ALBEDO);
    paths.position[k] = optional(RT_POSITION);
  }
  paths.alpha = arena_.takeZero<float>(size);
  paths.depth = optional(RT_DEPTH);
  if (paths.depth) std::fill_n(paths.depth, size, std::numeric_limits<float>::infinity());
  paths.name = arena_.takeZero<uint32_t>(size);
  paths.first = arena_.take<uint8_t>(size);
  std::fill_n(paths.first, size, uint8_t(film));
  paths.hits.allocate(arena_, n);
  for (auto* list : {&paths.missed, &paths.met, &paths.order}) *list = arena_.take<uint32_t>(size);
}

void TileRenderer::wave(uint32_t firstSample, uint32_t samples) {
  ArenaScope scope(arena_);
  const uint32_t n = uint32_t(pixels_.size()) * samples;
  Paths paths;
  paths.rays.allocate(arena_, n);
  allocate(paths, n, true);
  samples_.allocate(arena_, n);
  samples_.random = arena_.takeZero<uint8_t>(n);
  makeCameraRays(paths, firstSample);
  for (uint32_t i = 0; i < n; i++) paths.states.set(i, RayState{.path = i});
  level_ = 0;
  if (scene_.transport.shaderClass) {
    runTransportShader(paths);
  } else {
    counters_.camera += n;
    follow(paths, n);
  }
  addToPixels(paths, firstSample, samples);
}

// Traces the loaded rays, then the rays that they spawn, bounce by bounce. Rays are processed in
// portions of at most n in a fixed order, so that the sums of a path have one order.
void TileRenderer::follow(Paths& paths, uint32_t n) {
  traceWave(paths);
  for (level_++; !next_.empty() && level_ <= scene_.frame.depth; level_++) {
    std::swap(queue_, next_);
    next_.clear();
    counters_.secondary += queue_.size();
    for (size_t begin = 0; begin < queue_.size() && !stopped(); begin += n) {
      loadRays(paths, begin, uint32_t(std::min<size_t>(n, queue_.size() - begin)));
      traceWave(paths);
    }
  }
  for (size_t i = 0; i < next_.size(); i++)
    for (int k = 0; k < 3; k++) ledger_.cutByDepth += double(next_.states().throughput[k][i]);
  next_.clear();
}

void TileRenderer::loadRays(Paths& paths, size_t begin, uint32_t n) {
  paths.rays.count = n;
  for (int k = 0; k < 3; k++) {
    paths.rays.org[k] = queue_.origin()[k] + begin;
    paths.rays.dir[k] = queue_.direction()[k] + begin;
  }
  std::fill_n(paths.rays.tnear, n, 0.0f);
  std::fill_n(paths.rays.tfar, n, std::numeric_limits<float>::infinity());
  paths.states = queue_.statesFrom(begin);
}

void TileRenderer::traceWave(Paths& paths) {
  ArenaScope scope(arena_);
  const Coherence coherence = level_ == 0 ? Coherence::coherent : Coherence::incoherent;
  scene_.kernel->intersect(paths.rays, maskAll, coherence, paths.hits);
  skipCulledBacks(scene_, arena_, counters_, paths.rays, paths.hits);
  absorbAlongRays(scene_, paths.rays, paths.hits, paths.states);
  uint32_t misses = 0, hitCount = 0;
  for (uint32_t i = 0; i < paths.rays.count; i++)
    (paths.hits.record[i] == noHit ? paths.missed[misses++] : paths.met[hitCount++]) = i;
  addEnvironment(paths, paths.missed, misses);
  for (const BucketRange& range :
       sortByBucket(scene_, paths.hits, paths.met, hitCount, paths.order, arena_))
    shadeRange(paths, paths.hits, range, paths.order + range.begin);
}

RtsBatch TileRenderer::makeBatch() {
  RtsBatch batch;
  batch.scene = &scene_;
  batch.arena = &arena_;
  batch.counters = &counters_;
  batch.tracer = this;
  return batch;
}

RtsBatch TileRenderer::makeBatch(const Paths& paths, const Points& points, const uint32_t* order) {
  RtsBatch batch = makeBatch();
  batch.points = &points;
  batch.states = &paths.states;
  batch.order = order;
  return batch;
}

void TileRenderer::makeCameraRays(Paths& paths, uint32_t firstSample) {
  const uint32_t n = paths.rays.count, size = padded(n);
  const uint32_t samples = n / uint32_t(pixels_.size());
  ArenaScope scope(arena_);
  float* xy[2] = {arena_.take<float>(size), arena_.take<float>(size)};
  RtsRays local;
  for (int k = 0; k < 3; k++) {
    local.origin[k] = arena_.takeZero<float>(size);
    local.direction[k] = arena_.takeZero<float>(size);
  }
  uint32_t lane = 0;
  for (uint32_t pixel : pixels_)
    for (uint32_t sample = firstSample; sample < firstSample + samples; sample++, lane++)
      samples_.set(lane, pixel, replicates_.seedOf(sample), replicates_.indexOf(sample));
  float* place[2]; // in the pixel
  randomNumbersAtStart(samples_, n, arena_).drawPair(0, arena_, place);
  lane = 0;
  for (uint32_t pixel : pixels_)
    for (uint32_t s = 0; s < samples; s++, lane++) {
      xy[0][lane] = float(pixel % width_) + (centred_ ? 0.5f : place[0][lane]);
      xy[1][lane] = float(pixel / width_) + (centred_ ? 0.5f : place[1][lane]);
    }
  for (; lane < size; lane++) {
    xy[0][lane] = xy[0][n - 1];
    xy[1][lane] = xy[1][n - 1];
  }
  for (uint32_t i = 0; i < size; i++) {
    paths.rays.tnear[i] = 0;
    paths.rays.tfar[i] = std::numeric_limits<float>::infinity();
  }
  const float* points[2] = {xy[0], xy[1]};
  const float extent[2] = {float(width_), float(scene_.frame.height)};
  RtsBatch batch = makeBatch();
  batch.rays = n;
  const ShaderSlot& camera = scene_.camera.shader;
  {
    const RunningShader running(*camera.shaderClass);
    camera.shaderClass->generate(&scene_.host, &batch, camera.params, n, points, extent, &local);
  }
  const Affine& m = scene_.camera.fromLocal;
  for (uint32_t i = 0; i < size; i++) {
    const float ox = local.origin[0][i], oy = local.origin[1][i], oz = local.origin[2][i];
    const float dx = local.direction[0][i], dy = local.direction[1][i], dz = local.direction[2][i];
    float d[3];
    for (int k = 0; k < 3; k++) {
      paths.rays.org[k][i] = m.r[k][0] * ox + m.r[k][1] * oy + m.r[k][2] * oz + m.r[k][3];
      d[k] = m.r[k][0] * dx + m.r[k][1] * dy + m.r[k][2] * dz;
    }
    const float s = 1 / std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int k = 0; k < 3; k++) paths.rays.dir[k][i] = d[k] * s;
  }
}

// Evaluates the environment in the directions of rays. Returns local unit directions and rgba,
// padded.
void TileRenderer::evaluateSky(const Rays& rays, const uint32_t* lanes, uint32_t n,
                               float* direction[3], float* rgba[4]) {
  const uint32_t size = padded(n);
  for (int k = 0; k < 3; k++) direction[k] = arena_.take<float>(size);
  for (int k = 0; k < 4; k++) rgba[k] = arena_.takeZero<float>(size);
  const Affine& m = scene_.environment.toLocal;
  for (uint32_t i = 0; i < size; i++) {
    const uint32_t lane = lanes[std::min(i, n - 1)];
    const float x = rays.dir[0][lane], y = rays.dir[1][lane], z = rays.dir[2][lane];
    float d[3];
    for (int k = 0; k < 3; k++) d[k] = m.r[k][0] * x + m.r[k][1] * y + m.r[k][2] * z;
    const float s = 1 / std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int k = 0; k < 3; k++) direction[k][i] = d[k] * s;
  }
  const ShaderSlot& environment = scene_.environment.shader;
  RtsBatch batch = makeBatch();
  batch.lanes = n;
  const float* directions[3] = {direction[0], direction[1], direction[2]};
  const RunningShader running(*environment.shaderClass);
  environment.shaderClass->miss(&scene_.host, &batch, environment.params, n, directions, rgba);
  sanitizeOutput(*environment.shaderClass, batch, n, {rgba[0], rgba[1], rgba[2], rgba[3]});
}

void TileRenderer::addEnvironment(Paths& paths, const uint32_t* missed, uint32_t n) {
  const ShaderSlot& environment = scene_.environment.shader;
  if (n == 0 || !environment.shaderClass || !environment.shaderClass->miss) return;
  ArenaScope scope(arena_);
  float *direction[3], *rgba[4];
  evaluateSky(paths.rays, missed, n, direction, rgba);
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t lane = missed[i], path = paths.states.path[lane];
    const float pdf = paths.states.pdf[lane];
    const PathFlags flags = paths.states.flagsOf(lane);
    float weight = 0, misWeight = 1;
    // Light sampling of the sky could also have chosen this direction, so BSDF sampling has this
    // MIS weight.
    if (pdf > 0 && scene_.emitters.any()) {
      const float d[3] = {direction[0][i], direction[1][i], direction[2][i]};
      misWeight = pdf / (pdf + scene_.emitters.skyPdf(paths.states.previousOf(lane), d));
    }
    if (flags.specularSinceDiffuse()) {
      const float light[3] = {rgba[0][i], rgba[1][i], rgba[2][i]};
      unsampledLightOf(flags).meet(light, brightestFor(flags));
    }
    for (int k = 0; k < 3; k++) {
      const float throughput = paths.states.throughput[k][lane];
      if (std::isfinite(rgba[k][i])) paths.radiance[k][path] += throughput * misWeight * rgba[k][i];
      weight += throughput;
    }
    if (!flags.deflected()) paths.alpha[path] += weight / 3 * rgba[3][i];
  }
}

// Evaluates fog at the hits. On mirrored and refracted paths the fog has the whole path length, in
// the direction of the current ray.
void TileRenderer::attenuate(const Points& points, const Paths& paths, const uint32_t* order,
                             float* fog[4]) {
  const ShaderSlot& environment = scene_.environment.shader;
  fog[3] = nullptr;
  if (!environment.shaderClass || !environment.shaderClass->attenuate) return;
  const uint32_t n = points.hits.count, size = padded(n);
  float* fromEye[3];
  for (auto& a : fromEye) a = arena_.take<float>(size);
  const Affine& m = scene_.environment.toLocal;
  const RtsHits& h = points.hits;
  for (uint32_t i = 0; i < size; i++) {
    const bool deflected = paths.states.flagsOf(order[std::min(i, n - 1)]).deflected();
    float toHit[3];
    for (int j = 0; j < 3; j++)
      toHit[j] = deflected ? h.direction[j][i] * h.distance[i] : h.position[j][i] - scene_.eye[j];
    for (int k = 0; k < 3; k++)
      fromEye[k][i] = m.r[k][0] * toHit[0] + m.r[k][1] * toHit[1] + m.r[k][2] * toHit[2];
  }
  for (int k = 0; k < 4; k++) fog[k] = arena_.takeZero<float>(size);
  RtsBatch batch = makeBatch();
  batch.lanes = n;
  const float* vectors[3] = {fromEye[0], fromEye[1], fromEye[2]};
  const RunningShader running(*environment.shaderClass);
  environment.shaderClass->attenuate(&scene_.host, &batch, environment.params, n, vectors, fog,
                                     fog[3]);
}

void TileRenderer::shadeRange(Paths& paths, const RayHits& hits, const BucketRange& range,
                              const uint32_t* order) {
  ArenaScope scope(arena_);
  const uint32_t n = range.end - range.begin;
  const Points points =
      makePoints(scene_, paths.rays, hits, order, n, paths.states.travelled, arena_);
  const Shading shading = traitsOf(scene_.frame.transport).shading;
  (this->*shadings[size_t(shading)])(paths, points, scene_.buckets[range.bucket], order);
}

void TileRenderer::shadeByLobes(Paths& paths, const Points& points, const Bucket& bucket,
                                const uint32_t* order) {
  if (bucket.shaderClass->surface)
    scatterRange(paths, points, bucket, order);
  else
    shadeByShade(paths, points, bucket, order);
}

void TileRenderer::shadeByShade(Paths& paths, const Points& points, const Bucket& bucket,
                                const uint32_t* order) {
  if (!bucket.shaderClass->shade) return scatterRange(paths, points, bucket, order);
  const uint32_t size = padded(points.hits.count);
  RtsShading shaded;
  for (int k = 0; k < 3; k++) {
    shaded.radiance[k] = arena_.takeZero<float>(size);
    shaded.transmission[k] = arena_.takeZero<float>(size);
    shaded.albedo[k] = has(RT_ALBEDO) ? arena_.takeZero<float>(size) : nullptr;
  }
  {
    ArenaScope inner(arena_);
    RtsBatch batch = makeBatch(paths, points, order);
    batch.lightSet = bucket.lightSet;
    const RunningShader running(*bucket.shaderClass);
    bucket.shaderClass->shade(&scene_.host, &batch, &points.hits, &shaded);
    sanitizeOutput(*bucket.shaderClass, batch, shaded);
  }
  float* fog[4];
  attenuate(points, paths, order, fog);
  const float* airlight[4] = {fog[0], fog[1], fog[2], fog[3]};
  addShading(points, shaded, order, paths, airlight);
}

// Adds shaded radiance to the paths and spawns rays through transparent surfaces.
void TileRenderer::addShading(const Points& points, const RtsShading& shaded, const uint32_t* order,
                              Paths& paths, const float* fog[4]) {
  for (uint32_t i = 0; i < points.hits.count; i++) {
    const RayState ray = paths.states[order[i]];
    float transmission[3], covered = 0, through = 0;
    for (int k = 0; k < 3; k++) {
      const float t = shaded.transmission[k][i];
      transmission[k] = t > 0 ? std::min(t, 1.0f) : 0.0f;
      float radiance = std::isfinite(shaded.radiance[k][i]) ? shaded.radiance[k][i] : 0.0f;
      if (fog[3])
        radiance = fog[3][i] * radiance + (1 - fog[3][i]) * fog[k][i] * (1 - transmission[k]);
      paths.radiance[k][ray.path] += ray.throughput[k] * radiance;
      covered += ray.throughput[k] * (1 - transmission[k]);
      through += ray.throughput[k] * transmission[k];
    }
    if (!ray.flags.deflected()) paths.alpha[ray.path] += covered / 3;
    if (paths.first[ray.path]) storeFirstHit(points, i, ray.path, shaded.albedo, paths);
    if (through <= 1e-6f) {
      ledger_.cutByEnergy += double(through);
      continue;
    }
    NextRay nextRay{.pdf = 0,
                    .deflected = false,
                    .split = false,
                    .twoSided = false,
                    .channel = ray.flags.channel(),
                    .branch = ray.branch,
                    .media = ray.media};
    for (int k = 0; k < 3; k++) {
      nextRay.direction[k] = points.hits.direction[k][i];
      nextRay.weight[k] = transmission[k];
    }
    push(points, i, order[i], nextRay, paths);
  }
}

// Stores the first hit for the auxiliary channels (AOVs).
void TileRenderer::storeFirstHit(const Points& points, uint32_t i, uint32_t path,
                                 float* const albedo[3], Paths& paths) {
  const RtsHits& h = points.hits;
  paths.first[path] = 0;
  paths.name[path] = scene_.records[points.record[i]].name;
  float along = 0;
  for (int k = 0; k < 3; k++) {
    along += (h.position[k][i] - scene_.eye[k]) * scene_.viewAxis[k];
    if (paths.normal[k]) paths.normal[k][path] = h.normal[k][i];
    if (paths.albedo[k]) paths.albedo[k][path] = albedo[k][i];
    if (paths.position[k]) paths.position[k][path] = float(h.position[k][i] + scene_.origin[k]);
  }
  if (paths.depth) paths.depth[path] = along;
}

// Queues another ray of the path, starting on the side of the surface that its direction leads to.
void TileRenderer::push(const Points& points, uint32_t i, uint32_t lane, const NextRay& nextRay,
                        Paths& paths) {
  const RtsHits& h = points.hits;
  RayState ray = paths.states[lane];
  float origin[3];
  liftPoint(points, i, nextRay.direction, origin);
  for (int k = 0; k < 3; k++) ray.throughput[k] *= nextRay.weight[k];
  ray.travelled = h.distance[i];
  ray.pdf = nextRay.pdf;
  const bool specular = !(nextRay.pdf > 0);
  if (!specular) ray.previous = lightSampleContext(points, i, nextRay.twoSided);
  if (nextRay.deflected) {
    const PathClass before = ray.flags.pathClass();
    if (before == PathClass::undeflected)
      ray.flags.setClass(specular ? PathClass::specularFirst : PathClass::diffuse);
    else if (before != PathClass::specularFirst)
      ray.flags.setClass(specular ? PathClass::caustic : PathClass::diffuse);
    if (!specular) ray.flags.set(PathFlags::scatteredBit, true);
    ray.flags.set(PathFlags::specularSinceDiffuseBit, ray.flags.scattered() && specular);
    if (ray.flags.specularSinceDiffuse())
      unsampledLightOf(ray.flags).send(ray.throughput, brightestFor(ray.flags));
    ray.flags.set(PathFlags::deflectedBit, true);
  }
  ray.branch = nextRay.branch;
  ray.flags.setChannel(nextRay.channel);
  ray.media = nextRay.media;
  if (nextRay.split) ray.flags.addSplit();
  next_.push(origin, nextRay.direction, ray);
}

void TileRenderer::addToPixels(const Paths& paths, uint32_t firstSample, uint32_t samples) {
  const float limit = scene_.frame.clamp;
  for (size_t pixel = 0; pixel < pixels_.size(); pixel++) {
    PixelSums& sums = sums_[places_[pixel]];
    for (uint32_t s = 0; s < samples; s++) {
      const size_t i = pixel * samples + s;
      float radiance[3] = {paths.radiance[0][i], paths.radiance[1][i], paths.radiance[2][i]};
      for (float& r : radiance) {
        if (!(limit > 0 && r > limit)) continue;
        ledger_.clipped += double(r) - double(limit);
        r = limit;
      }
      if (required_.spread)
        sums.add(radiance, paths.alpha[i]);
      else
        sums.addColor(radiance, paths.alpha[i]);
      if (required_.error) {
        sums.addTails(radiance);
        sums.random |= samples_.random[i] != 0;
        // Replicates larger than the leaf are closed where leaves are merged.
        const uint32_t next = firstSample + s + 1;
        if (replicates_.many() && replicates_.indexOf(next) == 0 &&
            next - leaf_ >= replicates_.size())
          sums.closeReplicate();
      }
      for (int k = 0; k < 3; k++) {
        if (paths.normal[k]) sums.normal[k] += paths.normal[k][i];
        if (paths.albedo[k]) sums.albedo[k] += paths.albedo[k][i];
      }
      if (firstSample + s) continue;
      if (paths.depth) sums.depth = paths.depth[i];
      if (paths.position[0])
        for (int k = 0; k < 3; k++) sums.position[k] = paths.position[k][i];
      sums.name = has(RT_NAME) ? float(paths.name[i]) : 0.0f;
    }
  }
}

} // namespace openrt

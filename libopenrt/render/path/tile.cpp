// tile.cpp: the wave loop of TileRenderer. Every sum has a fixed order, so the pixels of a tile do
// not depend on who renders it.
#include "render/path/tile.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "render/lights/emitted.h"
#include "render/lights/environment.h"
#include "render/lights/lamps.h"
#include "render/path/accumulate.h"
#include "render/path/camera_rays.h"
#include "render/path/measure.h"
#include "render/surface/sanitize_output.h"
#include "render/surface/surface_shader.h"
#include "render/wave/light_stride.h"
#include "shading/running.h"

namespace openrt {

namespace {
constexpr uint32_t pathsInFlight = 4096;
} // namespace

TileRenderer::TileRenderer(const RenderScene& scene)
    : scene_(scene), width_(scene.frame.width), required_(requiredSums(scene.frame)) {}

void TileRenderer::begin(const Tile& tile) {
  if (tile == tile_) return;
  tile_ = tile;
  listPixels(tile);
  if (scene_.lightPathFlux > 0) footprint_ = footprintOf(context_, tile);
}

// Lists the pixels of a tile in blocks of 4 x 4, those with light first.
void TileRenderer::listPixels(const Tile& tile) {
  pixels_.clear();
  std::vector<uint32_t> unlit;
  for (uint32_t by = tile.y0; by < tile.y1; by += 4)
    for (uint32_t bx = tile.x0; bx < tile.x1; bx += 4)
      for (uint32_t y = by; y < std::min(by + 4, tile.y1); y++)
        for (uint32_t x = bx; x < std::min(bx + 4, tile.x1); x++) {
          const bool lit = isLit(x, y, lightStride_, scene_.frame.seed);
          (lit ? pixels_ : unlit).push_back(y * width_ + x);
        }
  lit_ = uint32_t(pixels_.size());
  pixels_.insert(pixels_.end(), unlit.begin(), unlit.end());
  places_.clear();
  for (const uint32_t pixel : pixels_)
    places_.push_back((pixel / width_ - tile.y0) * tile.width() + pixel % width_ - tile.x0);
}

// Where faces coincide, a ray's hit may depend on the other rays of its batch. So a leaf is always
// divided into the same waves.
bool TileRenderer::render(const Tile& tile, const Replicates& replicates, bool centred,
                          uint32_t first, uint32_t samples, std::span<PixelSums> sums,
                          const std::atomic<bool>& stop, HitCounts* hits) {
  begin(tile);
  ledger_ = {};
  replicates_ = replicates;
  centred_ = centred;
  leaf_ = first;
  sums_ = sums;
  hits_ = required_.names ? hits : nullptr;
  if (hits_) hits_->clear();
  stop_ = &stop;
  ledger_.samples += samples;
  const auto all = uint32_t(pixels_.size());
  // A pixel without light has its first sample only, so that what it sees and the light of the
  // environment there belong together.
  const bool done = renderPixels({0, lit_, true}, first, samples) &&
                    (first > 0 || renderPixels({lit_, all, false}, 0, 1));
  if (hits_) hits_->finish();
  return done;
}

bool TileRenderer::renderPixels(const PixelRange& range, uint32_t first, uint32_t samples) {
  if (range.count() == 0) return !stopped();
  const uint32_t most = std::clamp(std::bit_floor(pathsInFlight / range.count()), 1u, largestWave);
  for (uint32_t s = first, end = first + samples; s < end;) {
    if (stopped()) return false;
    const uint32_t n = std::min(most, end - s);
    renderWave(range, s, n);
    s += n;
  }
  return !stopped(); // a wave may have been interrupted
}

void TileRenderer::renderWave(const PixelRange& range, uint32_t firstSample, uint32_t samples) {
  ArenaScope scope(arena_);
  const auto pixels = std::span<const uint32_t>(pixels_).subspan(range.begin, range.count());
  const bool centred = centred_ || scene_.frame.measure != RT_MEASURE_NOTHING;
  const FilmSamples film{pixels, width_, firstSample, samples, replicates_, centred};
  const uint32_t n = film.count();
  PixelSamples found;
  found.allocate(arena_, n);
  found.allocateFirst(arena_, n, scene_.frame.channels);
  samples_.allocate(arena_, n);
  samples_.random = arena_.takeZero<uint8_t>(n);
  startSamples(film, samples_);
  Wave wave;
  wave.rays.allocate(arena_, n);
  wave.states.allocate(arena_, n);
  for (uint32_t i = 0; i < n; i++) wave.states.set(i, RayState{.path = i});
  level_ = 0;
  float* xy[2];
  sampleFilm(film, samples_, arena_, xy);
  makeCameraRays(context_, xy, wave.rays);
  if (scattersInMedia()) startInMedia(wave);
  if (scene_.transport.shaderClass) {
    runTransportShader(wave.rays, found);
  } else {
    counters_.camera += n;
    renderPaths(range.light, wave, found);
  }
  addToPixels(range, found, firstSample, samples);
}

void TileRenderer::renderPaths(bool light, Wave& wave, PixelSamples& found) {
  if (scene_.frame.measure == RT_MEASURE_ILLUMINANCE) {
    const uint32_t n = wave.rays.count; // follow() uses the wave again
    for (float*& lamps : lampLight_) lamps = arena_.takeZero<float>(n);
    follow(wave, found);
    return noteFoundLight(n, found);
  }
  firstHits_.begin(wave.rays);
  if (showsNoLight_) {
    firstHits_.describe(context_, wave, found);
  } else if (!light) {
    describe(wave, found);
  } else {
    if (scene_.frame.followImages) found.firstHits = &firstHits_;
    if (scattersInMedia()) describeBehindMedia(wave, found);
    follow(wave, found);
  }
  firstHits_.finish(found);
}

// Finds what pixels without light see, and the light of the environment where they see it.
void TileRenderer::describe(Wave& wave, PixelSamples& found) {
  firstHits_.describe(context_, wave, found);
  addEnvironment(context_, wave, unsampled_, found);
  found.complete = arena_.takeZero<uint8_t>(wave.rays.count);
  for (const uint32_t lane : wave.missed) found.complete[wave.states.path[lane]] = 1;
}

// Traces the rays of a wave, then the rays that they spawn, bounce by bounce. Rays are processed in
// portions of at most the size of the wave in a fixed order, so that the sums of a path have one
// order.
void TileRenderer::follow(Wave& wave, PixelSamples& found) {
  const uint32_t most = wave.rays.count;
  if (scene_.frame.measure == RT_MEASURE_ILLUMINANCE && nesting_ == 0)
    measureIlluminance(wave, found);
  else
    traceWave(wave, found);
  for (level_++; !next_.empty() || !guided_.empty(); level_++) {
    std::swap(queue_, next_);
    next_.clear();
    queue_.cut(level_, scene_.frame.depth, ledger_.cutByDepth);
    counters_.secondary += queue_.size();
    for (size_t begin = 0; begin < queue_.size() && !stopped(); begin += most) {
      loadWave(queue_, begin, uint32_t(std::min<size_t>(most, queue_.size() - begin)), wave);
      traceWave(wave, found);
    }
    guided_.follow(samples_, level_, found);
  }
}

void TileRenderer::traceWave(Wave& wave, PixelSamples& found) {
  ArenaScope scope(arena_);
  intersectWave(context_, level_ == 0 ? WaveSource::camera : WaveSource::surfaces, wave);
  if (scattersInMedia()) scatterInMedia(wave, found);
  addEnvironment(context_, wave, unsampled_, found);
  const auto shade = shadings[size_t(traitsOf(scene_.frame.transport).shading)];
  forEachBucket(context_, wave, [&](const Points& points, const Bucket& bucket) {
    (this->*shade)(points, bucket, wave.states, found);
  });
}

void TileRenderer::shadeByLobes(const Points& points, const Bucket& bucket,
                                const PathStates& states, PixelSamples& found) {
  if (bucket.shaderClass->surface)
    scatter(points, bucket, states, found);
  else
    shadeByShade(points, bucket, states, found);
}

void TileRenderer::shadeByShade(const Points& points, const Bucket& bucket,
                                const PathStates& states, PixelSamples& found) {
  if (!bucket.shaderClass->shade) return scatter(points, bucket, states, found);
  const uint32_t size = padded(points.hits.count);
  RtsShading shaded{};
  for (int k = 0; k < 3; k++) {
    shaded.radiance[k] = arena_.takeZero<float>(size);
    shaded.transmission[k] = arena_.takeZero<float>(size);
    if (has(RT_ALBEDO)) shaded.albedo[k] = arena_.takeZero<float>(size);
  }
  RtsBatch batch = makeBatch(context_, points, states);
  batch.lightSet = bucket.lightSet;
  {
    ArenaScope inner(arena_);
    const RunningShader running(*bucket.shaderClass);
    bucket.shaderClass->shade(&scene_.host, &batch, &points.hits, &shaded);
    sanitizeOutput(*bucket.shaderClass, batch, shaded);
  }
  addShading(pathsOf(batch), shaded, fogAt(context_, points, states), found);
}

// Returns where the light that surfaces send back is collected: their emission is the first part.
SentLight TileRenderer::sentLight(const RtsBatch& batch, const RtsSurface& surface) {
  SentLight sent{{surface.emission[0], surface.emission[1], surface.emission[2]}};
  const bool coats = has(RT_REFLECTION) && tracesPaths(scene_.frame.transport) &&
                     std::any_of(batch.lobes, batch.lobes + batch.lobeCount,
                                 [](const RtsLobe& lobe) { return lobe.coat != 0; });
  if (coats)
    for (auto& a : sent.coated) a = arena_.takeZero<float>(padded(batch.points->hits.count));
  return sent;
}

// Shades surfaces that are described by lobes. The stages are those of docs/architecture.md, "One
// hit, stage by stage".
void TileRenderer::scatter(const Points& points, const Bucket& bucket, const PathStates& states,
                           PixelSamples& found) {
  RtsBatch batch = makeBatch(context_, points, states);
  batch.lightSet = bucket.lightSet;
  const RtsSurface surface = runSurfaceShader(batch, *bucket.shaderClass, has(RT_ALBEDO));
  sanitizeOutput(*bucket.shaderClass, batch, surface);
  const Boundaries boundaries = crossBoundaries(batch, *bucket.shaderClass);
  batch.crossing = boundaries.crossing;
  weightEmission(batch, boundaries, unsampled_, surface.emission);
  const SentLight sent = sentLight(batch, surface);
  gatherLight(batch, boundaries, sent);
  addSurface(batch, surface, sent, boundaries, fogAt(context_, points, states), found);
}

// Adds the light of lamps and emitters that the lobes of a batch send back, and spawns the rays
// that find the rest.
void TileRenderer::gatherLight(RtsBatch& batch, const Boundaries& boundaries,
                               const SentLight& sent) {
  addLamps(batch, sent);
  continueFromLobes(batch, boundaries, sent);
}

// Returns whether the depth limit leaves room for one more surface on the path of hit i.
bool TileRenderer::goesOn(const RtsBatch& batch, uint32_t i) const {
  return isWithinDepth(batch.states->flagsOf(batch.order[i]), level_ + 1, scene_.frame.depth);
}

bool TileRenderer::samplesEmitters(const RtsBatch& batch) const {
  if (!scene_.emitters->any()) return false;
  if (level_ < scene_.frame.depth) return true;
  for (uint32_t i = 0; i < batch.points->hits.count; i++)
    if (goesOn(batch, i)) return true;
  return false;
}

// Does the same without the lamps.
void TileRenderer::continueFromLobes(RtsBatch& batch, const Boundaries& boundaries,
                                     const SentLight& sent) {
  LobeSampling sampling;
  const bool path = tracesPaths(scene_.frame.transport);
  const bool emitters = path && samplesEmitters(batch);
  if (path) {
    sampling = drawChoices(batch, randomNumbersAt(samples_, *batch.states, batch.order,
                                                  batch.points->hits.count, firstPair(), arena_));
    sampleLobes(batch, sampling);
    if (emitters) allocateSelection(batch, sampling);
  }
  spawnRays(pathsOf(batch), sampling, boundaries);
  if (emitters && level_ >= scene_.frame.depth)
    for (float* followed : sampling.selectionProbability)
      for (uint32_t i = 0; followed && i < batch.points->hits.count; i++)
        if (!goesOn(batch, i)) followed[i] = 0;
  if (emitters) sampleEmitters(batch, sampling, boundaries, sent);
  if (emitters && scene_.lightPathFlux > 0) addLightPathBound(pathsOf(batch), sampling, footprint_);
  if (emitters && scene_.photonGuide) guided_.start(pathsOf(batch), sampling, boundaries);
}

namespace {

// The largest radiance of a sample. More is the work of a faulty shader or of a hostile world, and
// sums of such samples would not be finite floats.
constexpr float brightest = 1e36f;

// Limits the radiance of a sample; `clipped` adds up what it loses. A sum that is not a number
// counts as dark.
float clampRadiance(float radiance, float limit, double& clipped) {
  if (radiance <= limit && radiance >= -brightest) return radiance;
  if (!(radiance > limit)) return 0;
  clipped += double(std::min(radiance, std::numeric_limits<float>::max())) - double(limit);
  return limit;
}

} // namespace

void TileRenderer::addToPixels(const PixelRange& range, const PixelSamples& found,
                               uint32_t firstSample, uint32_t samples) {
  const float clamp = scene_.frame.clamp,
              limit = clamp > 0 ? std::min(clamp, brightest) : brightest;
  for (uint32_t pixel = 0; pixel < range.count(); pixel++) {
    const uint32_t place = places_[range.begin + pixel];
    PixelSums& sums = sums_[place];
    for (uint32_t s = 0; s < samples; s++) {
      const uint32_t i = pixel * samples + s;
      const bool first = firstSample + s == 0;
      if (hits_) {
        const std::vector<uint32_t>& united = scene_.frame.unitedNames;
        const uint32_t name = found.name[i];
        hits_->add(place, name < united.size() ? united[name] : name);
      }
      if (found.complete && !found.complete[i]) { // a surface, and no light
        addFirst(found, i, sums);
        continue;
      }
      float radiance[3] = {found.radiance[0][i], found.radiance[1][i], found.radiance[2][i]};
      if (scene_.frame.measure)
        std::fill_n(radiance, 3, readingOf(scene_.frame, load(found.radiance, i)));
      for (float& r : radiance) r = clampRadiance(r, limit, ledger_.clipped);
      if (required_.spread)
        sums.add(radiance, found.alpha[i]);
      else
        sums.addColor(radiance, found.alpha[i]);
      if (required_.error) {
        sums.addTails(radiance);
        sums.random |= samples_.random[i];
        // Replicates larger than the leaf are closed where leaves are merged.
        const uint32_t next = firstSample + s + 1;
        if (replicates_.many() && replicates_.indexOf(next) == 0 &&
            next - leaf_ >= replicates_.size())
          sums.closeReplicate();
      }
      if (first)
        addFirst(found, i, sums);
      else
        addSurfaces(found, i, sums);
    }
  }
}

void TileRenderer::addSurfaces(const PixelSamples& found, uint32_t path, PixelSums& sums) {
  for (int k = 0; k < 3; k++) {
    if (found.normal[k]) sums.normal[k] += found.normal[k][path];
    if (found.albedo[k]) sums.albedo[k] += found.albedo[k][path];
    if (found.reflection[k]) sums.reflection[k] += found.reflection[k][path];
  }
}

void TileRenderer::addFirst(const PixelSamples& found, uint32_t path, PixelSums& sums) {
  addSurfaces(found, path, sums);
  if (found.depth) sums.depth = found.depth[path];
  if (found.position[0])
    for (int k = 0; k < 3; k++) sums.position[k] = found.position[k][path];
  if (found.motion[0])
    for (int k = 0; k < 3; k++) sums.motion[k] = found.motion[k][path];
  sums.name = has(RT_NAME) ? float(found.name[path]) : 0.0f;
}

} // namespace openrt

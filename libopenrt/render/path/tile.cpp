// tile.cpp: the samples of a tile, wave by wave. Every sum has a fixed order, so the pixels of a
// tile do not depend on who renders it.
#include "render/path/tile.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "render/lights/environment.h"
#include "render/medium/containing_media.h"
#include "render/path/camera_rays.h"
#include "render/path/light_path_ratios.h"
#include "render/path/measure.h"
#include "render/path/transport_shader.h"

namespace openrt {

namespace {
constexpr uint32_t pathsInFlight = 4096;
} // namespace

TileRenderer::TileRenderer(const RenderScene& scene)
    : scene_(scene), width_(scene.frame.width), required_(requiredSums(scene.frame)) {
  for (const ChannelInfo& row : channelTable)
    for (uint32_t k = 0; k < row.components && (scene.frame.channels & row.bit); k++) {
      if (row.source == ChannelSource::firstSample) firstPlaces_.push_back(row.place + k);
      if (row.source == ChannelSource::mean) meanPlaces_.push_back(row.place + k);
    }
}

void TileRenderer::begin(const Tile& tile) {
  if (tile == tile_) return;
  tile_ = tile;
  listPixels(tile);
  if (scene_.lightPathFlux > 0) paths_.footprint = footprintOf(tracer_.context(), tile);
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
  paths_.ledger = {};
  paths_.centred = centred;
  paths_.stop = &stop;
  replicates_ = replicates;
  leaf_ = first;
  sums_ = sums;
  hits_ = required_.names ? hits : nullptr;
  if (hits_) hits_->clear();
  paths_.ledger.samples += samples;
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
  Arena& arena = paths_.arena;
  ArenaScope scope(arena);
  const auto pixels = std::span<const uint32_t>(pixels_).subspan(range.begin, range.count());
  const bool centred = paths_.centred || scene_.frame.measure != RT_MEASURE_NOTHING;
  const FilmSamples film{pixels,      width_,  firstSample,        samples,
                         replicates_, centred, scene_.frame.jitter};
  const uint32_t n = film.count();
  PixelSamples found;
  found.allocate(arena, n);
  found.allocateChannels(arena, n, scene_.frame.channels);
  PathSamples paths;
  paths.allocate(arena, n);
  paths.random = arena.takeZero<uint8_t>(n);
  startSamples(film, paths);
  tracer_.begin(paths);
  Wave wave;
  wave.rays.allocate(arena, n);
  wave.states.allocate(arena, n);
  const float ratio = firstRatio(scene_);
  for (uint32_t i = 0; i < n; i++) wave.states.set(i, RayState{.path = i, .lightPathRatio = ratio});
  float* xy[2];
  sampleFilm(film, paths, arena, xy);
  recordPlaces(film, xy, found);
  makeCameraRays(tracer_.context(), xy, wave.rays);
  if (!scene_.mediumLights.empty()) {
    ArenaScope inner(arena);
    findContainingMedia(tracer_.context(), wave.rays, wave.states.media);
  }
  if (scene_.transport.shaderClass) {
    runTransportShader(tracer_.context(), wave.rays, found);
  } else {
    paths_.counters.camera += n;
    renderPaths(range.light, wave, found);
  }
  addToPixels(range, film, found);
}

void TileRenderer::renderPaths(bool light, Wave& wave, PixelSamples& found) {
  if (scene_.frame.measure == RT_MEASURE_ILLUMINANCE)
    return measureIlluminance(tracer_, wave, found);
  firstHits_.begin(wave.rays);
  if (showsNoLight_) {
    firstHits_.describe(tracer_.context(), wave, found);
  } else if (!light) {
    describe(wave, found);
  } else {
    if (scene_.frame.followImages) found.firstHits = &firstHits_;
    if (!scene_.mediumLights.empty())
      firstHits_.describeBehindMedia(tracer_.context(), wave, found);
    tracer_.trace(wave, found);
  }
  firstHits_.finish(found);
}

// Finds what pixels without light see, and the light of the environment where they see it.
void TileRenderer::describe(Wave& wave, PixelSamples& found) {
  firstHits_.describe(tracer_.context(), wave, found);
  addEnvironment(tracer_.context(), wave, paths_.unsampled, found);
  found.complete = paths_.arena.takeZero<uint8_t>(wave.rays.count);
  for (const uint32_t lane : wave.missed) found.complete[wave.states.path[lane]] = 1;
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

void TileRenderer::addToPixels(const PixelRange& range, const FilmSamples& film,
                               const PixelSamples& found) {
  const float clamp = scene_.frame.clamp,
              limit = clamp > 0 ? std::min(clamp, brightest) : brightest;
  for (uint32_t pixel = 0; pixel < range.count(); pixel++) {
    const uint32_t place = places_[range.begin + pixel];
    PixelSums& sums = sums_[place];
    for (uint32_t s = 0; s < film.perPixel; s++) {
      const uint32_t i = pixel * film.perPixel + s;
      if (hits_) {
        const std::vector<uint32_t>& united = scene_.frame.unitedNames;
        const uint32_t name = found.names[i];
        hits_->add(place, name < united.size() ? united[name] : name);
      }
      if (found.complete && !found.complete[i]) { // a surface, and no light
        addValues(found, i, true, sums);
        continue;
      }
      float radiance[3] = {found.radiance[0][i], found.radiance[1][i], found.radiance[2][i]};
      if (scene_.frame.measure)
        std::fill_n(radiance, 3, readingOf(scene_.frame, load(found.radiance, i)));
      for (float& r : radiance) r = clampRadiance(r, limit, paths_.ledger.clipped);
      if (required_.spread)
        sums.add(radiance, found.alpha[i]);
      else
        sums.addColor(radiance, found.alpha[i]);
      if (required_.error) {
        sums.addTails(radiance);
        sums.random |= tracer_.samples().random[i];
        // Replicates larger than the leaf are closed where leaves are merged.
        const uint32_t next = film.first + s + 1;
        if (replicates_.many() && replicates_.indexOf(next) == 0 &&
            next - leaf_ >= replicates_.size())
          sums.closeReplicate();
      }
      addValues(found, i, film.first + s == 0, sums);
    }
  }
}

void TileRenderer::addValues(const PixelSamples& found, uint32_t path, bool first,
                             PixelSums& sums) const {
  for (const uint32_t place : meanPlaces_) sums.valueSums[place] += found.meanValues[place][path];
  if (!first) return;
  for (const uint32_t place : firstPlaces_)
    sums.firstValues[place] = found.firstValues[place][path];
}

} // namespace openrt

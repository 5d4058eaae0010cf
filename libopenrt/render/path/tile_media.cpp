// tile_media.cpp: the part of TileRenderer for media that scatter: collisions are shaded like
// surfaces that have the phase function as their only lobe.
#include <algorithm>

#include "render/lights/lamps.h"
#include "render/medium/containing_media.h"
#include "render/medium/lamp_places.h"
#include "render/medium/phase_function.h"
#include "render/path/tile.h"
#include "scene/channels.h"

namespace openrt {

void TileRenderer::startInMedia(const Wave& wave) {
  ArenaScope scope(arena_);
  findContainingMedia(context_, wave.rays, wave.states.media);
}

// The channels of first surfaces show what is behind the medium, whether the light of the sample
// comes from there or from the medium.
void TileRenderer::describeBehindMedia(const Wave& wave, PixelSamples& found) {
  const uint32_t n = wave.rays.count;
  if (has(firstHitChannels)) {
    Wave seen;
    seen.rays = wave.rays;
    seen.states.allocate(arena_, n);
    for (uint32_t i = 0; i < n; i++) seen.states.set(i, wave.states[i]);
    firstHits_.describe(context_, seen, found);
  }
  std::fill_n(found.first, n, uint8_t(0));
}

void TileRenderer::scatterInMedia(Wave& wave, PixelSamples& found) {
  ArenaScope scope(arena_);
  const std::span<const uint32_t> flights = listFlights(context_, wave);
  if (flights.empty()) return;
  forEachMedium(context_, wave, flights, [&](uint16_t medium, std::span<const uint32_t> lanes) {
    gatherLamps(medium, wave, lanes, found);
  });
  const RayPlaces collisions = sampleFlights(context_, samples_, firstPair(), flights, wave);
  forEachMedium(context_, wave, collisions.lanes,
                [&](uint16_t medium, std::span<const uint32_t> lanes) {
                  scatterInMedium(medium, wave, {lanes, collisions.distance}, found);
                });
}

// Adds the phase function of a medium to the lobes of a batch.
void TileRenderer::addPhaseLobe(uint16_t medium, RtsBatch& batch) const {
  const RtsLobe& lobe = *scene_.host.customLobe(&batch, &phaseLobe, 1);
  const uint32_t n = padded(batch.points->hits.count);
  std::fill_n(lobe.data[0], n, scene_.shaders->media()[medium - 1].anisotropy);
  for (float* weight : lobe.weight) std::fill_n(weight, n, 1.0f);
}

// The light of lamps is gathered at places of their own along each ray, and not where it collides.
void TileRenderer::gatherLamps(uint16_t medium, const Wave& wave, std::span<const uint32_t> flights,
                               PixelSamples& found) {
  const uint32_t set = scene_.mediumLights[medium - 1].set;
  if (scene_.lightSets[set].empty()) return;
  ArenaScope scope(arena_);
  const LampPlaces lamps = sampleLampPlaces(context_, samples_, firstPair(), medium, flights, wave);
  if (lamps.places.lanes.empty()) return;
  const Points points = pointsAlong(context_, wave, lamps.places);
  RtsBatch batch = makeBatch(context_, points, wave.states);
  batch.lightSet = set;
  addPhaseLobe(medium, batch);
  const uint32_t n = points.hits.count;
  SentLight sent;
  for (auto& colour : sent.radiance) colour = arena_.takeZero<float>(padded(n));
  addLamps(batch, sent);
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t lane = lamps.places.lanes[i], path = wave.states.path[lane];
    const Vec3f light = load(lamps.weight, lane) * load(sent.radiance, i);
    if (isFinite(light)) found.add(path, wave.states.flagsOf(lane), light);
  }
}

void TileRenderer::scatterInMedium(uint16_t medium, const Wave& wave, const RayPlaces& collisions,
                                   PixelSamples& found) {
  ArenaScope scope(arena_);
  const Points points = pointsAlong(context_, wave, collisions);
  const uint32_t n = points.hits.count;
  RtsBatch batch = makeBatch(context_, points, wave.states);
  addPhaseLobe(medium, batch);
  SentLight sent;
  for (auto& colour : sent.radiance) colour = arena_.takeZero<float>(padded(n));
  continueFromLobes(batch, {}, sent);
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t lane = collisions.lanes[i], path = wave.states.path[lane];
    const Vec3f throughput = load(wave.states.throughput, lane);
    found.add(path, wave.states.flagsOf(lane), throughput * load(sent.radiance, i));
    if (!wave.states.flagsOf(lane).deflected())
      found.alpha[path] += (throughput.x + throughput.y + throughput.z) / 3;
  }
}

} // namespace openrt

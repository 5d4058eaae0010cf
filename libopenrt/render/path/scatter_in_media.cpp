#include "render/path/scatter_in_media.h"

#include <algorithm>

#include "render/lights/lamps.h"
#include "render/medium/lamp_places.h"
#include "render/medium/phase_function.h"

namespace openrt {
namespace {

// Adds the phase function of a medium to the lobes of a batch.
void addPhaseLobe(uint16_t medium, RtsBatch& batch) {
  const RenderScene& scene = batch.scene;
  const RtsLobe& lobe = *scene.host.customLobe(&batch, &phaseLobe, 1);
  const uint32_t n = padded(batch.points->hits.count);
  std::fill_n(lobe.data[0], n, scene.shaders->media()[medium - 1].anisotropy);
  for (float* weight : lobe.weight) std::fill_n(weight, n, 1.0f);
}

// Allocates the light, 0, that n places send back.
SentLight noLight(uint32_t n, Arena& arena) {
  SentLight sent;
  for (auto& colour : sent.radiance) colour = arena.takeZero<float>(padded(n));
  return sent;
}

// Gathers the light of lamps at places of their own along each ray, and not where it collides.
void gatherLamps(const PathTracer& tracer, uint16_t medium, const Wave& wave,
                 std::span<const uint32_t> flights, PixelSamples& found) {
  const StageContext& context = tracer.context();
  const uint32_t set = context.scene.mediumLights[medium - 1].set;
  if (context.scene.lightSets[set].empty()) return;
  ArenaScope scope(context.arena);
  const LampPlaces lamps =
      sampleLampPlaces(context, tracer.samples(), tracer.firstPair(), medium, flights, wave);
  if (lamps.places.lanes.empty()) return;
  const Points points = pointsAlong(context, wave, lamps.places);
  RtsBatch batch(context, points, wave.states);
  batch.lights.set = set;
  addPhaseLobe(medium, batch);
  const uint32_t n = points.hits.count;
  const SentLight sent = noLight(n, context.arena);
  addLamps(batch, sent);
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t lane = lamps.places.lanes[i], path = wave.states.path[lane];
    const Vec3f light = load(lamps.weight, lane) * load(sent.radiance, i);
    if (isFinite(light)) found.add(path, wave.states.flagsOf(lane), light);
  }
}

void scatterInMedium(PathTracer& tracer, uint16_t medium, const Wave& wave,
                     const RayPlaces& collisions, PixelSamples& found) {
  const StageContext& context = tracer.context();
  ArenaScope scope(context.arena);
  const Points points = pointsAlong(context, wave, collisions);
  const uint32_t n = points.hits.count;
  RtsBatch batch(context, points, wave.states);
  addPhaseLobe(medium, batch);
  const SentLight sent = noLight(n, context.arena);
  tracer.continueFromLobes(batch, {}, sent);
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t lane = collisions.lanes[i], path = wave.states.path[lane];
    const Vec3f throughput = load(wave.states.throughput, lane);
    found.add(path, wave.states.flagsOf(lane), throughput * load(sent.radiance, i));
    if (!wave.states.flagsOf(lane).deflected())
      found.alpha[path] += (throughput.x + throughput.y + throughput.z) / 3;
  }
}

} // namespace

void scatterInMedia(PathTracer& tracer, Wave& wave, PixelSamples& found) {
  const StageContext& context = tracer.context();
  ArenaScope scope(context.arena);
  const std::span<const uint32_t> flights = listFlights(context, wave);
  if (flights.empty()) return;
  forEachMedium(context, wave, flights, [&](uint16_t medium, std::span<const uint32_t> lanes) {
    gatherLamps(tracer, medium, wave, lanes, found);
  });
  const RayPlaces collisions =
      sampleFlights(context, tracer.samples(), tracer.firstPair(), flights, wave);
  forEachMedium(context, wave, collisions.lanes,
                [&](uint16_t medium, std::span<const uint32_t> lanes) {
                  scatterInMedium(tracer, medium, wave, {lanes, collisions.distance}, found);
                });
}

} // namespace openrt

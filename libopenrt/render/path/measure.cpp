#include "render/path/measure.h"

#include <algorithm>
#include <numbers>

#include "render/lights/emitters.h"
#include "render/lights/lamps.h"

namespace openrt {
namespace {

// Makes shading points at the origins of rays, whose normals are the directions of the rays. They
// belong to no record of the scene.
//
// Shadow rays and spawned rays start at the sensor itself: its position is given, so it has no
// rounding error that could lift them off a surface.
Points sensorPoints(const Rays& rays, Arena& arena) {
  const uint32_t n = rays.count, size = padded(n);
  const auto filled = [&](float value) {
    auto* array = arena.take<float>(size);
    std::fill_n(array, size, value);
    return array;
  };
  Points points{};
  RtsHits& hits = points.hits;
  hits.count = n;
  for (int k = 0; k < 3; k++) {
    auto *position = arena.take<float>(size), *normal = arena.take<float>(size),
         *direction = arena.take<float>(size);
    for (uint32_t i = 0; i < size; i++) { // the padding repeats the last ray
      const uint32_t lane = std::min(i, n - 1);
      position[i] = rays.org[k][lane];
      normal[i] = rays.dir[k][lane];
      direction[i] = -normal[i];
    }
    hits.position[k] = position;
    hits.direction[k] = direction;
    hits.geometric[k] = hits.normal[k] = normal;
  }
  hits.uv[0] = hits.uv[1] = hits.distance = hits.segment = filled(0);
  for (auto& color : hits.color) color = filled(1);
  hits.flags = arena.takeZero<uint32_t>(size);
  hits.params = arena.takeZero<const void*>(size);
  points.error = filled(0);
  auto *record = arena.take<uint32_t>(size), *order = arena.take<uint32_t>(size);
  std::fill_n(record, size, noHit);
  for (uint32_t i = 0; i < size; i++) order[i] = std::min(i, n - 1);
  points.record = record;
  points.order = order;
  return points;
}

// Tells which sensors have a part of the scene before them, as far as its bounds tell. Nothing can
// send light to the others but lamps without extent and the sky.
const uint8_t* findCovered(const RenderScene& scene, const Rays& rays, Arena& arena) {
  auto* covered = arena.takeZero<uint8_t>(rays.count);
  if (scene.records.empty()) return covered;
  float low[3], high[3];
  scene.kernel->bounds(low, high);
  for (uint32_t i = 0; i < rays.count; i++) {
    // The corner of the bounds that is farthest before the sensor, along its normal.
    double distance = 0;
    for (int k = 0; k < 3; k++) {
      const double normal = double(rays.dir[k][i]);
      distance += normal * (double(normal > 0 ? high[k] : low[k]) - double(rays.org[k][i]));
    }
    covered[i] = !(distance < 0);
  }
  return covered;
}

// Shades the white matt surfaces of the sensors. Writes what lamps without extent give, by path, to
// `lampLight`.
void shadeSensors(PathTracer& tracer, const Wave& wave, float* const lampLight[3],
                  PixelSamples& found) {
  const StageContext& context = tracer.context();
  const RenderScene& scene = context.scene;
  Arena& arena = context.arena;
  ArenaScope scope(arena);
  const Points points = sensorPoints(wave.rays, arena);
  RtsBatch batch(context, points, wave.states);
  batch.lights.set = 0; // the lights that shine on everything (flatten.cpp)
  const uint32_t n = points.hits.count;
  const RtsLobe& white = *scene.host.lobe(&batch, RTS_LOBE_DIFFUSE);
  SentLight sent;
  for (int k = 0; k < 3; k++) {
    std::fill_n(white.weight[k], padded(n), 1.0f);
    sent.radiance[k] = arena.takeZero<float>(padded(n));
  }
  // Where there is nothing to hit and no sky, light comes from the lamps alone: the reading is
  // exact and needs no random path.
  addLamps(batch, sent);
  for (uint32_t i = 0; i < n; i++) store(load(sent.radiance, i), lampLight, wave.states.path[i]);
  const uint8_t* const covered = findCovered(scene, wave.rays, arena);
  const bool isAnyCovered = std::find(covered, covered + n, 1) != covered + n;
  if (isAnyCovered || scene.skyShines) tracer.continueFromLobes(batch, {}, sent);
  // Under a sky of one radiance and nothing else every path finds the same light.
  const SkySampler* sky = scene.emitters->sky();
  const bool even = !scene.skyShines || (sky && !sky->black() && !sky->usable());
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t path = wave.states.path[i];
    store(load(found.radiance, path) + load(sent.radiance, i), found.radiance, path);
    found.alpha[path] = 1;
    found.first[path] = 0;
    if (even && !covered[i]) tracer.samples().random[path] = 0;
  }
}

// Notes which random paths of sensors have found light beside that of the lamps without extent. If
// all have, and the same amount, no light is missing by chance (error.cpp).
void noteFoundLight(uint32_t n, const PixelSamples& found, const float* const lampLight[3],
                    const PathSamples& samples) {
  for (uint32_t i = 0; i < n; i++) {
    const Vec3f light = load(found.radiance, i), lamps = load(lampLight, i);
    if (light.x > lamps.x || light.y > lamps.y || light.z > lamps.z)
      samples.random[i] &= uint8_t(~RandomPath::inVain);
  }
}

} // namespace

void measureIlluminance(PathTracer& tracer, Wave& wave, PixelSamples& found) {
  const uint32_t n = wave.rays.count; // follow() uses the wave again
  float* lampLight[3];
  for (auto& lamps : lampLight) lamps = tracer.context().arena.takeZero<float>(n);
  shadeSensors(tracer, wave, lampLight, found);
  tracer.follow(wave, found);
  noteFoundLight(n, found, lampLight, tracer.samples());
}

// The radiance of a white matt surface is its illuminance over pi (J. H. Lambert, "Photometria",
// 1760).
float readingOf(const edit::FrameSettingsT& frame, const Vec3f& radiance) {
  const float luminance = 0.2126f * radiance.x + 0.7152f * radiance.y + 0.0722f * radiance.z;
  return frame.measure == RT_MEASURE_ILLUMINANCE ? std::numbers::pi_v<float> * luminance
                                                 : luminance;
}

} // namespace openrt

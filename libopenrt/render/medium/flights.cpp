#include "render/medium/flights.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/wave/point_block.h"

namespace openrt {
namespace {

// Keeps the random numbers of flights apart from those of surfaces.
constexpr uint32_t flightPair = 0x666c6967u;

struct Flight {
  double weight[3]; // factors of the throughput
  double distance;  // infinite: the ray reaches the surface
};

// length: to the surface. u: selects the colour. v: selects the distance.
Flight sampleFlight(const RtsMedium& medium, const ColourShares& shares, double length, double u,
                    double v) {
  const auto extinction = double(extinctionOf(medium, shares.select(u)));
  const double distance =
      extinction > 0 ? -std::log1p(-v) / extinction : std::numeric_limits<double>::infinity();
  const bool collides = distance < length;
  const double flown = collides ? distance : length;
  Flight flight;
  double transmittance[3], pdf = 0;
  for (int k = 0; k < 3; k++) {
    const auto own = double(extinctionOf(medium, k));
    transmittance[k] = std::exp(-own * flown);
    pdf += shares.share[k] * transmittance[k] * (collides ? own : 1);
  }
  for (int k = 0; k < 3; k++)
    flight.weight[k] =
        pdf > 0 ? transmittance[k] * (collides ? double(medium.scattering[k]) : 1) / pdf : 0;
  flight.distance = collides ? distance : std::numeric_limits<double>::infinity();
  return flight;
}

} // namespace

std::span<const uint32_t> listFlights(const StageContext& context, const Wave& wave) {
  const std::span<const RtsMedium> media = context.scene.shaders->media();
  auto* key = context.arena.take<uint64_t>(wave.met.size() + 1); // the medium, then the lane
  size_t n = 0;
  for (const uint32_t lane : wave.met)
    if (const uint16_t medium = mediumOf(wave.states.media[lane], media);
        medium && scatters(media[medium - 1]))
      key[n++] = uint64_t(medium) << 32 | lane;
  std::sort(key, key + n);
  auto* lanes = context.arena.take<uint32_t>(n + 1);
  for (size_t i = 0; i < n; i++) lanes[i] = uint32_t(key[i]);
  return {lanes, n};
}

int ColourShares::select(double u) const {
  int selected = 0;
  for (double rest = u; selected < 2 && rest >= share[selected]; selected++)
    rest -= share[selected];
  while (selected > 0 && !(share[selected] > 0)) selected--; // the shares were rounded
  return selected;
}

ColourShares sharesOf(const Vec3f& throughput) {
  ColourShares shares;
  double sum = 0;
  for (size_t k = 0; k < 3; k++) sum += std::max(0.0, double(throughput[k]));
  for (size_t k = 0; k < 3 && sum > 0; k++)
    shares.share[k] = std::max(0.0, double(throughput[k])) / sum;
  return shares;
}

float roundingAlong(const RenderScene& scene, const Wave& wave, uint32_t lane) {
  const Record& record = scene.records[wave.hits.record[lane]];
  const Vec3f kernel = load(wave.hits.ng, lane), direction = load(wave.rays.dir, lane),
              n = normalize(record.instanced ? record.frames->kernelNormal * kernel : kernel),
              reach = abs(load(wave.rays.org, lane)) + wave.hits.t[lane] * abs(direction);
  return 2 * gammaOf(8) * largest(reach) / std::max(std::fabs(dot(n, direction)), 0.01f);
}

RayPlaces sampleFlights(const StageContext& context, const PathSamples& samples, uint32_t pair,
                        std::span<const uint32_t> flights, Wave& wave) {
  const RenderScene& scene = context.scene;
  Arena& arena = context.arena;
  const std::span<const RtsMedium> media = scene.shaders->media();
  const auto n = uint32_t(flights.size());
  auto* lanes = arena.take<uint32_t>(n + 1);
  auto* distance = arena.take<float>(wave.rays.count);
  auto* collides = arena.takeZero<uint8_t>(wave.rays.count);
  float* square[2];
  randomNumbersAt(samples, wave.states, flights.data(), n, pair, arena)
      .drawPair(flightPair, arena, square);
  uint32_t collisions = 0;
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t lane = flights[i];
    const RtsMedium& medium = media[mediumOf(wave.states.media[lane], media) - 1];
    const Vec3f throughput = load(wave.states.throughput, lane);
    const float length = wave.hits.t[lane], margin = roundingAlong(scene, wave, lane);
    samples.markRandom(wave.states.path[lane]);
    // A layer that is thinner than the rounding of positions has no room for a collision.
    if (!(length > 2 * margin) || !(largest(throughput) > 0)) continue;
    const Flight flight = sampleFlight(medium, sharesOf(throughput), double(length),
                                       double(square[0][i]), double(square[1][i]));
    Vec3f left;
    for (size_t k = 0; k < 3; k++) left[k] = float(double(throughput[k]) * flight.weight[k]);
    store(left, wave.states.throughput, lane);
    if (!std::isfinite(flight.distance)) continue;
    collides[lane] = 1;
    distance[lane] = std::clamp(float(flight.distance), margin, length - margin);
    lanes[collisions++] = lane;
  }
  size_t met = 0;
  for (const uint32_t lane : wave.met)
    if (!collides[lane]) wave.met[met++] = lane;
  wave.met = wave.met.first(met);
  return {{lanes, collisions}, distance};
}

Points pointsAlong(const StageContext& context, const Wave& wave, const RayPlaces& places) {
  Arena& arena = context.arena;
  const uint32_t n = uint32_t(places.lanes.size()), size = padded(n);
  const auto floats = [&] { return arena.take<float>(size); };
  float *position[3], *direction[3], *normal[3];
  for (int k = 0; k < 3; k++) {
    position[k] = floats();
    direction[k] = floats();
    normal[k] = floats();
  }
  float *travelled = floats(), *segment = floats(), *one = floats();
  auto *record = arena.take<uint32_t>(size), *order = arena.take<uint32_t>(size);
  for (uint32_t i = 0; i < size; i++) { // the padding repeats the last place
    const uint32_t lane = places.lanes[std::min(i, n - 1)];
    const float distance = places.distance[lane];
    const Vec3f along = load(wave.rays.dir, lane);
    const Vec3d origin(load(wave.rays.org, lane));
    store(Vec3f(origin + double(distance) * Vec3d(along)), position, i);
    store(along, direction, i);
    store(-along, normal, i);
    segment[i] = distance;
    travelled[i] = wave.states.travelled[lane] + distance;
    one[i] = 1;
    record[i] = wave.hits.record[lane];
    order[i] = lane;
  }
  Points points{};
  RtsHits& hits = points.hits;
  hits.count = n;
  for (int k = 0; k < 3; k++) {
    hits.position[k] = position[k];
    hits.direction[k] = direction[k];
    hits.geometric[k] = hits.normal[k] = normal[k];
  }
  hits.uv[0] = hits.uv[1] = points.error = arena.takeZero<float>(size);
  for (auto& colour : hits.color) colour = one;
  hits.distance = travelled;
  hits.segment = segment;
  hits.flags = arena.takeZero<uint32_t>(size);
  hits.params = arena.takeZero<const void*>(size);
  points.record = record;
  points.rayHits = &wave.hits;
  points.order = order;
  return points;
}

} // namespace openrt

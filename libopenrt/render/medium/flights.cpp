#include "render/medium/flights.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/surface/point_block.h"

namespace openrt {
namespace {

// Keeps the random numbers of flights apart from those of surfaces.
constexpr uint32_t flightPair = 0x666c6967u;

// What a medium does with the colours of a ray.
struct Colours {
  double extinction[3], scattering[3];
  double share[3]; // probability that the colour is selected
};

struct Flight {
  double weight[3]; // factors of the throughput
  double distance;  // infinite: the ray reaches the surface
};

// length: to the surface. u: selects the colour. v: selects the distance.
Flight sampleFlight(const Colours& colours, double length, double u, double v) {
  int selected = 0;
  for (double rest = u; selected < 2 && rest >= colours.share[selected]; selected++)
    rest -= colours.share[selected];
  while (selected > 0 && !(colours.share[selected] > 0)) selected--; // u was rounded up
  const double extinction = colours.extinction[selected],
               distance = extinction > 0 ? -std::log1p(-v) / extinction
                                         : std::numeric_limits<double>::infinity();
  const bool collides = distance < length;
  const double flown = collides ? distance : length;
  Flight flight;
  double transmittance[3], pdf = 0;
  for (int k = 0; k < 3; k++) {
    transmittance[k] = std::exp(-colours.extinction[k] * flown);
    pdf += colours.share[k] * transmittance[k] * (collides ? colours.extinction[k] : 1);
  }
  for (int k = 0; k < 3; k++)
    flight.weight[k] =
        pdf > 0 ? transmittance[k] * (collides ? colours.scattering[k] : 1) / pdf : 0;
  flight.distance = collides ? distance : std::numeric_limits<double>::infinity();
  return flight;
}

// Returns how near to a surface along the ray a position may be on its other side by rounding.
float roundingAlong(const RenderScene& scene, const Wave& wave, uint32_t lane) {
  const Record& record = scene.records[wave.hits.record[lane]];
  const Vec3f kernel = load(wave.hits.ng, lane), direction = load(wave.rays.dir, lane),
              n = normalize(record.instanced ? record.kernelNormal * kernel : kernel),
              reach = abs(load(wave.rays.org, lane)) + wave.hits.t[lane] * abs(direction);
  return 2 * gammaOf(8) * largest(reach) / std::max(std::fabs(dot(n, direction)), 0.01f);
}

// Returns the probabilities of the colours, 0 0 0 for a ray that carries nothing.
Colours coloursOf(const RtsMedium& medium, const Vec3f& throughput) {
  Colours colours{};
  double sum = 0;
  for (int k = 0; k < 3; k++) {
    colours.extinction[k] = double(extinctionOf(medium, k));
    colours.scattering[k] = double(medium.scattering[k]);
    sum += std::max(0.0, double(throughput[size_t(k)]));
  }
  for (int k = 0; k < 3 && sum > 0; k++)
    colours.share[k] = std::max(0.0, double(throughput[size_t(k)])) / sum;
  return colours;
}

// Lists the rays of wave.met in media that scatter. Returns their number.
uint32_t listFlights(const RenderScene& scene, const Wave& wave, uint32_t* lanes) {
  const std::span<const RtsMedium> media = scene.shaders->media();
  uint32_t n = 0;
  for (const uint32_t lane : wave.met)
    if (const uint16_t medium = mediumOf(wave.states.media[lane], media);
        medium && scatters(media[medium - 1]))
      lanes[n++] = lane;
  return n;
}

} // namespace

Collisions sampleFlights(const StageContext& context, const PathSamples& samples, uint32_t pair,
                         Wave& wave) {
  const RenderScene& scene = context.scene;
  Arena& arena = context.arena;
  const std::span<const RtsMedium> media = scene.shaders->media();
  auto* lane = arena.take<uint32_t>(wave.met.size() + 1);
  const uint32_t n = listFlights(scene, wave, lane);
  auto* distance = arena.take<float>(padded(n));
  if (n == 0) return {{}, distance};
  float* square[2];
  randomNumbersAt(samples, wave.states, lane, n, pair, arena).drawPair(flightPair, arena, square);
  uint32_t collisions = 0;
  auto* collides = arena.takeZero<uint8_t>(wave.rays.count);
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t at = lane[i];
    const RtsMedium& medium = media[mediumOf(wave.states.media[at], media) - 1];
    const Vec3f throughput = load(wave.states.throughput, at);
    const Colours colours = coloursOf(medium, throughput);
    const float length = wave.hits.t[at], margin = roundingAlong(scene, wave, at);
    samples.markRandom(wave.states.path[at]);
    // A layer that is thinner than the rounding of positions has no room for a collision.
    if (!(length > 2 * margin) || !(largest(throughput) > 0)) continue;
    const Flight flight =
        sampleFlight(colours, double(length), double(square[0][i]), double(square[1][i]));
    Vec3f left;
    for (size_t k = 0; k < 3; k++) left[k] = float(double(throughput[k]) * flight.weight[k]);
    store(left, wave.states.throughput, at);
    if (!std::isfinite(flight.distance)) continue;
    collides[at] = 1;
    lane[collisions] = at;
    distance[collisions++] = std::clamp(float(flight.distance), margin, length - margin);
  }
  size_t met = 0;
  for (const uint32_t at : wave.met)
    if (!collides[at]) wave.met[met++] = at;
  wave.met = wave.met.first(met);
  return {{lane, collisions}, distance};
}

Points collisionPoints(const StageContext& context, const Wave& wave,
                       const Collisions& collisions) {
  Arena& arena = context.arena;
  const uint32_t n = uint32_t(collisions.lanes.size()), size = padded(n);
  const auto floats = [&] { return arena.take<float>(size); };
  float *position[3], *direction[3], *normal[3];
  for (int k = 0; k < 3; k++) {
    position[k] = floats();
    direction[k] = floats();
    normal[k] = floats();
  }
  float *travelled = floats(), *segment = floats(), *one = floats();
  auto *record = arena.take<uint32_t>(size), *order = arena.take<uint32_t>(size);
  for (uint32_t i = 0; i < size; i++) { // the padding repeats the last collision
    const uint32_t at = std::min(i, n - 1), lane = collisions.lanes[at];
    const Vec3f along = load(wave.rays.dir, lane);
    const Vec3d origin(load(wave.rays.org, lane));
    store(Vec3f(origin + double(collisions.distance[at]) * Vec3d(along)), position, i);
    store(along, direction, i);
    store(-along, normal, i);
    segment[i] = collisions.distance[at];
    travelled[i] = wave.states.travelled[lane] + collisions.distance[at];
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

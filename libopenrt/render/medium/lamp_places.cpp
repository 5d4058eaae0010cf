#include "render/medium/lamp_places.h"

#include <algorithm>
#include <cmath>

namespace openrt {
namespace {

// Keeps the random numbers of these places apart from those of flights and surfaces.
constexpr uint32_t lampPair = 0x6c616d70u;

// Equal angles along a ray, as seen from a lamp.
class EqualAngles {
 public:
  EqualAngles(const Vec3d& origin, const Vec3d& direction, double length, const Vec3d& lamp) {
    nearest_ = dot(lamp - origin, direction);
    const Vec3d aside = lamp - origin - nearest_ * direction;
    // A lamp on the ray itself would have a pdf without bound.
    aside_ = std::max(std::sqrt(dot(aside, aside)), 1e-4 * length);
    from_ = std::atan(-nearest_ / aside_);
    to_ = std::atan((length - nearest_) / aside_);
  }
  double sample(double u) const { return nearest_ + aside_ * std::tan(from_ + u * (to_ - from_)); }
  double pdf(double t) const {
    const double along = t - nearest_, square = aside_ * aside_ + along * along;
    return to_ > from_ ? aside_ / ((to_ - from_) * square) : 0;
  }

 private:
  double nearest_, aside_, from_, to_;
};

// Collisions before the end of the ray: an exponential distribution that ends at `length`.
double sampleCollision(double extinction, double length, double u) {
  const double end = -std::expm1(-extinction * length);
  return end > 1e-12 ? -std::log1p(-u * end) / extinction : u * length;
}
double collisionPdf(double extinction, double length, double t) {
  const double end = -std::expm1(-extinction * length);
  return end > 1e-12 ? extinction * std::exp(-extinction * t) / end : 1 / length;
}

// A ray through a medium, with the lamps that shine on it.
struct Segment {
  const RtsMedium& medium;
  const std::vector<Vec3f>& lamps;
  ColourShares shares;
  Vec3d origin, direction;
  double length;

  double sample(double u, double v) const {
    const auto n = double(lamps.size());
    if (n == 0 || u < 0.5) {
      const double colour = n == 0 ? u : 2 * u;
      return sampleCollision(double(extinctionOf(medium, shares.select(colour))), length, v);
    }
    const auto lamp = size_t(std::min((2 * u - 1) * n, n - 1));
    return EqualAngles(origin, direction, length, Vec3d(lamps[lamp])).sample(v);
  }
  double pdf(double t) const {
    double collision = 0, angle = 0;
    for (int k = 0; k < 3; k++)
      collision += shares.share[k] * collisionPdf(double(extinctionOf(medium, k)), length, t);
    if (lamps.empty()) return collision;
    for (const Vec3f& lamp : lamps)
      angle += EqualAngles(origin, direction, length, Vec3d(lamp)).pdf(t);
    return 0.5 * collision + 0.5 * angle / double(lamps.size());
  }
};

} // namespace

LampPlaces sampleLampPlaces(const StageContext& context, const PathSamples& samples, uint32_t pair,
                            uint16_t medium, std::span<const uint32_t> flights, const Wave& wave) {
  Arena& arena = context.arena;
  const RtsMedium& properties = context.scene.shaders->media()[medium - 1];
  const std::vector<Vec3f>& lamps = context.scene.mediumLights[medium - 1].lamps;
  const auto n = uint32_t(flights.size());
  auto* lanes = arena.take<uint32_t>(n + 1);
  auto* distance = arena.take<float>(wave.rays.count);
  LampPlaces out{};
  for (auto& weight : out.weight) weight = arena.take<float>(wave.rays.count);
  float* square[2];
  randomNumbersAt(samples, wave.states, flights.data(), n, pair, arena)
      .drawPair(lampPair, arena, square);
  uint32_t places = 0;
  for (uint32_t i = 0; i < n; i++) {
    const uint32_t lane = flights[i];
    const Vec3f throughput = load(wave.states.throughput, lane);
    const float length = wave.hits.t[lane], margin = roundingAlong(context.scene, wave, lane);
    if (!(length > 2 * margin) || !(largest(throughput) > 0)) continue;
    const Segment segment{properties,
                          lamps,
                          sharesOf(throughput),
                          Vec3d(load(wave.rays.org, lane)),
                          Vec3d(load(wave.rays.dir, lane)),
                          double(length)};
    const double t = segment.sample(double(square[0][i]), double(square[1][i])),
                 pdf = segment.pdf(t);
    if (!(t >= 0 && t <= double(length)) || !(pdf > 0)) continue;
    for (int k = 0; k < 3; k++)
      out.weight[k][lane] =
          float(double(wave.states.throughput[k][lane]) * double(properties.scattering[k]) *
                std::exp(-double(extinctionOf(properties, k)) * t) / pdf);
    distance[lane] = std::clamp(float(t), margin, length - margin);
    lanes[places++] = lane;
  }
  out.places = {{lanes, places}, distance};
  return out;
}

} // namespace openrt

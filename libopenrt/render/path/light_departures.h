// light_departures.h: where light paths start, and the flux that they have carried away from there.
// [render]
#pragma once

#include <vector>

#include "render/lights/light_sources.h"
#include "render/wave/batch.h"
#include "render/wave/random_numbers.h"

namespace openrt {

// The pairs of dimensions of the sampler for the start of a light path. The pairs of the surfaces
// follow.
enum class LightPair : uint32_t { source, place, direction, count };

// The light sources of the light paths of a wave, by path.
class LightDepartures {
 public:
  explicit LightDepartures(const StageContext& context) : context_(context) {}
  // Samples the first rays of n paths and queues those that carry flux.
  void start(const LightSources& sources, const PathSamples& samples, uint32_t n, RayQueue& queue);
  // Returns the ray that a path has started with.
  const LightSources::LightRay& ray(uint32_t path) const { return rays_[path]; }
  // Adds the length of the ray that has reached the next surface.
  void travel(uint32_t path, float length) { departures_[path].pathLength += double(length); }
  // Returns the length of the path so far. The sun is so far away that its direction is the same
  // wherever light arrives.
  float length(uint32_t path) const {
    return float(departures_[path].pathLength * (rays_[path].sun ? 0x1p20 : 1));
  }
  // Multiplies the throughput by the emitted flux when a path has reached its first surface, hit i.
  // Returns whether any throughput is left.
  bool applyEmission(const Points& points, uint32_t i, RayState& state);
  // Computes the attenuation at the current, non-specular surface of a path, if it is not known
  // yet: evaluates the light at the end of the unfolded path, in the direction in which the path
  // has left it. A light with inverse-square falloff has the same flux everywhere; a difference
  // below 1e-3 is then taken as rounding.
  void updateAttenuation(uint32_t path);
  // Returns the attenuation that the path has after `length` more along its ray.
  Vec3f attenuationAfter(uint32_t path, double length);
  // Returns the flux at the current surface over that in the throughput, by colour.
  const Vec3f& attenuation(uint32_t path) const { return departures_[path].attenuation; }
  // Returns the factor of the flux at a surface that scatters the path. The first one decides:
  // a lamp's colour may be its irradiance there (RTS_IRRADIANCE). surface: it has the trait.
  float irradianceFactor(uint32_t path, bool surface) const;
  // Says that a surface has scattered the path, and that its flux has this factor.
  void setScattered(uint32_t path) { departures_[path].scattered = true; }
  // Multiplies the throughput by the attenuation of a path that is scattered.
  void applyAttenuation(RayState& state);

 private:
  // State of a path that started at a light without extent, or in the sun. The attenuation is that
  // of the unfolded path, as if mirrors and smooth boundaries had not bent it, up to the first
  // non-specular surface.
  struct Departure {
    double pathLength = 0;      // path length from the light to the current hit
    Vec3f flux;                 // flux at the first surface; contained in the throughput after that
    Vec3f attenuation{1, 1, 1}; // flux at the current hit divided by `flux`
    // the attenuation has been applied, or the light does not depend on distance
    bool attenuationKnown = true;
    bool scattered = false; // a surface has scattered the path
  };
  Vec3f lampFlux(const LightSources::LightRay& start, const Vec3f& at);
  void evaluateSun();

  const StageContext context_;
  std::vector<LightSources::LightRay> rays_;
  std::vector<Departure> departures_;
};

} // namespace openrt

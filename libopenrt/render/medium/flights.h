// flights.h: how far rays fly in a medium that scatters before they collide with it. [render]
#pragma once

#include <span>

#include "render/wave/random_numbers.h"
#include "render/wave/wave.h"

namespace openrt {

// Places along the rays of a wave. The arrays lie in the arena.
struct RayPlaces {
  std::span<const uint32_t> lanes;
  const float* distance; // from the rays' origins, by lane
};

// Lists the lanes of the rays that fly through media that scatter to a surface, in the order of the
// media and then of the lanes. A ray that leaves the scene is not listed: it was not inside a
// closed body.
std::span<const uint32_t> listFlights(const StageContext& context, const Wave& wave);

// Calls f(medium, lanes) for the lanes of each medium. The lanes must be in the order of
// listFlights().
template <class F> void forEachMedium(const StageContext& context, const Wave& wave,
                                      std::span<const uint32_t> lanes, const F& f) {
  const std::span<const RtsMedium> media = context.scene.shaders->media();
  for (size_t begin = 0, end; begin < lanes.size(); begin = end) {
    const uint16_t medium = mediumOf(wave.states.media[lanes[begin]], media);
    for (end = begin + 1; end < lanes.size(); end++)
      if (mediumOf(wave.states.media[lanes[end]], media) != medium) break;
    f(medium, lanes.subspan(begin, end - begin));
  }
}

// The probability with which a decision about a ray follows each colour: in proportion to the
// throughput. All 0 for a ray that carries nothing.
struct ColourShares {
  double share[3] = {};
  // Returns the colour that a number in [0, 1) selects.
  int select(double u) const;
};
ColourShares sharesOf(const Vec3f& throughput);

// Returns how near to a surface, along the ray that hits it, a position may be on its other side by
// rounding. Places in a medium keep this distance from both ends of the ray.
float roundingAlong(const RenderScene& scene, const Wave& wave, uint32_t lane);

// Samples for each flight whether the ray collides, and where. Removes the rays that collide from
// wave.met and returns them. Multiplies the throughputs by their weights: the transmittance for
// rays that reach the surface, transmittance times coefficient of scattering for rays that collide,
// each over the pdf. Marks the paths as random. pair: PathTracer::firstPair().
//
// One colour is selected and the distance is sampled for its extinction. The pdf is that of all
// colours together (balance heuristic), so no colour has a large weight: A. Wilkie et al., "Hero
// Wavelength Spectral Sampling", EGSR 2014; M. Pharr, W. Jakob, G. Humphreys, "Physically Based
// Rendering", 4th ed., 14.2.2.
RayPlaces sampleFlights(const StageContext& context, const PathSamples& samples, uint32_t pair,
                        std::span<const uint32_t> flights, Wave& wave);

// Makes shading points of places along rays. Their normals point against the rays.
Points pointsAlong(const StageContext& context, const Wave& wave, const RayPlaces& places);

} // namespace openrt

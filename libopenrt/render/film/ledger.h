// ledger.h: energy that the picture leaves out on purpose and that no error bar covers (depth
// limit, energy cut, clamp), and light that it may have missed by chance. The sums are taken over
// the samples of one tile in a fixed order, and tiles are added in a fixed order, so they do not
// depend on threads. [render]
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "scene/vec3.h"

namespace openrt {

// -ln 0.05. After n misses in a row, a probability is below this / n with 95 % confidence.
inline constexpr double ruleOfThree = 2.9957;

// Emitted light that only BSDF sampling can find: the ray comes from a non-specular surface via
// mirrors or smooth boundaries, so light sampling cannot connect to the emitter.
struct UnsampledLight {
  // Radiance if every such ray hit the brightest emitter that it can reach; summed over the
  // colours.
  double light = 0;
  // Number of such rays, and of those that hit something at least half as bright as that emitter. A
  // ray counts with the MIS weight of BSDF sampling, because guided rays find the rest of its
  // light.
  double rays = 0;
  double met = 0;
  // Radiance that one light path of the photon pass would add if it came to where the rays start;
  // summed over the colours and the camera paths of a tile. 0: no light paths tell what they would
  // have found.
  double byLightPath = 0;

  void add(const UnsampledLight& c) {
    light += c.light;
    rays += c.rays;
    met += c.met;
    byLightPath += c.byLightPath;
  }
  // Counts a ray. brightest: radiance of the brightest emitter that the ray can reach, summed over
  // the colours. The colour of the emitter is not known here, so the largest component of the
  // throughput bounds what the ray could contribute.
  void send(const Vec3f& throughput, double brightest, double weight = 1) {
    if (!(brightest > 0)) return;
    light += double(largest(throughput)) * weight * brightest;
    rays += weight;
  }
  // Counts the hit of such a ray if the radiance found there is at least half of `brightest`.
  void meet(const Vec3f& radiance, double brightest, double weight = 1) {
    const double sum = double(radiance.x) + double(radiance.y) + double(radiance.z);
    if (sum >= .5 * brightest) met += weight;
  }
  // Returns a bound of the share of rays that should have hit such an emitter but did not: the
  // upper 95 % bound of a Poisson variable (E. B. Wilson, M. M. Hilferty, The distribution of
  // chi-square, 1931) less the number of hits. Without hits this is the rule of three. From 32 hits
  // on the share is 0, because then the samples' own variance covers it.
  double missedShare() const {
    constexpr double enough = 32, normal95 = 1.645;
    if (!(rays > 0) || !(met < enough)) return 0;
    const double n = met + 1,
                 bound = n * std::pow(1 - 1 / (9 * n) + normal95 / (3 * std::sqrt(n)), 3);
    return std::min(1.0, (bound - met) / rays);
  }
  // Returns by how much light paths lower the bound missedShare() * light.
  double lessByLightPaths() const {
    const double byLightPaths = ruleOfThree * byLightPath, byRays = missedShare() * light;
    return byLightPaths > 0 && byRays > 0 ? byRays * byRays / (byRays + byLightPaths) : 0;
  }
};

struct Ledger { // all values are summed over the colours
  // Throughput of the paths ended by the depth limit and by the energy cut.
  double cutByDepth = 0, cutByEnergy = 0;
  double clipped = 0; // radiance removed by the clamp
  // Light of emissive shapes and of the sky. Light that is left to light tracing is not in them.
  UnsampledLight unsampled, unsampledSky;
  uint64_t samples = 0; // samples per pixel of the tile

  void add(const Ledger& l) {
    cutByDepth += l.cutByDepth;
    cutByEnergy += l.cutByEnergy;
    clipped += l.clipped;
    samples += l.samples;
    unsampled.add(l.unsampled);
    unsampledSky.add(l.unsampledSky);
  }
  // Adds the ledger of a tile divided by its number of samples: the sum over its pixels for one
  // sample each. Light that was not sampled belongs to all samples and is not divided.
  void addMean(const Ledger& l) {
    if (l.samples == 0) return;
    const double n = double(l.samples);
    cutByDepth += l.cutByDepth / n;
    cutByEnergy += l.cutByEnergy / n;
    clipped += l.clipped / n;
    samples = 1;
    unsampled.add(l.unsampled);
    unsampledSky.add(l.unsampledSky);
  }
  // Returns a bound of the radiance that the mean of `paths` samples may lack, summed over the
  // colours, if rays of this tile find emitters as often as the rays that `all` sums up.
  double missedRadiance(const Ledger& all, double paths) const {
    if (!(paths > 0)) return 0;
    return (all.unsampled.missedShare() * unsampled.light +
            all.unsampledSky.missedShare() * unsampledSky.light) /
           paths;
  }
  // Returns the bound that follows from the rays of this tile and from light paths together: with a
  // probability of 95 %, less than three of both were to be expected for the light that they lack.
  double missedByTile(double paths) const {
    if (!(paths > 0)) return 0;
    return missedRadiance(*this, paths) -
           (unsampled.lessByLightPaths() + unsampledSky.lessByLightPaths()) / paths;
  }
};

} // namespace openrt

// ledger.h: what a picture leaves out on purpose and no error bar covers, and what it may have missed by chance: sums over the
// samples of one tile, added in their order. Tiles are added up in theirs, so that the sums do not depend on threads. [render]
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace openrt {

inline double sumOf(const float v[3]) { return double(v[0]) + double(v[1]) + double(v[2]); }

// Light that rays meet by chance alone: they come from a surface that scatters, by way of mirrors or smooth boundaries, so that
// no place on an emitter can be chosen for them.
struct ChanceLight {
  double light = 0; // what they would bring if each met the brightest emitter that it can meet; colours summed
  double rays = 0;  // their number
  double met = 0;   // how many have met something at least half as bright as that one

  void add(const ChanceLight& c) { light += c.light, rays += c.rays, met += c.met; }
  // brightest: the radiance of that emitter, colours summed, here and below. Whatever its colour, a ray brings no more of it than
  // by the largest part of its throughput.
  void send(const float throughput[3], double brightest) {
    if (!(brightest > 0)) return;
    light += double(std::max({throughput[0], throughput[1], throughput[2]})) * brightest;
    rays++;
  }
  void meet(const float radiance[3], double brightest) {
    if (sumOf(radiance) >= .5 * brightest) met++;
  }
  // Share of the rays that have not met such an emitter although they might have: how much the upper bound of 95 % of a Poisson
  // variable (E. B. Wilson, M. M. Hilferty, The distribution of chi-square, 1931) is more than what was met; none: the rule of
  // three. Once so many have, the samples tell by themselves.
  double missedShare() const {
    constexpr double enough = 32, normal95 = 1.645;
    if (!(rays > 0) || !(met < enough)) return 0;
    const double n = met + 1, bound = n * std::pow(1 - 1 / (9 * n) + normal95 / (3 * std::sqrt(n)), 3);
    return std::min(1.0, (bound - met) / rays);
  }
};

struct Ledger {                           // summed over the colours
  double cutByDepth = 0, cutByEnergy = 0; // throughput of paths that the depth limit, the energy cut ended
  double clipped = 0;                     // radiance above the clamp
  ChanceLight chance;                     // of rays that may meet any emitter
  ChanceLight chanceSky;                  // of those for which the emitters that have a place are left to paths from lamps
  uint64_t samples = 0;                   // a pixel of the tile

  void add(const Ledger& l) {
    cutByDepth += l.cutByDepth, cutByEnergy += l.cutByEnergy, clipped += l.clipped, samples += l.samples;
    chance.add(l.chance), chanceSky.add(l.chanceSky);
  }
  // Of a tile of so many samples to that of one: its pixels' sum. Light by chance is of the samples, and not divided.
  void addMean(const Ledger& l) {
    if (l.samples == 0) return;
    const double n = double(l.samples);
    cutByDepth += l.cutByDepth / n, cutByEnergy += l.cutByEnergy / n, clipped += l.clipped / n, samples = 1;
    chance.add(l.chance), chanceSky.add(l.chanceSky);
  }
  // Radiance that the mean of so many paths may lack, colours summed, if rays of this tile meet emitters as often as those that
  // `all` is the sum of.
  double missedByChance(const Ledger& all, double paths) const {
    if (!(paths > 0)) return 0;
    return (all.chance.missedShare() * chance.light + all.chanceSky.missedShare() * chanceSky.light) / paths;
  }
};

} // namespace openrt

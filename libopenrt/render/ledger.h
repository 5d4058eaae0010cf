// ledger.h: what a picture leaves out on purpose and no error bar covers: sums over the samples of one tile, added in their
// order. Tiles are added up in theirs, so that the sums do not depend on threads. [render]
#pragma once

#include <cstdint>

namespace openrt {

struct Ledger {                           // summed over the colours
  double cutByDepth = 0, cutByEnergy = 0; // throughput of paths that the depth limit, the energy cut ended
  double clipped = 0;                     // radiance above the clamp
  uint64_t samples = 0;                   // a pixel of the tile

  void add(const Ledger& l) {
    cutByDepth += l.cutByDepth, cutByEnergy += l.cutByEnergy, clipped += l.clipped, samples += l.samples;
  }
  // Of a tile of so many samples to that of one: its pixels' sum.
  void addMean(const Ledger& l) {
    if (l.samples == 0) return;
    const double n = double(l.samples);
    cutByDepth += l.cutByDepth / n, cutByEnergy += l.cutByEnergy / n, clipped += l.clipped / n, samples = 1;
  }
};

inline double sumOf(const float v[3]) { return double(v[0]) + double(v[1]) + double(v[2]); }

} // namespace openrt

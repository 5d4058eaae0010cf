// bsdf_choice.h: the choice of one of the BSDF samples of a hit, and Russian roulette. [render]
#pragma once

#include <algorithm>

#include "render/surface/bsdf_samples.h"

namespace openrt {

// The throughput that each BSDF sample of a hit is expected to carry. One of them is selected with
// a probability proportional to it.
struct BsdfChoice {
  float carried[BsdfSamples::maximum], sum = 0;
  uint32_t count;

  // throughput: of the path up to the hit; 1 1 1 if it is not known yet.
  BsdfChoice(const BsdfSamples& samples, const Vec3f& throughput) : count(samples.count) {
    for (uint32_t w = 0; w < count; w++)
      sum += carried[w] = largest(samples.list[w].expectedWeight * throughput);
  }
  // Returns the sample that a random number in [0, 1) selects.
  uint32_t select(float u) const { return sampleDiscrete(carried, count, u * sum); }
  float probability(uint32_t sample) const { return carried[sample] / sum; }
};

// Returns the probability with which a path that carries this throughput survives Russian roulette.
inline float survivalProbability(float carried) { return std::min(1.0f, carried); }

// A camera path that carries at least this throughput always survives Russian roulette. It has the
// effect that a path that splits at glass spends few rays on what is hardly seen, and that the rays
// of a path which carries energy are no more than 8 at a time, on the mean (decision 47).
constexpr float certainThroughput = 0.125f;
// A camera path follows all BSDF samples of a surface unless it has split this often before.
constexpr uint32_t mostSplits = 4;

} // namespace openrt

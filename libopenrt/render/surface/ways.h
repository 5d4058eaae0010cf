// ways.h: the directions in which a path may go on from one hit, with what each carries: one for
// every lobe, two at a smooth boundary. [render]
#pragma once

#include "render/surface/lobes.h"
#include "render/surface/media.h"

namespace openrt {

// A direction in which a path may go on. density: by solid angle, of a lobe that scatters; 0: it
// could not be another.
struct Way {
  float direction[3], weight[3], density;
  float share[3]; // about what it carries, whatever direction was chosen: ways are chosen by this
  uint32_t lobe;
  uint8_t channel; // 1 + the only colour it carries, 0: all
  bool bent, lost; // lost: on the wrong side of the facet
};

// The share that a number between 0 and the sum of all falls on.
inline uint32_t chooseAmong(const float* shares, uint32_t count, float at) {
  uint32_t chosen = 0;
  while (chosen + 1 < count && at >= shares[chosen]) at -= shares[chosen++];
  return chosen;
}

class Ways {
 public:
  static constexpr uint32_t maximum = 6 * RTS_MAX_LOBES;
  // eta: index of refraction on the ray's side over that behind, by colour, where the engine knows
  // it, else null. channel: as in Way, of the ray. fromLamp: the path comes from a lamp: what it
  // carries is flux, which boundaries do not compress.
  Ways(const RtsHits& hits, uint32_t hit, const float* eta, uint8_t channel, bool fromLamp = false);
  // samples: null for lobes that do not scatter; those that do are then left out.
  void add(uint32_t number, const RtsLobe& lobe, const LobeSamples* samples);

  Way list[maximum];
  uint32_t count = 0;

 private:
  Way& put(const float direction[3], const float weight[3], float factor);
  void scatter(const RtsLobe& lobe, const LobeSamples& samples, const float w[3]);
  void mirror(const float n[3], const float w[3], float factor);
  void dielectric(const float n[3], const float w[3], float eta);
  uint32_t hit_, lobe_ = 0;
  const float* eta_;
  uint8_t channel_;
  bool fromLamp_;
  float d_[3], g_[3];
};

} // namespace openrt

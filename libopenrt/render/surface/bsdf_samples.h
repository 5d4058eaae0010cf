// bsdf_samples.h: BSDF samples of one hit: the directions in which a path may continue, one for
// every lobe, two at a smooth boundary (four if it disperses light). Light paths use it. Camera
// paths compute the same numbers for all hits of a batch at once (sample_arrays.h). [render]
#pragma once

#include "render/media.h"
#include "render/surface/lobes.h"
#include "scene/vec3.h"

namespace openrt {

// One sampled continuation of a path. pdf: solid-angle pdf of a non-specular lobe; 0: a specular
// direction.
struct BsdfSample {
  Vec3f direction, weight;
  float pdf;
  // Approximate weight independent of the sampled direction. One of several samples is selected
  // with probability proportional to it.
  Vec3f expectedWeight;
  uint32_t lobe;
  uint8_t channel; // 1 + index of the only colour that is carried; 0: all colours
  // deflected: the direction differs from the incoming ray's. rejected: the direction is on the
  // wrong side of the facet.
  bool deflected, rejected;
};

// Samples a discrete distribution: returns the index of the share that `at` falls into, where `at`
// lies between 0 and the sum of all shares.
inline uint32_t sampleDiscrete(const float* shares, uint32_t count, float at) {
  uint32_t chosen = 0;
  while (chosen + 1 < count && at >= shares[chosen]) at -= shares[chosen++];
  return chosen;
}

class BsdfSamples {
 public:
  static constexpr uint32_t maximum = 4 * RTS_MAX_LOBES;
  // eta: relative index of refraction (ray's side over far side) by colour if the engine knows it,
  // else null; the lobe's parameter has that of the channel. channel: channel of the incoming ray,
  // as in BsdfSample. fromLamp: the path starts at a light, so it carries flux (importance
  // transport), which is not scaled by eta squared at boundaries.
  BsdfSamples(const RtsHits& hits, uint32_t hit, const float* eta, uint8_t channel,
              bool fromLamp = false);
  // Adds the samples of one lobe. samples: null for specular lobes. Non-specular lobes without
  // samples are left out.
  void add(uint32_t number, const RtsLobe& lobe, const LobeSamples* samples);

  union { // keeps the elements beyond `count` uninitialised: most hits have one or two samples
    BsdfSample list[maximum];
  };
  uint32_t count = 0;

 private:
  BsdfSample& put(const Vec3f& direction, const Vec3f& weight, float factor);
  void scatter(const RtsLobe& lobe, const LobeSamples& samples, const Vec3f& w);
  BsdfSample& mirror(const Vec3f& n, const Vec3f& w, float factor);
  // A smooth boundary for one index of refraction.
  struct Boundary {
    double eta, cosine, cosineBehind, reflectance;
  };
  Boundary boundaryOf(const Vec3f& n, float eta) const;
  void refract(const Vec3f& n, const Vec3f& w, const Boundary& boundary);
  void disperse(const Vec3f& n, const Vec3f& w);
  uint32_t hit_, lobe_ = 0;
  const float* eta_;
  uint8_t channel_;
  bool fromLamp_;
  Vec3f d_, g_; // the ray's direction, the geometric normal
};

} // namespace openrt

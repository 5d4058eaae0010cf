// scalar_bsdf.h: the BSDF samples of one hit, computed without vector lanes, and the choice of one
// of them. Tests compare the arrays that the renderer computes for all hits of a batch with these
// (render/surface/sample_arrays.h, continue_paths.h).
#pragma once

#include <algorithm>
#include <cmath>

#include "render/surface/lobes.h"
#include "render/surface/sample_arrays.h"
#include "render/surface/scatter.h"

namespace openrt::test {

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
  // as in BsdfSample.
  BsdfSamples(const RtsHits& hits, uint32_t hit, const float* eta, uint8_t channel,
              TransportMode mode = TransportMode::radiance);
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
  TransportMode mode_;
  Vec3f d_, g_; // the ray's direction, the geometric normal
};

inline BsdfSamples::BsdfSamples(const RtsHits& hits, uint32_t hit, const float* eta,
                                uint8_t channel, TransportMode mode)
    : hit_(hit), eta_(eta), channel_(channel), mode_(mode), d_(load(hits.direction, hit)),
      g_(load(hits.geometric, hit)) {}

inline void BsdfSamples::add(uint32_t number, const RtsLobe& lobe, const LobeSamples* samples) {
  Vec3f w;
  if (!weightAt(lobe, hit_, w)) return;
  lobe_ = number;
  const Vec3f n = load(lobe.normal, hit_);
  switch (lobe.kind) {
  case RTS_LOBE_REFLECTION: mirror(n, w, 1); break;
  case RTS_LOBE_TRANSPARENT: put(d_, w, 1).deflected = false; break;
  case RTS_LOBE_DIELECTRIC:
    if (eta_ && channel_ == 0 && (eta_[0] != eta_[1] || eta_[0] != eta_[2])) {
      disperse(n, w);
    } else {
      const Boundary boundary = boundaryOf(n, lobe.parameter[0][hit_]);
      if (boundary.reflectance > 0) mirror(n, w, float(boundary.reflectance));
      refract(n, w, boundary);
    }
    break;
  default:
    if (samples) scatter(lobe, *samples, w);
  }
}

inline BsdfSample& BsdfSamples::put(const Vec3f& direction, const Vec3f& w, float factor) {
  return list[count++] = {.direction = direction,
                          .weight = w * factor,
                          .pdf = 0,
                          .expectedWeight = w * factor,
                          .lobe = lobe_,
                          .channel = channel_,
                          .deflected = true,
                          .rejected = false};
}

inline void BsdfSamples::scatter(const RtsLobe& lobe, const LobeSamples& samples, const Vec3f& w) {
  const Vec3f out = load(samples.direction, hit_), n = load(lobe.normal, hit_);
  double behind, share = 1;
  if (lobe.kind == RTS_LOBE_GLOSSY && lobe.parameter[1][hit_] > 0)
    share =
        fresnel(std::min(1.0, std::max(0.0, -double(dot(d_, n)))), lobe.parameter[1][hit_], behind);
  BsdfSample& sample = put(out, w, float(share));
  sample.weight = w * load(samples.value, hit_);
  sample.pdf = samples.pdf[hit_];
  sample.rejected = !(sample.pdf > 0);
  if (sample.rejected) return;
  if (mode_ == TransportMode::importance && lobe.kind == RTS_LOBE_ROUGH_DIELECTRIC &&
      dot(out, n) < 0) {
    const float eta = lobe.parameter[0][hit_];
    sample.weight = sample.weight / (eta * eta);
  }
  sample.rejected = dot(out, n) > 0 ? !(dot(out, g_) > 0)
                                    : !nonSpecularFunctions(lobe)->transmits || !(dot(out, g_) < 0);
}

// A shading normal may reflect a ray below the facet; then the facet's own normal is used.
inline BsdfSample& BsdfSamples::mirror(const Vec3f& n, const Vec3f& w, float factor) {
  const Vec3f out = reflectAt(d_, n);
  return put(dot(out, g_) > 0 ? out : reflectAt(d_, g_), w, factor);
}

inline BsdfSamples::Boundary BsdfSamples::boundaryOf(const Vec3f& n, float eta) const {
  Boundary out{};
  out.eta = eta > 0 && std::isfinite(eta) ? eta : 1;
  out.cosine = std::min(1.0, std::max(0.0, -double(dot(d_, n))));
  out.reflectance = fresnel(out.cosine, out.eta, out.cosineBehind);
  return out;
}

// Radiance is scaled by the squared relative index where it enters a denser medium (R. Siegel, J.
// Howell, "Thermal Radiation Heat Transfer", on n^2). So a refracted ray has the weight eta^2.
inline void BsdfSamples::refract(const Vec3f& n, const Vec3f& w, const Boundary& boundary) {
  const double eta = boundary.eta, transmittance = 1 - boundary.reflectance;
  if (!(transmittance > 0)) return;
  const Vec3f out = refractAt(d_, n, eta, boundary.cosine, boundary.cosineBehind);
  if (dot(out, g_) < 0)
    put(out, w,
        float(mode_ == TransportMode::importance ? transmittance : transmittance * eta * eta));
}

// Dispersion: every colour is refracted separately. All are reflected in one direction.
inline void BsdfSamples::disperse(const Vec3f& n, const Vec3f& w) {
  Boundary boundary[3];
  Vec3f reflectance;
  for (int k = 0; k < 3; k++) {
    boundary[k] = boundaryOf(n, eta_[k]);
    reflectance[k] = float(boundary[k].reflectance);
  }
  const float most = largest(reflectance);
  if (most > 0) mirror(n, w, most).weight = w * reflectance;
  for (int k = 0; k < 3; k++) {
    Vec3f only;
    only[k] = w[k];
    channel_ = uint8_t(k + 1);
    if (w[k] > 0) refract(n, only, boundary[k]);
  }
  channel_ = 0;
}

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

} // namespace openrt::test

#include "render/surface/bsdf_samples.h"

#include <cmath>

#include "render/surface/scatter.h"

namespace openrt {

BsdfSamples::BsdfSamples(const RtsHits& hits, uint32_t hit, const float* eta, uint8_t channel,
                         bool fromLamp)
    : hit_(hit), eta_(eta), channel_(channel), fromLamp_(fromLamp), d_(load(hits.direction, hit)),
      g_(load(hits.geometric, hit)) {}

void BsdfSamples::add(uint32_t number, const RtsLobe& lobe, const LobeSamples* samples) {
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

BsdfSample& BsdfSamples::put(const Vec3f& direction, const Vec3f& w, float factor) {
  return list[count++] = {.direction = direction,
                          .weight = w * factor,
                          .pdf = 0,
                          .expectedWeight = w * factor,
                          .lobe = lobe_,
                          .channel = channel_,
                          .deflected = true,
                          .rejected = false};
}

void BsdfSamples::scatter(const RtsLobe& lobe, const LobeSamples& samples, const Vec3f& w) {
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
  if (fromLamp_ && lobe.kind == RTS_LOBE_ROUGH_DIELECTRIC && dot(out, n) < 0) {
    const float eta = lobe.parameter[0][hit_];
    sample.weight = sample.weight / (eta * eta);
  }
  sample.rejected = dot(out, n) > 0 ? !(dot(out, g_) > 0)
                                    : !nonSpecularFunctions(lobe)->transmits || !(dot(out, g_) < 0);
}

// A shading normal may reflect a ray below the facet; then the facet's own normal is used.
BsdfSample& BsdfSamples::mirror(const Vec3f& n, const Vec3f& w, float factor) {
  const Vec3f out = reflectAt(d_, n);
  return put(dot(out, g_) > 0 ? out : reflectAt(d_, g_), w, factor);
}

BsdfSamples::Boundary BsdfSamples::boundaryOf(const Vec3f& n, float eta) const {
  Boundary out{};
  out.eta = eta > 0 && std::isfinite(eta) ? eta : 1;
  out.cosine = std::min(1.0, std::max(0.0, -double(dot(d_, n))));
  out.reflectance = fresnel(out.cosine, out.eta, out.cosineBehind);
  return out;
}

// Radiance is scaled by the squared relative index where it enters a denser medium (R. Siegel, J.
// Howell, "Thermal Radiation Heat Transfer", on n^2). So a refracted ray has the weight eta^2.
void BsdfSamples::refract(const Vec3f& n, const Vec3f& w, const Boundary& boundary) {
  const double eta = boundary.eta, transmittance = 1 - boundary.reflectance;
  if (!(transmittance > 0)) return;
  const Vec3f out = refractAt(d_, n, eta, boundary.cosine, boundary.cosineBehind);
  if (dot(out, g_) < 0) put(out, w, float(fromLamp_ ? transmittance : transmittance * eta * eta));
}

// Dispersion: every colour is refracted separately. All are reflected in one direction.
void BsdfSamples::disperse(const Vec3f& n, const Vec3f& w) {
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

} // namespace openrt

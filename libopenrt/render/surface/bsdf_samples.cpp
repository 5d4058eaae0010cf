#include "render/surface/bsdf_samples.h"

#include <cmath>

#include "render/surface/scatter.h"

namespace openrt {

BsdfSamples::BsdfSamples(const RtsHits& hits, uint32_t hit, const float* eta, uint8_t channel,
                         bool fromLamp)
    : hit_(hit), eta_(eta), channel_(channel), fromLamp_(fromLamp) {
  for (int k = 0; k < 3; k++) {
    d_[k] = hits.direction[k][hit];
    g_[k] = hits.geometric[k][hit];
  }
}

void BsdfSamples::add(uint32_t number, const RtsLobe& lobe, const LobeSamples* samples) {
  float w[3];
  if (!weightAt(lobe, hit_, w)) return;
  lobe_ = number;
  const float n[3] = {lobe.normal[0][hit_], lobe.normal[1][hit_], lobe.normal[2][hit_]};
  switch (lobe.kind) {
  case RTS_LOBE_REFLECTION: mirror(n, w, 1); break;
  case RTS_LOBE_TRANSPARENT: put(d_, w, 1).deflected = false; break;
  case RTS_LOBE_DIELECTRIC:
    // Dispersion: every colour is refracted separately.
    if (eta_ && channel_ == 0 && (eta_[0] != eta_[1] || eta_[0] != eta_[2])) {
      for (int k = 0; k < 3; k++) {
        float only[3] = {0, 0, 0};
        only[k] = w[k];
        channel_ = uint8_t(k + 1);
        if (w[k] > 0) dielectric(n, only, eta_[k]);
      }
      channel_ = 0;
    } else {
      dielectric(n, w, eta_ ? eta_[channel_ ? channel_ - 1 : 0] : lobe.parameter[0][hit_]);
    }
    break;
  default:
    if (samples) scatter(lobe, *samples, w);
  }
}

BsdfSample& BsdfSamples::put(const float direction[3], const float w[3], float factor) {
  BsdfSample& sample = list[count++];
  for (int k = 0; k < 3; k++) {
    sample.direction[k] = direction[k];
    sample.expectedWeight[k] = sample.weight[k] = w[k] * factor;
  }
  sample.pdf = 0;
  sample.lobe = lobe_;
  sample.channel = channel_;
  sample.deflected = true;
  sample.rejected = false;
  return sample;
}

void BsdfSamples::scatter(const RtsLobe& lobe, const LobeSamples& samples, const float w[3]) {
  const float out[3] = {samples.direction[0][hit_], samples.direction[1][hit_],
                        samples.direction[2][hit_]};
  const float n[3] = {lobe.normal[0][hit_], lobe.normal[1][hit_], lobe.normal[2][hit_]};
  double behind, share = 1;
  if (lobe.kind == RTS_LOBE_GLOSSY && lobe.parameter[1][hit_] > 0)
    share = fresnel(std::min(1.0, std::max(0.0, -double(dot3(d_, n)))), lobe.parameter[1][hit_],
                    behind);
  BsdfSample& sample = put(out, w, float(share));
  for (int k = 0; k < 3; k++) sample.weight[k] = w[k] * samples.value[k][hit_];
  sample.pdf = samples.pdf[hit_];
  sample.rejected = !(sample.pdf > 0);
  if (sample.rejected) return;
  if (fromLamp_ && lobe.kind == RTS_LOBE_ROUGH_DIELECTRIC && dot3(out, n) < 0) {
    const float eta = lobe.parameter[0][hit_];
    for (float& weight : sample.weight) weight /= eta * eta;
  }
  sample.rejected = dot3(out, n) > 0
                        ? !(dot3(out, g_) > 0)
                        : !nonSpecularFunctions(lobe)->transmits || !(dot3(out, g_) < 0);
}

// A shading normal may reflect a ray below the facet; then the facet's own normal is used.
void BsdfSamples::mirror(const float n[3], const float w[3], float factor) {
  float out[3];
  reflectAt(d_, n, out);
  if (!(dot3(out, g_) > 0)) reflectAt(d_, g_, out);
  put(out, w, factor);
}

// Radiance is scaled by the squared relative index where it enters a denser medium (R. Siegel, J.
// Howell, "Thermal Radiation Heat Transfer", on n^2). So a refracted ray has the weight eta^2.
void BsdfSamples::dielectric(const float n[3], const float w[3], float eta) {
  if (!(eta > 0) || !std::isfinite(eta)) eta = 1;
  const double cosine = std::min(1.0, std::max(0.0, -double(dot3(d_, n))));
  double behind;
  const double r = fresnel(cosine, eta, behind);
  if (r > 0) mirror(n, w, float(r));
  if (r >= 1) return;
  float out[3];
  refractAt(d_, n, eta, cosine, behind, out);
  if (dot3(out, g_) < 0) put(out, w, float(fromLamp_ ? 1 - r : (1 - r) * eta * eta));
}

} // namespace openrt

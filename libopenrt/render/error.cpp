// error.cpp: see error.h.
//
// Replicated randomised quasi-Monte Carlo: A. B. Owen, "Monte Carlo theory, methods and examples", 17.3 (error estimation from
// independent randomisations). Student's interval over the replicates' means; the last replicate may be shorter.
#include "render/error.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace openrt {
namespace {

constexpr uint32_t fewestSamples = 32, fewestReplicates = 16; // of frames whose error is asked for
constexpr uint32_t trustedReplicates = 8;
// A mean of n samples is about normal if skewness^2 / n and kurtosis / n are small (F. Y. Edgeworth's expansion). For a light
// that a fraction p of the samples meets both are 1 / (n p): one over the number of samples that met it.
//   Both are judged by the 8x8 pixels together, by two measures that fail in different places: the kurtosis of all samples finds
// what is rare and bright, unless a brighter edge hides it; the skewness of the replicates' means finds tails of any scale,
// unless few pixels have met them. A test of the pixel by itself would pick those that have missed what is rare, and make things
// worse. Where nothing is random only edges are left, of which the first measure is enough. Limits by experiment
// (docs/accuracy.md); the mean |skewness| of sixteen normal numbers is 0.44.
constexpr double largestKurtosis = 1.0 / 4, largestSkewness = 0.7; // the former over n

struct Moments { // of the grey of the samples about their mean, summed
  double second, fourth;
};

Moments moments(const PixelSums& s) {
  const double n = s.samples, sum = s.delta[0] + s.delta[1] + s.delta[2], m = sum / n;
  const double second = s.grey[0] - sum * m;
  const double fourth = s.grey[2] - 4 * m * s.grey[1] + 6 * m * m * s.grey[0] - 3 * n * m * m * m * m;
  const double noise = 1e-12 * std::fabs(s.grey[0]); // of the subtraction
  return {second > noise ? second : 0, std::max(fourth, 0.0)};
}

double skewnessOfMeans(const PixelSums& s) {
  const double r = s.replicates, mean = s.closedGrey[0] / r, square = s.closedGrey[1] / r, v = square - mean * mean;
  if (!(v > 1e-12 * square)) return 1; // all alike although the samples vary: a lattice
  return (s.closedGrey[2] / r - 3 * mean * square + 2 * mean * mean * mean) / (v * std::sqrt(v));
}

// Variance of the mean of colour k, and the degrees of freedom it was estimated with.
double varianceOfMean(const PixelSums& s, const Replicates& replicates, int k, uint32_t& freedom) {
  const double n = s.samples;
  const uint32_t rest = replicates.many() ? s.samples - s.replicates * replicates.size() : 0;
  const uint32_t count = s.replicates + (rest ? 1 : 0);
  if (!replicates.many() || count < 2) {
    freedom = s.samples - 1;
    return std::max(0.0, s.delta2[k] - s.delta[k] * s.delta[k] / n) / (n - 1) / n;
  }
  // Sum over the replicates of (their sum - their share of the whole)^2: unbiased where all are of one size.
  const double mean = s.delta[k] / n, size = replicates.size();
  const double last = (s.delta[k] - s.closed[k]) - rest * mean;
  const double squares = s.closed2[k] - 2 * size * mean * s.closed[k] + s.replicates * size * size * mean * mean + last * last;
  freedom = count - 1;
  const double noise = 1e-13 * s.closed2[k];
  return squares > noise ? squares / (n * n) * count / (count - 1) : 0;
}

} // namespace

double student95(uint32_t degreesOfFreedom) {
  static constexpr double table[] = {0, 12.7062, 4.30265, 3.18245, 2.77645, 2.57058, 2.44691, 2.36462, 2.30600, 2.26216};
  if (degreesOfFreedom < std::size(table)) return table[degreesOfFreedom];
  // M. Abramowitz, I. Stegun, "Handbook of Mathematical Functions", 26.7.5
  const double z = 1.959963985, v = degreesOfFreedom, z3 = z * z * z, z5 = z3 * z * z;
  const double first = (z3 + z) / 4, second = (5 * z5 + 16 * z3 + 3 * z) / 96;
  const double third = (3 * z5 * z * z + 19 * z5 + 17 * z3 - 15 * z) / 384;
  return z + first / v + second / (v * v) + third / (v * v * v);
}

bool wantsError(const edit::FrameSettingsT& frame) {
  return (frame.channels & (RT_ERROR | RT_TRUST)) || frame.targetError > 0 || frame.timeLimit > 0;
}

Replicates replicatesOf(const edit::FrameSettingsT& frame, uint32_t samples, uint32_t seed) {
  uint32_t count = frame.replicates;
  if (count == 0) count = wantsError(frame) && samples >= fewestSamples ? fewestReplicates : 1;
  if (count <= 1) return {seed, 31};
  return {seed, uint32_t(std::bit_width(std::max(samples / count, 1u))) - 1};
}

void Tails::add(const PixelSums& s) {
  const Moments m = moments(s);
  square2 += m.second * m.second / s.samples;
  fourth += m.fourth;
  if (m.second > 0 && s.random && s.replicates > 2) skewness += std::fabs(skewnessOfMeans(s)), varying++;
  for (int k = 0; k < 3; k++) largest[k] = std::max(largest[k], s.largest[k]);
}

PixelError pixelError(const PixelSums& s, const Replicates& replicates, const Tails* around) {
  PixelError e;
  if (s.samples == 0) return e;
  const double infinity = std::numeric_limits<double>::infinity(), n = s.samples;
  double half = 0, expected = 0;
  uint32_t freedom = 0;
  bool varies = false;
  for (int k = 0; k < 3; k++) {
    const double v = s.samples > 1 ? varianceOfMean(s, replicates, k, freedom) : infinity;
    double h = s.samples > 1 ? student95(freedom) * std::sqrt(v) : infinity;
    // Mean of |x| of a normal x, with the bias of the root of a variance taken out (the factor known as c4).
    double mean = s.samples > 1 ? std::sqrt(2 / M_PI * v) * (4.0 * freedom + 1) / (4.0 * freedom) : infinity;
    const double spread = s.delta2[k] - s.delta[k] * s.delta[k] / n;
    if (spread > 1e-12 * s.delta2[k])
      varies = true;
    else if (s.random && around)
      h = mean = around->largest[k] > 0 ? ruleOfThree / n * around->largest[k] : infinity;
    e.halfWidth[k] = float(h);
    e.mean[k] = float(s.rgba[k] / n);
    half += h, expected += mean;
  }
  e.relative = relativeError(half, e.mean), e.expected = relativeError(expected, e.mean);
  e.samples = s.samples;
  e.constant = s.samples > 1 && !varies && !s.random;
  e.trusted = around && replicates.many() && freedom + 1 >= trustedReplicates && std::isfinite(half) && (varies || !s.random);
  if (!e.trusted || !varies) return e;
  e.trusted = around->kurtosis() <= n * largestKurtosis && (!s.random || around->meanSkewness() <= largestSkewness);
  return e;
}

uint32_t samplesFor(double target, double halfWidth, uint32_t samples, uint32_t most) {
  const double ratio = halfWidth / target, needed = samples * ratio * ratio;
  if (!(needed < most)) return most;
  return std::min(most, std::bit_ceil(std::max(uint32_t(std::ceil(needed)), fewestSamples)));
}

} // namespace openrt

// openrt_phase_function.cpp: the phase function of media that scatter, and its sampling.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "render/medium/phase_function.h"

namespace openrt {
namespace {

constexpr double anisotropies[] = {-.99, -.5, -1e-3, -1e-4, -5e-5, 0, 1e-6, 9e-5, .1, .5, .9, .99};

// Integrates over the sphere by the midpoint rule in the distribution of the sampled cosine, whose
// integrand has no peak.
TEST(PhaseFunction, IsNormalizedAndHasItsMeanCosine) {
  for (const double g : anisotropies) {
    // Substitutes cosine = 1 - 2 x^4 towards the peak at 1, or at -1 if g is negative.
    constexpr int n = 200000;
    double total = 0, mean = 0;
    for (int i = 0; i < n; i++) {
      const double x = (i + .5) / n, cosine = std::copysign(1.0, g) * (1 - 2 * x * x * x * x),
                   weight = 2 * std::numbers::pi * 8 * x * x * x / n;
      total += weight * phaseFunction(g, cosine);
      mean += weight * phaseFunction(g, cosine) * cosine;
    }
    EXPECT_NEAR(total, 1, 1e-7) << g;
    EXPECT_NEAR(mean, g, 1e-7) << g;
  }
}

// The distribution function of the cosine at a sampled cosine is the number that sampled it.
TEST(PhaseFunction, SamplesInvertTheDistribution) {
  for (const double g : anisotropies) {
    double mean = 0;
    constexpr int n = 1000;
    for (int i = 0; i < n; i++) {
      const double u = (i + .5) / n, cosine = samplePhaseCosine(g, u);
      ASSERT_GE(cosine, -1);
      ASSERT_LE(cosine, 1);
      const double distribution =
          std::fabs(g) < 1e-3
              ? .5 * (1 + cosine) - .75 * g * (1 - cosine * cosine) -
                    1.25 * g * g * cosine * (1 - cosine * cosine)
              : (1 - g * g) / (2 * g) * (1 / std::sqrt(1 + g * g - 2 * g * cosine) - 1 / (1 + g));
      EXPECT_NEAR(distribution, u, 1e-8) << g;
      mean += cosine / n;
    }
    EXPECT_NEAR(mean, g, 2e-4) << g;
  }
}

// The table of functions is what the transports call.
TEST(PhaseFunction, LobeSamplesWhatItEvaluates) {
  constexpr uint32_t n = 64;
  const Vec3f ray = normalize(Vec3f{.3f, -.5f, .8f});
  std::vector<float> along[3], to[3], value[3], again[3], u(n), v(n), g(n, .7f), pdf(n), density(n);
  RtsHits hits{};
  RtsLobe lobe{};
  float *direction[3], *quotient[3], *values[3];
  for (int k = 0; k < 3; k++) {
    along[k].assign(n, ray[size_t(k)]);
    to[k].resize(n);
    value[k].resize(n);
    again[k].resize(n);
    hits.direction[k] = along[k].data();
    direction[k] = to[k].data();
    quotient[k] = value[k].data();
    values[k] = again[k].data();
  }
  hits.count = n;
  lobe.data[0] = g.data();
  std::vector<uint32_t> hit(n);
  for (uint32_t i = 0; i < n; i++) {
    hit[i] = i;
    u[i] = (float(i) + .5f) / n;
    v[i] = float(i * 29 % n) / n;
  }
  const float* square[2] = {u.data(), v.data()};
  phaseLobe.sample(&lobe, &hits, n, hit.data(), square, direction, quotient, pdf.data());
  phaseLobe.evaluate(&lobe, &hits, n, hit.data(), direction, values, density.data());
  for (uint32_t i = 0; i < n; i++) {
    const Vec3f d = load(direction, i);
    EXPECT_NEAR(length(d), 1, 1e-6);
    EXPECT_NEAR(dot(d, ray), samplePhaseCosine(.7, double(u[i])), 1e-6);
    EXPECT_NEAR(density[i], pdf[i], 1e-5 * pdf[i]);
    EXPECT_EQ(again[0][i], density[i]);
    EXPECT_EQ(value[0][i], 1);
  }
}

} // namespace
} // namespace openrt

// openrt_lobes.cpp: Tests the engine's scattering lobes: samples, values and pdfs must be
// consistent.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "render/surface/lobes.h"
#include "render/surface/scatter.h"
#include "render/wave/sampler.h"

namespace {

using namespace openrt;

// One hit with one lobe, the normal along z, seen at `degrees` from it.
struct Bench {
  float weight[3] = {1, 1, 1}, normal[3] = {0, 0, 1}, parameter[2] = {0, 0}, direction[3];
  RtsLobe lobe{};
  RtsHits hits{};
  Arena arena;

  Bench(RtsLobeKind kind, float first, float second, double degrees) {
    const double a = degrees * M_PI / 180;
    direction[0] = float(-std::sin(a));
    direction[1] = 0;
    direction[2] = float(-std::cos(a));
    parameter[0] = first;
    parameter[1] = second;
    lobe.kind = kind;
    for (int k = 0; k < 3; k++) {
      lobe.weight[k] = &weight[k];
      lobe.normal[k] = &normal[k];
      hits.direction[k] = &direction[k];
    }
    for (int k = 0; k < 2; k++) lobe.parameter[k] = &parameter[k];
    hits.count = 1;
  }
  // Returns the mean of the sampled weights and the fraction of samples that have a direction.
  std::pair<double, double> sampled(uint32_t edge) {
    const uint32_t n = edge * edge;
    std::vector<float> u(n), v(n);
    const std::vector<uint32_t> hit(n, 0);
    for (uint32_t i = 0; i < n; i++) {
      u[i] = (float(i % edge) + .5f) / float(edge);
      v[i] = (float(i / edge) + toUnit(hash(i))) / float(edge);
    }
    const float* square[2] = {u.data(), v.data()};
    LobeSamples samples(arena, n);
    samples.sample(lobe, hits, n, hit.data(), square);
    LobeValues answers(arena, n);
    answers.evaluate(lobe, hits, n, hit.data(), samples.direction);
    double sum = 0, some = 0;
    for (uint32_t i = 0; i < n; i++) {
      if (!(samples.pdf[i] > 0)) continue;
      some++;
      sum += samples.value[0][i];
      const Vec3f d = load(samples.direction, i);
      EXPECT_NEAR(dot(d, d), 1, 1e-5);
      // Evaluated again for the rounded direction; near the axis of a narrow lobe digits are lost.
      EXPECT_NEAR(answers.pdf[i] / samples.pdf[i], 1, 2e-3) << i;
      EXPECT_NEAR(answers.value[0][i], samples.value[0][i] * samples.pdf[i],
                  3e-3 * answers.value[0][i] + 1e-6)
          << i;
    }
    return {sum / n, some / n};
  }
  // Returns the integrals of value and pdf over the sphere of directions, by the midpoint rule in
  // theta and phi.
  std::pair<double, double> integrated(uint32_t rows) {
    const uint32_t columns = rows;
    double value = 0, pdf = 0;
    for (uint32_t row = 0; row < rows; row++) {
      std::vector<float> d[3];
      for (auto& a : d) a.resize(columns);
      const std::vector<uint32_t> hit(columns, 0);
      // Equal steps of theta: narrow lobes lie at small angles or near the horizon.
      const double theta = M_PI * (row + .5) / rows, s = std::sin(theta);
      for (uint32_t c = 0; c < columns; c++) {
        const double phi = 2 * M_PI * (c + .5) / columns;
        d[0][c] = float(s * std::cos(phi));
        d[1][c] = float(s * std::sin(phi));
        d[2][c] = float(std::cos(theta));
      }
      const float* directions[3] = {d[0].data(), d[1].data(), d[2].data()};
      ArenaScope scope(arena);
      LobeValues answers(arena, columns);
      answers.evaluate(lobe, hits, columns, hit.data(), directions);
      const double cell = 2 * M_PI / columns * M_PI / rows * s;
      for (uint32_t c = 0; c < columns; c++) {
        value += answers.value[0][c] * cell;
        pdf += answers.pdf[c] * cell;
      }
    }
    return {value, pdf};
  }
};

struct Case {
  const char* name;
  RtsLobeKind kind;
  float first, second;
};

class Lobe : public testing::TestWithParam<Case> {};

TEST_P(Lobe, WhatIsSampledIsWhatIsEvaluated) {
  for (const double degrees : {0., 30., 60., 80., 89.}) {
    Bench bench(GetParam().kind, GetParam().first, GetParam().second, degrees);
    const auto [mean, some] = bench.sampled(256);
    const auto [value, pdf] = bench.integrated(1200);
    EXPECT_NEAR(mean, value, 1e-2) << degrees;
    EXPECT_NEAR(some, pdf, 1e-2) << degrees;
    EXPECT_LE(mean, GetParam().kind == RTS_LOBE_ROUGH_DIELECTRIC ? 2.26 : 1.0001) << degrees;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, Lobe,
    testing::Values(Case{"Diffuse", RTS_LOBE_DIFFUSE, 0, 0},
                    Case{"Smooth", RTS_LOBE_GLOSSY, .15f, 0},
                    Case{"Glossy", RTS_LOBE_GLOSSY, .3f, 0}, Case{"Rough", RTS_LOBE_GLOSSY, 1, 0},
                    Case{"Coat", RTS_LOBE_GLOSSY, .3f, 1 / 1.5f},
                    Case{"Into", RTS_LOBE_ROUGH_DIELECTRIC, 1 / 1.5f, .3f},
                    Case{"OutOf", RTS_LOBE_ROUGH_DIELECTRIC, 1.5f, .3f},
                    Case{"RoughInto", RTS_LOBE_ROUGH_DIELECTRIC, 1 / 1.5f, .8f}),
    [](const auto& info) { return std::string(info.param.name); });

// Reciprocity: exchanging the directions keeps the value divided by the cosine.
TEST(Lobes, GlossyIsReciprocal) {
  Bench one(RTS_LOBE_GLOSSY, .4f, 1 / 1.5f, 20), other(RTS_LOBE_GLOSSY, .4f, 1 / 1.5f, 65);
  const uint32_t hit = 0;
  LobeValues a(one.arena, 1), b(one.arena, 1);
  const float to65[3] = {float(std::sin(65 * M_PI / 180)), 0, float(std::cos(65 * M_PI / 180))};
  const float to20[3] = {float(std::sin(20 * M_PI / 180)), 0, float(std::cos(20 * M_PI / 180))};
  const float *first[3] = {&to65[0], &to65[1], &to65[2]},
              *second[3] = {&to20[0], &to20[1], &to20[2]};
  a.evaluate(one.lobe, one.hits, 1, &hit, first);
  b.evaluate(other.lobe, other.hits, 1, &hit, second);
  EXPECT_NEAR(a.value[0][0] / to65[2], b.value[0][0] / to20[2], 1e-6);
}

} // namespace

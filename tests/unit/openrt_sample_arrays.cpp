// openrt_sample_arrays.cpp: Tests the BSDF samples that vector code makes at all hits of a batch,
// and the selection of one of them: they are those of the scalar functions (scalar_bsdf.h).
// Reflection and refraction agree with Fresnel's and Snell's equations near the critical angle and
// at grazing angles.
#include <gtest/gtest.h>

#include <cmath>

#include "render/path/spawn_rays.h"
#include "render/surface/adjoint.h"
#include "render/surface/continue_paths.h"
#include "unit/lobe_hits.h"
#include "unit/scalar_bsdf.h"

using namespace openrt;
using openrt::test::BsdfChoice;
using openrt::test::BsdfSample;
using openrt::test::BsdfSamples;
using openrt::test::count;
using openrt::test::expectEqual;
using openrt::test::Glass;
using openrt::test::Hits;
using openrt::test::PlaneHits;

namespace {

// Reflectance and refracted direction by Fresnel's and Snell's equations in long double, for a ray
// in the x-z plane. The cosine of incidence is the one that float can represent.
struct ClosedForm {
  long double reflectance = 1, x = 0, z = 0;
  ClosedForm(long double cosine, long double eta) {
    const long double sine2 = 1 - cosine * cosine, behind2 = 1 - eta * eta * sine2;
    if (behind2 <= 0) return;
    const long double behind = std::sqrt(behind2);
    const long double s = (eta * cosine - behind) / (eta * cosine + behind),
                      p = (cosine - eta * behind) / (cosine + eta * behind);
    reflectance = (s * s + p * p) / 2;
    x = eta * std::sqrt(sine2);
    z = -behind;
  }
};

// Compares the samples at a boundary z = 0 with the closed form, for rays with these cosines.
void expectClosedForm(const std::vector<double>& cosines, float eta) {
  const uint32_t n = uint32_t(cosines.size());
  PlaneHits plane(n);
  RtsBatch batch = plane.batch();
  plane.add(batch, RTS_LOBE_DIELECTRIC, 1);
  const RtsLobe& lobe = batch.lobes[0];
  std::fill_n(lobe.parameter[0], n, eta);
  for (uint32_t i = 0; i < n; i++)
    store(Vec3f{float(std::sqrt(1 - cosines[i] * cosines[i])), 0, -float(cosines[i])},
          Hits::arrayOf(plane.points.hits.direction), i);
  BoundarySamples out;
  const auto take = [&] { return plane.arena.take<float>(padded(n)); };
  for (int k = 0; k < 3; k++) {
    out.reflected[k] = take();
    out.refracted[k] = take();
  }
  out.reflectedShare = take();
  out.refractedShare = take();
  sampleBoundary(plane.points.hits, lobe, lobe.parameter[0], TransportMode::radiance, out);
  for (uint32_t i = 0; i < n; i++) {
    const ClosedForm exact(float(cosines[i]), eta);
    const Vec3f d = load(plane.points.hits.direction, i);
    EXPECT_NEAR(out.reflectedShare[i], double(exact.reflectance), 1e-7) << cosines[i];
    EXPECT_NEAR(out.refractedShare[i], double((1 - exact.reflectance) * eta * eta), 3e-7)
        << cosines[i];
    expectEqual(load(out.reflected, i), {d.x, 0, -d.z}, "reflection", i);
    if (!(out.refractedShare[i] > 0)) continue;
    // The direction has a float error of its own, beside that of the cosine.
    EXPECT_NEAR(out.refracted[0][i], double(exact.x), 3e-7) << cosines[i];
    EXPECT_NEAR(out.refracted[2][i], double(exact.z), 3e-7) << cosines[i];
  }
}

} // namespace

// Where glass disperses light, one ray carries the reflection of all colours, and the refraction of
// each colour has a ray of its own. By colour they carry what Fresnel's equations say.
TEST(SampleArrays, DispersionReflectsAllColoursInOneRay) {
  Hits hits(RT_TRANSPORT_WHITTED);
  hits.plane.scene.frame.energyCut = 0;
  hits.plane.add(hits.batch, RTS_LOBE_DIELECTRIC, 1);
  const Glass glass(hits, true);
  UnsampledLights unsampled(hits.plane.scene, hits.ledger);
  RayQueue next;
  spawnRays({hits.batch, 3, hits.samples, unsampled, hits.ledger, next}, {}, glass.boundaries);
  uint32_t reflections = 0, refractions = 0;
  for (size_t r = 0; r < next.size(); r++) {
    const RayState ray = next.states()[r];
    const uint32_t i = ray.path, colour = ray.flags.channel();
    if (!glass.boundaries.disperses[i]) continue;
    const RtsHits& at = hits.plane.points.hits;
    const float cosine =
        std::min(1.0f, -dot(load(at.direction, i), load(hits.batch.lobes[0].normal, i)));
    if (cosine < 0.01f) continue;
    const bool reflected = dot(load(next.direction(), r), load(at.geometric, i)) > 0;
    (reflected ? reflections : refractions)++;
    EXPECT_EQ(reflected, colour == 0) << i;
    for (uint32_t k = 0; k < 3; k++) {
      const float eta = glass.eta[i][k];
      const double reflectance = double(ClosedForm(cosine, eta).reflectance);
      const double part = reflected         ? reflectance
                          : colour == k + 1 ? (1 - reflectance) * eta * eta
                                            : 0;
      EXPECT_NEAR(ray.throughput[k], load(hits.plane.states.throughput, i)[k] * part, 1e-6) << i;
    }
  }
  EXPECT_GT(reflections, count / 10);
  EXPECT_GT(refractions, 2 * reflections);
}

// The flux of a light path is divided between the reflection and the refractions, colour by colour.
TEST(SampleArrays, DispersionKeepsTheFluxOfLightPaths) {
  Hits hits(RT_TRANSPORT_PATH);
  hits.plane.add(hits.batch, RTS_LOBE_DIELECTRIC, 1);
  const Glass glass(hits, true);
  const BsdfSampleArrays samples(hits.batch, {}, glass.boundaries, TransportMode::importance);
  uint32_t complete = 0;
  for (uint32_t i = 0; i < count; i++) {
    if (!glass.boundaries.disperses[i]) continue;
    uint32_t ways = 0;
    Vec3f sum;
    for (const SampleArrays& sample : samples) {
      const Vec3f weight = sample.weightAt(i);
      ways += largest(weight) > 0;
      sum = sum + weight;
    }
    EXPECT_LE(ways, 4u);
    if (ways < 4) continue; // total reflection, or a refraction above the facet
    complete++;
    for (int k = 0; k < 3; k++) EXPECT_NEAR(sum[k], 1, 1e-6) << i;
  }
  EXPECT_GT(complete, count / 10);
}

namespace {

// Compares the samples that selectSamples() selects with those of the scalar functions.
// onlySpecular: at every third hit non-specular samples do not count. roulette: paths may end.
void expectSelectionOfScalarFunctions(Hits& hits, const Boundaries& boundaries, TransportMode mode,
                                      bool onlySpecular, bool roulette) {
  const LobeSampling sampling = hits.sampleAll();
  const BsdfSampleArrays samples(hits.batch, sampling, boundaries, mode);
  auto* specular = hits.plane.arena.takeZero<uint32_t>(padded(count));
  for (uint32_t i = 0; onlySpecular && i < count; i++) specular[i] = i % 3 == 0;
  const bool known = mode == TransportMode::radiance;
  Selection selection{.points = &hits.plane.points,
                      .choice = sampling.choices[0],
                      .survival = roulette ? sampling.choices[1] : nullptr,
                      .throughput = known ? hits.plane.states.throughput : nullptr,
                      .onlySpecular = onlySpecular ? specular : nullptr};
  selection.allocate(hits.plane.arena);
  selectSamples(selection, samples);
  uint32_t selected = 0;
  for (uint32_t i = 0; i < count; i++) {
    const RayState ray = hits.plane.states[i];
    const RtsHits& at = hits.plane.points.hits;
    BsdfSamples expected(at, i, boundaries.etaAt(i), ray.flags.channel(), mode);
    for (uint32_t l = 0; l < hits.batch.lobes.size(); l++)
      expected.add(l, hits.batch.lobes[l], specular[i] ? nullptr : sampling.samples[l]);
    const BsdfChoice choice(expected, known ? ray.throughput : Vec3f{1, 1, 1});
    const float survival = roulette ? std::min(1.0f, choice.sum) : 1;
    EXPECT_EQ(selection.survivalProbability[i], survival) << i;
    const uint32_t chosen = choice.select(sampling.choices[0][i]);
    const bool survives = !roulette || sampling.choices[1][i] < survival;
    if (!survives || !(choice.sum > 0) || !(choice.carried[chosen] > 0)) {
      EXPECT_EQ(selection.number[i], SampleArrays::lacking) << i;
      continue;
    }
    selected++;
    ASSERT_NE(selection.number[i], SampleArrays::lacking) << i;
    const SampleArrays& found = samples[selection.number[i]];
    const BsdfSample& sample = expected.list[chosen];
    EXPECT_EQ(found.lobe, &hits.batch.lobes[sample.lobe]) << i;
    EXPECT_EQ(selection.probability[i], choice.probability(chosen)) << i;
    expectEqual(load(found.direction, i), sample.direction, "direction", i);
    EXPECT_EQ(found.deflected, sample.deflected) << i;
    EXPECT_EQ(found.colour ? found.colour : ray.flags.channel(), sample.channel) << i;
    EXPECT_EQ(found.isConsistentAt(at, i), !sample.rejected) << i;
    if (sample.rejected) continue;
    const float scale = mode == TransportMode::importance
                            ? radianceScale(*found.lobe, i, load(found.direction, i))
                            : 1;
    expectEqual(found.weightAt(i) / scale, sample.weight, "weight", i);
  }
  EXPECT_GT(selected, count / 4);
}

} // namespace

TEST(SampleArrays, OneSampleOfEachHitIsSelected) {
  for (const auto mode : {TransportMode::radiance, TransportMode::importance})
    for (const bool onlySpecular : {false, true}) {
      const bool roulette = mode == TransportMode::importance;
      SCOPED_TRACE(testing::Message() << int(mode) << ' ' << onlySpecular);
      Hits paint(RT_TRANSPORT_PATH);
      paint.add(RTS_LOBE_DIFFUSE);
      paint.add(RTS_LOBE_GLOSSY, 0.3f, 1 / 1.5f);
      paint.add(RTS_LOBE_REFLECTION);
      expectSelectionOfScalarFunctions(paint, {}, mode, onlySpecular, roulette);
      Hits frosted(RT_TRANSPORT_PATH);
      frosted.add(RTS_LOBE_TRANSPARENT);
      frosted.add(RTS_LOBE_ROUGH_DIELECTRIC, 1 / 1.5f, 0.2f);
      frosted.add(RTS_LOBE_DIELECTRIC, 1.3f);
      expectSelectionOfScalarFunctions(frosted, {}, mode, onlySpecular, roulette);
      Hits prism(RT_TRANSPORT_PATH);
      prism.add(RTS_LOBE_DIELECTRIC);
      prism.add(RTS_LOBE_DIFFUSE);
      const Glass glass(prism, true);
      expectSelectionOfScalarFunctions(prism, glass.boundaries, mode, onlySpecular, roulette);
    }
}

TEST(SampleArrays, BoundariesFollowFresnelAndSnell) {
  std::vector<double> all, grazing;
  for (int i = 0; i <= 200; i++) all.push_back(i / 200.0);
  for (int i = 0; i < 100; i++) grazing.push_back(std::pow(10, -i / 5.0));
  for (const float eta : {1 / 1.5f, 1.5f, 1 / 2.42f, 2.42f, 1 / 1.0003f, 1.0003f}) {
    SCOPED_TRACE(eta);
    expectClosedForm(all, eta);
    expectClosedForm(grazing, eta);
  }
  // Equal indices: double loses the square of cosines below 1e-7, which no ray has by chance.
  grazing.resize(31);
  expectClosedForm(all, 1);
  expectClosedForm(grazing, 1);
}

TEST(SampleArrays, BoundariesAtTheCriticalAngle) {
  for (const float eta : {1.0003f, 1.33f, 1.5f, 2.42f}) {
    SCOPED_TRACE(eta);
    std::vector<double> cosines;
    const double critical = std::sqrt(1 - 1 / (double(eta) * double(eta)));
    for (int i = -40; i <= 40; i++) cosines.push_back(critical * (1 + i * 0x1p-24));
    for (int i = 2; i < 30; i++)
      for (const double side : {-1., 1.})
        cosines.push_back(critical * (1 + side * std::pow(2, -i)));
    for (double& cosine : cosines) cosine = std::min(cosine, 1.0);
    expectClosedForm(cosines, eta);
  }
}

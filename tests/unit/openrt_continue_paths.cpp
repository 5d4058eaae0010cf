// openrt_continue_paths.cpp: Tests the vector code that continues camera paths: its rays are those
// of the scalar functions (scalar_bsdf.h), on every instruction set.
#include <gtest/gtest.h>

#include "render/lights/emitted.h"
#include "render/path/spawn_rays.h"
#include "render/surface/continue_paths.h"
#include "scene/transports.h"
#include "unit/lobe_hits.h"
#include "unit/same_bytes.h"
#include "unit/scalar_bsdf.h"

using namespace openrt;
using openrt::test::BsdfChoice;
using openrt::test::BsdfSample;
using openrt::test::BsdfSamples;
using openrt::test::count;
using openrt::test::expectEqual;
using openrt::test::expectSameBytes;
using openrt::test::Glass;
using openrt::test::Hits;

namespace {

struct Spawned {
  Vec3f origin, direction;
  RayState state;
};

// The rays of all hits by the scalar functions, hit by hit.
struct ScalarRays {
  std::vector<Spawned> rays;
  std::vector<uint8_t> random = std::vector<uint8_t>(count);
  std::vector<float> selection[RTS_MAX_LOBES];
  double cutByEnergy = 0;

  ScalarRays(const Hits& hits, const LobeSampling& sampling, const Boundaries& boundaries) {
    for (auto& list : selection) list.assign(count, 0);
    for (uint32_t i = 0; i < count; i++) {
      const RayState ray = hits.plane.states[i];
      BsdfSamples samples(hits.plane.points.hits, i, boundaries.etaAt(i), ray.flags.channel());
      for (uint32_t l = 0; l < hits.batch.lobes.size(); l++) {
        samples.add(l, hits.batch.lobes[l], sampling.samples[l]);
        if (sampling.samples[l]) random[i] = 1;
      }
      const BsdfChoice choice(samples, ray.throughput);
      if (!(choice.sum > 0)) continue;
      if (!sampling.choices[0]) {
        for (uint32_t w = 0; w < samples.count; w++) {
          const bool cut = choice.carried[w] < hits.plane.scene.frame.energyCut;
          if (!cut) send(hits, boundaries, i, samples, w, 1, 1);
          for (size_t k = 0; cut && k < 3; k++)
            cutByEnergy += double(samples.list[w].expectedWeight[k]) * double(ray.throughput[k]);
        }
        continue;
      }
      const bool all = samples.count == 1 || ray.flags.splits() < mostSplits;
      random[i] |= !all;
      const uint32_t chosen = choice.select(sampling.choices[0][i]);
      for (uint32_t w = 0; w < samples.count; w++) {
        const float probability = all ? 1 : choice.probability(w);
        selection[samples.list[w].lobe][i] = probability;
        if (samples.list[w].rejected || (!all && w != chosen)) continue;
        const bool alone =
            samples.count == 1 && !nonSpecularFunctions(hits.batch.lobes[samples.list[w].lobe]);
        const float survival =
            alone ? 1 : std::min(1.0f, choice.carried[w] / (probability * certainThroughput));
        random[i] |= survival < 1;
        if (sampling.choices[1][i] < survival)
          send(hits, boundaries, i, samples, w, probability, probability * survival);
      }
    }
  }

 private:
  void send(const Hits& hits, const Boundaries& boundaries, uint32_t i, const BsdfSamples& samples,
            uint32_t w, float probability, float kept) {
    const BsdfSample& sample = samples.list[w];
    const Points& points = hits.plane.points;
    RayState ray = hits.plane.states[i];
    ray.throughput *= sample.weight / kept;
    ray.travelled = points.hits.distance[i];
    ray.pdf = sample.pdf * probability;
    const bool specular = !(sample.pdf > 0);
    if (!specular) ray.previous = lightSampleContext(points, i, transmitsAt(hits.batch, i));
    const PathClass before = ray.flags.pathClass();
    if (sample.deflected) {
      ray.flags.set(PathFlags::connectableBit,
                    !specular && before == PathClass::specularFirst && !ray.flags.scattered());
      if (hits.batch.lobes[sample.lobe].coat && !ray.flags.scattered())
        ray.flags.set(PathFlags::reflectedBit, true);
      if (before == PathClass::undeflected)
        ray.flags.setClass(specular ? PathClass::specularFirst : PathClass::diffuse);
      else if (before != PathClass::specularFirst)
        ray.flags.setClass(specular ? PathClass::caustic : PathClass::diffuse);
      if (!specular) ray.flags.set(PathFlags::scatteredBit, true);
      ray.flags.set(PathFlags::specularSinceDiffuseBit, ray.flags.scattered() && specular);
      ray.flags.set(PathFlags::deflectedBit, true);
    } else {
      ray.flags.addPassage();
      ray.pdf = hits.plane.states[i].pdf;
    }
    if (w) ray.branch = hash(ray.branch + w, 4);
    ray.flags.setChannel(sample.channel);
    ray.media = mediaTowards(points, i, sample.direction, boundaries, ray.media);
    if (samples.count > 1) ray.flags.addSplit();
    rays.push_back({liftPoint(points, i, sample.direction), sample.direction, ray});
  }
};

// Compares the rays of spawnRays() with those of the scalar functions. They may be in another
// order; path and branch name a ray.
void expectRaysOfScalarFunctions(Hits& hits, const Boundaries& boundaries = {}) {
  const LobeSampling sampling = hits.sampleAll();
  const ScalarRays expected(hits, sampling, boundaries);
  UnsampledLights unsampled(hits.plane.scene, hits.ledger);
  RayQueue next;
  spawnRays({hits.batch, 3, hits.samples, unsampled, hits.ledger, next}, sampling, boundaries);
  ASSERT_EQ(next.size(), expected.rays.size());
  EXPECT_GT(next.size(), count / 20);
  for (const Spawned& ray : expected.rays) {
    size_t at = 0;
    while (at < next.size() && (next.states().path[at] != ray.state.path ||
                                next.states().branch[at] != ray.state.branch))
      at++;
    ASSERT_LT(at, next.size()) << ray.state.path;
    const RayState found = next.states()[at];
    const uint32_t path = found.path;
    expectEqual(load(next.origin(), at), ray.origin, "origin", path);
    expectEqual(load(next.direction(), at), ray.direction, "direction", path);
    expectEqual(found.throughput, ray.state.throughput, "throughput", path);
    expectEqual(found.previous.position, ray.state.previous.position, "previous position", path);
    expectEqual(found.previous.normal, ray.state.previous.normal, "previous normal", path);
    EXPECT_EQ(found.travelled, ray.state.travelled) << path;
    EXPECT_EQ(found.pdf, ray.state.pdf) << path;
    EXPECT_EQ(found.flags.bits, ray.state.flags.bits) << path;
    EXPECT_EQ(found.media, ray.state.media) << path;
  }
  for (uint32_t i = 0; i < count; i++) {
    EXPECT_EQ(hits.samples.random[i] != 0, expected.random[i] != 0) << i;
    for (uint32_t l = 0; l < hits.batch.lobes.size(); l++)
      if (const float* probability = sampling.selectionProbability[l]) {
        EXPECT_EQ(probability[i], expected.selection[l][i]) << i;
      }
  }
  EXPECT_NEAR(hits.ledger.cutByEnergy, expected.cutByEnergy, 1e-9);
}

} // namespace

TEST(ContinuePaths, RaysOfOneSpecularLobe) {
  for (const auto transport : {RT_TRANSPORT_PATH, RT_TRANSPORT_WHITTED})
    for (const auto kind : {RTS_LOBE_REFLECTION, RTS_LOBE_TRANSPARENT, RTS_LOBE_DIELECTRIC})
      for (const float eta : {1 / 1.5f, 1.5f}) {
        SCOPED_TRACE(testing::Message() << transport << ' ' << kind << ' ' << eta);
        Hits hits(transport);
        hits.add(kind, eta);
        expectRaysOfScalarFunctions(hits);
      }
}

TEST(ContinuePaths, RaysOfSeveralLobes) {
  for (const auto transport : {RT_TRANSPORT_PATH, RT_TRANSPORT_WHITTED}) {
    Hits paint(transport);
    paint.add(RTS_LOBE_DIFFUSE);
    paint.add(RTS_LOBE_GLOSSY, 0.3f, 1 / 1.5f);
    paint.add(RTS_LOBE_REFLECTION);
    expectRaysOfScalarFunctions(paint);
    Hits frosted(transport);
    frosted.add(RTS_LOBE_TRANSPARENT);
    frosted.add(RTS_LOBE_ROUGH_DIELECTRIC, 1 / 1.5f, 0.2f);
    frosted.add(RTS_LOBE_DIELECTRIC, 1.3f);
    expectRaysOfScalarFunctions(frosted);
  }
}

TEST(ContinuePaths, RaysAtBoundariesOfMedia) {
  for (const bool disperses : {false, true})
    for (const auto transport : {RT_TRANSPORT_PATH, RT_TRANSPORT_WHITTED}) {
      SCOPED_TRACE(testing::Message() << transport << ' ' << disperses);
      Hits hits(transport);
      hits.add(RTS_LOBE_DIELECTRIC);
      const Glass glass(hits, disperses);
      expectRaysOfScalarFunctions(hits, glass.boundaries);
    }
}

TEST(ContinuePaths, AHiddenBoundaryIsPassedStraight) {
  Hits hits(RT_TRANSPORT_PATH);
  hits.add(RTS_LOBE_DIELECTRIC);
  const Glass glass(hits, false);
  for (uint32_t i = 0; i < count; i++) {
    glass.boundaries.crossing[i].visible = false;
    store(Vec3f(), hits.batch.lobes[0].weight, i);
  }
  UnsampledLights unsampled(hits.plane.scene, hits.ledger);
  RayQueue next;
  spawnRays({hits.batch, 3, hits.samples, unsampled, hits.ledger, next}, hits.sampleAll(),
            glass.boundaries);
  ASSERT_EQ(next.size(), count);
  for (uint32_t i = 0; i < count; i++) {
    const RayState before = hits.plane.states[i], after = next.states()[i];
    expectEqual(load(next.direction(), i), load(hits.plane.points.hits.direction, i), "way", i);
    expectEqual(after.throughput, before.throughput, "throughput", i);
    PathFlags passed = before.flags;
    passed.addPassage();
    EXPECT_EQ(after.flags.bits, passed.bits);
    EXPECT_EQ(after.pdf, before.pdf);
    EXPECT_EQ(after.media, glass.boundaries.crossing[i].behind);
    EXPECT_EQ(hits.samples.random[i], 0);
  }
}

TEST(ContinuePaths, InstructionSetsGiveTheSameBytes) {
  expectSameBytes([](std::vector<float>& out) {
    Hits hits(RT_TRANSPORT_PATH);
    hits.add(RTS_LOBE_DIELECTRIC);
    hits.add(RTS_LOBE_REFLECTION);
    hits.add(RTS_LOBE_DIFFUSE);
    const Glass glass(hits, true);
    UnsampledLights unsampled(hits.plane.scene, hits.ledger);
    RayQueue next;
    spawnRays({hits.batch, 3, hits.samples, unsampled, hits.ledger, next}, hits.sampleAll(),
              glass.boundaries);
    PathStates states = next.states();
    const auto append = [&](auto* array) {
      for (size_t i = 0; i < next.size() * sizeof *array; i++)
        out.push_back(reinterpret_cast<const unsigned char*>(array)[i]);
    };
    states.forEachArray(append);
    for (int k = 0; k < 3; k++) {
      append(next.origin()[k]);
      append(next.direction()[k]);
    }
  });
}

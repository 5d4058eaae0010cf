// openrt_continue_paths.cpp: Tests the vector code that continues camera paths: its rays are those
// of the scalar functions (BsdfSamples, BsdfChoice), on every instruction set; and reflection and
// refraction agree with Fresnel's and Snell's equations near the critical angle and at grazing
// angles.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "render/lights/emitted.h"
#include "render/path/spawn_rays.h"
#include "render/surface/bsdf_choice.h"
#include "render/surface/sample_arrays.h"
#include "scene/transports.h"
#include "unit/plane_hits.h"
#include "unit/same_bytes.h"

using namespace openrt;
using openrt::test::expectSameBytes;
using openrt::test::PlaneHits;

namespace {

constexpr uint32_t count = 333; // no multiple of any vector width

struct Random {
  std::mt19937 engine{17};
  float operator()(float low, float high) {
    return low + (high - low) * float(engine() >> 8) * 0x1p-24f;
  }
  Vec3f inCube() { return {(*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)}; }
};

// Hits with random directions, shading normals and paths.
struct Hits {
  PlaneHits plane{count};
  Random random;
  RtsBatch batch{plane.batch()};
  PathSamples samples;
  Ledger ledger;

  explicit Hits(uint32_t transport) {
    plane.scene.frame.transport = uint8_t(transport);
    plane.scene.frame.energyCut = 0.05f;
    samples.allocate(plane.arena, count);
    samples.random = plane.arena.takeZero<uint8_t>(count);
    const PathStates& states = plane.states;
    for (uint32_t i = 0; i < count; i++) {
      samples.set(i, i, 1, 0);
      const Vec3f d = normalize(Vec3f{random(-1, 1), random(-1, 1), random(-1, -0.01f)});
      store(d, arrayOf(plane.points.hits.direction), i);
      store(normalize(Vec3f{0, 0, 2} + random.inCube()), arrayOf(plane.points.hits.normal), i);
      store({random(0, 1), random(0, 1), random(0, 0.1f)}, states.throughput, i);
      store(random.inCube(), states.previousPosition, i);
      store(random.inCube(), states.previousNormal, i);
      states.unguidedWeight[i] = random(0, 1);
      states.branch[i] = i % 3 ? 0 : hash(i);
      PathFlags flags;
      flags.setClass(PathClass(i % 4));
      flags.set(PathFlags::scatteredBit, i % 4 == 1 || i % 4 == 2);
      flags.setChannel(i % 5 == 0 ? uint8_t(i % 4) : uint8_t(0));
      for (uint32_t s = 0; s < i % 7; s++) flags.addSplit();
      states.flags[i] = flags.bits;
    }
  }
  void add(RtsLobeKind kind, float p0 = 0, float p1 = 0) {
    plane.add(batch, kind, 0);
    const RtsLobe& lobe = batch.lobes[batch.lobes.size() - 1];
    for (uint32_t i = 0; i < count; i++) {
      // Every tenth hit lacks the lobe. Weights that are no numbers count as 0.
      if (i % 10) store({random(0, 1), random(0, 1), i % 8 ? random(0, 1) : NAN}, lobe.weight, i);
      lobe.parameter[0][i] = p0 * random(0.8f, 1.2f);
      lobe.parameter[1][i] = i % 4 ? p1 : 0;
    }
  }
  LobeSampling sampleAll() {
    if (!tracesPaths(plane.scene.frame.transport)) return {};
    LobeSampling sampling =
        drawChoices(batch, randomNumbersAt(samples, plane.states, batch.order, count,
                                           pairAtLevel(1, 3), plane.arena));
    sampleLobes(batch, sampling);
    allocateSelection(batch, sampling);
    return sampling;
  }
  // The arrays of the plane's hits are only const for shaders.
  static float* const* arrayOf(const float* const* arrays) {
    return const_cast<float* const*>(arrays);
  }
};

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
            alone ? 1 : survivalProbability(choice.carried[w] / (probability * certainThroughput));
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

void expectEqual(const Vec3f& a, const Vec3f& b, const char* what, uint32_t path) {
  EXPECT_TRUE(a == b) << what << " of path " << path << ": " << a.x << ' ' << a.y << ' ' << a.z
                      << " and " << b.x << ' ' << b.y << ' ' << b.z;
}

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

// Indices of refraction by colour on the other side of each hit, and the media there.
struct Glass {
  float (*eta)[3];
  Boundaries boundaries;
  explicit Glass(Hits& hits, bool disperses) {
    eta = hits.plane.arena.take<float[3]>(count);
    boundaries.eta = eta;
    boundaries.crossing = hits.plane.arena.take<Crossing>(count);
    boundaries.disperses = hits.plane.arena.takeZero<uint32_t>(padded(count));
    const RtsLobe& lobe = hits.batch.lobes[0];
    for (uint32_t i = 0; i < count; i++) {
      boundaries.crossing[i] = {{uint16_t(i), 7, 0, 0}, 0, 7, true, false};
      const uint8_t channel = hits.plane.states.flagsOf(i).channel();
      const bool differ = disperses && i % 2;
      for (int k = 0; k < 3; k++) eta[i][k] = 1 / (1.5f + (differ ? 0.02f * float(k) : 0));
      boundaries.disperses[i] = channel == 0 && differ;
      lobe.parameter[0][i] = eta[i][channel ? channel - 1 : 0];
    }
  }
};

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
  sampleBoundary(plane.points.hits, lobe, lobe.parameter[0], out);
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
TEST(ContinuePaths, DispersionReflectsAllColoursInOneRay) {
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
TEST(ContinuePaths, DispersionKeepsTheFluxOfLightPaths) {
  Hits hits(RT_TRANSPORT_PATH);
  hits.plane.add(hits.batch, RTS_LOBE_DIELECTRIC, 1);
  const Glass glass(hits, true);
  for (uint32_t i = 0; i < count; i++) {
    if (!glass.boundaries.disperses[i]) continue;
    BsdfSamples samples(hits.plane.points.hits, i, glass.boundaries.etaAt(i), 0, true);
    samples.add(0, hits.batch.lobes[0], nullptr);
    ASSERT_GT(samples.count, 0u);
    EXPECT_LE(samples.count, 4u);
    EXPECT_EQ(samples.list[0].channel, 0);
    Vec3f sum;
    for (uint32_t w = 0; w < samples.count; w++) sum = sum + samples.list[w].weight;
    if (samples.count < 4) continue; // total reflection, or a refraction above the facet
    for (int k = 0; k < 3; k++) EXPECT_NEAR(sum[k], 1, 1e-6) << i;
  }
}

TEST(ContinuePaths, BoundariesFollowFresnelAndSnell) {
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

TEST(ContinuePaths, BoundariesAtTheCriticalAngle) {
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

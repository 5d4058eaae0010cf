// openrt_path_stages.cpp: Tests stages of path tracing and light tracing alone, on arrays made by
// hand: random numbers, camera rays, the lists of a wave, fog, BSDF samples and the rays that
// continue paths.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "render/lights/environment.h"
#include "render/path/camera_rays.h"
#include "render/path/spawn_rays.h"
#include "render/surface/continue_paths.h"
#include "render/wave/wave.h"
#include "unit/plane_hits.h"

using namespace openrt;
using openrt::test::PlaneHits;

namespace {

constexpr uint32_t pixels[] = {7, 12};

FilmSamples film(bool centred = false) {
  return {.pixels = pixels,
          .width = 5,
          .first = 6,
          .perPixel = 4,
          .replicates = {.seed = 3, .shift = 3},
          .centred = centred};
}

PathSamples samplesOf(const FilmSamples& film, Arena& arena) {
  PathSamples samples;
  samples.allocate(arena, film.count());
  samples.random = arena.takeZero<uint8_t>(film.count());
  startSamples(film, samples);
  return samples;
}

// A camera whose rays start at the film and look along -z, with directions of length 2.
void generateParallel(const RtsHost*, RtsBatch*, const void*, uint32_t n, const float* const xy[2],
                      const float*, RtsRays* out) {
  for (uint32_t i = 0; i < padded(n); i++) {
    out->origin[0][i] = xy[0][i];
    out->origin[1][i] = xy[1][i];
    out->direction[2][i] = -2;
  }
}

struct Paths { // what spawnRays() needs besides a batch
  explicit Paths(PlaneHits& plane)
      : samples(samplesOf(film(), plane.arena)), unsampled(plane.scene, ledger) {}
  CameraPaths at(const RtsBatch& batch, uint32_t level = 0) {
    return {batch, level, samples, unsampled, ledger, next};
  }
  PathSamples samples;
  Ledger ledger;
  UnsampledLights unsampled;
  RayQueue next;
};

} // namespace

TEST(PathStages, RandomNumbersAreThoseOfTheSamplerOfEachPath) {
  PlaneHits plane(8);
  const FilmSamples of = film();
  const PathSamples samples = samplesOf(of, plane.arena);
  plane.states.branch[5] = 77;
  const uint32_t order[] = {5, 2, 7}, level = 3;
  const RandomNumbers random =
      randomNumbersAt(samples, plane.states, order, 3, pairAtLevel(1, level), plane.arena);
  float* square[2];
  random.draw(Decision::choice, plane.arena, square);
  for (uint32_t i = 0; i < 3; i++) {
    const uint32_t path = order[i], sample = of.first + path % of.perPixel;
    const uint32_t pair = 1 + 4 * level + 1 + plane.states.branch[path];
    float x, y;
    PairSampler(pixels[path / of.perPixel], pair,
                of.replicates.seedOf(sample))(of.replicates.indexOf(sample), x, y);
    EXPECT_EQ(square[0][i], x) << i;
    EXPECT_EQ(square[1][i], y) << i;
  }
}

TEST(PathStages, FilmSamplesLieInTheirPixels) {
  Arena arena;
  const FilmSamples of = film();
  float *xy[2], *middle[2];
  sampleFilm(of, samplesOf(of, arena), arena, xy);
  sampleFilm(film(true), samplesOf(of, arena), arena, middle);
  for (uint32_t path = 0; path < of.count(); path++) {
    const uint32_t pixel = pixels[path / of.perPixel];
    EXPECT_EQ(uint32_t(xy[0][path]), pixel % of.width);
    EXPECT_EQ(uint32_t(xy[1][path]), pixel / of.width);
    EXPECT_EQ(middle[0][path], float(pixel % of.width) + 0.5f);
    EXPECT_EQ(middle[1][path], float(pixel / of.width) + 0.5f);
  }
  for (uint32_t i = of.count(); i < padded(of.count()); i++)
    EXPECT_EQ(xy[0][i], xy[0][of.count() - 1]);
}

TEST(PathStages, CameraRaysAreMappedToRenderSpace) {
  PlaneHits plane(4);
  RtsClass camera{};
  camera.generate = generateParallel;
  plane.scene.camera.shader.shaderClass = &camera;
  plane.scene.camera.fromLocal = {{{0, 3, 0, 10}, {3, 0, 0, 20}, {0, 0, 3, 30}}}; // turned, scaled
  std::vector<float> x(16, 1), y(16, 2);
  const float* xy[2] = {x.data(), y.data()};
  Rays rays;
  rays.allocate(plane.arena, 4);
  makeCameraRays(plane.context(), xy, rays);
  for (uint32_t i = 0; i < 4; i++) {
    EXPECT_EQ(rays.org[0][i], 16);
    EXPECT_EQ(rays.org[1][i], 23);
    EXPECT_EQ(rays.org[2][i], 30);
    EXPECT_EQ(rays.dir[0][i], 0);
    EXPECT_EQ(rays.dir[2][i], -1);
    EXPECT_EQ(rays.tnear[i], 0);
    EXPECT_TRUE(std::isinf(rays.tfar[i]));
  }
}

TEST(PathStages, AWaveIsLoadedFromTheMiddleOfAQueue) {
  Arena arena;
  RayQueue queue;
  for (uint32_t i = 0; i < 10; i++) {
    queue.push({float(i), 0, 0}, {0, 1, 0}, RayState{.path = 100 + i});
  }
  Wave wave;
  wave.rays.allocate(arena, 4);
  loadWave(queue, 3, 4, wave);
  ASSERT_EQ(wave.rays.count, 4u);
  wave.hits.allocate(arena, 4);
  for (uint32_t i = 0; i < 4; i++) {
    EXPECT_EQ(wave.rays.org[0][i], float(3 + i));
    EXPECT_EQ(wave.states.path[i], 103 + i);
    wave.hits.record[i] = i % 2 ? noHit : 0;
  }
  splitByHit(arena, wave);
  EXPECT_EQ(std::vector<uint32_t>(wave.met.begin(), wave.met.end()), (std::vector<uint32_t>{0, 2}));
  EXPECT_EQ(std::vector<uint32_t>(wave.missed.begin(), wave.missed.end()),
            (std::vector<uint32_t>{1, 3}));
}

TEST(PathStages, FogLeavesOutWhatTheSurfaceShowsOfBeyond) {
  float airlight = 0.5f, transmittance = 0.25f;
  Fog fog;
  EXPECT_EQ(fog.attenuate(0, 1, 3, 0), 3);
  fog.airlight[1] = &airlight;
  fog.transmittance = &transmittance;
  EXPECT_EQ(fog.attenuate(0, 1, 4, 0), 1 + 0.375f);
  EXPECT_EQ(fog.attenuate(0, 1, 4, 1), 1);
}

TEST(PathStages, ASampleIsSelectedInProportionToWhatItCarries) {
  PlaneHits plane(1);
  RtsBatch batch = plane.batch();
  plane.add(batch, RTS_LOBE_REFLECTION, 0.25f);
  plane.add(batch, RTS_LOBE_TRANSPARENT, 0.75f);
  store({0.5f, 0.25f, 0}, plane.states.throughput, 0);
  const BsdfSampleArrays samples(batch, {}, {}, TransportMode::radiance);
  for (const float u : {0.24f, 0.26f, 0.99f}) {
    auto* choice = plane.arena.takeZero<float>(padded(1));
    choice[0] = u;
    Selection selection{.points = &plane.points,
                        .choice = choice,
                        .survival = nullptr,
                        .throughput = plane.states.throughput,
                        .onlySpecular = nullptr};
    selection.allocate(plane.arena);
    selectSamples(selection, samples);
    EXPECT_EQ(selection.survivalProbability[0], 1);
    EXPECT_EQ(selection.number[0], u < 0.25f ? 0u : 1u);
    EXPECT_EQ(selection.probability[0], u < 0.25f ? 0.25f : 0.75f);
  }
}

TEST(PathStages, LobesAreSampledAboveTheSurface) {
  PlaneHits plane(8);
  RtsBatch batch = plane.batch();
  plane.add(batch, RTS_LOBE_REFLECTION, 0.5f);
  plane.add(batch, RTS_LOBE_DIFFUSE, 0.5f);
  const PathSamples samples = samplesOf(film(), plane.arena);
  LobeSampling sampling = drawChoices(batch, randomNumbersAt(samples, plane.states, batch.order, 8,
                                                             pairAtLevel(1, 0), plane.arena));
  sampleLobes(batch, sampling);
  allocateSelection(batch, sampling);
  EXPECT_EQ(sampling.samples[0], nullptr);
  EXPECT_EQ(sampling.selectionProbability[0], nullptr);
  ASSERT_NE(sampling.samples[1], nullptr);
  ASSERT_NE(sampling.selectionProbability[1], nullptr);
  for (uint32_t i = 0; i < 8; i++) {
    EXPECT_GT(sampling.samples[1]->direction[2][i], 0);
    EXPECT_GT(sampling.samples[1]->pdf[i], 0);
  }
}

TEST(PathStages, MirrorsReflectThePathsInTheOrderOfTheHits) {
  PlaneHits plane(8);
  plane.scene.frame.transport = RT_TRANSPORT_WHITTED;
  RtsBatch batch = plane.batch();
  plane.add(batch, RTS_LOBE_REFLECTION, 0.5f);
  Paths paths(plane);
  spawnRays(paths.at(batch), {}, {});
  ASSERT_EQ(paths.next.size(), 8u);
  for (uint32_t i = 0; i < 8; i++) {
    const RayState state = paths.next.states()[i];
    EXPECT_EQ(state.path, i);
    EXPECT_EQ(state.throughput[0], 0.5f);
    EXPECT_EQ(state.travelled, 2);
    EXPECT_EQ(state.pdf, 0);
    EXPECT_TRUE(state.flags.deflected());
    EXPECT_EQ(state.flags.pathClass(), PathClass::specularFirst);
    EXPECT_FLOAT_EQ(paths.next.direction()[0][i], std::sqrt(0.5f));
    EXPECT_FLOAT_EQ(paths.next.direction()[2][i], std::sqrt(0.5f));
    EXPECT_GT(paths.next.origin()[2][i], 0); // lifted to the side of the direction
  }
}

TEST(PathStages, TheEnergyCutEndsBranchesAndIsCounted) {
  PlaneHits plane(8);
  plane.scene.frame.transport = RT_TRANSPORT_WHITTED;
  plane.scene.frame.energyCut = 0.6f;
  RtsBatch batch = plane.batch();
  plane.add(batch, RTS_LOBE_REFLECTION, 0.5f);
  Paths paths(plane);
  spawnRays(paths.at(batch), {}, {});
  EXPECT_EQ(paths.next.size(), 0u);
  EXPECT_EQ(paths.ledger.cutByEnergy, 8 * 3 * 0.5);
}

TEST(PathStages, OneLobeAndManyLobesContinuePathsAlike) {
  // A second lobe without weight turns off the vector code; the rays must be the same.
  RayQueue queues[2];
  for (int many = 0; many < 2; many++) {
    PlaneHits plane(8);
    plane.scene.frame.transport = RT_TRANSPORT_PATH;
    RtsBatch batch = plane.batch();
    plane.add(batch, RTS_LOBE_DIFFUSE, 0.5f * certainThroughput);
    if (many) plane.add(batch, RTS_LOBE_REFLECTION, 0);
    Paths paths(plane);
    LobeSampling sampling =
        drawChoices(batch, randomNumbersAt(paths.samples, plane.states, batch.order, 8,
                                           pairAtLevel(1, 4), plane.arena));
    sampleLobes(batch, sampling);
    spawnRays(paths.at(batch, 4), sampling, {});
    for (uint32_t i = 0; i < 8; i++) EXPECT_EQ(paths.samples.random[i], RandomPath::all);
    std::swap(queues[many], paths.next);
  }
  ASSERT_EQ(queues[0].size(), queues[1].size());
  ASSERT_GT(queues[0].size(), 0u);
  ASSERT_LT(queues[0].size(), 8u); // Russian roulette has ended some
  for (uint32_t i = 0; i < queues[0].size(); i++) {
    EXPECT_EQ(queues[0].states().path[i], queues[1].states().path[i]);
    EXPECT_EQ(queues[0].states().flags[i], queues[1].states().flags[i]);
    for (int k = 0; k < 3; k++) {
      EXPECT_EQ(queues[0].origin()[k][i], queues[1].origin()[k][i]);
      EXPECT_EQ(queues[0].direction()[k][i], queues[1].direction()[k][i]);
      EXPECT_EQ(queues[0].states().throughput[k][i], queues[1].states().throughput[k][i]);
    }
  }
}

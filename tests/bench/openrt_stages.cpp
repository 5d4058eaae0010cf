// openrt_stages.cpp: nanoseconds a hit of stages of the ray core that need no scene
// (docs/architecture.md, "One hit, stage by stage"). Items are hits.
#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <vector>

#include "render/lights/light_rays.h"
#include "render/lights/light_samples.h"
#include "render/lights/light_tree.h"
#include "render/path/accumulate.h"
#include "render/path/camera_rays.h"
#include "render/path/spawn_rays.h"
#include "render/surface/lambert.h"
#include "render/surface/sample_lobes.h"
#include "render/surface/sanitize_output.h"
#include "render/wave/faults.h"
#include "render/wave/point_block.h"
#include "render/wave/random_numbers.h"
#include "unit/plane_hits.h"

using namespace openrt;

namespace {

constexpr uint32_t count = 4096;

std::vector<float> numbers(float low, float high, uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<float> out(count);
  for (float& x : out) x = low + (high - low) * float(random() >> 8) * 0x1p-24f;
  return out;
}

// Points on a floor below a ceiling with lamps of two triangles each.
struct Room {
  std::vector<float> x = numbers(-3, 3, 1), y = std::vector<float>(count, 0), z = numbers(-3, 3, 2);
  std::vector<float> nx = y, ny = std::vector<float>(count, 1), nz = y;
  std::vector<float> error = std::vector<float>(count, 1e-6f);
  std::vector<uint32_t> twoSided = std::vector<uint32_t>(count, 0);
  std::vector<float> pick = numbers(0, 1, 3), u = numbers(0, 1, 4), v = numbers(0, 1, 5);
  std::vector<float> wanted = std::vector<float>(count, 1);
  std::vector<float> corner[3][3];
  std::vector<uint32_t> sides, shape = std::vector<uint32_t>(count);
  std::vector<float> share = y, probability = y, out[6] = {y, y, y, y, y, y};
  LightTree tree;
  Arena arena;
  SampledLights samples;

  Room() {
    std::vector<LightBounds> bounds;
    const float at[2][3][2] = {{{-1, -1}, {1, -1}, {1, 1}}, {{-1, -1}, {1, 1}, {-1, 1}}};
    for (const auto& triangle : at) {
      for (int c = 0; c < 3; c++) {
        corner[c][0].push_back(triangle[c][0]);
        corner[c][1].push_back(3);
        corner[c][2].push_back(triangle[c][1]);
      }
      sides.push_back(3 | ShapeArrays::oneRadiance);
      LightBounds b{{-1, 3, -1}, {1, 3, 1}, {0, -1, 0}, 1};
      b.intensity = 2;
      bounds.push_back(b);
    }
    tree.build(bounds);
    samples.allocate(arena, count);
  }
  ShapeArrays shapes() const {
    ShapeArrays arrays;
    for (int c = 0; c < 3; c++)
      for (int k = 0; k < 3; k++) arrays.corner[c][k] = corner[c][k].data();
    arrays.sides = sides.data();
    for (int k = 0; k < 3; k++) arrays.radiance[k] = ny.data();
    return arrays;
  }
  // Starts the shadow rays of light samples at all points.
  LightSamples shadowRays() {
    sampleFromRoot(tree.root(), shapes(), points(), 0, samples);
    LightSamples rays;
    rays.allocate(arena, count);
    startShadowRays(points(), samples, rays);
    return rays;
  }
  LightPoints points() const {
    return {count,
            {x.data(), y.data(), z.data()},
            {nx.data(), ny.data(), nz.data()},
            error.data(),
            twoSided.data(),
            pick.data(),
            u.data(),
            v.data(),
            wanted.data()};
  }
  ChosenLights chosen() { return {share.data(), shape.data(), probability.data()}; }
};

void setItems(benchmark::State& state) {
  state.SetItemsProcessed(int64_t(state.iterations()) * count);
}

void lightChoice(benchmark::State& state) {
  Room room;
  for (auto _ : state) chooseFromRoot(room.tree.root(), room.points(), 0, room.chosen());
  setItems(state);
}
BENCHMARK(lightChoice)->Name("stage/light choice among two");

void lightSamples(benchmark::State& state) {
  Room room;
  chooseFromRoot(room.tree.root(), room.points(), 0, room.chosen());
  for (auto _ : state) sampleShapes(room.shapes(), room.points(), room.chosen(), room.samples);
  setItems(state);
}
BENCHMARK(lightSamples)->Name("stage/light samples on triangles");

void lightsOfOneNode(benchmark::State& state) {
  Room room;
  for (auto _ : state)
    sampleFromRoot(room.tree.root(), room.shapes(), room.points(), 0, room.samples);
  setItems(state);
}
BENCHMARK(lightsOfOneNode)->Name("stage/light choice and samples, one node");

void shadowRays(benchmark::State& state) {
  Room room;
  LightSamples rays = room.shadowRays();
  for (auto _ : state) startShadowRays(room.points(), room.samples, rays);
  setItems(state);
}
BENCHMARK(shadowRays)->Name("stage/shadow rays of light samples");

void lightWeights(benchmark::State& state) {
  test::PlaneHits plane(count);
  RtsBatch batch = plane.batch();
  plane.add(batch, RTS_LOBE_DIFFUSE, 0.5f);
  Room room;
  LightSamples rays = room.shadowRays();
  LobeValues values(room.arena, count);
  for (auto _ : state) {
    values.evaluate(batch.lobes[0], plane.points.hits, rays.rays.count, rays.hit, rays.rays.dir);
    weightByLobe(batch.lobes[0], room.wanted.data(), values, false, rays);
    benchmark::DoNotOptimize(rays);
  }
  setItems(state);
}
BENCHMARK(lightWeights)->Name("stage/weights of light samples, one Lambert lobe");

void lightOfLamps(benchmark::State& state) {
  Room room;
  LightSamples rays = room.shadowRays();
  const std::vector<uint8_t> blocked(padded(count));
  std::vector<uint32_t> others(padded(count));
  for (int k = 0; k < 3; k++) std::fill_n(rays.response[k], count, 1.0f);
  float* const radiance[3] = {room.out[0].data(), room.out[1].data(), room.out[2].data()};
  for (auto _ : state)
    addOneRadiance(room.shapes(), rays, rays.response, blocked.data(), radiance, others.data());
  setItems(state);
}
BENCHMARK(lightOfLamps)->Name("stage/light of lamps of one radiance");

void emissionPdfs(benchmark::State& state) {
  Room room;
  const LightSamples rays = room.shadowRays();
  FoundShapes found;
  found.allocate(room.arena, count);
  found.count = count;
  for (uint32_t i = 0; i < count; i++) {
    const uint32_t r = i % rays.rays.count;
    store(load(rays.rays.org, r), found.position, i);
    store(Vec3f{0, 1, 0}, found.normal, i);
    store(load(rays.rays.dir, r), found.direction, i);
    found.shape[i] = rays.shape[r];
  }
  for (auto _ : state)
    pdfFromRoot(room.tree.root(), room.shapes(), found, 0, room.probability.data());
  setItems(state);
}
BENCHMARK(emissionPdfs)->Name("stage/light pdfs of found emission");

void lambert(benchmark::State& state) {
  Room room;
  RtsLobe lobe{};
  lobe.normal[0] = room.nx.data();
  lobe.normal[1] = room.ny.data();
  lobe.normal[2] = room.nz.data();
  std::vector<uint32_t> hit(count);
  for (uint32_t i = 0; i < count; i++) hit[i] = i;
  float* const direction[3] = {room.out[0].data(), room.out[1].data(), room.out[2].data()};
  float* const quotient[3] = {room.out[3].data(), room.out[4].data(), room.out[5].data()};
  const float* const square[2] = {room.u.data(), room.v.data()};
  for (auto _ : state)
    sampleLambert(&lobe, nullptr, count, hit.data(), square, direction, quotient,
                  room.probability.data());
  setItems(state);
}
BENCHMARK(lambert)->Name("stage/BSDF samples of Lambert lobes");

void shadingPoints(benchmark::State& state) {
  PointBlock block{};
  std::mt19937 random(9);
  const auto number = [&] { return float(random() >> 8) * 0x1p-24f; };
  for (uint32_t i = 0; i < lanes; i++) {
    for (int k = 0; k < 3; k++) {
      block.direction[k][i] = number() - 1;
      block.ng[k][i] = number();
      for (auto& corner : block.corner) corner[k][i] = number();
    }
    block.u[i] = block.v[i] = 0.3f;
    block.scale[i] = 1;
  }
  std::vector<float> floats(20 * count);
  std::vector<uint32_t> flags(count);
  PointArrays out{};
  float* at = floats.data();
  const auto next = [&] {
    at += count;
    return at - count;
  };
  for (auto* group : {out.position, out.direction, out.geometric, out.normal})
    for (int k = 0; k < 3; k++) group[k] = next();
  for (auto& a : out.uv) a = next();
  for (auto& a : out.color) a = next();
  out.error = next();
  out.flags = flags.data();
  for (auto _ : state)
    for (uint32_t i = 0; i < count; i += lanes) {
      PointBlock copy = block;
      interpolateTriangles(copy);
      finishPoints(copy, out, i);
    }
  setItems(state);
}
BENCHMARK(shadingPoints)->Name("stage/shading points of triangles");

void randomNumbers(benchmark::State& state) {
  Room room;
  std::vector<uint32_t> key(count, 7), pair(count, 3), index(count);
  for (uint32_t i = 0; i < count; i++) index[i] = i;
  for (auto _ : state)
    samplePairs(count, key.data(), pair.data(), 1, index.data(), room.u.data(), room.v.data());
  setItems(state);
}
BENCHMARK(randomNumbers)->Name("stage/a pair of random numbers");

// The samples of the paths of `plane`, and the random numbers at its hits.
struct PlanePaths {
  test::PlaneHits plane{count};
  PathSamples samples;
  Ledger ledger;
  UnsampledLights unsampled{plane.scene, ledger};
  RayQueue next;

  PlanePaths() {
    samples.allocate(plane.arena, count);
    samples.random = plane.arena.takeZero<uint8_t>(count);
    for (uint32_t i = 0; i < count; i++) samples.set(i, i / 16, 1, i % 16);
  }
  RandomNumbers random() {
    return randomNumbersAt(samples, plane.states, plane.points.order, count, pairAtLevel(1, 1),
                           plane.arena);
  }
};

void randomNumbersOfHits(benchmark::State& state) {
  PlanePaths paths;
  for (auto _ : state) {
    ArenaScope scope(paths.plane.arena);
    benchmark::DoNotOptimize(paths.random());
  }
  setItems(state);
}
BENCHMARK(randomNumbersOfHits)->Name("stage/sequences of the paths of hits");

void lobes(benchmark::State& state) {
  PlanePaths paths;
  RtsBatch batch = paths.plane.batch();
  paths.plane.add(batch, RTS_LOBE_DIFFUSE, 0.5f);
  const RandomNumbers random = paths.random();
  for (auto _ : state) {
    ArenaScope scope(paths.plane.arena);
    LobeSampling sampling = drawChoices(batch, random);
    sampleLobes(batch, sampling);
  }
  setItems(state);
}
BENCHMARK(lobes)->Name("stage/BSDF samples with their random numbers");

// A lobe of a surface and its weight.
struct Lobe {
  RtsLobeKind kind;
  float weight;
};

// splits: how often the paths have split before.
void nextRays(benchmark::State& state, std::initializer_list<Lobe> lobes, uint32_t splits = 0) {
  PlanePaths paths;
  paths.plane.scene.frame.transport = RT_TRANSPORT_PATH;
  RtsBatch batch = paths.plane.batch();
  for (const Lobe& lobe : lobes) {
    paths.plane.add(batch, lobe.kind, lobe.weight);
    if (lobe.kind == RTS_LOBE_DIELECTRIC)
      std::fill_n(batch.lobes[batch.lobes.size() - 1].parameter[0], count, 1 / 1.5f);
  }
  PathFlags flags;
  for (uint32_t s = 0; s < splits; s++) flags.addSplit();
  std::fill_n(paths.plane.states.flags, count, flags.bits);
  LobeSampling sampling = drawChoices(batch, paths.random());
  sampleLobes(batch, sampling);
  const CameraPaths at{batch, 1, paths.samples, paths.unsampled, paths.ledger, paths.next};
  for (auto _ : state) {
    paths.next.clear();
    spawnRays(at, sampling, {});
  }
  setItems(state);
}
constexpr Lobe matte{RTS_LOBE_DIFFUSE, 0.5f}, mirror{RTS_LOBE_REFLECTION, 0.25f},
    glass{RTS_LOBE_DIELECTRIC, 1}, pane{RTS_LOBE_TRANSPARENT, 0.5f};
BENCHMARK_CAPTURE(nextRays, matte, {matte})->Name("stage/spawned rays, Lambert");
BENCHMARK_CAPTURE(nextRays, both, {matte, mirror})->Name("stage/spawned rays, Lambert and mirror");
BENCHMARK_CAPTURE(nextRays, mirror, {mirror})->Name("stage/spawned rays, mirror");
BENCHMARK_CAPTURE(nextRays, pane, {pane})->Name("stage/spawned rays, transparent");
BENCHMARK_CAPTURE(nextRays, glass, {glass})->Name("stage/spawned rays, glass");
BENCHMARK_CAPTURE(nextRays, selected, {glass}, 4)->Name("stage/spawned rays, glass, one selected");

// The time of the camera's shader is not in it: this one does nothing.
void cameraRays(benchmark::State& state) {
  PlanePaths paths;
  std::vector<uint32_t> pixels(count / 16);
  for (uint32_t i = 0; i < count / 16; i++) pixels[i] = i;
  const FilmSamples film{pixels, 64, 0, 16, {}, false};
  RtsClass camera{};
  camera.generate = [](const RtsHost*, RtsBatch*, const void*, uint32_t, const float* const*,
                       const float*, RtsRays*) {};
  paths.plane.scene.camera.shader.shaderClass = &camera;
  paths.plane.scene.camera.fromLocal = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  Rays rays;
  rays.allocate(paths.plane.arena, count);
  for (auto _ : state) {
    ArenaScope scope(paths.plane.arena);
    startSamples(film, paths.samples);
    float* xy[2];
    sampleFilm(film, paths.samples, paths.plane.arena, xy);
    makeCameraRays(paths.plane.context(), xy, rays);
  }
  setItems(state);
}
BENCHMARK(cameraRays)->Name("stage/camera rays");

// lobes: 1: one Lambert lobe; 2: also a mirror, which shows what lies beyond the surface.
void surfaceLight(benchmark::State& state) {
  PlanePaths paths;
  PixelSamples found;
  found.allocate(paths.plane.arena, count);
  RtsBatch batch = paths.plane.batch();
  paths.plane.add(batch, RTS_LOBE_DIFFUSE, 0.5f);
  if (state.range(0) > 1) paths.plane.add(batch, RTS_LOBE_REFLECTION, 0.25f);
  RtsSurface surface{};
  for (auto& a : surface.emission) a = paths.plane.arena.takeZero<float>(count);
  const SentLight sent{{surface.emission[0], surface.emission[1], surface.emission[2]}};
  for (auto _ : state) addSurface(batch, surface, sent, {}, {}, found);
  setItems(state);
}
BENCHMARK(surfaceLight)->Name("stage/light added to the paths, lobes")->Arg(1)->Arg(2);

void shaderOutput(benchmark::State& state) {
  PlanePaths paths;
  RtsBatch batch = paths.plane.batch();
  paths.plane.add(batch, RTS_LOBE_DIFFUSE, 0.5f);
  RtsSurface surface{};
  for (auto& a : surface.emission) a = paths.plane.arena.takeZero<float>(count);
  const RtsClass shaderClass{};
  for (auto _ : state) sanitizeOutput(shaderClass, batch, surface);
  setItems(state);
}
BENCHMARK(shaderOutput)->Name("stage/test for NaN in a shader's output");

} // namespace

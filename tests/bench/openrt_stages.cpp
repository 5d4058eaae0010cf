// openrt_stages.cpp: nanoseconds a hit of stages of the ray core that need no scene
// (docs/architecture.md, "One hit, stage by stage"). Items are hits.
#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <vector>

#include "render/lights/light_samples.h"
#include "render/lights/light_tree.h"
#include "render/path/random_numbers.h"
#include "render/path/spawn_rays.h"
#include "render/surface/lambert.h"
#include "render/surface/point_block.h"
#include "render/surface/sample_lobes.h"
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
  std::vector<uint8_t> wanted = std::vector<uint8_t>(count, 1);
  std::vector<float> corner[3][3];
  std::vector<uint32_t> sides, shape = std::vector<uint32_t>(count);
  std::vector<float> share = y, probability = y, out[6] = {y, y, y, y, y, y};
  std::vector<uint32_t> exact = twoSided;
  LightTree tree;

  Room() {
    std::vector<LightBounds> bounds;
    const float at[2][3][2] = {{{-1, -1}, {1, -1}, {1, 1}}, {{-1, -1}, {1, 1}, {-1, 1}}};
    for (const auto& triangle : at) {
      for (int c = 0; c < 3; c++) {
        corner[c][0].push_back(triangle[c][0]);
        corner[c][1].push_back(3);
        corner[c][2].push_back(triangle[c][1]);
      }
      sides.push_back(3);
      LightBounds b{{-1, 3, -1}, {1, 3, 1}, {0, -1, 0}, 1};
      b.intensity = 2;
      bounds.push_back(b);
    }
    tree.build(bounds);
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
  ShapeArrays shapes;
  for (int c = 0; c < 3; c++)
    for (int k = 0; k < 3; k++) shapes.corner[c][k] = room.corner[c][k].data();
  shapes.sides = room.sides.data();
  const SampledLights out{{room.out[0].data(), room.out[1].data(), room.out[2].data()},
                          room.out[3].data(),
                          room.out[4].data(),
                          room.out[5].data(),
                          room.exact.data()};
  for (auto _ : state) sampleShapes(shapes, room.points(), room.chosen(), out);
  setItems(state);
}
BENCHMARK(lightSamples)->Name("stage/light samples on triangles");

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
      std::fill_n(batch.lobes[batch.lobeCount - 1].parameter[0], count, 1 / 1.5f);
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

} // namespace

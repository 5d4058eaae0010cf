// openrt_hit_lanes.cpp: Tests the vector code of the small stages around a hit: random numbers,
// camera rays, the test for NaN, and the light that hits add to their paths. The results are those
// of the scalar formulas, bit by bit, on all instruction sets.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "render/lanes/all_finite.h"
#include "render/path/accumulate.h"
#include "render/path/camera_rays.h"
#include "render/surface/lobes.h"
#include "render/surface/sample_lobes.h"
#include "unit/plane_hits.h"
#include "unit/same_bytes.h"

using namespace openrt;
using openrt::test::expectSameBytes;
using openrt::test::PlaneHits;

namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();

// Returns number i of a list between 0 and 1.
float number(uint32_t i, uint32_t list) { return toUnit(hash(i, list)); }

void append(std::vector<float>& out, const float* from, uint32_t n) {
  out.insert(out.end(), from, from + n);
}

// Hits of rays, of which some belong to the same path, with emission, three lobes and fog.
struct Surfaces {
  static constexpr uint32_t count = 37;
  PlaneHits plane{count};
  RtsBatch batch;
  RtsSurface surface{};
  std::vector<Crossing> crossing{count};
  Boundaries boundaries;
  Fog fog;

  explicit Surfaces(bool manyLobes) : batch(plane.batch()) {
    for (uint32_t i = 0; i < count; i++) {
      plane.states.path[i] = i / 3;
      plane.states.flags[i] = i % 2 ? uint32_t(PathFlags::deflectedBit) : 0;
      for (int k = 0; k < 3; k++) plane.states.throughput[k][i] = number(i, uint32_t(k));
    }
    for (int k = 0; k < 3; k++) {
      surface.emission[k] = floats(10 + uint32_t(k));
      surface.emission[k][5 + k] = infinite;
    }
    plane.add(batch, RTS_LOBE_DIFFUSE, 0.5f);
    if (!manyLobes) return;
    for (const RtsLobeKind kind : {RTS_LOBE_TRANSPARENT, RTS_LOBE_REFLECTION}) {
      plane.add(batch, kind, 0);
      float* const* weight = batch.lobes[batch.lobes.size() - 1].weight;
      for (int k = 0; k < 3; k++)
        for (uint32_t i = 0; i < count; i++) weight[k][i] = number(i, uint32_t(20 + kind + k));
      weight[0][7] = std::nanf("");
      weight[1][8] = -1;
      weight[2][9] = infinite;
    }
    for (uint32_t i = 0; i < count; i++) crossing[i].visible = i % 4 != 0;
    boundaries.crossing = crossing.data();
    fog.transmittance = floats(30);
    for (int k = 0; k < 3; k++) fog.airlight[k] = floats(31 + uint32_t(k));
  }

  float* floats(uint32_t list) {
    auto* out = plane.arena.takeZero<float>(padded(count));
    for (uint32_t i = 0; i < count; i++) out[i] = number(i, list);
    return out;
  }
  PixelSamples samples() {
    PixelSamples found;
    found.allocate(plane.arena, count);
    return found;
  }
};

// Adds the light of hit i as the formulas say, one number after the other.
void addHit(const Surfaces& at, uint32_t i, PixelSamples& found) {
  const PathStates& states = at.plane.states;
  const uint32_t path = states.path[i];
  const bool visible = at.boundaries.visibleAt(i);
  constexpr Vec3f one{1, 1, 1};
  Vec3f clear = visible ? Vec3f() : one, seen = clear, w;
  for (uint32_t l = 0; visible && l < at.batch.lobes.size(); l++) {
    const RtsLobe& lobe = at.batch.lobes[l];
    if (nonSpecularFunctions(lobe) || !weightAt(lobe, i, w)) continue;
    seen += w;
    if (lobe.kind == RTS_LOBE_TRANSPARENT) clear += w;
  }
  const Vec3f throughput = load(states.throughput, i);
  for (int k = 0; k < 3; k++) {
    const float emission = at.surface.emission[k][i];
    const float light = at.fog.attenuate(i, k, std::isfinite(emission) ? emission : 0.0f,
                                         std::min(seen[size_t(k)], 1.0f));
    found.radiance[k][path] += throughput[size_t(k)] * light;
  }
  if (!states.flagsOf(i).deflected())
    found.alpha[path] += dot(throughput, one - min(clear, one)) / 3;
}

} // namespace

TEST(HitLanes, RandomNumbersAreThoseOfTheScalarSampler) {
  constexpr uint32_t n = 1003, draw = 3;
  std::vector<uint32_t> key(n), pair(n), index(n);
  for (uint32_t i = 0; i < n; i++) {
    key[i] = hash(i / 16, 9);
    pair[i] = i % 5 ? 4 : hash(i, 1);
    index[i] = i % 3 ? i : hash(i, 2);
  }
  expectSameBytes([&](std::vector<float>& out) {
    std::vector<float> x(n + 1, -1), y(n + 1, -1), second(n + 1, -1);
    samplePairs(n, key.data(), pair.data(), draw, index.data(), x.data(), y.data());
    samplePairs(n, key.data(), pair.data(), draw, index.data(), nullptr, second.data());
    for (uint32_t i = 0; i < n; i++) {
      float expectedX, expectedY;
      // key[i] is hash(pixel, seed) of this pixel and seed.
      PairSampler(i / 16, pair[i] + draw, 9)(index[i], expectedX, expectedY);
      ASSERT_EQ(x[i], expectedX) << i;
      ASSERT_EQ(y[i], expectedY) << i;
    }
    EXPECT_EQ(second, y);
    EXPECT_EQ(x[n], -1); // nothing is written behind the end
    EXPECT_EQ(y[n], -1);
    append(out, x.data(), n);
    append(out, y.data(), n);
  });
}

TEST(HitLanes, OneLobeDrawsTheSameRouletteNumbersAsManyLobes) {
  constexpr uint32_t n = 20;
  PlaneHits plane(n);
  PathSamples samples;
  samples.allocate(plane.arena, n);
  for (uint32_t i = 0; i < n; i++) samples.set(i, i, 1, 5);
  RtsBatch batch = plane.batch();
  const auto draw = [&](RtsLobeKind kind) {
    plane.add(batch, kind, 0.5f);
    return drawChoices(batch, randomNumbersAt(samples, plane.states, batch.order, n,
                                              pairAtLevel(1, 2), plane.arena));
  };
  const LobeSampling one = draw(RTS_LOBE_DIFFUSE), two = draw(RTS_LOBE_REFLECTION);
  for (uint32_t i = 0; i < n; i++) {
    EXPECT_EQ(one.choices[0][i], 0);
    EXPECT_EQ(one.choices[1][i], two.choices[1][i]);
  }
  EXPECT_NE(two.choices[0][0], two.choices[0][1]);
}

TEST(HitLanes, CameraRaysAreThoseOfTheScalarFormulas) {
  constexpr uint32_t n = 21;
  PlaneHits plane(n);
  RtsClass camera{};
  camera.generate = [](const RtsHost*, RtsBatch*, const void*, uint32_t, const float* const xy[2],
                       const float*, RtsRays* out) {
    for (uint32_t i = 0; i < n; i++) {
      store({xy[0][i], xy[1][i], 1}, out->origin, i);
      store({xy[1][i], xy[0][i], -2}, out->direction, i);
    }
  };
  plane.scene.camera.shader.shaderClass = &camera;
  const Affine map{{{0.3f, 3.1f, 0.1f, 10}, {3.7f, 0, 0.2f, 20}, {0.7f, 0.9f, 3, 30}}};
  plane.scene.camera.fromLocal = map;
  std::vector<float> x(padded(n)), y(padded(n));
  for (uint32_t i = 0; i < padded(n); i++) {
    x[i] = number(i, 1);
    y[i] = number(i, 2);
  }
  const float* const xy[2] = {x.data(), y.data()};
  expectSameBytes([&](std::vector<float>& out) {
    Rays rays;
    rays.allocate(plane.arena, n);
    makeCameraRays(plane.context(), xy, rays);
    for (uint32_t i = 0; i < n; i++) {
      const Vec3f direction = map.direction(Vec3f{y[i], x[i], -2});
      EXPECT_EQ(load(rays.org, i), map.point(Vec3f{x[i], y[i], 1})) << i;
      EXPECT_EQ(load(rays.dir, i), direction * (1 / length(direction))) << i;
    }
    for (int k = 0; k < 3; k++) {
      append(out, rays.org[k], n);
      append(out, rays.dir[k], n);
    }
  });
}

TEST(HitLanes, LightOfHitsIsThatOfTheScalarFormulas) {
  for (const bool manyLobes : {false, true}) {
    Surfaces at(manyLobes);
    constexpr uint32_t n = Surfaces::count;
    PixelSamples expected = at.samples();
    for (uint32_t i = 0; i < n; i++) addHit(at, i, expected);
    expectSameBytes([&](std::vector<float>& out) {
      PixelSamples found = at.samples();
      const SentLight sent{
          {at.surface.emission[0], at.surface.emission[1], at.surface.emission[2]}};
      addSurface(at.batch, at.surface, sent, at.boundaries, at.fog, found);
      for (uint32_t i = 0; i < n; i++) {
        EXPECT_EQ(load(found.radiance, i), load(expected.radiance, i)) << i;
        EXPECT_EQ(found.alpha[i], expected.alpha[i]) << i;
      }
      for (const float* colour : found.radiance) append(out, colour, n);
      append(out, found.alpha, n);
    });
  }
}

TEST(HitLanes, NumbersThatAreNotFiniteAreFoundEverywhere) {
  expectSameBytes([](std::vector<float>& out) {
    std::vector<float> values(35, -std::numeric_limits<float>::max());
    for (uint32_t n = 0; n <= 34; n++) {
      values[n] = infinite; // behind the end
      EXPECT_TRUE(allFinite(values.data(), n)) << n;
      for (const float bad : {infinite, -infinite, std::nanf("")}) {
        values[n] = bad;
        EXPECT_FALSE(allFinite(values.data(), n + 1)) << n;
      }
      values[n] = 1;
    }
    append(out, values.data(), 35);
  });
}

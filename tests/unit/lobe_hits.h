// lobe_hits.h: hits with random directions, shading normals, lobes and paths, for tests of the
// stages that sample lobes.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "render/film/ledger.h"
#include "render/surface/sample_lobes.h"
#include "render/wave/boundaries.h"
#include "scene/transports.h"
#include "unit/plane_hits.h"

namespace openrt::test {

inline constexpr uint32_t count = 333; // no multiple of any vector width

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

inline void expectEqual(const Vec3f& a, const Vec3f& b, const char* what, uint32_t path) {
  EXPECT_TRUE(a == b) << what << " of path " << path << ": " << a.x << ' ' << a.y << ' ' << a.z
                      << " and " << b.x << ' ' << b.y << ' ' << b.z;
}

} // namespace openrt::test

// openrt_projected_pdfs.cpp: the pdfs of lobes for a path and for the one that runs the other way,
// and the weights of light paths and camera paths.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "render/lights/light_path_weights.h"
#include "render/surface/lobes.h"
#include "render/surface/projected_pdfs.h"
#include "unit/lobe_hits.h"

namespace openrt {
namespace {

using test::count;

// Hits with a lobe, and a direction above each.
struct Pairs {
  test::Hits hits{RT_TRANSPORT_PATH};
  float* direction[3];

  Pairs(RtsLobeKind kind, float p0, float p1) {
    hits.add(kind, p0, p1);
    for (auto& a : direction) a = hits.plane.arena.take<float>(padded(count));
    for (uint32_t i = 0; i < count; i++)
      store(normalize(Vec3f{hits.random(-1, 1), hits.random(-1, 1), hits.random(.05f, 1)}),
            direction, i);
  }
  ProjectedPdfs pdfs() {
    Arena& arena = hits.plane.arena;
    LobeValues values(arena, count, &hits.batch);
    const uint32_t* all = arena.takeNumbers(count);
    values.evaluate(lobe(), hits.plane.points.hits, count, all, direction);
    return projectedPdfs(hits.batch, lobe(), count, all, direction, values.pdf);
  }
  // Lets the paths run the other way.
  void reverse() {
    for (uint32_t i = 0; i < count; i++) {
      const Vec3f arriving = load(hits.plane.points.hits.direction, i);
      store(-load(direction, i), test::Hits::arrayOf(hits.plane.points.hits.direction), i);
      store(-arriving, direction, i);
    }
  }
  const RtsLobe& lobe() const { return hits.batch.lobes[0]; }
};

void expectReversible(Pairs&& pairs) {
  const ProjectedPdfs there = pairs.pdfs();
  pairs.reverse();
  const ProjectedPdfs back = pairs.pdfs();
  uint32_t positive = 0;
  for (uint32_t i = 0; i < count; i++) {
    const Vec3f n = load(pairs.lobe().normal, i);
    // Both directions are above the lobe's normal.
    if (!(dot(n, load(pairs.direction, i)) > 0) ||
        !(dot(n, load(pairs.hits.plane.points.hits.direction, i)) < 0))
      continue;
    EXPECT_NEAR(there.ahead[i], back.back[i], 1e-4f * there.ahead[i]) << i;
    EXPECT_NEAR(there.back[i], back.ahead[i], 1e-4f * there.back[i]) << i;
    positive += there.ahead[i] > 0 && there.back[i] > 0;
  }
  EXPECT_GT(positive, count / 3);
}

TEST(ProjectedPdfs, ChangePlacesWhenThePathIsReversed) {
  expectReversible({RTS_LOBE_DIFFUSE, 0, 0});
  expectReversible({RTS_LOBE_GLOSSY, .3f, 0});
  expectReversible({RTS_LOBE_GLOSSY, .05f, .66f});
  expectReversible({RTS_LOBE_ROUGH_DIELECTRIC, .66f, .3f});
}

TEST(ProjectedPdfs, OfLambertAreEven) {
  Pairs pairs(RTS_LOBE_DIFFUSE, 0, 0);
  const ProjectedPdfs pdfs = pairs.pdfs();
  EXPECT_FLOAT_EQ(pdfs.ahead[7], std::numbers::inv_pi_v<float>);
  EXPECT_FLOAT_EQ(pdfs.back[7], std::numbers::inv_pi_v<float>);
}

TEST(LightPathWeights, SumToOneForEachRatio) {
  for (const float ratio : {0.0f, 1e-30f, 1e-3f, 1.0f, 7.0f, 1e12f, 1e30f, INFINITY, NAN}) {
    const float share = lightPathShare(ratio);
    EXPECT_GE(share, 0);
    EXPECT_LE(share, 1);
    EXPECT_EQ(share + cameraPathShare(ratio), 1) << ratio;
  }
}

} // namespace
} // namespace openrt

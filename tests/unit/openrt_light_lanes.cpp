// openrt_light_lanes.cpp: Tests the vector code of light samples: all instruction sets of this
// machine give the same bytes, and the samples agree with the formulas in double precision.
#include <gtest/gtest.h>

#include <algorithm>

#include "render/lights/light_rays.h"
#include "render/lights/light_samples.h"
#include "render/lights/light_tree.h"
#include "render/lights/spherical.h"
#include "render/surface/lobes.h"
#include "render/wave/points.h"
#include "unit/lanes_support.h"

using namespace openrt;
using namespace openrt::test;

namespace {

// Random triangles and the points that see them.
struct Triangles {
  Numbers numbers{7};
  Arrays corner[3] = {vectors(numbers, 2), vectors(numbers, 2), vectors(numbers, 2)};
  std::vector<uint32_t> sides = std::vector<uint32_t>(count, 3);
  Arrays position = vectors(numbers, 5), normal = unitVectors(numbers);
  std::vector<float> error = std::vector<float>(count, 1e-6f);
  std::vector<uint32_t> twoSided = std::vector<uint32_t>(count, 1);
  std::vector<float> wanted = std::vector<float>(count, 1);
  std::vector<float> pick = numbers.list(0, 1), u = numbers.list(0, 1), v = numbers.list(0, 1);
  std::vector<uint32_t> shape = std::vector<uint32_t>(count);
  std::vector<float> share = std::vector<float>(count), probability = std::vector<float>(count, 1);

  Triangles() {
    for (uint32_t i = 0; i < count; i++) shape[i] = i;
  }
  ShapeArrays shapes() const {
    ShapeArrays arrays;
    for (int c = 0; c < 3; c++)
      for (int k = 0; k < 3; k++) arrays.corner[c][k] = corner[c][k].data();
    arrays.sides = sides.data();
    for (int k = 0; k < 3; k++) arrays.radiance[k] = corner[0][k].data();
    return arrays;
  }
  LightPoints points() const {
    return {count,
            {position[0].data(), position[1].data(), position[2].data()},
            {normal[0].data(), normal[1].data(), normal[2].data()},
            error.data(),
            twoSided.data(),
            pick.data(),
            u.data(),
            v.data(),
            wanted.data()};
  }
  ChosenLights chosen() { return {share.data(), shape.data(), probability.data()}; }
};

// Light samples by point.
struct Samples : SampledLights {
  Arena arena;
  Samples() { allocate(arena, count); }
  // Appends the numbers of the samples that are not left to other code.
  void appendTo(std::vector<float>& out) const {
    for (uint32_t i = 0; i < count; i++)
      if (!left[i])
        for (const float* list : {direction[0], direction[1], direction[2], distance, end, pdf})
          out.push_back(list[i]);
  }
};

LightTree treeOf(uint32_t lights, Numbers& numbers) {
  std::vector<LightBounds> bounds(lights);
  for (LightBounds& b : bounds) {
    for (int k = 0; k < 3; k++) {
      b.low[k] = numbers(-3, 3);
      b.high[k] = b.low[k] + numbers(0, 1);
    }
    b.cosineNormals = 1;
    b.intensity = numbers(0.1f, 5);
  }
  LightTree tree;
  tree.build(bounds);
  return tree;
}

TEST(LightLanes, LightSamplesHaveTheSameBytes) {
  Triangles scene;
  Numbers numbers(11);
  const LightTree tree = treeOf(5, numbers);
  expectSameBytes([&](std::vector<float>& out) {
    Samples samples;
    sampleShapes(scene.shapes(), scene.points(), scene.chosen(), samples);
    samples.appendTo(out);
    Triangles other;
    chooseFromRoot(tree.root(), other.points(), 2, other.chosen());
    out.insert(out.end(), other.share.begin(), other.share.end());
    out.insert(out.end(), other.probability.begin(), other.probability.end());
    for (const uint32_t shape : other.shape) out.push_back(float(shape));
  });
}

// Points that see the five triangles of a light tree with one node, from one side.
struct FewTriangles : Triangles {
  LightTree tree;
  explicit FewTriangles() {
    Numbers other(11);
    tree = treeOf(5, other);
    for (uint32_t i = 0; i < count; i += 3) twoSided[i] = 0;
    for (uint32_t i = 0; i < count; i += 5) wanted[i] = 0;
    for (uint32_t i = 0; i < 5; i += 2) sides[i] |= ShapeArrays::oneRadiance;
  }
  bool sample(float skyIrradiance, const SampledLights& out) const {
    return sampleFromRoot(tree.root(), shapes(), points(), skyIrradiance, out);
  }
  // Returns the points and directions of the samples as if BSDF sampling had found the shapes.
  FoundShapes found(const SampledLights& samples, Arena& arena) const {
    FoundShapes out;
    out.allocate(arena, count);
    for (uint32_t i = 0; i < count; i++) {
      if (samples.left[i] || !(samples.pdf[i] > 0)) continue;
      const Vec3f n{normal[0][i], normal[1][i], normal[2][i]},
          p{position[0][i], position[1][i], position[2][i]};
      store(offsetPoint(p, n, error[i]), out.position, out.count);
      store(twoSided[i] ? Vec3f() : n, out.normal, out.count);
      store(load(samples.direction, i), out.direction, out.count);
      out.shape[out.count++] = samples.shape[i];
    }
    return out;
  }
};

// A grey lobe at all points.
struct GreyLobe {
  Numbers numbers{31};
  Arrays normal = unitVectors(numbers);
  std::vector<float> weight = numbers.list(-0.2f, 1), followed = numbers.list(-0.2f, 1);
  RtsLobe lobe{};
  GreyLobe() {
    lobe.kind = RTS_LOBE_DIFFUSE;
    for (size_t k = 0; k < 3; k++) {
      lobe.normal[k] = normal[k].data();
      lobe.weight[k] = weight.data();
    }
  }
  // Weights light samples by the lobe, twice, as if the surface had two of them.
  void weigh(const LightSamples& samples, LobeValues& values) const {
    const uint32_t n = samples.rays.count;
    values.evaluate(lobe, {}, n, samples.hit, samples.rays.dir);
    for (const bool more : {false, true})
      weightByLobe(lobe, followed.data(), values, more, samples);
  }
};

TEST(LightLanes, RaysOfLightSamplesHaveTheSameBytes) {
  const FewTriangles scene;
  const GreyLobe grey;
  expectSameBytes([&](std::vector<float>& out) {
    Arena arena;
    Samples samples;
    scene.sample(2, samples);
    samples.appendTo(out);
    const FoundShapes found = scene.found(samples, arena);
    auto* pdf = arena.take<float>(padded(found.count));
    pdfFromRoot(scene.tree.root(), scene.shapes(), found, 2, pdf);
    out.insert(out.end(), pdf, pdf + found.count);
    // Points that are left to other code get no sample here.
    for (uint32_t i = 0; i < count; i++)
      if (samples.left[i]) samples.pdf[i] = 0;
    LightSamples rays;
    rays.allocate(arena, count);
    startShadowRays(scene.points(), samples, rays);
    LobeValues values(arena, rays.rays.count);
    grey.weigh(rays, values);
    removeUseless(rays);
    const uint32_t n = rays.rays.count;
    for (const float* list : {rays.rays.org[0], rays.rays.dir[1], rays.rays.tnear, rays.rays.tfar,
                              rays.distance, rays.pdf, rays.response[0], rays.response[2]})
      out.insert(out.end(), list, list + n);
    auto* blocked = arena.takeZero<uint8_t>(padded(n));
    for (uint32_t r = 0; r < n; r += 7) blocked[r] = 1;
    float* radiance[3];
    for (auto& a : radiance) a = arena.takeZero<float>(count);
    auto* others = arena.take<uint32_t>(padded(n));
    const uint32_t left =
        addOneRadiance(scene.shapes(), rays, rays.response, blocked, radiance, others);
    for (const float* list : radiance) out.insert(out.end(), list, list + count);
    for (uint32_t r = 0; r < left; r++) out.push_back(float(others[r]));
  });
}

TEST(LightLanes, OneNodeIsSampledLikeChoosingAndSampling) {
  FewTriangles scene;
  Samples one, two;
  const bool left = scene.sample(2, one);
  chooseFromRoot(scene.tree.root(), scene.points(), 2, scene.chosen());
  EXPECT_EQ(sampleShapes(scene.shapes(), scene.points(), scene.chosen(), two), left);
  for (uint32_t i = 0; i < count; i++) {
    ASSERT_EQ(one.left[i], two.left[i]) << i;
    ASSERT_EQ(one.pdf[i], two.pdf[i]) << i;
    if (!(one.pdf[i] > 0)) continue;
    EXPECT_GT(scene.wanted[i], 0) << i;
    if (one.left[i] == SampledLights::sky) {
      EXPECT_EQ(one.pdf[i], scene.share[i]) << i;
    } else if (!one.left[i]) {
      EXPECT_EQ(load(one.direction, i), load(two.direction, i)) << i;
    }
  }
}

TEST(LightLanes, PdfsOfFoundShapesAgreeWithTheSamples) {
  const FewTriangles scene;
  Arena arena;
  Samples samples;
  scene.sample(0, samples);
  const FoundShapes found = scene.found(samples, arena);
  ASSERT_GT(found.count, count / 10);
  auto* pdf = arena.take<float>(padded(found.count));
  pdfFromRoot(scene.tree.root(), scene.shapes(), found, 0, pdf);
  for (uint32_t f = 0, i = 0; f < found.count; f++, i++) {
    while (samples.left[i] || !(samples.pdf[i] > 0)) i++;
    EXPECT_NEAR(pdf[f] / samples.pdf[i], 1, 1e-5) << i;
    const uint32_t shape = found.shape[f];
    std::array<Vec3f, 3> corner;
    for (size_t c = 0; c < 3; c++)
      for (size_t k = 0; k < 3; k++) corner[c][k] = scene.corner[c][k][shape];
    const Vec3f place = load(found.position, f);
    const double exact = SphericalTriangle(corner, place).pdf(Vec3d(load(found.direction, f))) *
                         double(scene.tree.probability(place, load(found.normal, f), shape));
    EXPECT_NEAR(double(pdf[f]) / exact, 1, 1e-3) << i;
  }
}

TEST(LightLanes, ShadowRaysStartOnTheSideOfTheLight) {
  const FewTriangles scene;
  Arena arena;
  Samples samples;
  scene.sample(0, samples);
  LightSamples out;
  out.allocate(arena, count);
  startShadowRays(scene.points(), samples, out);
  uint32_t r = 0;
  for (uint32_t i = 0; i < count; i++) {
    if (!(samples.pdf[i] > 0)) continue;
    ASSERT_LT(r, out.rays.count);
    const Vec3f n{scene.normal[0][i], scene.normal[1][i], scene.normal[2][i]},
        p{scene.position[0][i], scene.position[1][i], scene.position[2][i]};
    const LightSample sample = out[r];
    EXPECT_EQ(out.hit[r], i);
    EXPECT_EQ(sample.shape, samples.shape[i]);
    EXPECT_EQ(sample.pdf, samples.pdf[i]);
    EXPECT_EQ(sample.distance, samples.distance[i]);
    EXPECT_EQ(sample.direction, load(samples.direction, i));
    EXPECT_EQ(load(out.rays.org, r),
              offsetPoint(p, dot(n, sample.direction) > 0 ? n : -n, scene.error[i]));
    EXPECT_EQ(out.rays.tnear[r], 0);
    EXPECT_EQ(out.rays.tfar[r], samples.end[i]);
    r++;
  }
  EXPECT_EQ(r, out.rays.count);
  EXPECT_GT(r, count / 10);
}

TEST(LightLanes, LightSamplesAreWeightedByTheBalanceHeuristic) {
  const FewTriangles scene;
  const GreyLobe grey;
  Arena arena;
  Samples samples;
  scene.sample(0, samples);
  LightSamples out;
  out.allocate(arena, count);
  startShadowRays(scene.points(), samples, out);
  const uint32_t n = out.rays.count;
  LobeValues values(arena, n);
  grey.weigh(out, values);
  std::vector<uint32_t> lit;
  for (uint32_t r = 0; r < n; r++) {
    const uint32_t i = out.hit[r];
    Vec3f w, expected;
    if (grey.followed[i] > 0 && weightAt(grey.lobe, i, w))
      expected = 2.0f * (w * load(values.value, r) *
                         (1 / (out.pdf[r] + grey.followed[i] * values.pdf[r])));
    EXPECT_EQ(load(out.response, r), expected) << r;
    if (expected.x > 0) lit.push_back(i);
  }
  removeUseless(out);
  EXPECT_LT(lit.size(), n);
  EXPECT_EQ(std::vector<uint32_t>(out.hit, out.hit + out.rays.count), lit);
  for (uint32_t r = 0; r < out.rays.count; r++)
    EXPECT_EQ(load(out.rays.dir, r), load(samples.direction, out.hit[r]));
}

TEST(LightLanes, LightOfOneRadianceIsAddedToTheHits) {
  const FewTriangles scene;
  Arena arena;
  LightSamples samples;
  samples.allocate(arena, 21);
  for (uint32_t r = 0; r < 21; r++) {
    samples.hit[r] = 2 * r;
    samples.shape[r] = r % 4 == 3 ? EmissiveShapes::none : r % 4; // 0 and 2 have one radiance
    store(Vec3f{1, 2, 3}, samples.response, r);
  }
  auto* blocked = arena.takeZero<uint8_t>(padded(21));
  blocked[4] = 1;
  float* radiance[3];
  for (auto& a : radiance) a = arena.takeZero<float>(42);
  auto* others = arena.take<uint32_t>(padded(21));
  const ShapeArrays shapes = scene.shapes();
  const uint32_t left =
      addOneRadiance(shapes, samples, samples.response, blocked, radiance, others);
  std::vector<uint32_t> expected;
  for (uint32_t r = 0; r < 21; r++) {
    const bool added = r % 2 == 0 && !blocked[r];
    if (!added && !blocked[r]) expected.push_back(r);
    const Vec3f light = Vec3f{1, 2, 3} * load(shapes.radiance, r % 4);
    EXPECT_EQ(load(radiance, 2 * r), added ? light : Vec3f()) << r;
  }
  EXPECT_EQ(std::vector<uint32_t>(others, others + left), expected);
}

TEST(LightLanes, OnlyEmittingHitsAreListed) {
  std::vector<float> zero(48), green(48);
  for (const uint32_t i : {0u, 15u, 17u, 32u, 40u}) green[i] = 0.5f;
  const float* const emission[3] = {zero.data(), green.data(), zero.data()};
  std::vector<uint32_t> hits(48);
  hits.resize(listEmitting(emission, 33, hits.data()));
  EXPECT_EQ(hits, (std::vector<uint32_t>{0, 15, 17, 32}));
}

TEST(LightLanes, LightSamplesAgreeWithDoublePrecision) {
  Triangles scene;
  Samples samples;
  sampleShapes(scene.shapes(), scene.points(), scene.chosen(), samples);
  // The ends of shadow rays are known where the surface faces the light.
  for (size_t k = 0; k < 3; k++) std::copy_n(samples.direction[k], count, scene.normal[k].begin());
  std::fill(scene.twoSided.begin(), scene.twoSided.end(), 0);
  sampleShapes(scene.shapes(), scene.points(), scene.chosen(), samples);
  uint32_t compared = 0, left = 0;
  for (uint32_t i = 0; i < count; i++) {
    if (samples.left[i]) {
      EXPECT_EQ(samples.left[i], SampledLights::inDouble);
      left++;
      continue;
    }
    std::array<Vec3f, 3> corner;
    Vec3f eye;
    for (size_t k = 0; k < 3; k++) {
      for (size_t c = 0; c < 3; c++) corner[c][k] = scene.corner[c][k][i];
      eye[k] = scene.position[k][i];
    }
    const SphericalTriangle seen(corner, eye);
    Vec3d direction;
    double distance;
    ASSERT_TRUE(seen.sample(scene.u[i], scene.v[i], direction, distance)) << i;
    ASSERT_GT(samples.pdf[i], 0) << i;
    EXPECT_NEAR(samples.pdf[i] / seen.pdf(direction), 1, 1e-3) << i;
    EXPECT_NEAR(samples.distance[i] / distance, 1, 1e-3) << i;
    EXPECT_LE(samples.end[i], samples.distance[i]);
    EXPECT_GE(samples.end[i], samples.distance[i] * 0.999f);
    for (size_t k = 0; k < 3; k++) EXPECT_NEAR(samples.direction[k][i], direction[k], 2e-4) << i;
    compared++;
  }
  EXPECT_GT(compared, 3 * count / 4);
  EXPECT_GT(left, 0u); // some random triangles are slivers
}

TEST(LightLanes, ChosenLightsHaveTheProbabilityOfTheTree) {
  Triangles scene;
  Numbers numbers(23);
  const LightTree tree = treeOf(6, numbers);
  ASSERT_TRUE(tree.hasOneNode());
  chooseFromRoot(tree.root(), scene.points(), 0, scene.chosen());
  uint32_t chosen = 0;
  for (uint32_t i = 0; i < count; i++) {
    EXPECT_EQ(scene.share[i], 0);
    if (!(scene.probability[i] > 0)) continue;
    chosen++;
    const Vec3f place{scene.position[0][i], scene.position[1][i], scene.position[2][i]};
    EXPECT_NEAR(scene.probability[i], tree.probability(place, Vec3f(), scene.shape[i]), 1e-4) << i;
  }
  EXPECT_GT(chosen, count / 2);
}

} // namespace

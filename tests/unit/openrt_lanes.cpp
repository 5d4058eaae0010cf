// openrt_lanes.cpp: Tests the vector code of the renderer: all instruction sets of this machine
// give the same bytes, light samples agree with the formulas in double precision, and the queue of
// rays keeps what it holds while it grows.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "render/lights/light_samples.h"
#include "render/lights/light_tree.h"
#include "render/lights/spherical.h"
#include "render/path/path_states.h"
#include "render/surface/lambert.h"
#include "render/surface/point_block.h"
#include "unit/same_bytes.h"

using namespace openrt;
using openrt::test::expectSameBytes;

namespace {

constexpr uint32_t count = 4096;

class Numbers {
 public:
  explicit Numbers(uint32_t seed) : random_(seed) {}
  float operator()(float low, float high) {
    return low + (high - low) * float(random_() >> 8) * 0x1p-24f;
  }
  std::vector<float> list(float low, float high) {
    std::vector<float> out(count);
    for (float& x : out) x = (*this)(low, high);
    return out;
  }

 private:
  std::mt19937 random_;
};

using Arrays = std::array<std::vector<float>, 3>;

Arrays vectors(Numbers& numbers, float size) {
  return {numbers.list(-size, size), numbers.list(-size, size), numbers.list(-size, size)};
}

Arrays unitVectors(Numbers& numbers) {
  Arrays v = vectors(numbers, 1);
  for (uint32_t i = 0; i < count; i++) {
    const double length = std::sqrt(double(v[0][i]) * v[0][i] + double(v[1][i]) * v[1][i] +
                                    double(v[2][i]) * v[2][i]);
    for (auto& component : v) component[i] = float(component[i] / length);
  }
  return v;
}

// Random triangles and the points that see them.
struct Triangles {
  Numbers numbers{7};
  Arrays corner[3] = {vectors(numbers, 2), vectors(numbers, 2), vectors(numbers, 2)};
  std::vector<uint32_t> sides = std::vector<uint32_t>(count, 3);
  Arrays position = vectors(numbers, 5), normal = unitVectors(numbers);
  std::vector<float> error = std::vector<float>(count, 1e-6f);
  std::vector<uint32_t> twoSided = std::vector<uint32_t>(count, 1);
  std::vector<uint8_t> wanted = std::vector<uint8_t>(count, 1);
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

struct Samples {
  Arrays direction{std::vector<float>(count), std::vector<float>(count), std::vector<float>(count)};
  std::vector<float> distance = std::vector<float>(count), end = distance, pdf = distance;
  std::vector<uint32_t> exact = std::vector<uint32_t>(count);
  SampledLights arrays() {
    return {{direction[0].data(), direction[1].data(), direction[2].data()},
            distance.data(),
            end.data(),
            pdf.data(),
            exact.data()};
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

TEST(Lanes, LightSamplesHaveTheSameBytes) {
  Triangles scene;
  Numbers numbers(11);
  const LightTree tree = treeOf(5, numbers);
  expectSameBytes([&](std::vector<float>& out) {
    Samples samples;
    sampleShapes(scene.shapes(), scene.points(), scene.chosen(), samples.arrays());
    for (const auto* list : {&samples.direction[0], &samples.direction[1], &samples.direction[2],
                             &samples.distance, &samples.end, &samples.pdf})
      for (uint32_t i = 0; i < count; i++)
        if (!samples.exact[i]) out.push_back((*list)[i]);
    Triangles other;
    chooseFromRoot(tree.root(), other.points(), 2, other.chosen());
    out.insert(out.end(), other.share.begin(), other.share.end());
    out.insert(out.end(), other.probability.begin(), other.probability.end());
    for (const uint32_t shape : other.shape) out.push_back(float(shape));
  });
}

TEST(Lanes, LambertLobesHaveTheSameBytes) {
  Numbers numbers(3);
  const Arrays normal = unitVectors(numbers);
  const std::vector<float> u = numbers.list(0, 1), v = numbers.list(0, 1);
  std::vector<uint32_t> hit(count);
  for (uint32_t i = 0; i < count; i++) hit[i] = count - 1 - i;
  expectSameBytes([&](std::vector<float>& out) {
    RtsLobe lobe{};
    Arrays normals = normal, direction = normal, value = normal;
    std::vector<float> pdf(count);
    for (int k = 0; k < 3; k++) lobe.normal[k] = normals[size_t(k)].data();
    float* const to[3] = {direction[0].data(), direction[1].data(), direction[2].data()};
    float* const values[3] = {value[0].data(), value[1].data(), value[2].data()};
    const float* const square[2] = {u.data(), v.data()};
    sampleLambert(&lobe, nullptr, count, hit.data(), square, to, values, pdf.data());
    for (const Arrays* arrays : {&direction, &value})
      for (const auto& list : *arrays) out.insert(out.end(), list.begin(), list.end());
    out.insert(out.end(), pdf.begin(), pdf.end());
    const float* const from[3] = {to[0], to[1], to[2]};
    evaluateLambert(&lobe, nullptr, count, hit.data(), from, values, pdf.data());
    out.insert(out.end(), pdf.begin(), pdf.end());
  });
}

TEST(Lanes, ShadingPointsHaveTheSameBytes) {
  Numbers numbers(5);
  PointBlock block{};
  auto* floats = reinterpret_cast<float*>(&block.direction);
  for (size_t i = 0; i < 6 * lanes; i++) floats[i] = numbers(-1, 1);
  for (uint32_t i = 0; i < lanes; i++) {
    block.own[i] = i % 16;
    block.attributes |= block.own[i];
    block.flipped[i] = i % 3 ? 0 : ~0u;
    block.u[i] = numbers(0, 0.5f);
    block.v[i] = numbers(0, 0.5f);
    block.scale[i] = 1;
    for (int c = 0; c < 3; c++) {
      for (int k = 0; k < 3; k++) {
        block.corner[c][k][i] = numbers(-5, 5);
        block.cornerNormal[c][k][i] = numbers(-1, 1);
        block.normalMatrix[c][k][i] = block.kernelNormal[c][k][i] = numbers(-1, 1);
      }
      for (int k = 0; k < 4; k++) {
        block.toRender[c][k][i] = numbers(-2, 2);
        block.cornerColor[c][k][i] = numbers(0, 1);
      }
      for (int k = 0; k < 2; k++) block.cornerTexCoord[c][k][i] = numbers(0, 1);
    }
  }
  expectSameBytes([&](std::vector<float>& out) {
    PointBlock copy = block;
    interpolateTriangles(copy);
    out.assign(20 * lanes, 0); // 12 components of vectors, uv, color, error, flags
    std::vector<uint32_t> flags(lanes);
    PointArrays to{};
    float* at = out.data();
    const auto next = [&] {
      at += lanes;
      return at - lanes;
    };
    for (auto* group : {to.position, to.direction, to.geometric, to.normal})
      for (int k = 0; k < 3; k++) group[k] = next();
    for (auto& a : to.uv) a = next();
    for (auto& a : to.color) a = next();
    to.error = next();
    to.flags = flags.data();
    finishPoints(copy, to, 0);
    float* const flagsOut = next();
    for (uint32_t i = 0; i < lanes; i++) flagsOut[i] = float(flags[i]);
  });
}

TEST(Lanes, LightSamplesAgreeWithDoublePrecision) {
  Triangles scene;
  Samples samples;
  sampleShapes(scene.shapes(), scene.points(), scene.chosen(), samples.arrays());
  uint32_t compared = 0, left = 0;
  for (uint32_t i = 0; i < count; i++) {
    if (samples.exact[i]) {
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

TEST(Lanes, ChosenLightsHaveTheProbabilityOfTheTree) {
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

TEST(RayQueues, KeepTheirRaysWhileTheyGrow) {
  RayQueue queue;
  for (uint32_t i = 0; i < 1000; i++) {
    RayState state{.path = i, .branch = 2 * i};
    state.flags.setChannel(uint8_t(i % 4));
    state.media = {uint16_t(i), 0, 0, 7};
    queue.push({float(i), 1, 2}, {0, float(i), 1}, state);
  }
  ASSERT_EQ(queue.size(), 1000u);
  RayQueue other;
  std::swap(queue, other);
  EXPECT_TRUE(queue.empty());
  const PathStates from = other.statesFrom(500);
  for (uint32_t i = 500; i < 1000; i++) {
    EXPECT_EQ(other.origin()[0][i], float(i));
    EXPECT_EQ(other.direction()[1][i], float(i));
    const RayState state = from[i - 500];
    EXPECT_EQ(state.path, i);
    EXPECT_EQ(state.branch, 2 * i);
    EXPECT_EQ(state.flags.channel(), i % 4);
    EXPECT_EQ(state.media[0], uint16_t(i));
    EXPECT_EQ(state.throughput[2], 1);
  }
}

TEST(PathFlags, HoldEachFactApart) {
  PathFlags flags;
  flags.setClass(PathClass::specularFirst);
  flags.setChannel(3);
  for (int i = 0; i < 300; i++) flags.addSplit();
  flags.set(PathFlags::deflectedBit, true);
  EXPECT_EQ(flags.splits(), PathFlags::mostSplits);
  EXPECT_EQ(flags.channel(), 3);
  EXPECT_EQ(flags.pathClass(), PathClass::specularFirst);
  EXPECT_TRUE(flags.deflected());
  EXPECT_FALSE(flags.scattered());
  flags.setChannel(0);
  flags.setClass(PathClass::undeflected);
  EXPECT_EQ(flags.splits(), PathFlags::mostSplits);
  EXPECT_EQ(flags.channel(), 0);
}

} // namespace

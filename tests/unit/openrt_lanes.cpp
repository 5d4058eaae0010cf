// openrt_lanes.cpp: Tests the vector code of the renderer: all instruction sets of this machine
// give the same bytes, and the queue of rays keeps what it holds while it grows. The tests of light
// samples are in openrt_light_lanes.cpp.
#include <gtest/gtest.h>

#include "render/surface/lambert.h"
#include "render/wave/path_states.h"
#include "render/wave/point_block.h"
#include "unit/lanes_support.h"

using namespace openrt;
using namespace openrt::test;

namespace {

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
  for (int i = 0; i < 700; i++) flags.addPassage();
  EXPECT_EQ(flags.passages(), 700u);
  EXPECT_EQ(flags.splits(), PathFlags::mostSplits);
  flags.setPassages(3);
  EXPECT_EQ(flags.passages(), 3u);
  EXPECT_TRUE(flags.deflected());
}

TEST(RayQueue, CutsThePathsThatWereBentTooOftenAndKeepsTheOrderOfTheOthers) {
  RayQueue queue;
  for (uint32_t i = 0; i < 10; i++) {
    RayState state{.throughput = {1, 2, 3}, .path = i};
    state.flags.setPassages(i);
    queue.push({float(i), 0, 0}, {0, 0, 1}, state);
  }
  double lost = 0;
  queue.cut(5, 5, lost);
  EXPECT_EQ(queue.size(), 10u);
  EXPECT_EQ(lost, 0);
  queue.cut(9, 5, lost); // needs four passages
  ASSERT_EQ(queue.size(), 6u);
  EXPECT_EQ(lost, 4 * 6);
  for (uint32_t i = 0; i < 6; i++) {
    EXPECT_EQ(queue.states().path[i], i + 4);
    EXPECT_EQ(queue.origin()[0][i], float(i + 4));
  }
  queue.cut(5 + mostPassages + 1, 5, lost);
  EXPECT_TRUE(queue.empty());
}

} // namespace

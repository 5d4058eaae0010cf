// openrt_primitive_runs.cpp: the map from the primitives of an Embree geometry to those of the
// scene, against a plain list.
#include <gtest/gtest.h>

#include <random>
#include <utility>
#include <vector>

#include "backend/local/accel/primitive_runs.h"

namespace openrt {
namespace {

struct Both {
  PrimitiveRuns runs;
  std::vector<std::pair<uint32_t, uint32_t>> list;

  void add(uint32_t record, uint32_t first, uint32_t count) {
    runs.add(record, first, count);
    for (uint32_t i = 0; i < count; i++) list.emplace_back(record, first + i);
  }
  void expectEqual() const {
    for (uint32_t i = 0; i < list.size(); i++) {
      const PrimitiveId found = runs.find(i);
      EXPECT_EQ(found.record, list[i].first) << i;
      EXPECT_EQ(found.primitive, list[i].second) << i;
    }
  }
};

TEST(PrimitiveRuns, OneRun) {
  Both both;
  both.add(7, 0, 1000);
  both.expectEqual();
}

// Degenerate triangles leave gaps in the numbers, and spheres have one primitive each.
TEST(PrimitiveRuns, ShortRunsGapsAndEmptyGeometries) {
  Both both;
  for (uint32_t record = 0; record < 100; record++) both.add(record, 0, 1);
  both.add(100, 0, 0);
  for (uint32_t t = 0; t < 100; t += 1 + t % 3) both.add(101, t, 1);
  both.add(101, 200, 17);
  both.expectEqual();
}

TEST(PrimitiveRuns, RandomRuns) {
  std::mt19937 random(1);
  Both both;
  for (uint32_t i = 0; i < 2000; i++) both.add(random() % 3, random() % 4, random() % 40);
  both.expectEqual();
}

} // namespace
} // namespace openrt

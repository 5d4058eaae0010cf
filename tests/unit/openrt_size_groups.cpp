// openrt_size_groups.cpp: which things that move together share a frame.
#include <gtest/gtest.h>

#include "backend/local/accel/size_groups.h"

namespace openrt {
namespace {

Box cube(double x, double half) { return {{x - half, -half, -half}, {x + half, half, half}}; }

TEST(SizeGroups, WhatFitsStaysTogether) {
  EXPECT_EQ(groupBySize({cube(0, 1), cube(1e4, 1), cube(5, .5)}), std::vector<uint32_t>(3));
  EXPECT_EQ(groupBySize({cube(7, 1e-9)}), std::vector<uint32_t>(1));
  EXPECT_TRUE(groupBySize({}).empty());
}

TEST(SizeGroups, WhatIsFarAwayIsApart) {
  const std::vector<uint32_t> groups = groupBySize({cube(0, 1), cube(1e8, 1), cube(3, 1)});
  EXPECT_EQ(groups[0], groups[2]);
  EXPECT_NE(groups[0], groups[1]);
}

TEST(SizeGroups, WhatIsHugeIsApartThoughItContainsTheRest) {
  const std::vector<uint32_t> groups = groupBySize({cube(0, 1e9), cube(1, 1), cube(2, 1)});
  EXPECT_NE(groups[0], groups[1]);
  EXPECT_EQ(groups[1], groups[2]);
}

TEST(SizeGroups, ThereAreFewAndBoxesWithoutSizeFollow) {
  std::vector<Box> boxes(2000);
  for (size_t i = 0; i < boxes.size(); i++) boxes[i] = cube(1e7 * double(i), i % 2 ? 1 : 0);
  boxes.emplace_back(); // empty
  for (const uint32_t group : groupBySize(boxes)) EXPECT_LT(group, mostGroups);
}

} // namespace
} // namespace openrt

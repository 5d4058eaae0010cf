// openrt_parameter_values.cpp: ParameterValues against std::map, under random values.
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scene/parameter_values.h"

namespace openrt {
namespace {

void expectEqual(const ParameterValue& value, const edit::ParameterT& expected) {
  EXPECT_EQ(value.index, expected.index);
  EXPECT_EQ(std::vector<float>(value.floats.begin(), value.floats.end()), expected.floats);
  EXPECT_EQ(value.integer, expected.integer);
  EXPECT_EQ(value.text, expected.text);
  EXPECT_EQ(value.texture, expected.texture);
}

TEST(ParameterValues, HoldWhatAMapHolds) {
  std::mt19937 random(1);
  for (int round = 0; round < 100; ++round) {
    ParameterValues values;
    std::map<uint32_t, edit::ParameterT> expected;
    for (int i = 0; i < 60; ++i) {
      edit::ParameterT edit;
      edit.index = random() % 12 == 0 ? ~0u - uint32_t(random() % 3) : uint32_t(random() % 12);
      for (size_t k = random() % 18; k > 0; --k) edit.floats.push_back(float(random()));
      if (random() % 2) edit.integer = int32_t(random());
      if (random() % 2) edit.text = std::string(random() % 10, 'a');
      if (random() % 2) edit.texture = uint32_t(random());
      values.set(valueOf(edit));
      expected[edit.index] = edit;
      auto next = expected.begin();
      for (const ParameterValue& value : values) {
        ASSERT_NE(next, expected.end());
        expectEqual(value, next->second);
        const auto found = values.find(next->first);
        ASSERT_TRUE(found);
        expectEqual(*found, next->second);
        ++next;
      }
      EXPECT_EQ(next, expected.end());
      EXPECT_FALSE(values.find(1000));
    }
  }
}

TEST(ParameterValues, KeepTheBitsOfNumbers) {
  const float numbers[] = {-0.0f, std::nanf("7"), INFINITY};
  ParameterValues values;
  values.set({.index = 3, .floats = numbers});
  const auto found = values.find(3);
  ASSERT_TRUE(found);
  EXPECT_TRUE(std::signbit(found->floats[0]));
  EXPECT_TRUE(std::isnan(found->floats[1]));
  EXPECT_EQ(found->floats[2], INFINITY);
}

TEST(ParameterValues, AreEmptyAgainWhenTheyAreCleared) {
  ParameterValues values;
  EXPECT_EQ(values.begin(), values.end());
  values.set({.index = 1, .integer = 5});
  EXPECT_NE(values.begin(), values.end());
  values.clear();
  EXPECT_EQ(values.begin(), values.end());
  EXPECT_FALSE(values.find(1));
}

} // namespace
} // namespace openrt

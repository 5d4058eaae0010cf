// xvrml_node_map.cpp: NodeMap against std::map, under random inserts and erases.
#include <map>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "xvrml/node_map.h"
#include "xvrml/walk.h"

using namespace xvrml;

namespace {

// Returns addresses that are used as keys only. step: small steps collide often.
std::vector<const Node*> keys(size_t count, uintptr_t step) {
  std::vector<const Node*> list;
  for (size_t i = 1; i <= count; ++i) list.push_back(reinterpret_cast<const Node*>(i * step));
  return list;
}

TEST(NodeMap, HoldsWhatAMapHolds) {
  for (const uintptr_t step : {uintptr_t(8), uintptr_t(112), uintptr_t(1) << 40}) {
    const std::vector<const Node*> all = keys(500, step);
    NodeMap<int> map;
    std::map<const Node*, int> expected;
    std::mt19937 random(1);
    for (int i = 0; i < 20'000; ++i) {
      const Node* node = all[random() % all.size()];
      if (random() % 3 == 0) {
        map.erase(node);
        expected.erase(node);
      } else {
        const auto [value, fresh] = map.insert(node, i);
        const auto [known, isNew] = expected.emplace(node, i);
        EXPECT_EQ(fresh, isNew);
        EXPECT_EQ(*value, known->second);
      }
      ASSERT_EQ(map.size(), expected.size());
    }
    for (const Node* node : all) {
      const int* value = map.find(node);
      ASSERT_EQ(value != nullptr, expected.contains(node));
      if (value) { EXPECT_EQ(*value, expected[node]); }
    }
  }
}

TEST(NodeMap, AnEmptyMapFindsNothing) {
  NodeMap<int> map;
  EXPECT_EQ(map.find(nullptr), nullptr);
  EXPECT_FALSE(map.contains(keys(1, 16)[0]));
  map.erase(keys(1, 16)[0]);
  EXPECT_EQ(map.size(), 0u);
}

TEST(NodeMap, RoomIsMadeAtOnceAndKeepsWhatIsThere) {
  const std::vector<const Node*> all = keys(100, 8);
  NodeMap<int> map;
  map.insert(all[0], 7);
  map.reserve(all.size());
  for (size_t i = 1; i < all.size(); ++i) map.insert(all[i], int(i));
  map.reserve(2); // there is room
  EXPECT_EQ(map.size(), all.size());
  EXPECT_EQ(*map.find(all[0]), 7);
  EXPECT_EQ(*map.find(all[99]), 99);
}

TEST(SeenNodes, TellsWhetherANodeIsNew) {
  SeenNodes seen;
  for (const Node* node : keys(100, 16)) {
    EXPECT_TRUE(seen.insert(node));
    EXPECT_FALSE(seen.insert(node));
    EXPECT_TRUE(seen.contains(node));
  }
}

} // namespace

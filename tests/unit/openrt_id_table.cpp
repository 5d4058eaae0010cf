// openrt_id_table.cpp: IdTable against std::map, under random inserts and erases.
#include <map>
#include <random>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "scene/id_table.h"

namespace openrt {
namespace {

template <class T>
void expectEqual(const IdTable<T>& table, const std::map<uint32_t, T>& expected) {
  ASSERT_EQ(table.size(), expected.size());
  auto next = expected.begin();
  for (const auto& [id, value] : table) {
    ASSERT_NE(next, expected.end());
    EXPECT_EQ(id, next->first);
    EXPECT_EQ(value, next->second);
    ++next;
  }
  EXPECT_EQ(next, expected.end());
}

TEST(IdTable, HoldsWhatAMapHolds) {
  for (const uint32_t spread : {1u, 700u, 8'000'000u}) {
    IdTable<std::string> table;
    std::map<uint32_t, std::string> expected;
    std::mt19937 random(1);
    for (int i = 0; i < 5000; ++i) {
      const uint32_t id = uint32_t(random() % 300) * spread;
      if (random() % 3 == 0) {
        table.erase(id);
        expected.erase(id);
      } else {
        const std::string value = std::to_string(i);
        EXPECT_EQ(table.try_emplace(id, value).second, expected.try_emplace(id, value).second);
        EXPECT_EQ(table.find(id)->second, expected[id]);
      }
    }
    expectEqual(table, expected);
    for (uint32_t i = 0; i < 300; ++i) {
      EXPECT_EQ(table.contains(i * spread), expected.contains(i * spread));
      EXPECT_EQ(table.find(i * spread) == table.end(), !expected.contains(i * spread));
    }
  }
}

TEST(IdTable, ValuesKeepTheirAddresses) {
  IdTable<int> table;
  int& first = table[1];
  first = 7;
  for (uint32_t id = 2; id < 10'000; ++id) table[id] = int(id);
  EXPECT_EQ(&table[1], &first);
  EXPECT_EQ(first, 7);
}

TEST(IdTable, AReusedEntryBeginsAnew) {
  IdTable<int> table;
  table[5] = 3;
  table.erase(5);
  EXPECT_EQ(table[6], 0);
  EXPECT_THROW(table.at(5), std::out_of_range);
}

TEST(IdTable, TheLargestIdIsAnId) {
  IdTable<int> table;
  table[~0u] = 1;
  expectEqual(table, {{~0u, 1}});
}

} // namespace
} // namespace openrt

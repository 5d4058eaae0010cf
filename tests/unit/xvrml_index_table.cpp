// xvrml_index_table.cpp: the hash table of numbers against std::multimap, also with equal hashes.
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "base/index_table.h"

namespace xvrml {
namespace {

TEST(IndexTable, FindsWhatWasInsertedAndNotErased) {
  std::mt19937_64 random(7);
  IndexTable table;
  std::multimap<uint64_t, uint32_t> expected;
  const auto holds = [&](uint64_t hash, uint32_t number) {
    return table.find(hash, [&](uint32_t found) { return found == number; }) == number;
  };
  EXPECT_EQ(table.find(1, [](uint32_t) { return true; }), IndexTable::none);
  for (uint32_t step = 0; step < 20000; ++step) {
    // Few hashes, which fall together near the end of the table, too.
    const uint64_t hash = (random() % 50 == 0 ? ~uint64_t(0) : random() % 300) << 32;
    if (random() % 5 < 3) {
      table.insert(hash, step);
      expected.emplace(hash, step);
    } else if (const auto found = expected.find(hash); found != expected.end()) {
      table.erase(hash, found->second);
      EXPECT_FALSE(holds(hash, found->second));
      expected.erase(found);
    } else {
      table.erase(hash, step); // nothing happens
    }
    EXPECT_EQ(table.size(), expected.size());
  }
  for (const auto& [hash, number] : expected) EXPECT_TRUE(holds(hash, number)) << number;
}

} // namespace
} // namespace xvrml

// picture_worker_facts.cpp: the table of the facts of a worker has all members of RTworker, and
// each name once.
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <set>
#include <string>
#include <type_traits>

#include "libpicture/worker_facts.h"

namespace {

// Members of RTworker have no gap between them, so that none is missing in the table.
TEST(WorkerFacts, everyMemberHasARow) {
  const RTworker worker{};
  const auto at = [&](const auto& member) {
    return size_t(reinterpret_cast<const char*>(&member) - reinterpret_cast<const char*>(&worker));
  };
  struct Place {
    size_t size, alignment;
  };
  // These have no row, or a row that converts them.
  std::map<size_t, Place> places = {
      {at(worker.size), {sizeof worker.size, alignof(size_t)}},
      {at(worker.name), {sizeof worker.name, 1}},
      {at(worker.alive), {sizeof worker.alive, alignof(int)}},
  };
  picture::forEachWorkerFact([&](const picture::WorkerFact&, auto get) {
    if constexpr (std::is_member_pointer_v<decltype(get)>) {
      const auto& member = worker.*get;
      places[at(member)] = {sizeof member, alignof(std::decay_t<decltype(member)>)};
    }
  });
  const auto aligned = [](size_t end, size_t to) { return (end + to - 1) / to * to; };
  size_t end = 0;
  for (const auto& [begin, place] : places) {
    EXPECT_EQ(begin, aligned(end, place.alignment)) << "a member before this one is missing";
    end = begin + place.size;
  }
  EXPECT_EQ(aligned(end, alignof(RTworker)), sizeof(RTworker)) << "the last member is missing";
}

TEST(WorkerFacts, namesAreUnique) {
  std::set<std::string> attributes, keys;
  picture::forEachWorkerFact([&](const picture::WorkerFact& fact, auto) {
    EXPECT_TRUE(attributes.insert(fact.attribute).second) << fact.attribute;
    EXPECT_TRUE(keys.insert(fact.key).second) << fact.key;
  });
  EXPECT_TRUE(attributes.count("tiles") && keys.count("tiles")) << "the key is the attribute";
  EXPECT_TRUE(attributes.count("busy_seconds") && keys.count("busy")) << "or another word";
}

} // namespace

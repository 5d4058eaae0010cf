// openrt_hit_counts.cpp: Tests counts of the names that samples hit, against counts by a map.
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "render/film/hit_counts.h"

using namespace openrt;

namespace {

using Samples = std::vector<std::pair<uint32_t, uint32_t>>; // pixel and name

HitCounts countsOf(const Samples& samples) {
  HitCounts counts;
  for (const auto& [pixel, name] : samples) counts.add(pixel, name);
  counts.finish();
  return counts;
}

std::vector<HitCount> listOf(const HitCounts& counts) {
  return {counts.all().begin(), counts.all().end()};
}

std::vector<HitCount> expected(const Samples& samples) {
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> times;
  for (const auto& sample : samples)
    if (sample.second > 0) times[sample]++;
  std::map<uint32_t, uint32_t> names;
  std::vector<HitCount> list;
  for (const auto& [sample, n] : times)
    if (names[sample.first]++ < HitCounts::mostNames)
      list.push_back({sample.first, sample.second, n});
  return list;
}

Samples samplesOf(uint32_t pixels, uint32_t names, int count, uint32_t seed) {
  std::mt19937 random(seed);
  Samples samples;
  for (int i = 0; i < count; i++)
    samples.emplace_back(uint32_t(random() % pixels), uint32_t(random() % names));
  return samples;
}

} // namespace

TEST(HitCounts, SamplesAreCountedByPixelAndName) {
  EXPECT_TRUE(countsOf({}).empty());
  EXPECT_TRUE(countsOf({{3, 0}}).empty()) << "0 is no name";
  EXPECT_EQ(listOf(countsOf({{1, 7}, {0, 9}, {1, 7}, {1, 2}, {0, 9}})),
            (std::vector<HitCount>{{0, 9, 2}, {1, 2, 1}, {1, 7, 2}}));
}

// Also of pixels with more names than are counted.
TEST(HitCounts, TheOrderOfMergesDoesNotMatter) {
  for (const uint32_t names : {3u, 20u, 90u, 400u}) {
    const Samples samples = samplesOf(5, names, 3000, names);
    const std::vector<HitCount> wanted = expected(samples);
    std::mt19937 random(names);
    for (int round = 0; round < 10; round++) {
      std::vector<HitCounts> parts;
      for (size_t at = 0; at < samples.size();) {
        const size_t end = std::min<size_t>(at + 1 + random() % 700, samples.size());
        parts.push_back(countsOf(
            {samples.begin() + std::ptrdiff_t(at), samples.begin() + std::ptrdiff_t(end)}));
        at = end;
      }
      while (parts.size() > 1) {
        const size_t from = random() % parts.size();
        HitCounts part = std::move(parts[from]);
        parts.erase(parts.begin() + std::ptrdiff_t(from));
        parts[random() % parts.size()].merge(part);
      }
      ASSERT_EQ(listOf(parts[0]), wanted) << names;
    }
  }
}

TEST(HitCounts, WhatCannotBeCountsIsRefused) {
  HitCounts counts;
  EXPECT_TRUE(counts.assign({}, 0));
  EXPECT_TRUE(counts.assign({{0, 1, 1}, {0, 2, 1}, {3, 1, 9}}, 4));
  for (const std::vector<HitCount>& wrong :
       std::initializer_list<std::vector<HitCount>>{{{4, 1, 1}},            // beyond the tile
                                                    {{0, 0, 1}},            // nothing was hit
                                                    {{0, 1, 0}},            // by no sample
                                                    {{0, 1, 1}, {0, 1, 1}}, // twice
                                                    {{0, 2, 1}, {0, 1, 1}}, // not sorted
                                                    {{1, 1, 1}, {0, 1, 1}}})
    EXPECT_FALSE(counts.assign(wrong, 4));
  std::vector<HitCount> many;
  for (uint32_t i = 0; i <= HitCounts::mostNames; i++) many.push_back({0, i + 1, 1});
  EXPECT_FALSE(counts.assign(many, 4));
  EXPECT_EQ(counts.all().size(), 3u) << "what was refused changes nothing";
}

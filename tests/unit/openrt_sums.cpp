// openrt_sums.cpp: sums of samples that are merged block by block: their values, and that these do
// not depend on how the samples were divided.
#include <cmath>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include "render/film/sums.h"

namespace openrt {
namespace {

constexpr RequiredSums everything{.spread = true,
                                  .error = true,
                                  .firstValues = placesOf(ChannelSource::firstSample),
                                  .valueSums = placesOf(ChannelSource::mean)};
using Samples = std::vector<std::array<float, 3>>;

// The first sample is darker than all others, so that the sums of differences from it have one
// sign.
Samples samplesOf(uint32_t count, uint32_t seed) {
  std::mt19937 random(seed);
  std::lognormal_distribution<float> value(0, 1);
  Samples samples(count, {.01f, .02f, .03f});
  for (uint32_t s = 1; s < count; s++)
    for (float& x : samples[s]) x = .1f + value(random);
  return samples;
}

void add(PixelSums& sums, const std::array<float, 3>& sample) {
  sums.add(sample.data(), sample[0]);
  sums.addTails(sample.data());
  for (size_t k = 0; k < std::size(sums.valueSums); k++)
    sums.valueSums[k] += k % 2 ? 1 - sample[k % 3] : sample[k % 3];
}

// Sums a leaf as the wavefront does.
SumBlock leafOf(const Samples& samples, uint32_t first, uint32_t count,
                const Replicates& replicates) {
  SumBlock block{first, count, std::vector<PixelSums>(1), {}};
  for (uint32_t s = first; s < first + count; s++) {
    add(block.sums[0], samples[s]);
    if (replicates.many() && replicates.indexOf(s + 1) == 0 && s + 1 - first >= replicates.size())
      block.sums[0].closeReplicate();
  }
  block.ledger.samples = count;
  block.ledger.clipped = double(samples[first][0]);
  return block;
}

std::vector<SumBlock> leavesOf(const Samples& samples, const Replicates& replicates) {
  std::vector<SumBlock> leaves;
  const auto all = uint32_t(samples.size());
  for (uint32_t s = 0; s < all;) {
    const uint32_t end = leafEnd(s, all, all);
    leaves.push_back(leafOf(samples, s, end - s, replicates));
    s = end;
  }
  return leaves;
}

SumBlock mergedInOrder(std::vector<SumBlock> blocks, const Replicates& replicates) {
  TileSums tile;
  for (SumBlock& block : blocks) {
    tile.join(block, everything, replicates);
    tile.keep(block, everything);
  }
  SumBlock out;
  EXPECT_NE(tile.fold(nullptr, out, everything, replicates), nullptr);
  return out;
}

void expectNear(const double* got, const double* expected, const char* what) {
  for (int k = 0; k < 3; k++)
    EXPECT_NEAR(got[k], expected[k], 1e-12 * std::fabs(expected[k])) << what << " " << k;
}

TEST(Sums, LeavesHaveTheBordersOfProgressiveRounds) {
  std::vector<uint32_t> ends;
  for (uint32_t s = 0; s < 100;) ends.push_back(s = leafEnd(s, 100, 100));
  EXPECT_EQ(ends, (std::vector<uint32_t>{1, 2, 4, 8, 16, 32, 64, 96, 100}));
  EXPECT_EQ(leafEnd(0, 31, 31), 31u);
  EXPECT_EQ(leafEnd(12, 65536, 65536), 16u);
}

TEST(Sums, BlocksAreAlignedPowersOfTwoOrAll) {
  for (const uint32_t samples : {1u, 31u, 32u, 33u, 100u, 128u, 4097u})
    for (const uint32_t largest : {1u, 32u, 50u, 64u, 1000u, ~0u})
      for (uint32_t s = 0, count; s < samples; s += count) {
        count = blockFrom(s, samples, largest);
        ASSERT_GT(count, 0u);
        ASSERT_LE(s + count, samples);
        if (s == 0 && count == samples) continue;
        EXPECT_TRUE(s + count == samples || count >= 32);
        if (s + count < samples || count >= 32) {
          EXPECT_TRUE(std::has_single_bit(count));
          EXPECT_EQ(s % count, 0u);
          EXPECT_LE(count, std::max(largest, 32u));
        }
      }
}

TEST(Sums, MergedAreThoseOfAllSamplesAtOnce) {
  for (const uint32_t count : {32u, 33u, 72u, 128u, 500u})
    for (uint32_t shift = 0; shift <= 8; shift++) {
      if ((1u << shift) > count) continue;
      const Replicates replicates{0, shift};
      const Samples samples = samplesOf(count, 7 * count + shift);
      PixelSums direct;
      for (uint32_t s = 0; s < count; s++) {
        add(direct, samples[s]);
        if (replicates.indexOf(s + 1) == 0) direct.closeReplicate();
      }
      const PixelSums merged = mergedInOrder(leavesOf(samples, replicates), replicates).sums[0];
      EXPECT_EQ(merged.samples, count);
      EXPECT_EQ(merged.replicates, count >> shift);
      expectNear(merged.rgba, direct.rgba, "rgba");
      expectNear(merged.valueSums, direct.valueSums, "values");
      for (int k = 0; k < 3; k++) {
        EXPECT_EQ(merged.first[k], direct.first[k]);
        EXPECT_EQ(merged.largest[k], direct.largest[k]);
      }
      expectNear(merged.delta, direct.delta, "delta");
      expectNear(merged.delta2, direct.delta2, "delta2");
      expectNear(merged.closed, direct.closed, "closed");
      expectNear(merged.closed2, direct.closed2, "closed2");
      expectNear(merged.closed3, direct.closed3, "closed3");
      expectNear(merged.closed4, direct.closed4, "closed4");
      expectNear(merged.grey, direct.grey, "grey");
    }
}

TEST(Sums, AnyOrderOfBlocksGivesTheSameBytes) {
  std::mt19937 random(3);
  for (const uint32_t shift : {0u, 3u, 5u, 7u, 31u}) {
    const Replicates replicates{0, shift};
    const std::vector<SumBlock> leaves = leavesOf(samplesOf(712, 5), replicates);
    const SumBlock expected = mergedInOrder(leaves, replicates);
    for (int i = 0; i < 20; i++) {
      std::vector<SumBlock> blocks = leaves;
      std::shuffle(blocks.begin(), blocks.end(), random);
      const SumBlock got = mergedInOrder(blocks, replicates);
      ASSERT_EQ(std::memcmp(&got.sums[0], &expected.sums[0], sizeof(PixelSums)), 0);
      ASSERT_EQ(got.ledger.clipped, expected.ledger.clipped);
      ASSERT_EQ(got.ledger.samples, 712u);
    }
  }
}

// Exactly zero, because that identifies constant pixels.
TEST(Sums, EqualSamplesHaveNoVariance) {
  const Samples samples(256, {.3f, .7f, .1f});
  const PixelSums merged = mergedInOrder(leavesOf(samples, {0, 4}), {0, 4}).sums[0];
  for (int k = 0; k < 3; k++) EXPECT_EQ(merged.delta2[k], 0);
  EXPECT_EQ(merged.grey[2], 0);
}

TEST(Sums, AGapEndsWhatCanBeShown) {
  const std::vector<SumBlock> leaves = leavesOf(samplesOf(128, 1), {});
  TileSums tile;
  SumBlock out;
  for (size_t i : {size_t(1), size_t(4), size_t(7)}) tile.keep(leaves[i], everything);
  EXPECT_EQ(tile.reach(nullptr), 0u);
  EXPECT_EQ(tile.fold(nullptr, out, everything, {}), nullptr);
  EXPECT_EQ(tile.reach(&leaves[0]), 2u);
  ASSERT_NE(tile.fold(&leaves[0], out, everything, {}), nullptr);
  EXPECT_EQ(out.sums[0].samples, 2u);
}

} // namespace
} // namespace openrt

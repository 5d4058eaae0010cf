// window_job_cuts.cpp: Tests how --jobs cuts a sequence, and the commands that it writes.
#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "run/job_cuts.h"

namespace vv {
namespace {

using Pieces = std::vector<std::pair<size_t, size_t>>;

std::vector<long long> numbers(size_t count, long long first = 0) {
  std::vector<long long> all(count);
  std::iota(all.begin(), all.end(), first);
  return all;
}

double costOf(const SequenceCosts& costs, const std::vector<long long>& frames,
              const std::pair<size_t, size_t>& piece) {
  double cost = costs.start + costs.step * double(frames[piece.second]);
  for (size_t i = piece.first; i <= piece.second; ++i) cost += costs.frames[i];
  return cost;
}

TEST(JobCuts, EqualFramesMakeEqualJobs) {
  const SequenceCosts costs{1, 0, std::vector<double>(12, 2.0)};
  EXPECT_EQ(cutIntoJobs(costs, numbers(12), 4), (Pieces{{0, 2}, {3, 5}, {6, 8}, {9, 11}}));
  EXPECT_EQ(cutIntoJobs(costs, numbers(12), 1), (Pieces{{0, 11}}));
  EXPECT_EQ(cutIntoJobs(costs, numbers(12), 99).size(), 12u);
  EXPECT_TRUE(cutIntoJobs(costs, {}, 3).empty());
}

TEST(JobCuts, JobsCoverAllFramesOnceAndCostAboutTheSame) {
  SequenceCosts costs{3, .01, {}};
  for (int i = 0; i < 1000; ++i) costs.frames.push_back(i < 500 ? 1 : 5); // the second half is dear
  const auto frames = numbers(1000, 40);
  const Pieces pieces = cutIntoJobs(costs, frames, 10);
  ASSERT_EQ(pieces.size(), 10u);
  size_t next = 0;
  double least = 1e9, most = 0;
  for (const auto& piece : pieces) {
    EXPECT_EQ(piece.first, next);
    next = piece.second + 1;
    const double cost = costOf(costs, frames, piece);
    if (piece.second != 999) least = std::min(least, cost); // the last one gets what is left
    most = std::max(most, cost);
  }
  EXPECT_EQ(next, 1000u);
  EXPECT_LT(most - least, 6); // a frame, and the steps before it
}

TEST(JobCuts, WorldsThatAreDearToStepGetLongerJobsInTheBeginning) {
  const SequenceCosts costs{0, 1, std::vector<double>(100, 1.0)};
  const Pieces pieces = cutIntoJobs(costs, numbers(100), 4);
  EXPECT_GT(pieces.front().second - pieces.front().first,
            2 * (pieces.back().second - pieces.back().first));
}

// A job of previews draws a block of frames that are not its own before, from a block's beginning.
TEST(JobCuts, BlocksAreNotCut) {
  SequenceCosts costs{1, 0, std::vector<double>(40, 1.0)};
  costs.block = costs.history = 8;
  const auto frames = numbers(40, 4); // 4 to 43: six blocks, the first and the last one shorter
  const Pieces pieces = cutIntoJobs(costs, frames, 3);
  ASSERT_EQ(pieces.size(), 3u);
  EXPECT_EQ(pieces.front().first, 0u);
  EXPECT_EQ(pieces.back().second, 39u);
  for (size_t i = 1; i < pieces.size(); ++i) {
    EXPECT_EQ(pieces[i].first, pieces[i - 1].second + 1);
    EXPECT_EQ(frames[pieces[i].first] % 8, 0);
    EXPECT_LE(pieces[i].second - pieces[i].first + 1, 16u);
  }
  EXPECT_EQ(cutIntoJobs(costs, frames, 99).size(), 6u);
  costs.history = 1000; // nothing is gained
  EXPECT_EQ(cutIntoJobs(costs, frames, 1), (Pieces{{0, 39}}));
}

TEST(JobCuts, CommandsAreReadBackByAShell) {
  const std::vector<std::string> words{"vv", "my world.wrl",    "--frames", "0-99",    "--jobs=4",
                                       "-o", "f-{frame:4}.png", "-D",       "A.b='c'", "--jobs",
                                       "4"};
  FrameRange range;
  range.first = 10;
  range.last = 30;
  range.step = 2;
  EXPECT_EQ(jobCommand(words, range),
            R"(vv 'my world.wrl' -o 'f-{frame:4}.png' -D 'A.b='\''c'\''' --frames 10-30/2)");
  EXPECT_EQ(jobCommand({"vv", "--jobs", "2", "-o", "a.gif", "--", "--frames"}, range),
            "vv -o a.gif --frames 10-30/2 -- --frames")
      << "words after -- are files";
}

} // namespace
} // namespace vv

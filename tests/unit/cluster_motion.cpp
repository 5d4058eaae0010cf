// cluster_motion.cpp: a worker that joins at any frame, or lags behind, finds the same motion
// (RT_MOTION) as one that was there from the beginning.
#include "backend/cluster/master/scene_log.h"
#include "unit/moving_scene.h"

namespace openrt::cluster {
namespace {

using namespace openrt::test;

class ClusterMotion : public testing::TestWithParam<std::vector<int>> { // views of the frames
 protected:
  void SetUp() override {
    commits_ = movingCommits(true, GetParam());
    FramePlayer player;
    for (const auto& commit : commits_) expected_.push_back(player.render(commit));
  }
  // Brings a worker from the scene of epoch `has` (0: none) to that of `wanted`.
  static void bring(FramePlayer& worker, SceneLog& log, Epoch has, Epoch wanted) {
    const std::vector<SceneLog::Step> steps = log.steps(has, wanted);
    ASSERT_FALSE(steps.empty());
    EXPECT_EQ(steps.back().epoch, wanted);
    EXPECT_EQ(steps.front().whole, has == 0);
    for (const SceneLog::Step& step : steps) worker.apply(step.parcel->commit);
  }
  bool shows(FramePlayer& worker, Epoch frame) const {
    return sameBytes(worker.render(), expected_[frame - 1]);
  }
  Commits commits_;
  std::vector<std::vector<float>> expected_;
};

TEST_P(ClusterMotion, IsThatOfAWorkerThatWasThereFromTheBeginning) {
  FramePlayer shaders;
  for (const bool trimmed : {false, true}) {
    SceneLog log(&shaders.shaders());
    for (Epoch frame = 1; frame <= commits_.size(); frame++) {
      log.add(frame, commits_[frame - 1]);
      log.settle(frame);
      if (trimmed) log.trim(frame);
      FramePlayer worker;
      bring(worker, log, 0, frame);
      EXPECT_TRUE(shows(worker, frame)) << "joined at frame " << frame;
    }
  }
}

TEST_P(ClusterMotion, IsTheSameWhileFramesOverlap) {
  FramePlayer shaders;
  SceneLog log(&shaders.shaders());
  for (Epoch frame = 1; frame <= commits_.size(); frame++) log.add(frame, commits_[frame - 1]);
  for (Epoch first = 1; first <= commits_.size(); first++) {
    log.settle(first); // the oldest unfinished frame
    for (Epoch frame = first; frame <= commits_.size(); frame++) {
      FramePlayer worker;
      bring(worker, log, 0, frame);
      EXPECT_TRUE(shows(worker, frame)) << first << " " << frame;
    }
  }
}

TEST_P(ClusterMotion, IsTheSameForAWorkerThatSkipsFrames) {
  FramePlayer shaders;
  SceneLog log(&shaders.shaders());
  FramePlayer worker;
  Epoch has = 0;
  for (Epoch frame = 1; frame <= commits_.size(); frame++) {
    log.add(frame, commits_[frame - 1]);
    log.settle(frame);
    if (frame % 3 == 2) continue;
    bring(worker, log, has, frame);
    has = frame;
    EXPECT_TRUE(shows(worker, frame)) << frame;
  }
}

INSTANTIATE_TEST_SUITE_P(Views, ClusterMotion,
                         testing::Values(std::vector<int>{}, std::vector<int>{0, 1, 0, 1, 0, 1, 0},
                                         std::vector<int>{0, 3, 3, 0, 7, 3, 7}));

} // namespace
} // namespace openrt::cluster

// openrt_motion.cpp: RT_MOTION follows from the commits: any number of threads, a recording and a
// backend that skips frames find the same bytes. What is not asked for is not kept.
#include <filesystem>

#include <unistd.h>

#include "backend/record/reader.h"
#include "render/motion.h"
#include "scene/history.h"
#include "unit/moving_scene.h"

namespace openrt {
namespace {

using namespace openrt::test;
namespace fs = std::filesystem;
using Pictures = std::vector<std::vector<float>>;

Pictures picturesOf(const Commits& commits, uint32_t threads = 1) {
  FramePlayer player(threads);
  Pictures pictures;
  for (const auto& commit : commits) pictures.push_back(player.render(commit));
  return pictures;
}

TEST(Motion, HasTheSameBytesOnAnyNumberOfThreads) {
  for (const bool follow : {false, true}) {
    const Commits commits = movingCommits(follow);
    const Pictures expected = picturesOf(commits);
    for (size_t i = 1; i < expected.size(); i++)
      EXPECT_FALSE(sameBytes(expected[i], expected[i - 1])) << i;
    for (const uint32_t threads : {2u, 5u}) {
      const Pictures got = picturesOf(commits, threads);
      for (size_t i = 0; i < got.size(); i++) EXPECT_TRUE(sameBytes(got[i], expected[i])) << i;
    }
  }
}

TEST(Motion, HasTheSameBytesInARecording) {
  const Commits commits = movingCommits(true);
  const Pictures expected = picturesOf(commits);
  const fs::path path = fs::temp_directory_path() / ("openrt_motion_" + std::to_string(::getpid()));
  BackendOptions options;
  options.file = path.string();
  const std::unique_ptr<Backend> recorder = makeRecordBackend(options);
  for (const auto& commit : commits) recorder->apply(commit);
  recorder->finish();
  FramePlayer player;
  const std::unique_ptr<RecordingReader> reader = openRecording(path.string(), &player.shaders());
  size_t frames = 0;
  while (const std::shared_ptr<const Commit> commit = reader->next()) {
    ASSERT_LT(frames, expected.size());
    EXPECT_TRUE(sameBytes(player.render(commit), expected[frames])) << frames;
    frames++;
  }
  EXPECT_EQ(frames, expected.size());
  fs::remove(path);
}

TEST(Motion, HasTheSameBytesIfFramesAreSkipped) {
  const Commits commits = movingCommits(true);
  const Pictures expected = picturesOf(commits);
  for (unsigned rendered = 0; rendered < 1u << movingFrames; rendered += 3) { // as bits
    FramePlayer player;
    for (size_t i = 0; i < commits.size(); i++) {
      player.apply(commits[i]);
      if ((rendered >> i & 1) == 0) continue;
      EXPECT_TRUE(sameBytes(player.render(), expected[i])) << i << " of " << rendered;
    }
  }
}

// Applies the commits and returns whether the history has anything after each of them.
std::vector<bool> watched(const Commits& commits) {
  Scene scene;
  SceneHistory history;
  std::vector<bool> any;
  for (const auto& commit : commits) {
    scene.apply(*commit, &history);
    any.push_back(history.any());
  }
  return any;
}

TEST(Motion, KeepsNothingThatIsNotAskedFor) {
  const auto frames = [](uint32_t channels) {
    return drawn([channels] {
      set({.channels = channels});
      drawMovingFrames();
    });
  };
  EXPECT_EQ(watched(frames(RT_RGBA | RT_POSITION)), std::vector<bool>(movingFrames, false));
  std::vector<bool> all(movingFrames, true);
  all.back() = false; // nothing has changed
  EXPECT_EQ(watched(frames(RT_RGBA | RT_MOTION)), all);
}

TEST(Motion, OfRestingScenesHasNoRecords) {
  ShaderRegistry shaders(shaderFolders(""));
  BackendOptions options;
  options.threads = 1;
  options.shaders = &shaders;
  LocalBackend backend(options);
  const Commits commits = movingCommits(false);
  std::vector<size_t> moved;
  for (const auto& commit : commits) {
    backend.apply(commit);
    const auto scene = backend.prepared();
    EXPECT_EQ(scene, backend.prepared()) << "a second call makes no other snapshot";
    moved.push_back(scene->motions ? scene->motions->moved.size() + scene->motions->allNew : 0);
  }
  EXPECT_EQ(moved.front(), 1u) << "all is new";
  EXPECT_GT(moved[1], 0u);
  EXPECT_EQ(moved.back(), 0u);
}

} // namespace
} // namespace openrt

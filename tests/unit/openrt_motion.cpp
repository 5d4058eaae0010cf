// openrt_motion.cpp: RT_MOTION follows from the commits: any number of threads, a recording and a
// backend that skips frames find the same bytes. Motion that is not asked for is not kept.
#include <filesystem>
#include <memory>

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

// Returns the same changes of the scene without the frames of other views.
Commits framesOf(int view, const std::vector<int>& views) {
  Commits commits = movingCommits(true, views);
  for (size_t i = 0; i < views.size(); i++) {
    if (views[i] == view) continue;
    edit::EditsT& edits = std::const_pointer_cast<Commit>(commits[i])->edits;
    edits.render = false;
    std::erase_if(edits.edits, [](const auto& edit) { return edit->any.AsFrameSettings(); });
  }
  return commits;
}

// Frames of other views do not change what a view sees.
TEST(Motion, OfAViewIsThatSinceItsOwnLastFrame) {
  const std::vector<std::vector<int>> turns = {
      {1, 2, 1, 2, 1, 2, 1}, {1, 1, 2, 2, 1, 2, 1}, {1, 2, 3, 1, 2, 3, 1}, {2, 1, 2, 2, 3, 2, 1}};
  for (const std::vector<int>& views : turns) {
    const Pictures seen = picturesOf(movingCommits(true, views));
    for (const int view : {1, 2, 3}) {
      FramePlayer alone;
      const Commits commits = framesOf(view, views);
      for (size_t i = 0; i < views.size(); i++) {
        alone.apply(commits[i]);
        if (views[i] != view) continue;
        EXPECT_TRUE(sameBytes(seen[i], alone.render())) << "view " << view << ", frame " << i;
      }
    }
  }
}

// Returns after how many frames of view 1, in each of which something moves, view 0 begins anew.
// channels: of the first frame of view 0.
uint64_t framesUntilForgotten(uint32_t channels) {
  for (uint64_t between = 1; between < 100; between++) {
    const Commits commits = drawn([&] {
      set({.channels = channels});
      rtBindShader(colored("Diffuse", nullptr, {}));
      const RTid ball = rtBeginObject(0);
      rtSphere(.3f);
      rtEndObject();
      const RTid moving = rtInstantiateObject(ball);
      lookFrom(0, 1, 6);
      rtRender();
      set({.channels = RT_RGBA | RT_MOTION});
      for (uint64_t i = 0; i <= between; i++) {
        const double matrix[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, double(i + 1), 0, 0, 1};
        rtInstanceMatrix(moving, matrix);
        rtQuality(RT_VIEW, i < between);
        rtRender();
      }
    });
    Scene scene;
    SceneHistory history;
    for (const auto& commit : commits) scene.apply(*commit, &history);
    if (history.view().beginning()) return between;
  }
  return 0;
}

TEST(Motion, OfAViewThatWasNotDrawnForLongBeginsAnew) {
  EXPECT_EQ(framesUntilForgotten(RT_RGBA | RT_MOTION), maxFramesBetween);
  EXPECT_EQ(framesUntilForgotten(RT_RGBA), 1u) << "what moved meanwhile was not noted";
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

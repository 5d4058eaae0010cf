// openrt_frame_work.cpp: a frame's jobs done by hand: in any order, in chunks of any size, given
// back, done twice, or sent as bytes. The picture always has the same bytes as the local backend's.
#include <cstring>
#include <map>
#include <numeric>
#include <random>

#include "render/frame/job_runner.h"
#include "render/frame/result_codec.h"
#include "unit/drawn_scene.h"

namespace openrt {
namespace {

using test::Room;
using test::Settings;

using Picture = std::map<uint32_t, std::vector<float>>; // by channel

Picture pictureOf(const FrameWork& work, const edit::FrameSettingsT& frame) {
  Picture picture;
  for (uint32_t channel = 1; channel <= allChannels; channel <<= 1) {
    if (!(frame.channels & channel)) continue;
    std::vector<float>& plane = picture[channel];
    plane.resize(size_t(frame.width) * frame.height * channelComponents(channel));
    EXPECT_TRUE(work.film().read(channel, plane));
  }
  return picture;
}

bool sameBytes(const Picture& a, const Picture& b) {
  if (a.size() != b.size()) return false;
  for (const auto& [channel, plane] : a) {
    const std::vector<float>& other = b.at(channel);
    if (plane.size() != other.size() ||
        std::memcmp(plane.data(), other.data(), plane.size() * sizeof(float)) != 0)
      return false;
  }
  return true;
}

const std::atomic<bool> never{false};

struct JobOrder {    // how the jobs are done
  uint32_t seed = 0; // 0: in order, one job after the other
  uint32_t atOnce = 20;
  bool progressive = false;
};

// Runs a frame to its end.
class Player {
 public:
  Player(const std::shared_ptr<const RenderScene>& scene, const JobOrder& way)
      : frame_(scene->frame), way_(way), random_(way.seed), runner_(scene) {
    frame_.progressive = way.progressive;
    work_ = std::make_unique<FrameWork>(frame_, factsOf(*scene), 3);
    if (way.seed % 2 == 1) {
      std::vector<uint32_t> tiles(work_->tiles());
      std::iota(tiles.begin(), tiles.end(), 0u);
      std::shuffle(tiles.begin(), tiles.end(), random_);
      work_->order(std::move(tiles));
    }
    std::vector<Job> jobs;
    for (;;) {
      Job job;
      FrameWork::Next next = FrameWork::Next::wait;
      if (jobs.size() < (way.seed ? way.atOnce : 1) &&
          (next = work_->next(job, largest())) == FrameWork::Next::job) {
        jobs.push_back(job);
        continue;
      }
      if (next == FrameWork::Next::over) break;
      EXPECT_FALSE(jobs.empty()) << "nothing is out, and nothing to do";
      if (jobs.empty()) break;
      const size_t i = way.seed ? random_() % jobs.size() : 0;
      job = jobs[i];
      jobs.erase(jobs.begin() + std::ptrdiff_t(i));
      done(job);
    }
    EXPECT_TRUE(work_->over());
    EXPECT_EQ(work_->progress(), 1);
    EXPECT_NEAR(work_->undone(), 0, 1e-6);
    work_->describe(stats);
  }
  Picture picture() const { return pictureOf(*work_, frame_); }
  uint32_t jobs() const { return jobs_; }
  RTstats stats{};

 private:
  uint32_t largest() { return way_.seed ? 32u << random_() % 4 : ~0u; }

  void done(const Job& job) {
    jobs_++;
    const uint32_t what = way_.seed ? random_() % 8 : 8;
    if (what == 0) return work_->giveBack(job);
    JobResult result;
    EXPECT_TRUE(runner_.run(job, never, result));
    if (what == 1) { // lost, given back, and then the result arrives after all
      work_->giveBack(job);
      if (random_() % 2) work_->giveBack(job);
    }
    if (what == 2) { // the result was sent by another machine
      JobResult far;
      const Tile tile = job.kind == Job::Kind::samples ? work_->tile(job.number) : Tile{};
      EXPECT_TRUE(decodeResult(frame_, job, tile, encodeResult(frame_, job, result), far));
      result = std::move(far);
    }
    JobResult again = result;
    EXPECT_TRUE(work_->take(job, std::move(result)));
    if (what < 4) {
      EXPECT_FALSE(work_->take(job, std::move(again))); // the same job twice
    }
    if (what == 4) work_->giveBack(job);
  }

  edit::FrameSettingsT frame_;
  const JobOrder way_;
  std::mt19937 random_;
  JobRunner runner_;
  std::unique_ptr<FrameWork> work_;
  uint32_t jobs_ = 0;
};

void expectTheSameInEveryWay(const Settings& settings, uint32_t ways = 3) {
  Room room(settings);
  const Player plain(room.scene(), {});
  const Picture expected = plain.picture();
  for (uint32_t seed = 1; seed <= ways; seed++)
    for (const bool progressive : {false, true}) {
      const Player played(room.scene(),
                          {.seed = seed, .atOnce = 4 * seed * seed, .progressive = progressive});
      EXPECT_TRUE(sameBytes(played.picture(), expected))
          << "way " << seed << (progressive ? ", progressive" : "");
      EXPECT_EQ(played.stats.leftOut.cutByDepth, plain.stats.leftOut.cutByDepth);
      EXPECT_EQ(played.stats.error.mean, plain.stats.error.mean);
    }
  for (const uint32_t threads : {1, 2, 5}) {
    Room other(settings, threads);
    other.backend().start();
    other.backend().wait();
    for (const auto& [channel, plane] : expected) {
      std::vector<float> got(plane.size());
      ASSERT_TRUE(other.backend().read(channel, got));
      EXPECT_EQ(std::memcmp(got.data(), plane.data(), plane.size() * sizeof(float)), 0)
          << "channel " << channel << ", " << threads << " threads";
    }
  }
}

TEST(FrameWorkByHand, SamplesInAnyPieces) {
  for (const int samples : {1, 31, 32, 100, 256}) expectTheSameInEveryWay({.samples = samples}, 2);
}

TEST(FrameWorkByHand, TilesOfAnySize) {
  for (const int tile : {4, 7, 16, 50, 128})
    expectTheSameInEveryWay(
        {.samples = 40, .width = 53, .height = 20, .tile = tile, .channels = RT_RGBA | RT_VARIANCE},
        1);
}

TEST(FrameWorkByHand, AWaveHoldsAtLeastASampleOfTheLargestTile) {
  expectTheSameInEveryWay(
      {.samples = 2, .transport = RT_TRANSPORT_DIRECT, .width = 140, .height = 130, .tile = 128},
      1);
}

TEST(FrameWorkByHand, AllChannels) {
  expectTheSameInEveryWay({.samples = 200, .channels = allChannels});
}

TEST(FrameWorkByHand, Replicates) {
  expectTheSameInEveryWay({.samples = 300, .channels = allChannels, .replicates = 3});
}

TEST(FrameWorkByHand, Pilots) {
  expectTheSameInEveryWay(
      {.samples = 1024, .width = 34, .height = 20, .channels = allChannels, .targetError = .15});
}

TEST(FrameWorkByHand, PathsFromLamps) {
  expectTheSameInEveryWay({.samples = 130, .transport = RT_TRANSPORT_LIGHT, .channels = RT_RGBA});
  expectTheSameInEveryWay({.samples = 256,
                           .transport = RT_TRANSPORT_LIGHT,
                           .channels = allChannels,
                           .targetError = .3});
}

// More time would otherwise not make caustics better. The limit is never reached: the samples end
// the frame.
TEST(FrameWorkByHand, UnderATimeLimitPathsFromLampsAreAsManyAsSamples) {
  for (const int samples : {32, 512}) {
    Room room({.samples = samples,
               .transport = RT_TRANSPORT_LIGHT,
               .channels = RT_RGBA | RT_ERROR | RT_TRUST | RT_SAMPLES,
               .timeLimit = 600});
    const edit::FrameSettingsT& frame = room.scene()->frame;
    const double pixels = double(frame.width) * frame.height;
    FrameWork work(frame, factsOf(*room.scene()), 1);
    JobRunner runner(room.scene());
    double paths = 0;
    Job job;
    while (work.next(job) == FrameWork::Next::job) {
      JobResult result;
      ASSERT_TRUE(runner.run(job, never, result));
      if (job.kind == Job::Kind::light) paths += job.count;
      ASSERT_TRUE(work.take(job, std::move(result)));
    }
    EXPECT_TRUE(work.over());
    const Picture picture = pictureOf(work, frame);
    for (const float n : picture.at(RT_SAMPLES)) EXPECT_EQ(n, float(samples));
    // Whole parts of 2048 paths, and at least sixteen of them.
    EXPECT_GE(paths, std::max(double(samples) * pixels - 2048, 16 * 2048.0));
    EXPECT_LE(paths, std::max(double(samples) * pixels + 2048, 16 * 2048.0));
  }
}

// The error of light paths falls with the root of their number (docs/error-bars.md).
TEST(FrameWorkByHand, TheNumberOfPathsFromLampsFollowsATargetBelowFivePercent) {
  for (const auto& [target, perPixel] :
       {std::pair{.1, 64.}, {.05, 64.}, {.025, 256.}, {.01, 1600.}}) {
    Room room({.samples = 4096, .transport = RT_TRANSPORT_LIGHT, .targetError = target});
    const edit::FrameSettingsT& frame = room.scene()->frame;
    const double pixels = double(frame.width) * frame.height;
    FrameWork work(frame, factsOf(*room.scene()), 1);
    double paths = 0;
    Job job; // jobs of light come first
    while (work.next(job) == FrameWork::Next::job && job.kind == Job::Kind::light)
      paths += job.count;
    EXPECT_NEAR(paths, perPixel * pixels, 16) << target;
  }
}

TEST(FrameWorkByHand, FourHundredPicturesOfOnePixel) {
  Room room({.samples = 64, .width = 1, .height = 1, .channels = allChannels}, 5);
  const Picture expected = Player(room.scene(), {}).picture();
  for (uint32_t i = 0; i < 400; i++) {
    Picture got = expected;
    if (i % 2) {
      got = Player(room.scene(), {.seed = i}).picture();
    } else {
      room.backend().start();
      room.backend().wait();
      for (auto& [channel, plane] : got) {
        std::fill(plane.begin(), plane.end(), -1.0f);
        ASSERT_TRUE(room.backend().read(channel, plane));
      }
    }
    ASSERT_TRUE(sameBytes(got, expected)) << i;
  }
}

TEST(FrameWorkByHand, ASinglePixelIsWorkForMany) {
  Room room({.samples = 512, .width = 1, .height = 1});
  FrameWork work(room.scene()->frame, factsOf(*room.scene()), 8);
  Job job;
  for (uint32_t i = 0; i < 8; i++) {
    ASSERT_EQ(work.next(job, 64), FrameWork::Next::job);
    EXPECT_EQ(job.count, 64u);
    EXPECT_EQ(job.first, 64 * i);
  }
  EXPECT_EQ(work.next(job, 64), FrameWork::Next::wait);
}

TEST(FrameWorkByHand, TilesComeInTheOrderThatIsAskedFor) {
  const Room room(Settings{.samples = 64, .tile = 8});
  const auto scene = room.scene();
  FrameWork work(scene->frame, factsOf(*scene), 1);
  std::vector<uint32_t> tiles(work.tiles());
  std::iota(tiles.rbegin(), tiles.rend(), 0u);
  work.order(tiles);
  Job job;
  for (const uint32_t tile : tiles)
    for (const uint32_t first : {0u, 32u}) {
      EXPECT_EQ(work.upcoming(), tile);
      ASSERT_EQ(work.next(job, 32), FrameWork::Next::job);
      EXPECT_EQ(job.number, tile);
      EXPECT_EQ(job.first, first);
    }
  EXPECT_EQ(work.upcoming(), work.tiles());
  work.giveBack(job);
  EXPECT_EQ(work.upcoming(), work.tiles()); // no tile is next
}

TEST(FrameWorkByHand, RoundsOverlap) {
  Room room({.samples = 64, .width = 40, .height = 40});
  edit::FrameSettingsT frame = room.scene()->frame;
  frame.progressive = true;
  FrameWork work(frame, factsOf(*room.scene()), 2);
  JobRunner runner(room.scene());
  std::vector<Job> jobs(2 * work.tiles() + 1);
  for (uint32_t i = 0; i < 2 * work.tiles(); i++) {
    ASSERT_EQ(work.next(jobs[i]), FrameWork::Next::job);
    EXPECT_EQ(jobs[i].first, i < work.tiles() ? 0u : 1u);
  }
  // No third round before the first is complete.
  EXPECT_EQ(work.next(jobs.back()), FrameWork::Next::wait);
  bool changed = false;
  work.onChange([&] { changed = true; });
  for (uint32_t i = 0; i < work.tiles(); i++) {
    JobResult result;
    runner.run(jobs[i], never, result);
    ASSERT_TRUE(work.take(jobs[i], std::move(result)));
    EXPECT_TRUE(changed);
    changed = false;
    EXPECT_EQ(work.next(jobs.back()) == FrameWork::Next::job, i + 1 == work.tiles());
  }
}

TEST(FrameWorkByHand, CancelledItHoldsWhatIsFinished) {
  Room room({.samples = 4, .width = 64, .height = 64, .channels = RT_RGBA | RT_SAMPLES | RT_ERROR});
  FrameWork work(room.scene()->frame, factsOf(*room.scene()), 2);
  JobRunner runner(room.scene());
  Job first, second;
  ASSERT_EQ(work.next(first), FrameWork::Next::job);
  ASSERT_EQ(work.next(second), FrameWork::Next::job);
  JobResult result;
  runner.run(first, never, result);
  JobResult late = result;
  ASSERT_TRUE(work.take(first, std::move(result)));
  work.cancel();
  EXPECT_TRUE(work.over());
  EXPECT_EQ(work.next(second), FrameWork::Next::over);
  EXPECT_FALSE(work.take(second, std::move(late)));
  std::vector<float> samples(64 * 64);
  ASSERT_TRUE(work.film().read(RT_SAMPLES, samples));
  const Tile tile = work.tile(first.number);
  EXPECT_EQ(samples[tile.y0 * 64 + tile.x0], 4);
  EXPECT_EQ(std::count(samples.begin(), samples.end(), 4.0f), std::ptrdiff_t(tile.pixels()));
}

TEST(FrameWorkByHand, WithoutACameraItIsOver) {
  edit::FrameSettingsT frame;
  frame.width = frame.height = 8;
  frame.channels = RT_RGBA;
  frame.samples = 1;
  FrameWork work(frame, {}, 2);
  Job job;
  EXPECT_EQ(work.next(job), FrameWork::Next::over);
  EXPECT_TRUE(work.over());
}

TEST(FrameWorkByHand, ResultsOfNoJobAreDropped) {
  Room room({.samples = 4});
  FrameWork work(room.scene()->frame, factsOf(*room.scene()), 2);
  Job job;
  ASSERT_EQ(work.next(job), FrameWork::Next::job);
  JobResult small, light;
  small.sums.resize(3);
  EXPECT_FALSE(work.take(job, std::move(small)));
  Job other = job;
  other.number = 100000;
  EXPECT_FALSE(work.take(other, JobResult()));
  other = job;
  other.kind = Job::Kind::light;
  light.light.resize(20 * 18 * 3);
  EXPECT_FALSE(work.take(other, std::move(light)));
  work.giveBack(other);
}

TEST(FrameWorkByHand, JobsThatAFrameDoesNotHaveAreRefused) {
  Room room({.samples = 4});
  JobRunner runner(room.scene());
  JobResult result;
  for (const Job& job :
       {Job{.number = 1000, .count = 1}, Job{.count = 0}, Job{.first = 30, .count = 3},
        Job{.count = ~0u}, Job{.count = 4, .replicates = {0, 40}},
        Job{.kind = Job::Kind::light, .count = 10}})
    EXPECT_THROW(runner.run(job, never, result), std::runtime_error);
}

} // namespace
} // namespace openrt

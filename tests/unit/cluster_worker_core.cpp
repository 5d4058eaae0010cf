// cluster_worker_core.cpp: Tests the executor of a worker: the order in which commits, jobs and
// queries take effect, how it reports failures, and that its pictures equal the local backend's.
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <mutex>

#include "backend/cluster/worker/worker_core.h"
#include "backend/instruction_sets.h"
#include "unit/drawn_scene.h"

namespace openrt::cluster {
namespace {

using test::Commits;

class Sink final : public WorkerSink {
 public:
  struct Report {
    std::string what; // ready, failed or done
    Epoch epoch = 0;
    Lease lease = 0;
  };
  void ready(Epoch epoch, const Prepared& prepared) override {
    const Busy one(*this);
    last = prepared;
    said.push_back({"ready", epoch, 0});
  }
  void failed(Epoch epoch, const std::string& why) override {
    const Busy one(*this);
    said.push_back({"failed", epoch, 0});
    failure = why;
  }
  void done(Epoch epoch, const LeasedJob& job, JobResult&& result) override {
    const Busy one(*this);
    said.push_back({"done", epoch, job.lease});
    if (work) work->take(job.job, std::move(result));
  }

  // Waits until `count` calls have arrived; returns false on a timeout.
  bool wait(size_t count) {
    std::unique_lock lock(mutex);
    return came.wait_for(lock, std::chrono::seconds(60), [&] { return said.size() >= count; });
  }
  std::vector<Report> all() {
    std::lock_guard lock(mutex);
    return said;
  }

  std::mutex mutex;
  std::condition_variable came;
  std::vector<Report> said;
  Prepared last;
  std::string failure;
  FrameWork* work = nullptr;

 private:
  struct Busy { // checks that one call is made at a time
    explicit Busy(Sink& s) : sink(s), lock(s.mutex, std::try_to_lock) {
      if (!lock.owns_lock()) lock.lock(); // keeps calls out while the test reads
    }
    ~Busy() { sink.came.notify_all(); }
    Sink& sink;
    std::unique_lock<std::mutex> lock;
  };
};

class WorkerCoreTest : public testing::Test {
 protected:
  WorkerCoreTest() : shaders(shaderFolders("")) {
    options.threads = 3;
    options.shaders = &shaders;
  }

  // A room, and commits that change it: the camera, and a frame with other settings.
  static Commits commits(const test::Settings& settings) {
    return test::drawn([&] {
      test::drawRoom();
      test::set(settings);
      rtRender();
      test::lookFrom(1, 1, 4);
      rtRender();
    });
  }
  // Renders all of an epoch's frame with this core alone.
  std::vector<float> picture(WorkerCore& core, Epoch epoch, Lease& lease) {
    FrameWork work(sink.last.frame, sink.last.facts, core.threads());
    {
      std::lock_guard lock(sink.mutex);
      sink.work = &work;
    }
    for (;;) {
      const size_t before = sink.all().size();
      std::vector<LeasedJob> jobs;
      LeasedJob next;
      FrameWork::Next what;
      while ((what = work.next(next.job, 32)) == FrameWork::Next::job) {
        next.lease = ++lease;
        jobs.push_back(next);
      }
      if (what == FrameWork::Next::over) break;
      core.work(epoch, jobs);
      if (!sink.wait(before + std::max<size_t>(jobs.size(), 1))) ADD_FAILURE() << "nothing comes";
      if (HasFailure()) break;
    }
    std::lock_guard lock(sink.mutex);
    sink.work = nullptr;
    std::vector<float> rgba(size_t(sink.last.frame.width) * sink.last.frame.height * 4);
    EXPECT_TRUE(work.film().read(RT_RGBA, rgba));
    return rgba;
  }
  std::vector<float> expected(const Commits& all, size_t count) {
    const auto backend = makeLocalBackend(options);
    for (size_t i = 0; i < count; i++) backend->apply(all[i]);
    backend->start();
    backend->wait();
    std::vector<float> rgba(size_t(sink.last.frame.width) * sink.last.frame.height * 4);
    EXPECT_TRUE(backend->read(RT_RGBA, rgba));
    return rgba;
  }

  ShaderRegistry shaders;
  BackendOptions options;
  Sink sink;
};

TEST_F(WorkerCoreTest, ItsPicturesAreThoseOfTheLocalBackend) {
  const Commits all = commits({.samples = 64, .transport = RT_TRANSPORT_AUTO});
  WorkerCore core(options, sink);
  EXPECT_EQ(core.threads(), 3u);
  Lease lease = 0;
  core.scene(1, all[0], true, true);
  ASSERT_TRUE(sink.wait(1));
  EXPECT_EQ(sink.all()[0].what, "ready");
  EXPECT_TRUE(sink.last.facts.camera);
  EXPECT_NE(sink.last.frame.transport, RT_TRANSPORT_AUTO);
  EXPECT_GT(sink.last.stats.scene.triangles, 0u);
  EXPECT_GT(std::strlen(sink.last.stats.machine.isa), 0u);
  EXPECT_EQ(picture(core, 1, lease), expected(all, 1));
  const size_t before = sink.all().size();
  core.scene(2, all[1], false, true);
  ASSERT_TRUE(sink.wait(before + 1));
  EXPECT_EQ(sink.all().back().what, "ready");
  EXPECT_EQ(picture(core, 2, lease), expected(all, 2));
  // After forget(), the first scene again.
  core.scene(3, all[0], true, false);
  core.prepare(3);
  core.prepare(3); // a second call must change nothing
  core.ask([](Backend&) {});
  EXPECT_EQ(sink.all().back().epoch, 3u);
  EXPECT_EQ(picture(core, 3, lease), expected(all, 1));
}

TEST_F(WorkerCoreTest, JobsAreFinishedBeforeTheSceneChanges) {
  const Commits all = commits({.samples = 8, .width = 64, .height = 64});
  WorkerCore core(options, sink);
  core.scene(1, all[0], true, true);
  std::vector<LeasedJob> jobs;
  for (uint32_t i = 0; i < 4; i++) jobs.push_back({i + 1, Job{.number = i, .count = 8}});
  core.work(1, jobs);
  core.scene(2, all[1], false, true);
  core.work(2, std::vector<LeasedJob>{{9, Job{.count = 8}}});
  ASSERT_TRUE(sink.wait(7));
  const auto said = sink.all();
  EXPECT_EQ(said[0].what, "ready");
  for (size_t i = 1; i <= 4; i++) EXPECT_TRUE(said[i].what == "done" && said[i].epoch == 1) << i;
  EXPECT_TRUE(said[5].what == "ready" && said[5].epoch == 2);
  EXPECT_TRUE(said[6].what == "done" && said[6].lease == 9);
}

TEST_F(WorkerCoreTest, DroppedJobsAreNotDone) {
  const Commits all = commits({.samples = 65536, .width = 64, .height = 64});
  WorkerCore core(options, sink);
  core.scene(1, all[0], true, true);
  std::vector<LeasedJob> jobs;
  for (uint32_t i = 0; i < 16; i++)
    jobs.push_back({i + 1, Job{.number = i, .count = 65536}}); // would take hours
  core.work(1, jobs);
  ASSERT_TRUE(sink.wait(1));
  core.drop(1);
  core.scene(2, all[1], false, true);
  ASSERT_TRUE(sink.wait(2));
  EXPECT_EQ(sink.all()[1].what, "ready");
  core.work(2, jobs); // the destructor cancels running jobs
}

TEST_F(WorkerCoreTest, QuestionsSeeWhatWasAskedBefore) {
  const Commits all = commits({.samples = 4});
  WorkerCore core(options, sink);
  core.scene(1, all[0], true, false);
  RThit hit{};
  bool seen = false;
  core.ask([&](Backend& backend) { seen = backend.queries()->pick(10, 16, hit); });
  EXPECT_TRUE(seen);
  EXPECT_GT(hit.t, 0);
  EXPECT_THROW(core.ask([](Backend&) { throw std::runtime_error("no"); }), std::runtime_error);
  EXPECT_TRUE(sink.all().empty());
}

TEST_F(WorkerCoreTest, WholeScenesHaveTheInstructionSetThatWasSet) {
  const Commits all = commits({.samples = 16});
  WorkerCore core(options, sink);
  Epoch epoch = 0;
  Lease lease = 0;
  RTstats stats{};
  core.ask([&](Backend& backend) { backend.stats(stats); });
  const std::string machine = instructionSetsFrom(stats.machine.isa);
  for (const std::string_view name : instructionSets) {
    if (!listsInstructionSet(machine, std::string(name))) continue;
    SCOPED_TRACE(name);
    const size_t before = sink.all().size();
    core.useInstructionSet(std::string(name));
    core.scene(++epoch, all[0], true, true);
    ASSERT_TRUE(sink.wait(before + 1));
    EXPECT_EQ(sink.last.stats.machine.isa, name);
    options.isa = name;
    EXPECT_EQ(picture(core, epoch, lease), expected(all, 1));
  }
}

TEST_F(WorkerCoreTest, AnUnknownInstructionSetFailsTheScene) {
  const Commits all = commits({.samples = 4});
  WorkerCore core(options, sink);
  core.useInstructionSet("mmx");
  core.scene(1, all[0], true, true);
  ASSERT_TRUE(sink.wait(1));
  EXPECT_EQ(sink.all()[0].what, "failed");
  EXPECT_NE(sink.failure.find("isa=mmx: expected auto, or one that this machine has: "),
            std::string::npos)
      << sink.failure;
}

TEST_F(WorkerCoreTest, FailuresAreSaid) {
  const Commits all = commits({.samples = 4});
  WorkerCore core(options, sink);
  // The core does not have the scene of this job.
  core.work(7, std::vector<LeasedJob>{{1, Job{.count = 4}}, {2, Job{.count = 4}}});
  ASSERT_TRUE(sink.wait(1));
  core.scene(8, all[0], true, true);
  core.work(8, std::vector<LeasedJob>{{3, Job{.number = 10000, .count = 4}}});
  ASSERT_TRUE(sink.wait(3));
  const auto said = sink.all();
  ASSERT_EQ(said.size(), 3u);
  EXPECT_TRUE(said[0].what == "failed" && said[0].epoch == 7);
  EXPECT_EQ(said[1].what, "ready");
  EXPECT_TRUE(said[2].what == "failed" && said[2].epoch == 8);
  EXPECT_NE(sink.failure.find("a job that this frame does not have"), std::string::npos);
}

TEST_F(WorkerCoreTest, EndsWithWorkInItsQueue) {
  const Commits all = commits({.samples = 65536, .width = 64, .height = 64});
  for (int i = 0; i < 20; i++) {
    WorkerCore core(options, sink);
    core.scene(1, all[0], true, true);
    std::vector<LeasedJob> jobs(8, {1, Job{.count = 65536}});
    core.work(1, jobs);
  }
}

} // namespace
} // namespace openrt::cluster

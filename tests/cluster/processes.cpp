// processes.cpp: pictures rendered with real worker processes on loopback. They have the same bytes
// as with one thread, whichever workers help, whenever they join and however they end.
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>

#include <unistd.h>

#include "cluster/support.h"
#include "drawing.h"
#include "openrt/query.h"

namespace {

using namespace cluster_test;

using Workers = std::vector<std::unique_ptr<Worker>>;

Workers start(int count) {
  Workers workers;
  for (int i = 0; i < count; i++) workers.push_back(std::make_unique<Worker>());
  return workers;
}

// Waits until this many workers have joined.
void join(uint32_t count) {
  EXPECT_TRUE(until([&] { return statistics().cluster.workers >= count; }))
      << statistics().cluster.workers << " of " << count << " workers";
}

uint64_t jobsOf(const std::vector<RTworker>& workers) {
  uint64_t jobs = 0;
  for (const RTworker& worker : workers) jobs += worker.jobs;
  return jobs;
}

TEST(ClusterProcesses, AnyNumberOfWorkersMakesTheSameBytes) {
  for (const FrameOptions& look :
       {FrameOptions{}, FrameOptions{.samples = 70, .transport = RT_TRANSPORT_AUTO}}) {
    const Picture one = expected(look);
    for (int count = 0; count <= 3; count++) {
      SCOPED_TRACE(count);
      const Workers helping = start(count);
      const Context context(
          "backend=cluster threads=1 " +
          (count ? workersOption(helping) : "listen=127.0.0.1:" + std::to_string(freePort())));
      World world;
      world.look(look);
      join(uint32_t(count));
      rtRender();
      EXPECT_EQ(different(pixels(look), one), 0u);
      const RTstats stats = statistics();
      EXPECT_EQ(stats.cluster.workers, uint32_t(count));
      EXPECT_EQ(stats.machine.threads, uint32_t(count) + 1);
      EXPECT_EQ(jobsOf(workers()), stats.cluster.tilesLocal + stats.cluster.tilesRemote);
    }
  }
}

// Adds a body of surfaces without facets to the scene.
void addReflector() {
  const double terms[] = {.02, -.001}, sphere[] = {1, 1, 1, 0, 0, 0, 0, 0, 0, -.3},
               low[] = {-.5, -.2, -.5}, high[] = {.5, .5, .5};
  const RTid reflector = rtBeginObject(0);
  rtAsphere(.5, -1, 2, terms, .2, .9);
  rtQuadric(sphere, low, high);
  rtEndObject();
  rtPushMatrix();
  rtLoadIdentity();
  rtTranslated(-2, 1.2, -1);
  rtRotated(-50, 1, 0, 0);
  rtInstantiateObject(reflector);
  rtPopMatrix();
}

TEST(ClusterProcesses, SurfacesWithoutFacetsHaveTheSameBytes) {
  const FrameOptions look;
  Picture one;
  {
    const Context alone("threads=1");
    const World world;
    addReflector();
    rtRender();
    one = pixels(look);
  }
  EXPECT_GT(different(one, expected(look)), 0u) << "they are in the picture";
  const Workers helping = start(2);
  const Context context("backend=cluster threads=1 " + workersOption(helping));
  const World world;
  addReflector();
  join(2);
  rtRender();
  EXPECT_EQ(different(pixels(look), one), 0u);
}

// Every machine traces the photons that guide paths (photon_guide.h).
TEST(ClusterProcesses, GuidedPathsAreTheSameOnAllMachines) {
  const FrameOptions look{.samples = 32};
  const auto render = [&] {
    drawing::drawRoom();
    rtFrameBuffer(look.width, look.height, look.channels);
    rtQuality(RT_SAMPLES_PER_PIXEL, look.samples);
    rtQuality(RT_TRANSPORT, look.transport);
    rtRender();
    return pixels(look);
  };
  Picture one;
  {
    const Context context("threads=1");
    one = render();
    EXPECT_NE(std::strstr(statistics().transport.reason, ", guided"), nullptr)
        << statistics().transport.reason;
  }
  const Workers helping = start(2);
  const Context context("backend=cluster threads=1 " + workersOption(helping));
  join(2);
  EXPECT_EQ(different(render(), one), 0u);
  EXPECT_GT(statistics().cluster.tilesRemote, 0u);
}

// The second worker joins between frames, and gets the scene of the frame before.
TEST(ClusterProcesses, MotionIsTheSameOnAllMachines) {
  const FrameOptions look{.channels = RT_RGBA | RT_POSITION | RT_NAME | RT_MOTION};
  constexpr double times[] = {0, .3, .7, .7, 1.4, 2};
  std::vector<Picture> expected;
  const auto renderFrames = [&](const std::function<void(size_t frame)>& before,
                                const std::function<void(size_t frame)>& after) {
    World world;
    world.look(look);
    for (size_t i = 0; i < std::size(times); i++) {
      before(i);
      if (i > 0) world.move(times[i]);
      rtRender();
      after(i);
    }
  };
  {
    const Context context("threads=1");
    renderFrames([](size_t) {}, [&](size_t) { expected.push_back(pixels(look)); });
  }
  const Workers helping = start(2);
  helping[1]->kill();
  const Context context("backend=cluster local=0 " + workersOption(helping));
  renderFrames(
      [&](size_t frame) {
        if (frame == 2) helping[1]->start();
        join(frame < 2 ? 1 : 2);
      },
      [&](size_t frame) { EXPECT_EQ(different(pixels(look), expected[frame]), 0u) << frame; });
}

TEST(ClusterProcesses, WithoutThreadsOfItsOwnTheMasterLeavesAllToTheWorkers) {
  const Workers helping = start(2);
  const Context context("backend=cluster local=0 " + workersOption(helping));
  World world;
  for (const double time : {0.0, .5}) {
    if (time > 0) world.move(time);
    rtRender();
    EXPECT_EQ(different(pixels({}), expected({}, time)), 0u);
  }
  const RTstats stats = statistics();
  EXPECT_EQ(stats.cluster.tilesLocal, 0u);
  EXPECT_GT(stats.cluster.tilesRemote, 0u);
  EXPECT_GT(stats.cluster.bytesSent, 10000u);
  EXPECT_GT(stats.cluster.bytesReceived, 10000u);
}

TEST(ClusterProcesses, WorkersUseTheInstructionSetOfTheMaster) {
  const Workers helping = start(1);
  int tried = 0;
  for (const char* isa : {"avx512", "avx2", "avx", "sse4.2", "sse2", "neon"}) {
    SCOPED_TRACE(isa);
    const std::string option = std::string(" isa=") + isa;
    const RTcontext probe = rtNewContext(option.c_str());
    rtGetError();
    if (!probe) continue; // not on this machine
    rtDeleteContext(probe);
    tried++;
    const auto picture = [](const std::string& config, uint32_t workers) {
      const Context context(config);
      World world;
      join(workers);
      rtRender();
      EXPECT_EQ(statistics().cluster.workers, workers);
      return pixels({});
    };
    const Picture one = picture("threads=1" + option, 0);
    EXPECT_EQ(different(picture("threads=3" + option, 0), one), 0u);
    EXPECT_EQ(
        different(picture("backend=cluster local=0 " + workersOption(helping) + option, 1), one),
        0u);
  }
  EXPECT_GT(tried, 0);
}

// Settings for a frame that takes longer than the test waits without workers, but not much longer.
FrameOptions longer() {
  return {.width = 120, .height = 90, .samples = 256, .channels = RT_RGBA | RT_ERROR | RT_SAMPLES};
}

TEST(ClusterProcesses, WhoJoinsInMidFrameHelps) {
  const Picture one = expected(longer());
  const int port = freePort();
  const Context context("backend=cluster threads=1 listen=127.0.0.1:" + std::to_string(port));
  World world;
  world.look(longer());
  rtSwapBuffers();
  ASSERT_TRUE(until([&] { return rtProgress(context.handle) > .05f; }));
  Worker late({"--connect", "127.0.0.1:" + std::to_string(port)});
  EXPECT_EQ(rtFinishFrame(), 1);
  EXPECT_EQ(different(pixels(longer()), one), 0u);
  EXPECT_GT(statistics().cluster.tilesRemote, 0u);
}

TEST(ClusterProcesses, AWorkerThatIsKilledInMidFrameIsMadeUpFor) {
  const Picture one = expected(longer());
  for (int victims : {1, 3}) {
    SCOPED_TRACE(victims);
    Workers helping = start(3);
    Context context("backend=cluster threads=1 local=" + std::string(victims == 1 ? "0 " : "1 ") +
                    workersOption(helping));
    World world;
    world.look(longer());
    join(3);
    rtSwapBuffers();
    ASSERT_TRUE(until([&] { return rtProgress(context.handle) > .1f; }));
    for (int i = 0; i < victims; i++) helping[size_t(i)]->kill();
    EXPECT_EQ(rtFinishFrame(), 1);
    EXPECT_EQ(different(pixels(longer()), one), 0u);
    EXPECT_EQ(statistics().cluster.workers, uint32_t(3 - victims));
    EXPECT_EQ(context.said("all workers have left"), victims == 3);
  }
}

TEST(ClusterProcesses, AllGoneAndNoThreadsOfItsOwnTheMasterFinishesAllTheSame) {
  const Picture one = expected(longer());
  Workers helping = start(2);
  Context context("backend=cluster local=0 threads=1 " + workersOption(helping));
  World world;
  world.look(longer());
  rtSwapBuffers();
  ASSERT_TRUE(until([&] { return rtProgress(context.handle) > .1f; }));
  for (auto& worker : helping) worker->kill();
  EXPECT_EQ(rtFinishFrame(), 1);
  EXPECT_EQ(different(pixels(longer()), one), 0u);
  EXPECT_TRUE(context.said("all workers have left"));
  EXPECT_GT(statistics().cluster.tilesLocal, 0u);
}

TEST(ClusterProcesses, NobodyToCallIsNoReasonToFail) {
  Context context("backend=cluster local=0 threads=1 workers=127.0.0.1:" +
                  std::to_string(freePort()));
  World world;
  rtRender();
  EXPECT_EQ(different(pixels({}), expected({})), 0u);
  EXPECT_TRUE(context.said("no worker"));
}

TEST(ClusterProcesses, AWorkerThatIsStoppedIsLeftOutUntilItGoesOn) {
  const Picture one = expected(longer());
  Workers helping = start(2);
  const Context context("backend=cluster threads=1 " + workersOption(helping));
  World world;
  world.look(longer());
  join(2);
  rtSwapBuffers();
  ASSERT_TRUE(until([&] { return rtProgress(context.handle) > .05f; }));
  helping[0]->signal(SIGSTOP);
  EXPECT_EQ(rtFinishFrame(), 1);
  EXPECT_EQ(different(pixels(longer()), one), 0u);
  ASSERT_TRUE(until([&] { return statistics().cluster.workers == 1; }));
  helping[0]->signal(SIGCONT);
  join(2);
  rtRender();
  EXPECT_EQ(different(pixels(longer()), one), 0u);
}

TEST(ClusterProcesses, AnAnimationIsTheSameFrameByFrame) {
  constexpr int frames = 100;
  const FrameOptions look{
      .width = 32, .height = 24, .samples = 2, .channels = RT_RGBA | RT_DEPTH | RT_NAME};
  std::vector<Picture> alone;
  {
    const Context context("threads=1");
    World world;
    world.look(look);
    for (int i = 0; i < frames; i++) {
      world.move(.1 * i);
      rtRender();
      alone.push_back(pixels(look));
    }
  }
  for (const char* how : {"split=auto", "split=frames", "split=samples local=0"}) {
    SCOPED_TRACE(how);
    Workers helping = start(2);
    const Context context("backend=cluster threads=1 " + workersOption(helping) + " " + how);
    World world;
    world.look(look);
    rtQuality(RT_FRAMES_IN_FLIGHT, 4);
    uint64_t seen = 0;
    const auto compare = [&] {
      const uint64_t number = statistics().frame;
      if (number == seen) return;
      seen = number;
      EXPECT_EQ(different(pixels(look), alone[size_t(number - 1)]), 0u) << "frame " << number;
    };
    for (int i = 0; i < frames; i++) {
      world.move(.1 * i);
      rtSwapBuffers();
      compare();
      if (i == 40) helping[0]->kill();
      if (i == 60) helping[0]->start();
    }
    while (rtFinishFrame()) compare();
    EXPECT_EQ(seen, uint64_t(frames));
  }
}

TEST(ClusterProcesses, ACancelledFrameEndsAndTheNextIsRight) {
  const Workers helping = start(2);
  const Context context("backend=cluster threads=1 " + workersOption(helping));
  World world;
  world.look({.width = 800, .height = 600, .samples = 4096, .channels = RT_RGBA});
  join(2);
  rtSwapBuffers();
  ASSERT_TRUE(until([&] { return rtProgress(context.handle) > 0; }));
  rtCancel(context.handle);
  EXPECT_EQ(rtFinishFrame(), 1);
  world.look({});
  rtRender();
  EXPECT_EQ(different(pixels({}), expected({})), 0u);
}

TEST(ClusterProcesses, RaysAreAskedAboutTheLastScene) {
  const Workers helping = start(1);
  RThit hits[2][3];
  uint32_t counts[2][2];
  std::vector<RThit> lists[2];
  RTclosest closest[2];
  for (int i = 0; i < 2; i++) {
    const Context context(i == 0 ? "threads=1"
                                 : "backend=cluster threads=1 local=0 " + workersOption(helping));
    World world;
    rtSwapBuffers();
    world.move(1.3);
    rtSwapBuffers(); // in flight, perhaps together with the one before
    const RTray rays[2] = {{{0, 0, 6}, 0, {0, -.1f, -1}, INFINITY},
                           {{-2.5f, 9, 0}, 0, {0, -1, 0}, INFINITY}};
    rtCastRays(2, rays, hits[i]);
    EXPECT_EQ(rtPick(30, 22, &hits[i][2]), 1);
    uint8_t occluded[2];
    rtOccludedRays(2, rays, occluded);
    EXPECT_TRUE(occluded[0] && occluded[1]);
    rtCountHits(2, rays, counts[i]);
    const size_t first[3] = {0, counts[i][0], size_t(counts[i][0]) + counts[i][1]};
    lists[i].resize(first[2]);
    rtListHits(2, rays, first, lists[i].data());
    const float points[3] = {0, 0, 6};
    rtClosestPoints(1, points, INFINITY, &closest[i]);
  }
  EXPECT_TRUE(counts[0][0] > 1 && counts[0][0] == counts[1][0] && counts[0][1] == counts[1][1]);
  ASSERT_EQ(lists[0].size(), lists[1].size());
  for (size_t k = 0; k < lists[0].size(); k++) EXPECT_EQ(lists[0][k].t, lists[1][k].t);
  EXPECT_TRUE(std::isfinite(closest[0].distance) && closest[0].distance == closest[1].distance);
  for (int k = 0; k < 3; k++) {
    EXPECT_EQ(hits[0][k].t, hits[1][k].t);
    EXPECT_EQ(hits[0][k].instance, hits[1][k].instance);
    EXPECT_EQ(hits[0][k].name, hits[1][k].name);
  }
}

TEST(ClusterProcesses, ARecordingBesideIsThatOfTheSameScene) {
  const auto file = std::filesystem::temp_directory_path() /
                    ("openrt_cluster_" + std::to_string(getpid()) + ".ortr");
  const auto alone = file.string() + "2";
  {
    const Workers helping = start(1);
    const Context context("backend=cluster threads=1 record=" + file.string() + " " +
                          workersOption(helping));
    World world;
    rtRender();
    EXPECT_EQ(different(pixels({}), expected({})), 0u);
  }
  {
    const Context context("backend=record file=" + alone);
    World world;
    rtRender();
  }
  const auto bytes = [](const std::filesystem::path& path) {
    return std::filesystem::file_size(path);
  };
  EXPECT_EQ(bytes(file), bytes(alone));
  std::filesystem::remove(file);
  std::filesystem::remove(alone);
}

TEST(ClusterProcesses, RequiredWorkersThatAreMissingAreAnError) {
  const Context context("backend=cluster threads=1 require=2 workers=127.0.0.1:" +
                        std::to_string(freePort()));
  World world;
  rtSwapBuffers();
  // The error also ends a frame that is only polled.
  EXPECT_TRUE(until([&] { return rtProgress(context.handle) == 1; }));
  rtFinishFrame();
  EXPECT_EQ(rtGetError(), RTenum(RT_CLUSTER_ERROR));
  EXPECT_NE(std::string(rtGetErrorMessage()).find("2 workers are needed, there are 0"),
            std::string::npos)
      << rtGetErrorMessage();
}

TEST(ClusterConfig, WhatCannotWorkIsSaidAtOnce) {
  for (const char* config :
       {"backend=cluster workers=@/nonexistent/hosts", "backend=cluster workers=203.0.113.9",
        "backend=cluster listen=0.0.0.0", "backend=cluster workers=127.0.0.1 key=/nonexistent/key",
        "backend=cluster workers=127.0.0.1 allow=/nonexistent/list"}) {
    EXPECT_EQ(rtNewContext(config), nullptr) << config;
    EXPECT_EQ(rtGetError(), RTenum(RT_CLUSTER_ERROR)) << config << ": " << rtGetErrorMessage();
  }
  rtNewContext("backend=cluster workers=203.0.113.9");
  rtGetError();
  EXPECT_NE(std::string(rtGetErrorMessage()).find("--new-key"), std::string::npos)
      << rtGetErrorMessage();
}

} // namespace

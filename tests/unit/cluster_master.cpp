// cluster_master.cpp: tests the master against fake workers that speak the protocol and compute
// their samples by a formula. Each link delivers in order, but the links take turns at random.
// Workers are lost, join late, stall, send everything twice or send garbage. The picture must
// always have the same bytes. Time is a number and randomness has a seed.
// Longer than 500 lines because the tests share one rig.
#include <cstring>
#include <deque>
#include <random>

#include <gtest/gtest.h>

#include "backend/cluster/master/hosts.h"
#include "backend/cluster/master/master.h"
#include "backend/cluster/net/greeting.h"
#include "backend/record/edits_bytes.h"
#include "backend/record/validator.h"
#include "render/frame/result_codec.h"
#include "scene/scene.h"

namespace {

using namespace openrt;
using namespace openrt::cluster;

message::Hello greeting() {
  message::Hello hello;
  hello.library = "0.1.0";
  hello.isa = "avx2";
  hello.kernel = "Embree 3";
  hello.platform = "glibc 2.36";
  hello.api = 1;
  hello.shaderAbi = 0x10002;
  hello.threads = 2;
  hello.host = "somewhere";
  return hello;
}

// Returns the result of a job: a formula of pixel, sample and seed.
JobResult samplesOf(const edit::FrameSettingsT& frame, const Job& job, const Tile& tile) {
  JobResult result;
  startSums(result.sums, size_t(tile.x1 - tile.x0) * (tile.y1 - tile.y0), requiredSums(frame));
  size_t at = 0;
  for (uint32_t y = tile.y0; y < tile.y1; y++)
    for (uint32_t x = tile.x0; x < tile.x1; x++, at++)
      for (uint32_t s = job.first; s < job.first + job.count; s++) {
        const uint32_t h = (x * 73856093u ^ y * 19349663u ^ s * 83492791u ^
                            job.replicates.seedOf(s) * 2654435761u) *
                           2246822519u;
        const float radiance[3] = {float(h >> 8) * 0x1p-24f, float(h & 0xffff) / 65536,
                                   float(frame.seed)};
        result.sums[at].addColor(radiance, 1);
      }
  result.counters.camera = result.sums.size() * job.count;
  result.ledger.samples = job.count;
  result.seconds = .001 * job.count;
  return result;
}

// A worker as the protocol sees it: it keeps the scene and a queue of jobs.
struct FakeWorker {
  Peer peer = 0;
  uint64_t session = 0;
  std::deque<Frames> toMaster, toWorker;
  std::deque<std::pair<Epoch, LeasedJob>> jobs;
  std::map<Hash, ArrayPtr> arrays;
  std::set<Hash> asked;
  std::map<Hash, std::pair<uint64_t, std::vector<std::byte>>> arriving;
  std::deque<message::Scene> scenes; // received and not yet applied
  Scene scene;
  std::unique_ptr<CommitValidator> validator = std::make_unique<CommitValidator>(nullptr);
  Epoch epoch = 0;
  std::map<Epoch, edit::FrameSettingsT> frames;
  bool gone = false, still = false, twice = false, nonsense = false, cut = false;
  std::string refused, isa; // isa: what the master has told it to use
  uint64_t arrayBytes = 0;  // bytes of arrays received

  void say(message::Body&& body) {
    Frames frames = encode(session, std::move(body));
    if (twice && session != 0) toMaster.push_back(frames);
    toMaster.push_back(std::move(frames));
  }
  void hear(Frames&& frames) {
    Message message;
    ASSERT_EQ(decode(std::move(frames), message), "");
    if (const auto* welcome = std::get_if<message::Welcome>(&message.body)) {
      session = welcome->session;
      isa = welcome->isa;
    }
    ASSERT_EQ(message.session, session);
    if (auto* given = std::get_if<message::Scene>(&message.body)) {
      message::Need need;
      need.epoch = given->epoch;
      for (const auto& name : given->arrays)
        if (!arrays.contains(name.hash) && asked.insert(name.hash).second)
          need.arrays.push_back(name.hash);
      scenes.push_back(std::move(*given));
      // Sending this message twice would be a protocol error.
      const bool wasTwice = std::exchange(twice, false);
      say(std::move(need));
      twice = wasTwice;
    }
    if (auto* piece = std::get_if<message::Piece>(&message.body)) {
      auto& [bytes, packed] = arriving[piece->hash];
      ASSERT_EQ(packed.size(), piece->offset);
      packed.insert(packed.end(), piece->data.begin(), piece->data.end());
      if (packed.size() == piece->stored) {
        const ArrayPtr array = unpackArray(packed, piece->bytes, piece->hash);
        ASSERT_TRUE(array);
        ASSERT_TRUE(arrays.emplace(piece->hash, array).second) << "an array came twice";
        arrayBytes += array->size();
        arriving.erase(piece->hash);
      }
    }
    if (const auto* prepare = std::get_if<message::Prepare>(&message.body)) ready(prepare->epoch);
    if (auto* given = std::get_if<message::Jobs>(&message.body))
      for (const LeasedJob& job : given->jobs) jobs.emplace_back(given->epoch, job);
    if (const auto* drop = std::get_if<message::Drop>(&message.body))
      std::erase_if(jobs, [&](const auto& job) { return job.first <= drop->epoch; });
    applyScenes();
  }
  void applyScenes() {
    while (!scenes.empty()) {
      const message::Scene& next = scenes.front();
      Commit commit;
      for (const auto& name : next.arrays) {
        if (!arrays.contains(name.hash)) return;
        commit.arrays[name.id] = arrays.at(name.hash);
      }
      unpackEdits(next.edits, commit.edits);
      if (next.whole) {
        scene = Scene();
        validator = std::make_unique<CommitValidator>(nullptr);
      }
      ASSERT_NO_THROW(validator->check(commit));
      scene.apply(commit);
      const Epoch at = next.epoch;
      const bool prepare = next.prepare;
      scenes.pop_front();
      epoch = at;
      if (prepare) ready(at);
    }
  }
  void ready(Epoch at) {
    EXPECT_EQ(at, epoch);
    frames[at] = scene.frame;
    frames[at].transport = RT_TRANSPORT_DIRECT;
    message::Ready ready;
    ready.epoch = at;
    ready.facts.camera = true;
    ready.transport = RT_TRANSPORT_DIRECT;
    ready.stats.scene.triangles = scene.objects.size() + (nonsense ? 1 : 0);
    say(std::move(ready));
  }
  void work() {
    if (jobs.empty()) return;
    const auto [at, job] = jobs.front();
    jobs.pop_front();
    const edit::FrameSettingsT& frame = frames.at(at);
    const FrameWork geometry(frame, FrameFacts{true, false}, 1); // for the sizes of tiles
    const JobResult made = samplesOf(frame, job.job, geometry.tile(job.job.number));
    message::Result result;
    result.epoch = at;
    result.lease = job.lease;
    result.seconds = made.seconds;
    result.camera = made.counters.camera;
    result.bytes = encodeResult(frame, job.job, made);
    if (cut) result.bytes.pop_back();
    say(std::move(result));
  }
};

class ClusterMaster : public testing::TestWithParam<int> {
 protected:
  std::mt19937 random{unsigned(GetParam())};
  size_t below(size_t n) { return random() % n; }

  void SetUp() override { make(); }
  void make(uint32_t require = 0) {
    MasterOptions options;
    options.self = greeting();
    options.self.isas = "avx2, sse2";
    options.require = require;
    options.local.log = [](int, const char* text, void* user) {
      static_cast<std::vector<std::string>*>(user)->push_back(text);
    };
    options.local.logUser = &log;
    mergeQueue.clear();
    if (GetParam() > 2) // merge on other threads
      options.results = [this](std::function<void()> heavy, MasterOptions::Then then) {
        mergeQueue.push_back({std::move(heavy), std::move(then)});
      };
    options.close = [this](Peer peer, const std::string& why) {
      worker(peer).refused = why;
      worker(peer).gone = true;
    };
    master = std::make_unique<Master>(
        options, [this](Peer peer, Frames&& frames) { return post(peer, std::move(frames)); },
        nullptr);
  }
  FakeWorker& worker(Peer peer) { return *workers.at(peer - 1); }
  bool post(Peer peer, Frames&& frames) {
    if (worker(peer).gone) return false;
    if (worker(peer).toWorker.size() > 5) return false; // the worker's queue is full
    worker(peer).toWorker.push_back(std::move(frames));
    return true;
  }
  FakeWorker& join(const message::Hello& hello = greeting()) {
    workers.push_back(std::make_unique<FakeWorker>());
    FakeWorker& fresh = *workers.back();
    fresh.peer = Peer(workers.size());
    master->joined(fresh.peer, "link " + std::to_string(fresh.peer), now);
    fresh.say(message::Hello(hello));
    return fresh;
  }
  void lose(FakeWorker& lost) {
    lost.gone = true;
    lost.toMaster.clear();
    lost.toWorker.clear();
    master->left(lost.peer, "silence", now);
  }

  // Makes one random event happen.
  void step() {
    now += .0005 * double(1 + below(4));
    if (!mergeQueue.empty() && below(2)) mergeOne();
    if (workers.empty()) return;
    FakeWorker& any = *workers[below(workers.size())];
    if (any.still) return;
    switch (any.gone ? 3 : below(3)) {
    case 0:
      if (!any.toWorker.empty()) {
        Frames frames = std::move(any.toWorker.front());
        any.toWorker.pop_front();
        any.hear(std::move(frames));
      }
      break;
    case 1:
      if (!any.toMaster.empty()) {
        Frames frames = std::move(any.toMaster.front());
        any.toMaster.pop_front();
        master->message(any.peer, std::move(frames), now);
      }
      break;
    case 2: any.work(); break;
    default: break;
    }
    master->advance(now);
  }

  // Advances a random result by one step: it is merged, or the master is told that it was.
  void mergeOne() {
    const size_t i = below(mergeQueue.size());
    if (mergeQueue[i].first) return std::exchange(mergeQueue[i].first, nullptr)();
    const MasterOptions::Then then = std::move(mergeQueue[i].second);
    mergeQueue.erase(mergeQueue.begin() + ptrdiff_t(i));
    then(now);
  }

  // Returns a scene of a few objects with arrays, and settings.
  std::shared_ptr<Commit> edits(int frame) {
    auto commit = std::make_shared<Commit>();
    const auto add = [&](auto edit) {
      auto entry = std::make_unique<edit::EditT>();
      entry->any.Set(std::move(edit));
      commit->edits.edits.push_back(std::move(entry));
    };
    const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const auto matrix = [&] {
      return std::make_unique<edit::Matrix>(flatbuffers::span<const double, 16>(identity));
    };
    const auto array = [&](ArrayId id, const void* data, size_t bytes) {
      auto made = std::make_shared<Array>(bytes);
      std::memcpy(made->data(), data, bytes);
      commit->arrays[id] = made;
      return id;
    };
    edit::ObjectT object;
    object.id = uint32_t(100 + frame);
    for (int g = 0; g < 2; g++) {
      auto geometry = std::make_unique<edit::GeometryT>();
      geometry->matrix = matrix();
      geometry->width = 1;
      const float points[9] = {0, 0, float(frame / 3), 1, 0, 0,
                               0, 1, float(g)}; // some frames share the same arrays
      const uint32_t corners[3] = {0, 1, 2};
      const auto base = ArrayId(10 * frame + 4 * g + 1);
      geometry->points = array(base, points, sizeof points);
      geometry->indices = array(base + 1, corners, sizeof corners);
      object.geometries.push_back(std::move(geometry));
    }
    add(std::move(object));
    edit::FrameSettingsT settings;
    settings.width = 70;
    settings.height = 37;
    settings.channels = RT_RGBA | RT_SAMPLES;
    settings.samples = frame % 3 == 1 ? 100 : 3;
    settings.depth = 5;
    settings.seed = uint32_t(frame);
    settings.tile = 8;
    add(edit::FrameSettingsT(settings));
    commit->edits.render = true;
    return commit;
  }
  // Returns the picture of a frame rendered without a cluster.
  std::vector<float> alone(int number) {
    edit::FrameSettingsT frame;
    const auto commit = edits(number);
    for (const auto& entry : commit->edits.edits)
      if (const auto* settings = entry->any.AsFrameSettings()) frame = *settings;
    frame.transport = RT_TRANSPORT_DIRECT;
    FrameWork work(frame, FrameFacts{true, false}, 1);
    for (Job job; work.next(job) == FrameWork::Next::job;)
      work.take(job, samplesOf(frame, job, work.tile(job.number)));
    return read(work);
  }
  static std::vector<float> read(const FrameWork& work) {
    std::vector<float> all(70 * 37 * 5);
    EXPECT_TRUE(work.film().read(RT_RGBA, {all.data(), 70 * 37 * 4}));
    EXPECT_TRUE(work.film().read(RT_SAMPLES, {all.data() + 70 * 37 * 4, 70 * 37}));
    return all;
  }
  void expectSame(Epoch epoch) {
    const Master::FrameState state = master->frame(epoch);
    ASSERT_TRUE(state.over && state.work) << state.failure;
    EXPECT_EQ(read(*state.work), alone(int(epoch)));
    master->forget(epoch);
  }
  template <class F> bool runUntil(const F& condition, int steps = 200000) {
    for (int i = 0; i < steps; i++) {
      if (condition()) return true;
      step();
    }
    return condition();
  }
  bool over(Epoch epoch) { return master->frame(epoch).over; }

  double now = 1;
  std::vector<std::string> log;
  std::vector<std::unique_ptr<FakeWorker>> workers;
  // The function is null once the result is in the picture.
  std::vector<std::pair<std::function<void()>, MasterOptions::Then>> mergeQueue;
  std::unique_ptr<Master> master;
};

TEST_P(ClusterMaster, WhateverHappensThePicturesAreTheSame) {
  for (int i = 0; i < 3; i++) join();
  workers[1]->twice = true;
  Epoch committed = 0;
  for (Epoch done = 0; done < 12;) {
    if (committed < 12 && committed < done + 1 + below(3)) {
      committed++;
      master->commit(committed, edits(int(committed)), true, now);
    }
    for (size_t i = 0; i < 40 + below(200); i++) step();
    switch (below(12)) {
    case 0: join().twice = below(2); break;
    case 1:
      if (FakeWorker& any = *workers[below(workers.size())]; !any.gone && &any != workers[0].get())
        lose(any);
      break;
    case 2: workers[below(workers.size())]->still ^= true; break;
    default: break;
    }
    workers[0]->still = false;
    while (done < committed && over(done + 1)) expectSame(++done);
    ASSERT_LT(now, 5000);
  }
  for (const std::string& line : log) EXPECT_EQ(line.find("invalid message"), line.npos) << line;
  for (const auto& each : workers) EXPECT_EQ(each->refused, "");
}

TEST_P(ClusterMaster, AllLostAndOthersComeInMidFrame) {
  FakeWorker& first = join();
  master->commit(1, edits(1), true, now);
  ASSERT_TRUE(runUntil([&] {
    const auto work = master->frame(1).work;
    return work && work->progress() > .3f;
  }));
  lose(first);
  for (int i = 0; i < 100; i++) step();
  EXPECT_FALSE(over(1));
  master->commit(2, edits(2), true, now);
  join();
  join();
  ASSERT_TRUE(runUntil([&] { return over(1) && over(2); }));
  expectSame(1);
  expectSame(2);
  EXPECT_EQ(master->totals().cluster.workers, 2u);
  EXPECT_EQ(master->workers().at(0).alive, 0);
}

TEST_P(ClusterMaster, AnArrayIsSentOnceToEach) {
  join();
  join();
  for (Epoch epoch = 1; epoch <= 6; epoch++) master->commit(epoch, edits(int(epoch)), true, now);
  ASSERT_TRUE(runUntil([&] { return over(6); }));
  // Points of 0, 1, 2 (frames 1 and 2, 3 to 5, 6) for two geometries, and the corners. A worker may
  // have skipped frames.
  for (const auto& each : workers) EXPECT_LE(each->arrayBytes, 3 * 2 * 36 + 12u);
}

TEST_P(ClusterMaster, WhoDiffersIsRefused) {
  message::Hello other = greeting();
  other.isa = "avx512";
  FakeWorker& mixed = join(other);
  other = greeting();
  other.protocol++;
  FakeWorker& newer = join(other);
  FakeWorker& good = join();
  master->commit(1, edits(1), true, now);
  ASSERT_TRUE(runUntil([&] { return over(1); }));
  expectSame(1);
  EXPECT_NE(mixed.refused.find("instruction set: the worker has avx512, the master avx2"),
            std::string::npos)
      << mixed.refused;
  EXPECT_NE(newer.refused.find("protocol"), std::string::npos);
  EXPECT_EQ(good.refused, "");
  FakeWorker& liar = join(); // reports another number of triangles
  liar.nonsense = true;
  master->commit(2, edits(2), true, now);
  ASSERT_TRUE(
      runUntil([&] { return over(2) && (!liar.refused.empty() || !good.refused.empty()); }));
  EXPECT_NE((liar.refused + good.refused).find("triangle"), std::string::npos);
}

TEST_P(ClusterMaster, WorkersUseItsInstructionSetOrAreRefused) {
  message::Hello other = greeting();
  other.isa = "avx512";
  other.isas = "avx512, avx2, sse2";
  FakeWorker& better = join(other);
  other.isa = other.isas = "sse2";
  FakeWorker& worse = join(other);
  FakeWorker& older = join(); // names no others than its own
  master->commit(1, edits(1), true, now);
  ASSERT_TRUE(runUntil([&] { return over(1); }));
  expectSame(1);
  EXPECT_EQ(better.isa, "avx2");
  EXPECT_EQ(older.isa, "avx2");
  EXPECT_EQ(better.refused + older.refused, "");
  EXPECT_NE(worse.refused.find("instruction set: the worker has sse2, the master avx2 (isa=sse2 "
                               "suits both)"),
            std::string::npos)
      << worse.refused;
}

TEST_P(ClusterMaster, NobodyWorksWithOtherVersionsOfShaders) {
  FakeWorker& before = join();
  master->commit(1, edits(1), true, now);
  ASSERT_TRUE(runUntil([&] { return over(1); }));
  expectSame(1);
  const auto commit = edits(2);
  auto entry = std::make_unique<edit::EditT>();
  entry->any.Set(edit::ReloadShadersT());
  commit->edits.edits.insert(commit->edits.edits.begin(), std::move(entry));
  master->commit(2, commit, true, now);
  FakeWorker& after = join();
  for (int i = 0; i < 300; i++) step();
  EXPECT_NE(before.refused.find("reloaded"), std::string::npos);
  EXPECT_NE(after.refused.find("reloaded"), std::string::npos);
  EXPECT_EQ(master->totals().cluster.workers, 0u);
}

TEST_P(ClusterMaster, WhoSendsWhatCannotBeReadIsRefusedAtOnce) {
  FakeWorker& bad = join();
  join();
  master->commit(1, edits(1), true, now);
  ASSERT_TRUE(runUntil([&] { return bad.session != 0; }));
  Frames noise(1, std::vector<std::byte>(64));
  for (auto& byte : noise[0]) byte = std::byte(random());
  master->message(bad.peer, std::move(noise), now);
  EXPECT_NE(bad.refused, "");
  ASSERT_TRUE(runUntil([&] { return over(1); }));
  expectSame(1);
}

TEST_P(ClusterMaster, NonsenseIsBorneThreeTimes) {
  FakeWorker& bad = join();
  FakeWorker& good = join();
  master->commit(1, edits(1), true, now);
  ASSERT_TRUE(runUntil([&] { return bad.session != 0 && good.session != 0; }));
  for (int i = 0; i < 3; i++) {
    EXPECT_EQ(bad.refused, "");
    master->message(bad.peer,
                    encode(bad.session, i == 1 ? message::Body(message::Need{
                                                     .epoch = 77, .arrays = {Hash{1, 2}}})
                                               : message::Body(message::Drop{.epoch = 1})),
                    now);
  }
  EXPECT_NE(bad.refused, "");
  ASSERT_TRUE(runUntil([&] { return over(1); }));
  expectSame(1);
  EXPECT_EQ(good.refused, "");
}

TEST_P(ClusterMaster, ResultsThatAreNoneAreBorneThreeTimes) {
  FakeWorker& bad = join();
  bad.cut = true;
  master->commit(1, edits(1), true, now);
  ASSERT_TRUE(runUntil([&] { return !bad.refused.empty(); }));
  EXPECT_NE(bad.refused.find("the result does not fit its job"), bad.refused.npos);
  EXPECT_EQ(master->totals().cluster.tilesRemote, 0u);
  join();
  ASSERT_TRUE(runUntil([&] { return over(1); }));
  expectSame(1);
  uint64_t done = 0;
  for (const RTworker& worker : master->workers()) done += worker.jobs;
  EXPECT_EQ(master->totals().cluster.tilesRemote, done);
}

TEST_P(ClusterMaster, ACancelledFrameIsOverAtOnceAndTheNextIsRight) {
  join();
  join();
  master->commit(1, edits(1), true, now);
  if (GetParam() % 2) {
    ASSERT_TRUE(runUntil([&] {
      const auto work = master->frame(1).work;
      return work && work->progress() > .2f;
    }));
  }
  master->cancel(1, now);
  EXPECT_TRUE(over(1));
  EXPECT_TRUE(master->frame(1).work);
  master->commit(2, edits(2), true, now);
  ASSERT_TRUE(runUntil([&] { return over(2); }));
  expectSame(2);
}

TEST_P(ClusterMaster, RequiredWorkersAreWaitedForAWhile) {
  make(2);
  join();
  master->commit(1, edits(1), true, now);
  for (int i = 0; i < 500; i++) step();
  EXPECT_EQ(master->totals().cluster.tilesRemote, 0u); // one worker is fewer than required
  join();
  ASSERT_TRUE(runUntil([&] { return over(1); }));
  expectSame(1);
  lose(*workers[0]);
  master->commit(2, edits(2), true, now);
  ASSERT_TRUE(runUntil([&] { return over(2); }));
  EXPECT_TRUE(master->frame(2).missing);
  EXPECT_NE(master->frame(2).failure.find("2 workers are needed, there is 1"), std::string::npos)
      << master->frame(2).failure;
}

INSTANTIATE_TEST_SUITE_P(Seeds, ClusterMaster, testing::Range(1, 7));

} // namespace

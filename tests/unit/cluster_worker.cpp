// cluster_worker.cpp: Tests a worker's session. The test plays the master.
#include "render/frame/result_codec.h"
#include "shading/registry.h"
#include "unit/cluster_worker_rig.h"

using namespace openrt;
using namespace openrt::cluster;

namespace {

Prepared prepared() {
  Prepared p;
  p.facts.camera = true;
  p.frame.width = p.frame.height = 8;
  p.frame.channels = RT_RGBA;
  p.frame.samples = 4;
  p.frame.depth = 2;
  p.frame.transport = RT_TRANSPORT_DIRECT;
  return p;
}

LeasedJob job(Lease lease, uint32_t tile = 0) {
  return {lease, {Job::Kind::samples, false, tile, 0, 4, {}}};
}

// Gives the worker a scene and makes it ready for jobs.
void makeReady(Rig& rig, Epoch epoch = 1, Epoch machines = 1) {
  const TinyScene scene(epoch);
  rig.tell(scene.message);
  rig.tell(scene.piece());
  rig.worker.ready(machines, prepared());
  rig.said.clear();
  rig.machine.told.clear();
}

using Told = std::vector<std::string>;

} // namespace

TEST(ClusterWorker, UsesTheInstructionSetOfItsMaster) {
  for (const char* wanted : {"sse2", "avx2", ""}) {
    Rig rig;
    rig.worker.joined(1, "somewhere", 0);
    message::Welcome welcome = usualWelcome(7);
    welcome.isa = wanted;
    rig.tell(welcome);
    EXPECT_TRUE(rig.worker.serving());
    EXPECT_EQ(rig.machine.isa, *wanted ? wanted : "avx2") << "older masters name none";
  }
}

TEST(ClusterWorker, RefusesAnInstructionSetThatItLacks) {
  Rig rig;
  rig.worker.joined(1, "somewhere", 0);
  message::Welcome welcome = usualWelcome(7);
  welcome.isa = "avx512";
  rig.tell(welcome);
  EXPECT_FALSE(rig.worker.serving());
  ASSERT_EQ(rig.closed.size(), 1u);
  EXPECT_EQ(rig.closed[0].second,
            "instruction set: the master wants avx512, the worker has avx2, sse2");
}

TEST(Worker, saysHelloAndServesWhoSaysWelcome) {
  Rig rig;
  rig.worker.joined(1, "somewhere", 0);
  EXPECT_EQ(rig.answer<message::Hello>().threads, 2u);
  EXPECT_FALSE(rig.worker.serving());
  rig.tell(usualWelcome(7));
  EXPECT_TRUE(rig.worker.serving());
}

TEST(Worker, refusesAMasterOfAnotherProtocol) {
  Rig rig;
  rig.worker.joined(1, "somewhere", 0);
  rig.tell(message::Welcome{
      .protocol = protocolVersion + 1, .session = 7, .heartbeat = 0.1f, .silence = 0.5f});
  EXPECT_FALSE(rig.worker.serving());
  ASSERT_EQ(rig.closed.size(), 1u);
  EXPECT_NE(rig.closed[0].second.find(std::to_string(protocolVersion + 1)), std::string::npos);
}

TEST(Worker, oneMasterAtATime) {
  Rig rig;
  rig.greet();
  rig.worker.joined(2, "elsewhere", 0);
  ASSERT_EQ(rig.closed.size(), 1u);
  EXPECT_EQ(rig.closed[0].first, 2u);
  EXPECT_NE(rig.closed[0].second.find("busy"), std::string::npos);
  rig.tell(usualWelcome(9), 9, 2); // no handler accepts it
  EXPECT_TRUE(rig.said.empty());
  rig.worker.left(1, "gone", 0);
  rig.worker.joined(3, "elsewhere", 0);
  EXPECT_EQ(rig.said.at(0).first, 3u);
}

TEST(Worker, aMasterThatDoesNotAnswerIsGivenUp) {
  Rig rig;
  rig.worker.joined(1, "somewhere", 100);
  rig.worker.advance(104);
  EXPECT_TRUE(rig.closed.empty());
  rig.worker.advance(106);
  EXPECT_EQ(rig.closed.size(), 1u);
  rig.said.clear();
  rig.worker.joined(2, "elsewhere", 106);
  EXPECT_EQ(rig.said.size(), 1u);
}

TEST(Worker, asksForArraysThatItLacksAndMakesTheScene) {
  Rig rig;
  rig.greet();
  const TinyScene scene(1);
  rig.tell(scene.message);
  const auto need = rig.answer<message::Need>();
  EXPECT_EQ(need.epoch, 1u);
  EXPECT_EQ(need.arrays, std::vector{scene.hash()});
  EXPECT_EQ(rig.machine.all(), Told{});
  rig.tell(scene.piece());
  EXPECT_EQ(rig.machine.all(), Told{"scene 1 whole prepare"});
  ASSERT_TRUE(rig.machine.commit->arrays.contains(10));
  EXPECT_EQ(rig.machine.commit->arrays.at(10)->data()[3], std::byte(1));
  EXPECT_EQ(rig.machine.commit->edits.edits.size(), 2u);
}

TEST(Worker, anArrayThatItHasIsNotSentAgain) {
  Rig rig;
  rig.greet();
  makeReady(rig);
  TinyScene again(2);
  rig.tell(again.message);
  EXPECT_TRUE(rig.answer<message::Need>().arrays.empty());
  EXPECT_EQ(rig.machine.all(), Told{"scene 2 whole prepare"});
  // The next master's message is not accepted either.
  rig.worker.left(1, "gone", 0);
  EXPECT_EQ(rig.machine.all(), Told{"drop 2"});
  rig.greet(8, 2);
  rig.tell(TinyScene(1).message, 8, 2);
  EXPECT_TRUE(rig.answer<message::Need>().arrays.empty());
  EXPECT_EQ(rig.machine.all(), Told{"scene 3 whole prepare"}) << "the machine's numbers go on";
}

TEST(Worker, aCacheOfNothingForgetsWhatTheSceneDoesNotUse) {
  Rig rig(nullptr, 0);
  rig.greet();
  makeReady(rig);
  EXPECT_EQ(rig.worker.cache().count(), 1u) << "in use";
  rig.machine.commit.reset();
  rig.worker.left(1, "gone", 0);
  EXPECT_EQ(rig.worker.cache().count(), 0u);
}

TEST(Worker, scenesWaitForTheirArraysInTheirOrder) {
  Rig rig;
  rig.greet();
  const TinyScene first(1, 1), second(2, 2), third(3, 1);
  rig.tell(first.message);
  rig.tell(second.message);
  rig.tell(third.message);
  ASSERT_EQ(rig.said.size(), 3u);
  EXPECT_TRUE(std::get<message::Need>(rig.said[2].second.body).arrays.empty())
      << "asked for already";
  rig.tell(message::Prepare{.epoch = 3});
  rig.tell(second.piece());
  EXPECT_EQ(rig.machine.all(), Told{});
  rig.tell(first.piece());
  EXPECT_EQ(rig.machine.all(), (Told{"scene 1 whole prepare", "scene 2 whole prepare",
                                     "scene 3 whole prepare", "prepare 3"}));
}

TEST(Worker, editsThatBreakARuleAreRefusedUntilAWholeSceneComes) {
  Rig rig;
  rig.greet();
  TinyScene bad(1);
  bad.message.arrays.clear(); // the texture names an array that is not sent
  rig.tell(bad.message);
  ASSERT_EQ(rig.said.size(), 2u);
  EXPECT_EQ(std::get<message::Failed>(rig.said[1].second.body).epoch, 1u);
  rig.said.clear();
  TinyScene next(2, 1, false);
  next.message.arrays.clear();
  rig.tell(next.message);
  EXPECT_TRUE(std::holds_alternative<message::Failed>(rig.said.at(1).second.body));
  EXPECT_EQ(rig.machine.all(), Told{});
  const TinyScene good(3);
  rig.tell(good.message);
  rig.tell(good.piece());
  EXPECT_EQ(rig.machine.all(), Told{"scene 3 whole prepare"});
}

TEST(Worker, editsThatAreNoneAreRefused) {
  Rig rig;
  rig.greet();
  TinyScene junk(1);
  junk.message.edits = someBytes(200);
  junk.message.arrays.clear();
  rig.tell(junk.message);
  EXPECT_TRUE(std::holds_alternative<message::Failed>(rig.said.at(1).second.body));
}

TEST(Worker, librariesAreComparedByTheirHash) {
  const ShaderRegistry shaders(shaderFolders(""));
  Rig rig(&shaders);
  rig.greet();
  const auto scene = [&](Epoch epoch, const std::string& name, const Hash& hash) {
    TinyScene s(epoch);
    s.message.libraries = {{.name = name, .hash = hash}};
    rig.tell(s.message);
    if (rig.worker.cache().count() == 0) rig.tell(s.piece());
    std::string why;
    for (const auto& [peer, m] : std::exchange(rig.said, {}))
      if (const auto* failed = std::get_if<message::Failed>(&m.body)) why = failed->why;
    return why;
  };
  EXPECT_NE(scene(1, "nosuchlibrary", {1, 2}).find("nosuchlibrary"), std::string::npos);
  EXPECT_NE(scene(2, "../vrml97", {1, 2}).find("no folder"), std::string::npos);
  const std::string differs = scene(3, "vrml97", {1, 2});
  EXPECT_NE(differs.find("vrml97"), std::string::npos);
  EXPECT_NE(differs.find(hex({1, 2})), std::string::npos);
  // The message names the hash it has, so that people can compare.
  const size_t at = differs.find("has hash ") + 9;
  const std::string own = differs.substr(at, 32);
  const Hash hash{std::stoull(own.substr(16), nullptr, 16),
                  std::stoull(own.substr(0, 16), nullptr, 16)};
  EXPECT_EQ(scene(4, "vrml97", hash), "");
  EXPECT_EQ(rig.machine.all(), Told{"scene 4 whole prepare"});
}

TEST(Worker, jobsAreDoneAndTheirResultsSent) {
  Rig rig;
  rig.greet();
  makeReady(rig);
  rig.tell(message::Jobs{.epoch = 1, .jobs = {job(100), job(101)}});
  EXPECT_EQ(rig.machine.all(), Told{"work 1 2"});
  JobResult result;
  result.sums.resize(64);
  result.seconds = 0.5;
  result.counters.camera = 256;
  rig.worker.done(1, rig.machine.jobs[1], std::move(result));
  const auto sent = rig.answer<message::Result>();
  EXPECT_EQ(sent.lease, 101u);
  EXPECT_EQ(sent.epoch, 1u);
  EXPECT_EQ(sent.camera, 256u);
  EXPECT_FALSE(sent.bytes.empty());
}

TEST(Worker, jobsThatAFrameDoesNotHave) {
  Rig rig;
  rig.greet();
  makeReady(rig);
  rig.tell(message::Jobs{.epoch = 1, .jobs = {job(1, 64)}});
  rig.tell(message::Jobs{.epoch = 9, .jobs = {job(2)}});
  rig.tell(message::Jobs{.epoch = 1, .jobs = {{3, {Job::Kind::light, false, 16, 0, 5, {}}}}});
  EXPECT_EQ(rig.badOnes.size(), 3u);
  rig.tell(message::Jobs{.epoch = 1, .jobs = {job(4), job(4)}});
  EXPECT_EQ(rig.badOnes.size(), 4u);
  EXPECT_EQ(rig.machine.all(), Told{});
}

TEST(Worker, whatIsDroppedIsNotSent) {
  Rig rig;
  rig.greet();
  makeReady(rig);
  rig.tell(message::Jobs{.epoch = 1, .jobs = {job(1)}});
  rig.tell(message::Drop{.epoch = 1});
  EXPECT_EQ(rig.machine.all(), (Told{"work 1 1", "drop 1"}));
  rig.worker.done(1, job(1), {});
  EXPECT_TRUE(rig.said.empty());
  rig.tell(message::Jobs{.epoch = 1, .jobs = {job(2)}}); // was already on its way
  EXPECT_EQ(rig.machine.all(), Told{});
  EXPECT_TRUE(rig.badOnes.empty());
}

TEST(Worker, whatComesOfAFormerMastersWorkIsNotTheNextOnes) {
  Rig rig;
  rig.greet();
  makeReady(rig);
  rig.tell(message::Jobs{.epoch = 1, .jobs = {job(1)}});
  rig.worker.left(1, "gone", 0);
  rig.greet(8, 2);
  rig.worker.done(1, job(1), {});
  rig.worker.failed(1, "late");
  rig.worker.ready(1, prepared());
  EXPECT_TRUE(rig.said.empty());
}

TEST(Worker, messagesOfAnotherSessionAreNotHeard) {
  Rig rig;
  rig.greet();
  rig.tell(TinyScene(1).message, 6); // replayed or late
  rig.tell(TinyScene(1).message, 0);
  rig.tell(TinyScene(1).message, 7, 2);
  EXPECT_TRUE(rig.said.empty());
  EXPECT_TRUE(rig.badOnes.empty());
}

TEST(Worker, aMessageThatCannotBeReadEndsTheSession) {
  Rig rig;
  rig.greet();
  rig.worker.message(1, {someBytes(30)}, 0);
  EXPECT_FALSE(rig.worker.serving());
  ASSERT_EQ(rig.closed.size(), 1u);
  EXPECT_NE(rig.closed[0].second.find("cannot be read"), std::string::npos);
}

TEST(Worker, nonsenseIsCounted) {
  Rig rig;
  rig.greet();
  rig.tell(message::Need{.epoch = 1});
  rig.tell(message::Hello{.threads = 1}); // a message that only workers send
  rig.tell(TinyScene(1).piece());         // a chunk that was not requested
  rig.tell(message::Prepare{.epoch = 1});
  rig.tell(usualWelcome(7));
  EXPECT_EQ(rig.badOnes.size(), 5u);
  const TinyScene scene(5);
  rig.tell(scene.message);
  rig.tell(scene.message); // replayed
  EXPECT_EQ(rig.badOnes.size(), 6u);
  auto wrong = scene.piece();
  wrong.data.back() ^= std::byte(1);
  rig.tell(wrong);
  EXPECT_EQ(rig.badOnes.size(), 7u);
  EXPECT_TRUE(std::holds_alternative<message::Failed>(rig.said.back().second.body))
      << "the scene cannot be made";
  EXPECT_EQ(rig.machine.all(), Told{});
}

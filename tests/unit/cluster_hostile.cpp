// cluster_hostile.cpp: a peer that has a key and attacks: it requests more than can be done, does
// not read, or repeats a message forever. It is disconnected, and the others lose neither memory
// nor log space to it.
#include "backend/cluster/master/master.h"
#include "backend/cluster/master/outbox.h"
#include "backend/cluster/net/greeting.h"
#include "backend/cluster/worker/worker.h"
#include "backend/record/edits_bytes.h"
#include "unit/cluster_fake_work.h"
#include "unit/cluster_wires.h"

using namespace openrt;
using namespace openrt::cluster;

namespace {

struct NoMachine final : JobExecutor { // a JobExecutor that never answers
  void useInstructionSet(const std::string&) override {}
  void scene(Epoch, std::shared_ptr<const Commit>, bool, bool) override {}
  void prepare(Epoch) override {}
  void work(Epoch, std::span<const LeasedJob>) override {}
  void drop(Epoch) override {}
};

struct LoneWorker {
  NoMachine machine;
  std::vector<std::string> closed, badOnes;
  std::vector<double> beats;
  size_t needed = 0; // number of arrays requested
  WorkerCounts counts;
  Worker worker;
  LoneWorker()
      : worker({.self = {.threads = 1}, .cacheBytes = 1000},
               {[this](Peer, Frames&& frames) {
                  Message m;
                  EXPECT_EQ(decode(std::move(frames), m), "");
                  if (const auto* need = std::get_if<message::Need>(&m.body))
                    needed += need->arrays.size();
                },
                [this](Peer, const std::string& why) { closed.push_back(why); },
                [this](Peer, const std::string& why) { badOnes.push_back(why); },
                [this](double heartbeat, double) { beats.push_back(heartbeat); }},
               machine, counts) {
    worker.joined(1, "somewhere", 0);
    tell(usualWelcome(7));
  }
  void tell(message::Body body) { worker.message(1, encode(7, std::move(body)), 0); }
};

message::Scene emptyScene(Epoch epoch) {
  edit::EditsT edits;
  edit::FrameSettingsT frame;
  frame.width = frame.height = 8;
  frame.channels = RT_RGBA;
  frame.samples = 4;
  frame.depth = 2;
  edits.edits.emplace_back(new edit::EditT)->any.Set(std::move(frame));
  edits.render = true;
  return {epoch, epoch == 1, true, {}, {}, packEdits(edits)};
}

struct LoneMaster {
  std::vector<std::string> log, closed;
  uint64_t session = 0;
  std::unique_ptr<Master> master;
  LoneMaster() {
    MasterOptions options;
    options.local.log = [](int, const char* text, void* user) {
      static_cast<std::vector<std::string>*>(user)->push_back(text);
    };
    options.local.logUser = &log;
    options.close = [this](Peer, const std::string& why) { closed.push_back(why); };
    master = std::make_unique<Master>(
        options,
        [this](Peer, Frames&& frames) {
          Message m;
          EXPECT_EQ(decode(std::move(frames), m), "");
          if (const auto* welcome = std::get_if<message::Welcome>(&m.body))
            session = welcome->session;
          return true;
        },
        nullptr);
    master->joined(1, "somewhere", 0);
    tell(message::Hello{.threads = 1});
    master->advance(0);
  }
  void tell(message::Body body) { master->message(1, encode(session, std::move(body)), 0); }
};

} // namespace

TEST(Hostile, moreScenesThanCanBeMade) {
  LoneWorker w;
  for (Epoch epoch = 1; epoch <= limits::scenesAtOnce; epoch++) w.tell(emptyScene(epoch));
  EXPECT_TRUE(w.closed.empty());
  EXPECT_TRUE(w.worker.serving());
  w.worker.ready(1, {}); // scene 1 is prepared, so there is room for another
  w.tell(emptyScene(limits::scenesAtOnce + 1));
  EXPECT_TRUE(w.closed.empty());
  w.tell(emptyScene(limits::scenesAtOnce + 2));
  ASSERT_EQ(w.closed.size(), 1u);
  EXPECT_NE(w.closed[0].find("more scenes"), std::string::npos);
  EXPECT_FALSE(w.worker.serving());
}

TEST(Hostile, manyArraysTakeNoMemoryUntilTheyCome) {
  LoneWorker w;
  message::Scene scene = emptyScene(1);
  for (uint64_t i = 1; i <= 200000; i++) scene.arrays.push_back({i, 1000, {i, i}});
  w.tell(std::move(scene)); // one zstd stream per scene would need 20 GB
  EXPECT_EQ(w.needed, 200000u);
  EXPECT_FALSE(ArrayStream({1, 1}, limits::arrayBytes).begun());
}

TEST(Hostile, piecesOfManyArraysAtOnce) {
  LoneWorker w;
  message::Scene scene = emptyScene(1);
  std::vector<message::Piece> pieces;
  for (uint32_t i = 0; i <= limits::arraysAtOnce; i++) {
    const auto bytes = someBytes(pieceBytes + 1, i + 1);
    const Hash hash = hashOf(bytes);
    scene.arrays.push_back({i + 1, bytes.size(), hash});
    pieces.push_back(pieceOf(hash, bytes.size(), packArray(bytes), 0)); // the first of two chunks
  }
  w.tell(std::move(scene));
  for (const auto& piece : pieces) w.tell(piece);
  ASSERT_EQ(w.badOnes.size(), 1u);
  EXPECT_NE(w.badOnes[0].find("too many arrays"), std::string::npos);
}

TEST(Hostile, epochsThatWrapAround) {
  LoneWorker w;
  w.tell(emptyScene(1));
  w.worker.left(1, "gone", 0); // the numbers of the next session start above
  w.worker.joined(1, "somewhere", 0);
  w.tell(usualWelcome(7));
  w.tell(message::Prepare{.epoch = ~Epoch(0)});
  w.tell(message::Jobs{.epoch = ~Epoch(0)});
  EXPECT_EQ(w.badOnes.size(), 2u);
  w.tell(message::Drop{.epoch = ~Epoch(0)}); // drops every epoch there is
  EXPECT_EQ(w.badOnes.size(), 2u);
}

TEST(Hostile, oneMastersHeartbeatsAreNotTheNextOnes) {
  LoneWorker w;
  w.worker.left(1, "gone", 0);
  w.worker.joined(2, "elsewhere", 0);
  w.worker.message(2,
                   encode(8, message::Welcome{.protocol = protocolVersion,
                                              .session = 8,
                                              .heartbeat = 50,
                                              .silence = 100}),
                   0);
  w.worker.left(2, "gone", 0);
  ASSERT_EQ(w.beats.size(), 4u);
  EXPECT_NEAR(w.beats[2], 50, 1e-6);
  EXPECT_EQ(w.beats[3], 0) << "as at the beginning";
}

TEST(Hostile, whoDoesNotReadIsNoticed) {
  const auto blocked = [](Frames&&) { return false; };
  Outbox many;
  for (size_t i = 0; i < limits::outboxMessages; i++) many.add(Frames{someBytes(1)});
  EXPECT_FALSE(many.flush(1, blocked));
  EXPECT_FALSE(many.overfull());
  many.add(Frames{someBytes(1)});
  EXPECT_TRUE(many.overfull());
  EXPECT_TRUE(many.flush(1, [](Frames&& frames) { return Frames(std::move(frames)).size() == 1; }));
  EXPECT_FALSE(many.overfull());
  many.clear();
  EXPECT_TRUE(many.empty());
}

TEST(Hostile, whoSaysHelloAgainAndAgainIsLetGo) {
  LoneMaster m;
  EXPECT_EQ(m.master->totals().cluster.workers, 1u);
  for (int i = 0; i < 10000; i++) m.tell(message::Hello{.threads = 1});
  EXPECT_EQ(m.closed.size(), 1u);
  EXPECT_EQ(m.master->totals().cluster.workers, 0u);
  EXPECT_LT(m.log.size(), 20u);
}

TEST(Hostile, whoTalksToTheLogForEver) {
  LoneMaster m;
  for (uint64_t i = 0; i < 5 * limits::logLines; i++)
    m.tell(message::Log{.level = 1, .text = "line " + std::to_string(i)});
  EXPECT_LT(m.log.size(), limits::logLines + 20);
}

TEST(Hostile, aJobDoesNotTakeLongerThanSinceItWasHandedOut) {
  Bench b;
  b.frame(1, 4);
  b.workers(1, 1, 1);
  const auto out = b.handOut();
  ASSERT_FALSE(out.empty());
  b.now += 2;
  b.done(out[0], 1e300);
  EXPECT_LE(b.s.tally(1).busy, 2);
  EXPECT_LT(b.s.lateAfter(1), 100) << "others' jobs would never be late";
}

TEST(Hostile, textsAreUtf8AndMoveNoCursor) {
  const auto shown = [](const std::string& text) {
    Message out;
    EXPECT_EQ(decode(encode(1, message::Log{.level = 2, .text = text}), out), "");
    return std::get<message::Log>(out.body).text;
  };
  EXPECT_EQ(shown("Gr\xc3\xbc\xc3\x9f \xe2\x82\xac \xf0\x9f\x8c\x8d"),
            "Gr\xc3\xbc\xc3\x9f \xe2\x82\xac \xf0\x9f\x8c\x8d");
  EXPECT_EQ(shown("a\xc2\x9b"
                  "2Jb"),
            "a  2Jb")
      << "CSI in one character";
  EXPECT_EQ(shown("\xff\xc3\x28\x80"), "\?\?(?");
  EXPECT_EQ(shown("\xc0\xaf\xed\xa0\x80\xf5\x80\xe2\x82"), "?????????")
      << "overlong, half a pair, cut";
  message::Ready ready{1, {}, RT_TRANSPORT_PATH, {}};
  std::memcpy(ready.stats.machine.isa, "a\x1b\xffz", 4);
  Message out;
  ASSERT_EQ(decode(encode(1, ready), out), "");
  EXPECT_STREQ(std::get<message::Ready>(out.body).stats.machine.isa, "a ?z");
}

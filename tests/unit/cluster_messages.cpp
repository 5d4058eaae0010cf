// cluster_messages.cpp: Tests that every message survives encoding and decoding. Messages that are
// truncated, altered, too large or inconsistent are refused.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <sstream>

#include "backend/cluster/messages/statistics.h"
#include "backend/cluster/net/greeting.h"
#include "backend/cluster/worker/array_cache.h"
#include "messages_generated.h"
#include "unit/cluster_wires.h"

using namespace openrt;
using namespace openrt::cluster;

namespace {

// Returns one message of each kind with all its fields set.
std::vector<message::Body> oneOfEach() {
  message::Ready ready{5, {true, false}, RT_TRANSPORT_PATH, {}};
  ready.stats.size = sizeof ready.stats;
  ready.stats.scene.triangles = 77;
  std::strcpy(ready.stats.machine.isa, "avx2");
  message::Result result{
      5, 9, 0.25, 1, 2, 3, {{.name = "Phong", .library = "vrml97", .hits = 4}}, someBytes(1000)};
  message::Jobs jobs{.epoch = 5};
  jobs.jobs.push_back({11, {Job::Kind::samples, true, 2, 64, 32, {7, 4}}});
  jobs.jobs.push_back({12, {Job::Kind::light, false, 15, 0, 4000000000u, {8, 31}}});
  std::vector<message::Body> all;
  all.emplace_back(message::Hello{.protocol = 1,
                                  .library = "0.1.0",
                                  .api = 1,
                                  .shaderAbi = 2,
                                  .isa = "avx2",
                                  .kernel = "Embree",
                                  .platform = "glibc 2.36",
                                  .threads = 16,
                                  .host = "node1",
                                  .process = 4711,
                                  .isas = "avx2, sse2",
                                  .share = 4711,
                                  .shareKey = "key"});
  all.emplace_back(message::Need{.epoch = 5, .arrays = {{1, 2}, {3, 4}}});
  all.emplace_back(ready);
  all.emplace_back(message::Failed{.epoch = 5, .why = "why"});
  all.emplace_back(result);
  all.emplace_back(message::Log{.level = 2, .text = "text"});
  message::Welcome welcome = usualWelcome(42);
  welcome.isa = "sse2";
  all.emplace_back(welcome);
  all.emplace_back(message::Scene{5,
                                  true,
                                  true,
                                  {{1, 100, {1, 2}}, {2, 200, {3, 4}}},
                                  {{.name = "vrml97", .hash = {5, 6}}},
                                  someBytes(333)});
  all.emplace_back(
      message::Piece{{.hash = {1, 2}, .bytes = 100, .stored = 50, .offset = 0}, someBytes(50)});
  all.emplace_back(message::Prepare{.epoch = 5});
  all.emplace_back(jobs);
  all.emplace_back(message::Drop{.epoch = 5});
  all.emplace_back(message::Beat{.sent = 1.5, .answer = true});
  all.emplace_back(message::Bye{.why = "why"});
  all.emplace_back(message::Got{.arrays = {{1, 2}, {3, 4}}, .failed = true, .kept = true});
  all.emplace_back(message::Source{.address = "node2:4711", .arrays = {{0, 100, {1, 2}}}});
  all.emplace_back(message::Fetch{.arrays = {{0, 100, {1, 2}}, {0, 200, {3, 4}}}});
  return all;
}

std::string problem(Frames frames) {
  Message out;
  return decode(std::move(frames), out);
}

Frames of(message::Body body) { return encode(42, std::move(body)); }

} // namespace

TEST(Messages, eachComesBackAsItWas) {
  for (const message::Body& body : oneOfEach()) {
    const Frames frames = of(body);
    Message out;
    ASSERT_EQ(decode(Frames(frames), out), "");
    EXPECT_EQ(out.session, 42u);
    ASSERT_EQ(out.body.index(), body.index());
    EXPECT_EQ(encode(42, std::move(out.body)), frames)
        << "the same message makes the same bytes, kind " << body.index();
  }
}

TEST(Messages, jobsKeepAllTheirNumbers) {
  const auto jobs = std::get<message::Jobs>(oneOfEach()[10]);
  Message out;
  ASSERT_EQ(decode(of(jobs), out), "");
  const auto& back = std::get<message::Jobs>(out.body).jobs;
  ASSERT_EQ(back.size(), 2u);
  for (size_t i = 0; i < 2; i++) {
    EXPECT_EQ(back[i].lease, jobs.jobs[i].lease);
    EXPECT_EQ(back[i].job, jobs.jobs[i].job);
  }
}

TEST(Messages, cutAnywhereIsRefusedOrHarmless) {
  for (const message::Body& body : oneOfEach()) {
    const Frames whole = of(body);
    for (size_t frame = 0; frame < whole.size(); frame++)
      for (size_t length = 0; length < whole[frame].size(); length++) {
        Frames cut = whole;
        cut[frame].resize(length);
        if (frame == 0 && length + 8 < whole[0].size()) {
          EXPECT_NE(problem(std::move(cut)), "") << body.index() << " " << length;
        } else {
          problem(std::move(cut));
        }
      }
  }
}

TEST(Messages, anyByteMayBeWrong) {
  for (const message::Body& body : oneOfEach()) {
    const Frames whole = of(body);
    for (size_t frame = 0; frame < whole.size(); frame++)
      for (size_t at = 0; at < whole[frame].size(); at++)
        for (const uint8_t value : {0x00, 0x01, 0x7f, 0x80, 0xff}) {
          Frames changed = whole;
          changed[frame][at] = std::byte(value);
          problem(std::move(changed)); // must neither crash nor allocate much
        }
  }
}

// The array of jobs is moved to the end of the header, by four bytes too far.
TEST(Messages, unalignedArraysAreRefused) {
  Frames frames = of(oneOfEach()[10]);
  std::vector<std::byte>& header = frames[0];
  ASSERT_EQ(problem(Frames(frames)), "");
  const auto* jobs = wire::GetHeader(header.data())->any_as_Jobs()->jobs();
  const size_t from = size_t(reinterpret_cast<const std::byte*>(jobs) - header.data());
  const std::vector<std::byte> copy(header.begin() + ptrdiff_t(from),
                                    header.begin() +
                                        ptrdiff_t(from + 4 + jobs->size() * sizeof(wire::Job)));
  const size_t to = (header.size() + 7) / 8 * 8;
  header.resize(to);
  header.insert(header.end(), copy.begin(), copy.end());
  for (size_t at = 0; at < from; at += 4) { // the field holds the distance to the array
    uint32_t distance;
    std::memcpy(&distance, header.data() + at, sizeof distance);
    if (at + distance != from) continue;
    distance = uint32_t(to - at);
    std::memcpy(header.data() + at, &distance, sizeof distance);
  }
  EXPECT_NE(problem(std::move(frames)).find("not aligned"), std::string::npos);
}

TEST(Messages, tooManyOrTooFewFrames) {
  for (const message::Body& body : oneOfEach()) {
    Frames frames = of(body);
    const bool many = std::holds_alternative<message::Scene>(body);
    frames.emplace_back(many ? 0 : 3);
    EXPECT_EQ(problem(std::move(frames)).empty(), many) << body.index();
    frames = of(body);
    if (frames.size() > 1) {
      frames.resize(1);
      EXPECT_NE(problem(std::move(frames)), "") << body.index();
    }
    EXPECT_NE(problem(Frames(limits::frames + 1, of(body)[0])), "");
  }
  EXPECT_NE(problem({}), "");
}

TEST(Messages, membersOfLaterVersionsAreIgnored) {
  flatbuffers::FlatBufferBuilder builder;
  const auto beat = wire::CreateBeat(builder, 1, false);
  const auto any = wire::Any(uint8_t(wire::Any::MAX) + 1);
  wire::FinishHeaderBuffer(builder, wire::CreateHeader(builder, 42, any, beat.Union()));
  const auto* bytes = reinterpret_cast<const std::byte*>(builder.GetBufferPointer());
  Message out;
  EXPECT_EQ(decode({{bytes, bytes + builder.GetSize()}, someBytes(7)}, out), "");
  EXPECT_TRUE(std::holds_alternative<message::Unknown>(out.body));
}

TEST(Messages, resultsAreChecked) {
  message::Result result{5, 9, 0.25, 1, 2, 3, {}, std::vector<std::byte>(200000)};
  Frames packed = of(result);
  ASSERT_EQ(packed.size(), 2u);
  EXPECT_LT(packed[1].size(), 5000u) << "zeros are worth packing";
  Message out;
  ASSERT_EQ(decode(Frames(packed), out), "");
  EXPECT_EQ(std::get<message::Result>(out.body).bytes, result.bytes);
  result.bytes = someBytes(200000);
  Frames plain = of(result);
  EXPECT_EQ(plain[1], result.bytes) << "noise is not";
  plain[1][777] ^= std::byte(1);
  EXPECT_NE(problem(plain).find("checksum"), std::string::npos);
  plain[1].pop_back();
  EXPECT_NE(problem(plain).find("size"), std::string::npos);
  packed[1][packed[1].size() / 2] ^= std::byte(255);
  EXPECT_NE(problem(packed), "");
}

TEST(Messages, resultsOfManyFrames) {
  for (const bool noise : {true, false}) {
    std::vector<std::byte> bytes(limits::chunkBytes + 12345);
    if (noise) bytes = someBytes(bytes.size());
    const Frames frames = of(message::Result{5, 9, 0.25, 1, 2, 3, {}, bytes});
    EXPECT_EQ(frames.size(), 3u);
    Message out;
    ASSERT_EQ(decode(Frames(frames), out), "");
    EXPECT_TRUE(std::get<message::Result>(out.body).bytes == bytes);
  }
}

// Members of RTstats have no gap between them, but before a group, so that none is missing in the
// table.
TEST(Messages, everyStatisticTravelsByItsName) {
  message::Ready ready{1, {}, RT_TRANSPORT_PATH, {}};
  const auto* begin = reinterpret_cast<const char*>(&ready.stats);
  size_t end = sizeof ready.stats.size;
  double next = 1;
  const auto aligned = [](size_t at, size_t to) { return (at + to - 1) / to * to; };
  forEachStatistic(ready.stats, [&](const char* name, auto& member) {
    using Member = std::remove_reference_t<decltype(member)>;
    const auto at = size_t(reinterpret_cast<const char*>(&member) - begin);
    EXPECT_TRUE(at == aligned(end, alignof(Member)) || at == aligned(end, alignof(RTstats)))
        << "a member before " << name << " is missing";
    end = at + sizeof member;
    if constexpr (std::is_array_v<Member>)
      std::snprintf(member, sizeof member, "%s", name);
    else
      member = Member(next++);
  });
  EXPECT_EQ(aligned(end, alignof(RTstats)), sizeof(RTstats)) << "the last member is missing";
  const auto shown = [](const RTstats& stats) {
    std::ostringstream all;
    forEachStatistic(stats,
                     [&](const char* name, auto& member) { all << name << " " << member << "\n"; });
    return all.str();
  };
  Message out;
  ASSERT_EQ(decode(of(ready), out), "");
  const RTstats& back = std::get<message::Ready>(out.body).stats;
  EXPECT_EQ(back.size, sizeof back);
  EXPECT_EQ(shown(back), shown(ready.stats));
}

TEST(Messages, statisticsOfOtherVersions) {
  using One = wire::StatisticT;
  const auto sent = [](const std::vector<One>& statistics) {
    wire::ReadyT ready;
    ready.transport = RT_TRANSPORT_PATH;
    for (const One& one : statistics) ready.stats.push_back(std::make_unique<One>(one));
    flatbuffers::FlatBufferBuilder builder;
    const auto table = wire::Ready::Pack(builder, &ready).Union();
    wire::FinishHeaderBuffer(builder, wire::CreateHeader(builder, 42, wire::Any::Ready, table));
    const auto* bytes = reinterpret_cast<const std::byte*>(builder.GetBufferPointer());
    return Frames{{bytes, bytes + builder.GetSize()}};
  };
  Message out;
  ASSERT_EQ(decode(sent({{.name = "ofALaterVersion", .value = 7},
                         {.value = 8},
                         {.name = "scene.triangles", .value = 9, .text = "ignored"},
                         {.name = "scene.lights", .value = 1e300},
                         {.name = "machine.threads", .value = 1e300},
                         {.name = "machine.isa", .value = 3, .text = std::string(4000, 'x')}}),
                   out),
            "");
  const RTstats& stats = std::get<message::Ready>(out.body).stats;
  EXPECT_EQ(stats.scene.triangles, 9u);
  EXPECT_EQ(stats.scene.lights, ~uint64_t(0));
  EXPECT_EQ(stats.machine.threads, ~uint32_t(0));
  EXPECT_EQ(stats.machine.isa, std::string(sizeof stats.machine.isa - 1, 'x'));
  EXPECT_EQ(stats.scene.objects, 0u);
  EXPECT_NE(problem(sent({{.name = "scene.triangles", .value = -1}})), "");
  EXPECT_NE(problem(sent({{.name = "machine.threads", .value = std::nan("")}})), "");
  EXPECT_EQ(problem(sent(std::vector<One>(limits::statistics))), "");
  EXPECT_NE(problem(sent(std::vector<One>(limits::statistics + 1))), "");
}

TEST(Messages, textsThatAreTooLongAreRefused) {
  wire::FailedT failed; // its text is a Text, which cuts what is assigned to it
  static_cast<std::string&>(failed.why) = std::string(limits::textBytes + 1, 'x');
  flatbuffers::FlatBufferBuilder builder;
  const auto table = wire::Failed::Pack(builder, &failed).Union();
  wire::FinishHeaderBuffer(builder, wire::CreateHeader(builder, 42, wire::Any::Failed, table));
  const auto* bytes = reinterpret_cast<const std::byte*>(builder.GetBufferPointer());
  EXPECT_EQ(problem({{bytes, bytes + builder.GetSize()}}), "Failed: a text is too long");
}

TEST(Messages, eachKindIsForOneSideOrForTheWire) {
  size_t handled = 0, ofBoth = 0;
  const auto handler = [&](const auto&) { handled++; };
  std::vector<message::Body> all = oneOfEach();
  EXPECT_EQ(all.size(), size_t(wire::Any::MAX)) << "a kind has no example";
  for (message::Body& body : all) {
    const bool worker = dispatch<Sender::worker>(body, handler);
    const bool master = dispatch<Sender::master>(body, handler);
    const bool sharer = dispatch<Sender::sharer>(body, handler);
    EXPECT_TRUE(worker || master || sharer) << body.index();
    ofBoth += worker && master;
  }
  EXPECT_EQ(handled, all.size() - ofBoth) << "the wire handles what both send";
  message::Body need = message::Need{.epoch = 1}, drop = message::Drop{.epoch = 1}, unknown;
  EXPECT_FALSE(dispatch<Sender::master>(need, handler));
  EXPECT_FALSE(dispatch<Sender::worker>(drop, handler));
  EXPECT_TRUE(dispatch<Sender::worker>(unknown, handler)) << "kinds of later versions are ignored";
}

TEST(Messages, textsAreCut) {
  Message out;
  ASSERT_EQ(decode(of(message::Failed{.epoch = 1, .why = std::string(100000, 'x')}), out), "");
  EXPECT_EQ(std::get<message::Failed>(out.body).why.size(), limits::textBytes);
}

TEST(Messages, textsCannotMoveTheCursor) {
  Message out;
  ASSERT_EQ(decode(of(message::Log{.level = 2, .text = "a\x1b[2Jb\nc\x7f"}), out), "");
  EXPECT_EQ(std::get<message::Log>(out.body).text, "a [2Jb c ");
}

TEST(Messages, numbersThatCannotBe) {
  const auto refused = [](message::Body body) { return !problem(of(std::move(body))).empty(); };
  EXPECT_TRUE(refused(message::Hello{.threads = 0}));
  EXPECT_FALSE(refused(message::Hello{.threads = 1}));
  EXPECT_FALSE(refused(message::Hello{.threads = 65536}));
  EXPECT_TRUE(refused(message::Hello{.threads = 65537}));
  EXPECT_TRUE(refused(message::Ready{1, {}, 99, {}}));
  EXPECT_TRUE(refused(
      message::Welcome{.protocol = protocolVersion, .session = 1, .heartbeat = 0, .silence = 0}));
  EXPECT_TRUE(refused(message::Welcome{
      .protocol = protocolVersion, .session = 1, .heartbeat = std::nanf(""), .silence = 1}));
  EXPECT_TRUE(refused(message::Scene{0, true, true, {}, {}, {}}));
  EXPECT_TRUE(refused(message::Scene{limits::epochs + 1, true, true, {}, {}, {}}));
  EXPECT_TRUE(refused(message::Scene{1, true, true, {{0, 1, {}}}, {}, {}}));
  EXPECT_TRUE(refused(message::Scene{1, true, true, {{1, limits::arrayBytes + 1, {}}}, {}, {}}));
  EXPECT_TRUE(refused(message::Scene{
      1, true, true, std::vector(5, message::ArrayName{1, limits::arrayBytes, {}}), {}, {}}));
  EXPECT_TRUE(refused(
      message::Piece{{.bytes = uint64_t(1) << 33, .stored = 1000, .offset = 0}, someBytes(1000)}))
      << "more than zstd can unpack";
  EXPECT_TRUE(refused(message::Piece{{.bytes = 1000, .stored = 100, .offset = 1}, someBytes(99)}))
      << "no multiple";
  EXPECT_TRUE(
      refused(message::Jobs{.epoch = 1,
                            .jobs = std::vector<LeasedJob>(
                                limits::jobs + 1, {1, {Job::Kind::samples, false, 0, 0, 1, {}}})}));
  EXPECT_TRUE(
      refused(message::Jobs{.epoch = 1, .jobs = {{1, {Job::Kind::samples, false, 0, 0, 0, {}}}}}));
  EXPECT_TRUE(refused(message::Jobs{
      .epoch = 1, .jobs = {{1, {Job::Kind::samples, false, 0, 0xffffffff, 0xffffffff, {}}}}}));
  EXPECT_TRUE(
      refused(message::Jobs{.epoch = 1, .jobs = {{1, {Job::Kind(9), false, 0, 0, 1, {}}}}}));
  message::Result result{.seconds = -1};
  EXPECT_TRUE(refused(result));
  result.seconds = INFINITY;
  EXPECT_TRUE(refused(result));
}

TEST(Arrays, travelInPiecesAndBackAsTheyWere) {
  for (const size_t size : {size_t(0), size_t(1), pieceBytes, 3 * pieceBytes + 17}) {
    const auto bytes = someBytes(size);
    const Hash hash = hashOf(bytes);
    const auto packed = packArray(bytes);
    ArrayStream stream(hash, size);
    for (size_t at = 0; at < packed.size(); at += pieceBytes) {
      EXPECT_FALSE(stream.complete());
      ASSERT_EQ(stream.put(pieceOf(hash, size, packed, at)), "");
    }
    ASSERT_TRUE(stream.complete());
    const ArrayPtr array = stream.take();
    ASSERT_NE(array, nullptr);
    ASSERT_EQ(array->size(), size);
    EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), array->data()));
    const ArrayPtr atOnce = unpackArray(packed, size, hash);
    ASSERT_NE(atOnce, nullptr);
    EXPECT_EQ(unpackArray(packed, size, {1, 2}), nullptr);
  }
}

TEST(Arrays, piecesThatDoNotFit) {
  const auto bytes = someBytes(2 * pieceBytes);
  const Hash hash = hashOf(bytes);
  const auto packed = packArray(bytes);
  const auto piece = [&](size_t at) { return pieceOf(hash, bytes.size(), packed, at); };
  EXPECT_NE(ArrayStream(hash, bytes.size()).put(piece(pieceBytes)), "") << "the second first";
  EXPECT_NE(ArrayStream(hash, bytes.size() - 1).put(piece(0)), "") << "another size";
  ArrayStream twice(hash, bytes.size());
  EXPECT_EQ(twice.put(piece(0)), "");
  EXPECT_NE(twice.put(piece(0)), "") << "the first twice";
  auto junk = piece(0);
  junk.data = someBytes(pieceBytes, 5);
  EXPECT_NE(ArrayStream(hash, bytes.size()).put(junk), "");
  // Too large: the packed array holds more bytes than stated.
  const auto larger = packArray(std::vector<std::byte>(1 << 20));
  EXPECT_NE(
      ArrayStream(hash, 1000).put({{.hash = hash, .bytes = 1000, .stored = larger.size()}, larger}),
      "");
  // Too small, and not the array that was stated.
  const std::vector<std::byte> zeros(1000);
  ArrayStream less(hash, 2000), other(hash, 1000);
  const auto small = packArray(zeros);
  EXPECT_EQ(less.put({{.hash = hash, .bytes = 2000, .stored = small.size()}, small}), "");
  EXPECT_TRUE(less.complete());
  EXPECT_EQ(less.take(), nullptr);
  EXPECT_EQ(other.put({{.hash = hash, .bytes = 1000, .stored = small.size()}, small}), "");
  EXPECT_EQ(other.take(), nullptr);
}

TEST(Arrays, theCacheKeepsWhatIsInUseAndThrowsAwayTheOldest) {
  ArrayCache cache(2500);
  const auto make = [] { return std::make_shared<Array>(1000); };
  ArrayPtr used = make();
  cache.put({0, 1}, used);
  for (uint64_t i = 2; i <= 4; i++) cache.put({0, i}, make());
  EXPECT_NE(cache.find({0, 2}, 1000), nullptr); // now array 3 is the oldest
  EXPECT_EQ(cache.find({0, 2}, 999), nullptr);
  cache.trim();
  EXPECT_EQ(cache.bytes(), 2000u);
  EXPECT_NE(cache.find({0, 1}, 1000), nullptr) << "in use";
  EXPECT_NE(cache.find({0, 2}, 1000), nullptr);
  EXPECT_EQ(cache.find({0, 3}, 1000), nullptr);
  EXPECT_EQ(cache.find({0, 4}, 1000), nullptr);
  used.reset();
  ArrayCache none(0);
  none.put({0, 1}, make());
  none.trim();
  EXPECT_EQ(none.count(), 0u);
}

// cluster_wire.cpp: Tests the wire: who is admitted and who is refused, oversized messages,
// heartbeats, lost connections. Real sockets on loopback; the tests wait for events instead of
// times.
#include <thread>

#include <netinet/in.h>
#include <sys/socket.h>

#include "backend/cluster/net/addresses.h"
#include "backend/cluster/net/seal.h"
#include "unit/cluster_wires.h"

using namespace openrt;
using namespace openrt::cluster;
using Kind = Event::Kind;

namespace {

// A peer without the Wire class: a bare socket, and message seals.
class RawPeer {
 public:
  explicit RawPeer(const Wire& other) : socket_(context_, zmq::socket_type::dealer) {
    socket_.set(zmq::sockopt::linger, 0);
    socket_.connect("tcp://" + other.address());
  }
  void send(Frames frames) {
    seal(frames, ++sent_);
    sendAsTheyAre(frames);
  }
  void sendAsTheyAre(const Frames& frames) {
    for (size_t i = 0; i < frames.size(); i++)
      socket_.send(zmq::buffer(frames[i].data(), frames[i].size()),
                   i + 1 < frames.size() ? zmq::send_flags::sndmore : zmq::send_flags::none);
  }
  bool receive(Frames& frames) {
    frames.clear();
    zmq::message_t part;
    do {
      if (!socket_.recv(part, zmq::recv_flags::dontwait)) return false;
      frames.emplace_back(part.data<std::byte>(), part.data<std::byte>() + part.size());
    } while (part.more());
    EXPECT_TRUE(unseal(frames, ++received_));
    return true;
  }

 private:
  zmq::context_t context_;
  zmq::socket_t socket_;
  uint64_t sent_ = 0, received_ = 0;
};

Frames beat() { return encode(0, message::Beat{.sent = 1, .answer = false}); }
Frames hello() { return encode(0, message::Hello{.library = "bare", .threads = 3}); }

// Returns why a peer that connects with these keys is refused, as reported by the server and by the
// client.
std::pair<std::string, std::string> refusals(const KeyRing& server, const KeyRing& client,
                                             const std::string& serverKey = "") {
  Wires wires;
  const Wire& door = wires.add(listening(server));
  const Wire& caller = wires.add(calling(door, client, serverKey));
  const double begin = steadySeconds();
  const std::string theirs = wires.next(caller, Kind::refused).text,
                    ours = wires.next(door, Kind::refused).text;
  testing::Test::RecordProperty("milliseconds", int((steadySeconds() - begin) * 1000));
  EXPECT_FALSE(wires.has(door, Kind::joined));
  EXPECT_FALSE(wires.has(caller, Kind::joined));
  return {theirs, ours};
}

} // namespace

TEST(Wire, bothSidesJoinAndMessagesArriveAsTheyWere) {
  Wires wires;
  Wire& door = wires.add(listening());
  Wire& caller = wires.add(calling(door));
  const Peer there = wires.next(caller, Kind::joined).peer,
             here = wires.next(door, Kind::joined).peer;
  ASSERT_NE(there, 0u);
  ASSERT_NE(here, 0u);
  EXPECT_TRUE(caller.send(there, hello()));
  const Message greeting = read(wires.next(door, Kind::message));
  ASSERT_TRUE(std::holds_alternative<message::Hello>(greeting.body));
  EXPECT_EQ(std::get<message::Hello>(greeting.body).threads, 3u);
  const auto edits = someBytes(3 << 20);
  message::Scene scene{7,    true, false, {{1, 2, {3, 4}}}, {{.name = "vrml97", .hash = {5, 6}}},
                       edits};
  EXPECT_TRUE(door.send(here, encode(99, std::move(scene))));
  const Message back = read(wires.next(caller, Kind::message));
  EXPECT_EQ(back.session, 99u);
  EXPECT_EQ(std::get<message::Scene>(back.body).edits, edits);
  EXPECT_GT(door.traffic(here).sent, edits.size());
  EXPECT_GT(caller.traffic(there).received, edits.size());
}

TEST(Wire, oneCallsManyAndIsCalledByMany) {
  Wires wires;
  Wire& a = wires.add(listening());
  Wire& b = wires.add(listening());
  WireOptions options = listening();
  options.connect = {a.address(), b.address()};
  Wire& master = wires.add(options);
  const Wire& c = wires.add(calling(master));
  for (int i = 0; i < 3; i++) EXPECT_NE(wires.next(master, Kind::joined).peer, 0u);
  EXPECT_NE(wires.next(a, Kind::joined).peer, 0u);
  EXPECT_NE(wires.next(b, Kind::joined).peer, 0u);
  EXPECT_NE(wires.next(c, Kind::joined).peer, 0u);
}

TEST(Wire, addressesBeyondTheLoopbackNeedKeys) {
  for (const char* address : {"0.0.0.0:0", "*:0", "192.0.2.1", "example.org:7447",
                              "[2001:db8::1]:7447", "[::]:0", "128.0.0.1"}) {
    const std::string listens = thrown([&] { Wire({{}, address, {}}); });
    EXPECT_NE(listens.find("--new-key"), std::string::npos) << address << ": " << listens;
    const std::string calls = thrown([&] { Wire({{address}, "", {}}); });
    EXPECT_NE(calls.find("--key"), std::string::npos) << address << ": " << calls;
  }
  for (const char* address : {"127.0.0.1:0", "127.1.2.3:0", "localhost:0", ":0"})
    EXPECT_EQ(thrown([&] { Wire({{}, address, {}}); }), "") << address;
}

TEST(Wire, addressesThatAreNone) {
  for (const char* address :
       {"a:b", "a:70000", "[::1", "[::1]x", "a b:1", "a:1=short", "http://a:1", "a:-1", "a:0"})
    EXPECT_NE(thrown([&] { Wire({{address}, "", {}}); }), "") << address;
}

TEST(Addresses, areReadAndShown) {
  const auto shown = [](const char* text) { return Address::parse(text).shown(); };
  EXPECT_EQ(shown("node1"), "node1:7447");
  EXPECT_EQ(shown("node1:80"), "node1:80");
  EXPECT_EQ(shown("tcp://10.0.0.1:80"), "10.0.0.1:80");
  EXPECT_EQ(shown(":80"), "127.0.0.1:80");
  EXPECT_EQ(shown("::1"), "[::1]:7447");
  EXPECT_EQ(shown("[2001:db8::1]:80"), "[2001:db8::1]:80");
  const std::string key = "rq:rM>}U?@Lns47E1%kR.o@n%FcmmsL/@{H8]yf7";
  const Address a = Address::parse("node1:80=" + key);
  EXPECT_EQ(a.key, key);
  EXPECT_EQ(a.shown(), "node1:80");
  EXPECT_EQ(shownEndpoint("tcp://[::ffff:10.0.0.1]:80"), "10.0.0.1:80");
  EXPECT_EQ(shownEndpoint("::ffff:10.0.0.1"), "10.0.0.1");
  EXPECT_EQ(shownEndpoint("tcp://[::1]:80"), "[::1]:80");
}

TEST(Addresses, namesAreLookedUpWithoutWaiting) {
#ifdef __SANITIZE_THREAD__
  GTEST_SKIP() << "the C library looks names up in threads that the sanitizer does not know";
#endif
  const auto found = [](const char* name, std::string& why) {
    const Lookup lookup(Address::parse(name));
    for (const double end = steadySeconds() + 60; !lookup.ready() && steadySeconds() < end;)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return lookup.result(why);
  };
  std::string why;
  const auto here = found("localhost:80", why);
  if (!here) GTEST_SKIP() << "localhost is not known here (/etc/hosts): " << why;
  EXPECT_TRUE(here->loopback());
  EXPECT_EQ(here->port, 80);
  EXPECT_FALSE(found("no-such-host.invalid", why));
  EXPECT_NE(why, "");
  const Lookup abandoned(Address::parse("another.invalid")); // the destructor does not wait either
}

TEST(Wire, localSocketsAndIpv6) {
  const Folder folder;
  for (const std::string& where : {"ipc://" + folder / "socket", std::string("[::1]:0")}) {
    Wires wires;
    std::unique_ptr<Wire> probe;
    if (!thrown([&] { probe = std::make_unique<Wire>(listening({}, where)); }).empty() &&
        where.starts_with("["))
      continue;
    probe.reset();
    const Wire& door = wires.add(listening({}, where));
    const Wire& caller = wires.add(calling(door));
    EXPECT_NE(wires.next(door, Kind::joined).peer, 0u) << where;
    EXPECT_NE(wires.next(caller, Kind::joined).peer, 0u) << where;
  }
}

TEST(Wire, aPortThatIsTaken) {
  const Wire first(listening());
  EXPECT_NE(thrown([&] {
              Wire({{}, first.address(), {}});
            }).find("cannot listen at " + first.address()),
            std::string::npos);
}

TEST(Wire, oneKeyForAll) {
  const Folder folder;
  const KeyRing keys = freshKeys(folder, "key");
  Wires wires;
  Wire& door = wires.add(listening(keys));
  Wire& caller = wires.add(calling(door, keys));
  EXPECT_NE(wires.next(door, Kind::joined).peer, 0u);
  EXPECT_TRUE(caller.send(wires.next(caller, Kind::joined).peer, hello()));
  EXPECT_EQ(std::get<message::Hello>(read(wires.next(door, Kind::message)).body).library, "bare");
}

TEST(Wire, keysOfOnesOwnAndAList) {
  const Folder folder;
  KeyRing server = freshKeys(folder, "server");
  const KeyRing client = freshKeys(folder, "client");
  server.allowed = {client.publicKey};
  Wires wires;
  const Wire& door = wires.add(listening(server));
  const Wire& caller = wires.add(calling(door, client, server.publicKey));
  EXPECT_NE(wires.next(door, Kind::joined).peer, 0u);
  EXPECT_NE(wires.next(caller, Kind::joined).peer, 0u);
}

TEST(Wire, whoIsNotOnTheListIsRefusedAndBothSay) {
  const Folder folder;
  const KeyRing server = freshKeys(folder, "server"), client = freshKeys(folder, "client");
  const auto [theirs, ours] = refusals(server, client, server.publicKey);
  EXPECT_NE(theirs.find("list"), std::string::npos) << theirs;
  EXPECT_NE(ours.find(client.publicKey), std::string::npos) << ours;
}

TEST(Wire, anotherKeyIsRefusedAndBothSay) {
  const Folder folder;
  const auto [theirs, ours] = refusals(freshKeys(folder, "server"), freshKeys(folder, "client"));
  EXPECT_NE(theirs.find("another key"), std::string::npos) << theirs;
  EXPECT_NE(ours.find("key"), std::string::npos) << ours;
}

TEST(Wire, aKeyOnOneSideOnlyIsRefusedAndBothSay) {
  const Folder folder;
  const KeyRing keys = freshKeys(folder, "key");
  for (const bool onServer : {true, false}) {
    const auto [theirs, ours] = refusals(onServer ? keys : KeyRing(), onServer ? KeyRing() : keys);
    EXPECT_NE(theirs.find("--key"), std::string::npos) << theirs;
    EXPECT_NE(ours.find("key"), std::string::npos) << ours;
  }
}

TEST(Wire, whoCallsANobodyIsToldOnceAndGoesOn) {
  Wires wires;
  std::string address;
  {
    const Wire gone(listening());
    address = gone.address();
  }
  const Wire& caller = wires.add(withLongTimeouts({{address}, "", {}}));
  EXPECT_NE(wires.next(caller, Kind::refused).text.find("there is no answer"), std::string::npos);
  const Wire& door = wires.add(withLongTimeouts({{}, address, {}}));
  EXPECT_NE(wires.next(caller, Kind::joined).peer, 0u);
  EXPECT_NE(wires.next(door, Kind::joined).peer, 0u);
  EXPECT_FALSE(wires.has(caller, Kind::refused));
}

TEST(Wire, whoEndsHasLeftAndIsCalledAgain) {
  Wires wires;
  const Wire& door = wires.add(listening());
  const std::string address = door.address();
  const Wire& caller = wires.add(calling(door));
  const Peer first = wires.next(caller, Kind::joined).peer;
  wires.next(door, Kind::joined);
  wires.end(door);
  EXPECT_EQ(wires.next(caller, Kind::left).peer, first);
  const Wire& again = wires.add(withLongTimeouts({{}, address, {}}));
  EXPECT_NE(wires.next(again, Kind::joined).peer, 0u);
  const Peer second = wires.next(caller, Kind::joined).peer;
  EXPECT_NE(second, 0u);
  EXPECT_NE(second, first);
}

TEST(Wire, aCallerThatEndsHasLeftAfterWhatItSaid) {
  Wires wires;
  const Wire& door = wires.add(listening());
  Wire& caller = wires.add(calling(door));
  const Peer there = wires.next(caller, Kind::joined).peer;
  for (uint32_t i = 0; i < 20; i++)
    EXPECT_TRUE(caller.send(there, encode(i, message::Prepare{.epoch = i})));
  wires.end(caller);
  for (uint32_t i = 0; i < 20; i++) EXPECT_EQ(read(wires.next(door, Kind::message)).session, i);
  EXPECT_NE(wires.next(door, Kind::left).peer, 0u);
}

TEST(Wire, whoIsClosedIsToldWhy) {
  Wires wires;
  Wire& door = wires.add(listening());
  const Wire& caller = wires.add(calling(door));
  door.close(wires.next(door, Kind::joined).peer, "busy with something else");
  EXPECT_EQ(wires.next(caller, Kind::left).text, "busy with something else");
}

TEST(Wire, silenceMeansLeftAndWhoComesToLifeBeginsAnew) {
  Wires wires;
  WireOptions options = listening();
  options.silence = 0.5;
  const Wire& door = wires.add(options);
  RawPeer bare(door);
  bare.send(beat());
  const Peer first = wires.next(door, Kind::joined).peer;
  const Event left = wires.next(door, Kind::left);
  EXPECT_EQ(left.peer, first);
  EXPECT_NE(left.text.find("it sent nothing"), std::string::npos);
  bare.send(hello()); // too late
  bool bye = false;
  for (const double end = steadySeconds() + 30; !bye && steadySeconds() < end; wires.serve())
    for (Frames frames; bare.receive(frames);) {
      Message message;
      ASSERT_EQ(decode(std::move(frames), message), "");
      bye |= std::holds_alternative<message::Bye>(message.body);
    }
  EXPECT_TRUE(bye);
  EXPECT_FALSE(wires.has(door, Kind::message));
  RawPeer again(door);
  again.send(hello());
  EXPECT_NE(wires.next(door, Kind::joined).peer, first);
}

TEST(Wire, beatsKeepTheIdleAliveAndMeasureTheWay) {
  Wires wires;
  WireOptions options = listening();
  options.silence = 2;
  Wire& door = wires.add(options);
  options = calling(door);
  options.silence = 2;
  Wire& caller = wires.add(options);
  const Peer there = wires.next(caller, Kind::joined).peer;
  for (const double end = steadySeconds() + 3; steadySeconds() < end;) wires.serve();
  EXPECT_FALSE(wires.has(door, Kind::left));
  EXPECT_FALSE(wires.has(caller, Kind::left));
  EXPECT_GT(caller.traffic(there).latency, 0);
}

TEST(Wire, threeMessagesThatAreNoneCloseThePeer) {
  const Frames bad[] = {{{}},
                        {someBytes(40)},
                        {someBytes(100000)},
                        {std::vector<std::byte>(64)},
                        Frames(limits::frames + 5, someBytes(4))};
  for (const Frames& junk : bad) {
    Wires wires;
    const Wire& door = wires.add(listening());
    RawPeer bare(door);
    bare.send(hello());
    EXPECT_NE(wires.next(door, Kind::message).peer, 0u);
    bare.send(junk);
    bare.send(junk);
    bare.send(hello());
    EXPECT_NE(wires.next(door, Kind::message).peer, 0u); // two bad messages are tolerated
    bare.send(junk);
    EXPECT_NE(wires.next(door, Kind::left).text.find("three invalid messages"), std::string::npos);
    bare.send(hello());
    for (int i = 0; i < 20; i++) wires.serve();
    EXPECT_FALSE(wires.has(door, Kind::message));
  }
}

TEST(Wire, whoOnlySpeaksJunkNeverJoins) {
  Wires wires;
  const Wire& door = wires.add(listening());
  RawPeer bare(door);
  for (int i = 0; i < 3; i++) bare.send({someBytes(50)});
  EXPECT_NE(wires.next(door, Kind::refused).text.find("three invalid messages"), std::string::npos);
  EXPECT_FALSE(wires.has(door, Kind::joined));
}

TEST(Wire, aFrameThatIsTooLargeEndsTheConnection) {
  Wires wires;
  const Wire& door = wires.add(listening());
  RawPeer bare(door);
  bare.send(hello());
  EXPECT_NE(wires.next(door, Kind::message).peer, 0u);
  bare.send({std::vector<std::byte>(largestMessage + 1)});
  EXPECT_NE(wires.next(door, Kind::left).peer, 0u);
  EXPECT_FALSE(wires.has(door, Kind::message));
}

TEST(Wire, headersThatAreCut) {
  Wires wires;
  const Wire& door = wires.add(listening());
  RawPeer bare(door);
  Frames whole = hello();
  bare.send(whole);
  bare.send(whole); // the same message twice: both arrive, because the wire does not interpret them
  EXPECT_NE(wires.next(door, Kind::message).peer, 0u);
  EXPECT_NE(wires.next(door, Kind::message).peer, 0u);
  for (int i = 0; i < 3; i++) {
    whole[0].resize(whole[0].size() / 2);
    bare.send(whole);
  }
  EXPECT_NE(wires.next(door, Kind::left).peer, 0u);
}

TEST(Wire, whatIsLostRepeatedOrDamagedOnTheWayEndsThePeer) {
  const Frames first = encode(
      7, message::Piece{{.hash = {1, 2}, .bytes = 10, .stored = 10, .offset = 0}, someBytes(10)});
  enum Damage { lost, repeated, damaged, shortened, without };
  for (const Damage damage : {lost, repeated, damaged, shortened, without}) {
    Wires wires;
    const Wire& door = wires.add(listening());
    RawPeer bare(door);
    Frames frames = first;
    seal(frames, 1);
    bare.sendAsTheyAre(frames);
    EXPECT_NE(wires.next(door, Kind::message).peer, 0u);
    frames = first;
    if (damage != repeated) seal(frames, damage == lost ? 3 : 2);
    if (damage == repeated) seal(frames, 1);
    if (damage == damaged) frames[0][frames[0].size() / 2] ^= std::byte(16);
    if (damage == shortened) frames[1].pop_back();
    if (damage == without) frames.pop_back();
    bare.sendAsTheyAre(frames);
    EXPECT_NE(wires.next(door, Kind::left).text.find("lost, repeated or damaged"),
              std::string::npos)
        << damage;
    bare.send(first);
    for (int i = 0; i < 20; i++) wires.serve();
    EXPECT_FALSE(wires.has(door, Kind::message));
  }
}

// A damaged length: the connection waits for a frame that never ends and swallows the heartbeats.
TEST(Wire, beatsInAFrameThatNeverEndsAreSilence) {
  Wires wires;
  WireOptions options = listening();
  options.silence = 0.5;
  const Wire& door = wires.add(options);
  const std::string address = door.address();
  const int fd = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(uint16_t(std::stoi(address.substr(address.rfind(':') + 1))));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(connect(fd, reinterpret_cast<sockaddr*>(&to), sizeof to), 0);
  const auto put = [fd](const std::string& bytes) {
    send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  };
  // ZMTP 3.0: greeting, mechanism NULL, READY.
  put(std::string("\xff\0\0\0\0\0\0\0\x01\x7f\x03\0", 12) + "NULL" + std::string(48, '\0'));
  char greeting[64];
  ASSERT_EQ(recv(fd, greeting, sizeof greeting, MSG_WAITALL), ssize_t(sizeof greeting));
  put(std::string("\x04\x1c\x05READY\x0bSocket-Type\0\0\0\x06"
                  "DEALER",
                  30));
  Frames frames = beat();
  seal(frames, 1);
  for (size_t i = 0; i < frames.size(); i++) {
    std::string head{char(i + 1 < frames.size()), char(frames[i].size())};
    put(head + std::string(reinterpret_cast<const char*>(frames[i].data()), frames[i].size()));
  }
  EXPECT_NE(wires.next(door, Kind::joined).peer, 0u);
  put(std::string("\x02\0\0\0\0\x03\0\0\0", 9)); // announces 48 MiB
  for (const double end = steadySeconds() + 30;
       !wires.has(door, Kind::left) && steadySeconds() < end; wires.serve()) {
    put(std::string(100, 'b'));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  EXPECT_NE(wires.next(door, Kind::left, 0).text.find("it sent nothing"), std::string::npos);
  close(fd);
}

TEST(Wire, aFullQueueSaysSoAndKeepsTheFrames) {
  Wires wires;
  const Wire& door = wires.add(listening());
  Wire& caller = wires.add(calling(door));
  const Peer there = wires.next(caller, Kind::joined).peer;
  const message::Piece piece{{.hash = {1, 2}, .bytes = 1 << 20, .stored = 1 << 20, .offset = 0},
                             someBytes(1 << 20)};
  Frames frames;
  uint32_t sent = 0;
  for (bool taken = true; taken && sent < 10000; sent += taken) { // the peer does not read
    frames = encode(1, message::Piece(piece));
    taken = caller.send(there, std::move(frames));
  }
  ASSERT_LT(sent, 10000u);
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_EQ(frames[1], piece.data);
  for (uint32_t i = 0; i < sent; i++) EXPECT_NE(wires.next(door, Kind::message).peer, 0u);
  EXPECT_TRUE(caller.send(there, std::move(frames)));
  EXPECT_EQ(std::get<message::Piece>(read(wires.next(door, Kind::message)).body).data, piece.data);
}

TEST(Wire, anyThreadWakesIt) {
  Wire wire(listening());
  std::thread other([&] { wire.wake(); });
  EXPECT_EQ(wire.receive(60).kind, Kind::woken);
  other.join();
  EXPECT_EQ(wire.receive(0).kind, Kind::nothing);
}

// cluster_exchange.cpp: Tests how workers pass arrays on: over real wires on loopback, with and
// without keys, and with sources that are absent, damaged or hostile.
#include "backend/cluster/worker/exchange.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include "backend/cluster/worker/array_cache.h"
#include "unit/cluster_wires.h"

using namespace openrt;
using namespace openrt::cluster;

namespace {

// A worker's half of the exchange, and what it has been given.
struct Side {
  Folder place;
  ArrayFolder folder{place / "arrays", uint64_t(1) << 30, {}};
  WorkerCounts counts;
  std::mutex mutex;
  std::condition_variable changed;
  std::map<Hash, ArrayPtr> given;
  Exchange exchange;

  explicit Side(const KeyRing& keys = {}, double patience = 30)
      : exchange({.listen = "127.0.0.1:0",
                  .keys = keys,
                  .patience = patience,
                  .done =
                      [this](const Hash& hash, ArrayPtr array) {
                        const std::lock_guard lock(mutex);
                        EXPECT_TRUE(given.emplace(hash, std::move(array)).second);
                        changed.notify_all();
                      }},
                 folder, counts) {}
  std::string address() const { return "127.0.0.1:" + std::to_string(exchange.port()); }

  message::ArrayName keep(size_t bytes, uint32_t seed) {
    const std::vector<std::byte> array = someBytes(bytes, seed), packed = packArray(array);
    ArrayFolder::Writer writer(folder, hashOf(array), packed.size());
    writer.write(packed);
    writer.keep();
    return {0, bytes, hashOf(array)};
  }
  // Waits for the answer about an array. Returns whether it has come.
  bool comes(const message::ArrayName& name) {
    std::unique_lock lock(mutex);
    EXPECT_TRUE(changed.wait_for(lock, std::chrono::seconds(60), [&] {
      return given.contains(name.hash);
    })) << "no answer";
    const ArrayPtr array = given[name.hash];
    return array && array->size() == name.bytes &&
           hashOf({array->data(), array->size()}) == name.hash;
  }
};

} // namespace

TEST(Exchange, anArrayGoesOnAndOn) {
  Side first, second, third;
  const message::ArrayName small = first.keep(5000, 1), large = first.keep(5 << 20, 2);
  second.exchange.fetch(first.address(), {small, large});
  EXPECT_TRUE(second.comes(small));
  EXPECT_TRUE(second.comes(large));
  third.exchange.fetch(second.address(), {large}); // it has kept it
  EXPECT_TRUE(third.comes(large));
  EXPECT_TRUE(third.folder.load(large.hash, large.bytes));
  EXPECT_GT(first.counts.toWorkers, large.bytes);
  EXPECT_GT(second.counts.toWorkers, large.bytes);
  EXPECT_GT(third.counts.fromWorkers, large.bytes);
}

TEST(Exchange, manyAskOneForMany) {
  Side first;
  std::vector<message::ArrayName> names;
  for (uint32_t i = 0; i < 40; i++) names.push_back(first.keep(5000 + 100000 * (i % 3), i + 1));
  std::vector<std::unique_ptr<Side>> others;
  for (int i = 0; i < 5; i++) {
    others.push_back(std::make_unique<Side>());
    others.back()->exchange.fetch(first.address(), {names.begin(), names.begin() + 20});
    others.back()->exchange.fetch(first.address(), {names.begin() + 20, names.end()});
  }
  for (const auto& other : others)
    for (const message::ArrayName& name : names) EXPECT_TRUE(other->comes(name));
}

TEST(Exchange, whatTheOtherLacksIsSaid) {
  Side first, second;
  const message::ArrayName there = first.keep(50000, 1), missing{0, 50000, {1, 2}};
  second.exchange.fetch(first.address(), {missing, there});
  EXPECT_FALSE(second.comes(missing));
  EXPECT_FALSE(second.comes(there)) << "all that was asked of it is asked elsewhere";
  EXPECT_EQ(second.counts.failedFetches, 2u);
  second.given.clear();
  second.exchange.fetch(first.address(), {there});
  EXPECT_TRUE(second.comes(there));
}

TEST(Exchange, aDamagedFileDoesNotArrive) {
  Side first, second;
  const message::ArrayName name = first.keep(3 << 20, 1);
  const std::string file = first.place / "arrays/" + hex(name.hash) + ".zst";
  std::fstream(file, std::ios::in | std::ios::out).seekp(2 << 20).put('x').put('y').put('z');
  second.exchange.fetch(first.address(), {name});
  EXPECT_FALSE(second.comes(name));
  EXPECT_FALSE(second.folder.open(name.hash, name.bytes));
}

TEST(Exchange, nobodyAtAnAddressIsNoReasonToWait) {
  Side side;
  uint64_t number = 1;
  for (const std::string address :
       {"127.0.0.1:1", "127.0.0.1:0", "no address", "ipc:///tmp/openrt-no-socket",
        "192.0.2.1:7447" /* not loopback, without a key */}) {
    const message::ArrayName name{0, 5000, {number++, 0}};
    side.exchange.fetch(address, {name});
    EXPECT_FALSE(side.comes(name)) << address;
  }
}

TEST(Exchange, aSourceThatSaysNothingIsGivenUp) {
  Wire mute(listening());
  Side side({}, 0.5);
  const message::ArrayName name{0, 5000, {1, 0}};
  side.exchange.fetch(mute.address(), {name});
  std::atomic<bool> over{false};
  std::thread beats([&] {
    while (!over) mute.receive(0.05);
  });
  EXPECT_FALSE(side.comes(name));
  over = true;
  beats.join();
}

TEST(Exchange, keysDecideWhoMayAsk) {
  const Folder folder;
  const KeyRing one = freshKeys(folder, "one"), other = freshKeys(folder, "other");
  Side first(one), friendly(one), stranger(other);
  const message::ArrayName name = first.keep(50000, 1);
  const std::string address = first.address() + "=" + one.publicKey;
  friendly.exchange.fetch(address, {name});
  EXPECT_TRUE(friendly.comes(name));
  stranger.exchange.fetch(address, {name});
  EXPECT_FALSE(stranger.comes(name));
  Side bare;
  bare.exchange.fetch(first.address(), {name});
  EXPECT_FALSE(bare.comes(name));
}

TEST(Exchange, whoSendsNonsenseIsRefused) {
  Side side;
  const message::ArrayName name = side.keep(50000, 1);
  Wires wires;
  Wire& hostile = wires.add(withLongTimeouts({{side.address()}, "", {}}));
  const Peer peer = wires.next(hostile, Event::Kind::joined).peer;
  ASSERT_NE(peer, 0u);
  for (int i = 0; i < 3; i++)
    ASSERT_TRUE(hostile.send(
        peer, encode(0, pieceOf({1, 2}, 5000, packArray(someBytes(5000)), 0)))); // unasked
  EXPECT_NE(wires.next(hostile, Event::Kind::left).text.find("not asked for"), std::string::npos);
  Side other;
  other.exchange.fetch(side.address(), {name});
  EXPECT_TRUE(other.comes(name)) << "others are served";
}

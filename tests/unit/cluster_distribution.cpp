// cluster_distribution.cpp: Tests who sends arrays to whom. Workers are numbers, and transfers take
// a round each.
#include "backend/cluster/master/distribution.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

using namespace openrt;
using namespace openrt::cluster;

namespace {

OfferPtr offerOf(uint64_t number, size_t bytes = 1 << 18) {
  auto offer = std::make_shared<Offer>();
  offer->array = std::make_shared<Array>(bytes);
  offer->hash = {number, 0};
  return offer;
}

std::string addressOf(WorkerId worker) { return "node" + std::to_string(worker) + ":1"; }

// Workers that get what is sent to them in the next round, or fail in it.
struct Farm {
  Distribution d;
  double now = 0;
  std::map<WorkerId, std::set<Hash>> have;
  std::map<WorkerId, size_t> sent; // transfers by sender
  std::set<WorkerId> dead;         // do not send what they have
  size_t failures = 0;

  void join(WorkerId first, size_t count, bool near = false) {
    for (WorkerId w = first; w < first + count; w++) d.join(w, addressOf(w), near);
  }
  // Does one round. Returns the number of transfers.
  size_t round() {
    const std::vector<Distribution::Transfer> begun = d.transfers(now);
    now += 0.1;
    for (const auto& t : begun) {
      sent[t.from]++;
      EXPECT_NE(t.from, t.to);
      const Hash& hash = t.offer->hash;
      const bool good =
          t.from == Distribution::master || (!dead.contains(t.from) && have[t.from].contains(hash));
      if (good) {
        EXPECT_TRUE(have[t.to].insert(hash).second) << "sent twice to " << t.to;
        d.got(t.to, {hash}, true, now);
      } else {
        failures++;
        d.failed(t.to, {hash});
      }
    }
    return begun.size();
  }
  size_t rounds() {
    size_t count = 0;
    while (round() > 0) count++;
    return count;
  }
};

} // namespace

TEST(Distribution, theMasterSendsAnArrayOnceAndTheNumberOfHoldersDoubles) {
  Farm farm;
  farm.join(1, 100);
  const OfferPtr offer = offerOf(1);
  for (WorkerId w = 1; w <= 100; w++) farm.d.need(w, offer, 0);
  EXPECT_EQ(farm.rounds(), 8u); // one from the master, then 2, 4 ... 128 have it
  EXPECT_EQ(farm.sent[Distribution::master], 1u);
  for (WorkerId w = 1; w <= 100; w++) EXPECT_EQ(farm.have[w].size(), 1u);
}

TEST(Distribution, manyArraysBurdenNobodyMuch) {
  Farm farm;
  farm.join(1, 50);
  std::vector<OfferPtr> offers;
  for (uint64_t i = 0; i < 200; i++) offers.push_back(offerOf(i));
  for (WorkerId w = 1; w <= 50; w++)
    for (const OfferPtr& offer : offers) farm.d.need(w, offer, 0);
  EXPECT_LT(farm.rounds(), 60u);
  EXPECT_EQ(farm.sent[Distribution::master], 200u);
  for (WorkerId w = 1; w <= 50; w++) {
    EXPECT_EQ(farm.have[w].size(), 200u);
    EXPECT_LT(farm.sent[w], 3000u); // the average is 196
  }
}

TEST(Distribution, whoComesLaterAsksThoseThatHaveIt) {
  Farm farm;
  farm.join(1, 2);
  const OfferPtr offer = offerOf(1);
  farm.d.need(1, offer, 0);
  farm.d.has(2, offer); // from an earlier day
  farm.have[2].insert(offer->hash);
  farm.rounds();
  EXPECT_EQ(farm.sent[Distribution::master], 0u);
  EXPECT_EQ(farm.sent[2], 1u);
}

TEST(Distribution, workersThatDoNotShareGetAllFromTheMaster) {
  Farm farm;
  farm.join(1, 1);
  farm.d.join(2, "", false);
  const OfferPtr offer = offerOf(1);
  farm.d.need(1, offer, 0);
  farm.d.need(2, offer, 0);
  farm.rounds();
  EXPECT_EQ(farm.sent[Distribution::master], 2u);
}

TEST(Distribution, mediumArraysGoToAFewWorkersAtOnce) {
  const std::vector<std::pair<size_t, size_t>> cases{{5000, 4}, {100000, 2}, {200000, 1}};
  for (const auto& [bytes, first] : cases) {
    Farm farm;
    farm.join(1, 100);
    const OfferPtr offer = offerOf(1, bytes);
    for (WorkerId w = 1; w <= 100; w++) farm.d.need(w, offer, 0);
    EXPECT_EQ(farm.d.transfers(0).size(), first);
    EXPECT_TRUE(farm.d.transfers(0).empty());
  }
}

TEST(Distribution, smallArraysComeFromTheMaster) {
  Farm farm;
  farm.join(1, 10);
  const OfferPtr offer = offerOf(1, 100);
  for (WorkerId w = 1; w <= 10; w++) farm.d.need(w, offer, 0);
  EXPECT_EQ(farm.rounds(), 1u);
  EXPECT_EQ(farm.sent[Distribution::master], 10u);
}

TEST(Distribution, whatADeadWorkerDoesNotSendTheMasterSends) {
  Farm farm;
  farm.join(1, 30);
  std::vector<OfferPtr> offers;
  for (uint64_t i = 0; i < 40; i++) offers.push_back(offerOf(i));
  farm.dead = {1};
  for (WorkerId w = 1; w <= 30; w++)
    for (const OfferPtr& offer : offers) farm.d.need(w, offer, 0);
  farm.rounds();
  for (WorkerId w = 1; w <= 30; w++) EXPECT_EQ(farm.have[w].size(), 40u) << w;
  EXPECT_GT(farm.failures, 0u);
  EXPECT_LE(farm.failures, 40u); // two workers without success are enough to leave it out
  EXPECT_LE(farm.sent[Distribution::master], 40u + farm.failures);
}

TEST(Distribution, aWorkerThatReachesNobodyIsLeftAlone) {
  Farm farm;
  farm.join(1, 10);
  for (uint64_t i = 0; i < 20; i++) { // all others have them all
    const OfferPtr offer = offerOf(i);
    for (WorkerId w = 2; w <= 10; w++) farm.d.has(w, offer);
    farm.d.need(1, offer, 0);
    for (const auto& t : farm.d.transfers(farm.now)) {
      farm.sent[t.from]++;
      if (t.from != Distribution::master) farm.d.failed(1, {offer->hash});
    }
    for (const auto& t : farm.d.transfers(farm.now)) farm.sent[t.from]++;
  }
  EXPECT_EQ(farm.sent[Distribution::master], 20u);
  size_t asked = 0;
  for (const auto& [from, count] : farm.sent) asked += from == Distribution::master ? 0 : count;
  EXPECT_EQ(asked, 2u);
}

TEST(Distribution, whoLeavesIsWaitedForByNobody) {
  Farm farm;
  farm.join(1, 3);
  const OfferPtr offer = offerOf(1);
  for (WorkerId w = 1; w <= 3; w++) farm.d.need(w, offer, 0);
  EXPECT_EQ(farm.d.transfers(0).size(), 1u); // to 1
  EXPECT_TRUE(farm.d.transfers(0).empty());
  farm.d.leave(1);
  farm.rounds();
  EXPECT_EQ(farm.sent[Distribution::master], 1u); // to 2
  EXPECT_EQ(farm.sent[2], 1u);
  farm.d.leave(2);
  farm.d.leave(3);
  EXPECT_TRUE(farm.d.transfers(100).empty());
}

TEST(Distribution, whereNothingArrivesTheMasterSendsToAll) {
  Farm farm;
  farm.join(1, 10);
  const OfferPtr offer = offerOf(1);
  for (WorkerId w = 1; w <= 10; w++) farm.d.need(w, offer, 100);
  EXPECT_EQ(farm.d.transfers(100).size(), 1u); // to 1, which hangs
  EXPECT_TRUE(farm.d.transfers(104).empty());
  EXPECT_EQ(farm.d.transfers(106).size(), 9u);
}

TEST(Distribution, aLargeArrayMayTakeItsTime) {
  Farm farm;
  farm.join(1, 2);
  const OfferPtr offer = offerOf(1, size_t(40) << 20);
  farm.d.need(1, offer, 0);
  farm.d.need(2, offer, 0);
  EXPECT_EQ(farm.d.transfers(0).size(), 1u);
  EXPECT_TRUE(farm.d.transfers(14).empty());
  EXPECT_EQ(farm.d.transfers(16).size(), 1u);
}

TEST(Distribution, loopbackAddressesAreForThisMachineAlone) {
  Farm farm;
  farm.join(1, 1, true);
  farm.join(2, 2, false);
  const OfferPtr offer = offerOf(1);
  farm.d.has(1, offer);
  farm.have[1].insert(offer->hash);
  farm.d.need(2, offer, 0);
  farm.d.need(3, offer, 0);
  farm.rounds();
  EXPECT_EQ(farm.sent[1], 0u);
  EXPECT_EQ(farm.sent[Distribution::master], 1u);
  EXPECT_EQ(farm.sent[2], 1u);
}

TEST(Distribution, whatIsNotKeptIsNotPassedOn) {
  Farm farm;
  farm.join(1, 2);
  const OfferPtr offer = offerOf(1);
  farm.d.need(1, offer, 0);
  EXPECT_EQ(farm.d.transfers(0).size(), 1u);
  farm.d.got(1, {offer->hash}, false, 0);
  farm.d.need(2, offer, 0);
  const auto next = farm.d.transfers(0);
  ASSERT_EQ(next.size(), 1u);
  EXPECT_EQ(next[0].from, Distribution::master);
}

TEST(Distribution, whatWorkersSayOfNothingIsIgnored) {
  Farm farm;
  farm.join(1, 1);
  farm.d.got(1, {{7, 7}}, true, 0);
  farm.d.failed(1, {{7, 7}});
  farm.d.got(9, {{7, 7}}, true, 0);
  farm.d.failed(9, {{7, 7}});
  const OfferPtr offer = offerOf(1);
  farm.d.need(1, offer, 0);
  EXPECT_EQ(farm.d.transfers(0).size(), 1u);
  farm.d.failed(1, {offer->hash}); // no worker was to be asked
  EXPECT_TRUE(farm.d.transfers(0).empty());
  farm.d.got(1, {offer->hash}, true, 0);
  EXPECT_TRUE(farm.d.transfers(0).empty());
}

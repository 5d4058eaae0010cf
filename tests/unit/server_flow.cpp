// server_flow.cpp: Tests the flow control of pages, who leads, and that docs/limits.md has the
// limits of vv serve.
#include <fstream>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "server/flow.h"
#include "server/idle_connections.h"
#include "server/pages.h"
#include "server/save_queue.h"

namespace vv::server {
namespace {

TEST(ServerFlow, APageGetsTheNextPictureWhenItHasAcknowledgedTheLast) {
  PictureFlow flow;
  EXPECT_EQ(flow.take(), 0u);
  flow.offer(1);
  EXPECT_EQ(flow.take(), 1u);
  flow.offer(2);
  EXPECT_EQ(flow.take(), 0u);
  EXPECT_TRUE(flow.isWaiting());
  EXPECT_TRUE(flow.acknowledge(1));
  EXPECT_FALSE(flow.isWaiting());
  EXPECT_EQ(flow.take(), 2u);
}

TEST(ServerFlow, ASlowPageGetsTheNewestPicture) {
  PictureFlow flow;
  for (uint32_t number = 1; number <= 100; ++number) {
    flow.offer(number);
    EXPECT_EQ(flow.take(), number == 1 ? 1u : 0u);
  }
  EXPECT_TRUE(flow.acknowledge(1));
  EXPECT_EQ(flow.take(), 100u);
}

TEST(ServerFlow, OtherAcknowledgementsCountForNothing) {
  PictureFlow flow;
  EXPECT_FALSE(flow.acknowledge(0));
  flow.offer(5);
  EXPECT_FALSE(flow.acknowledge(5)); // not sent yet
  EXPECT_EQ(flow.take(), 5u);
  EXPECT_FALSE(flow.acknowledge(4));
  EXPECT_FALSE(flow.acknowledge(6));
  EXPECT_TRUE(flow.acknowledge(5));
  EXPECT_FALSE(flow.acknowledge(5));
  EXPECT_EQ(flow.take(), 0u); // nothing newer
}

TEST(ServerFlow, MessagesAreLimitedOnAverageAndAtOnce) {
  MessageRate rate;
  int allowed = 0;
  while (rate.allow(100)) ++allowed;
  EXPECT_EQ(allowed, maxMessageBurst);
  EXPECT_FALSE(rate.allow(100));
  allowed = 0;
  while (rate.allow(101)) ++allowed;
  EXPECT_EQ(allowed, maxMessagesPerSecond);
  EXPECT_FALSE(rate.allow(50)); // a clock that goes back gives nothing
  for (int i = 0; i < 10 * maxMessagesPerSecond; ++i)
    EXPECT_TRUE(rate.allow(102 + double(i) / maxMessagesPerSecond));
}

TEST(ServerFlow, PagesOfTheWebAreLimitedOnAverageAndAtOnce) {
  OpenRate rate;
  int allowed = 0;
  for (int i = 0; i < 1000; ++i) allowed += rate.allow(5);
  EXPECT_EQ(allowed, maxOpenBurst);
  for (int i = 0; i < 6000; ++i) allowed += rate.allow(5 + .1 * i); // for ten minutes
  EXPECT_NEAR(allowed, maxOpenBurst + 10 * maxOpensPerMinute, 1);
}

TEST(ServerFlow, OfManyIdleConnectionsTheOldestGoes) {
  IdleConnections<const int*> idle;
  std::vector<int> connections(maxIdleConnections + 2);
  for (int i = 0; i < maxIdleConnections; ++i)
    EXPECT_EQ(idle.add(&connections[size_t(i)]), nullptr);
  idle.remove(&connections[0]);                  // it makes a request
  EXPECT_EQ(idle.add(&connections[0]), nullptr); // it is idle again, now as the newest
  EXPECT_EQ(idle.add(&connections[0]), nullptr); // known already
  const int* const newcomer = &connections[size_t(maxIdleConnections)];
  EXPECT_EQ(idle.add(newcomer), &connections[1]);
  idle.remove(&connections[1]); // its end is told, too
  EXPECT_EQ(idle.add(newcomer + 1), &connections[2]);
}

TEST(ServerFlow, FilesTakeNoMoreThanHalfOfTheTimeWhileOthersLook) {
  SaveQueue queue;
  EXPECT_FALSE(queue.begin(0));
  queue.want({1, Message::Format::png});
  queue.want({2, Message::Format::exr});
  EXPECT_EQ(queue.begin(10)->page, 1u);
  EXPECT_FALSE(queue.begin(11)) << "one at a time";
  queue.end(14, true);
  EXPECT_FALSE(queue.begin(17.9));
  const auto second = queue.begin(18);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->page, 2u);
  EXPECT_EQ(second->format, Message::Format::exr);
  queue.end(20, false);
  queue.want({1, Message::Format::png});
  EXPECT_TRUE(queue.begin(20)) << "nobody else looks";
}

TEST(ServerFlow, FilesThatAreGivenUpAreNotRendered) {
  SaveQueue queue;
  queue.want({1, Message::Format::png});
  queue.want({2, Message::Format::png});
  EXPECT_TRUE(queue.drop(1));
  EXPECT_FALSE(queue.drop(1));
  EXPECT_EQ(queue.begin(0)->page, 2u);
  EXPECT_FALSE(queue.drop(2)) << "it is being rendered";
  queue.want({3, Message::Format::png});
  queue.clear(); // another world
  EXPECT_FALSE(queue.begin(1));
  queue.want({4, Message::Format::png});
  EXPECT_TRUE(queue.begin(1));
}

TEST(ServerFlow, PicturesFitThePageWithinTheLimits) {
  EXPECT_EQ(pictureSizeFor(1600, 900), (PictureSize{1600, 900}));
  for (const auto& [width, height] : {std::pair{65536, 65536}, {65536, 1}, {5000, 3000}, {1, 1}}) {
    const PictureSize size = pictureSizeFor(width, height);
    EXPECT_GE(size.width, 1);
    EXPECT_GE(size.height, 1);
    EXPECT_LE(size.width, maxPictureSide);
    EXPECT_LE(size.height, maxPictureSide);
    EXPECT_LE(size.width * size.height, maxPicturePixels);
  }
  const PictureSize shared = pictureSizeFor(4096, 1024, maxViewPixels / 8.);
  EXPECT_LE(shared.width * shared.height, maxViewPixels / 8);
  EXPECT_NEAR(double(shared.width) / shared.height, 4, .01);
  const PictureSize large = pictureSizeFor(5000, 3000);
  EXPECT_NEAR(double(large.width) / large.height, 5.0 / 3, 0.002);
}

TEST(ServerPages, TheFirstPageLeadsAndTheNextFollowerAfterIt) {
  Pages pages;
  EXPECT_EQ(pages.leader(), 0u);
  for (const uint64_t number : {7u, 8u, 9u}) pages.join(number, 0);
  EXPECT_EQ(pages.leader(), 7u);
  EXPECT_EQ(pages.find(8)->role, Page::Role::follower);
  EXPECT_EQ(pages.separate(8), 1u);
  pages.leave(7);
  EXPECT_EQ(pages.leader(), 9u); // 8 has a view of its own
  EXPECT_EQ(pages.find(9)->role, Page::Role::leader);
  EXPECT_EQ(pages.ownerOf(1), 8u);
  pages.leave(9);
  EXPECT_EQ(pages.leader(), 8u);
  EXPECT_EQ(pages.find(8)->view, 0u);
  EXPECT_EQ(pages.ownerOf(1), 0u);
  pages.leave(8);
  EXPECT_EQ(pages.leader(), 0u);
}

TEST(ServerPages, ViewsAreLimitedAndUsedAgain) {
  Pages pages;
  for (uint64_t number = 1; number <= maxViews + 1; ++number) pages.join(number, 0);
  EXPECT_EQ(pages.separate(1), 0u); // the leader has the view of the world
  for (uint64_t number = 2; number <= maxViews; ++number)
    EXPECT_EQ(pages.separate(number), number - 1);
  EXPECT_EQ(pages.separate(2), 0u);
  EXPECT_EQ(pages.separate(maxViews + 1), 0u);
  EXPECT_TRUE(pages.follow(3));
  EXPECT_FALSE(pages.follow(3));
  EXPECT_EQ(pages.separate(maxViews + 1), 2u);
  EXPECT_EQ(pages.separate(99), 0u);
}

TEST(ServerPages, PagesThatDoNotAnswerDoNotLook) {
  Pages pages;
  EXPECT_FALSE(pages.isWatched(0));
  pages.join(1, 0);
  EXPECT_FALSE(pages.isWatched(0)); // its size is not known
  Page& page = *pages.find(1);
  page.sized = true;
  EXPECT_TRUE(pages.isWatched(100));
  page.flow.offer(1);
  page.flow.take();
  page.answered = 100;
  EXPECT_TRUE(pages.isWatched(101));
  EXPECT_FALSE(pages.isWatched(103));
  page.flow.acknowledge(1);
  EXPECT_TRUE(pages.isWatched(200));
}

TEST(ServerLimits, AreInTheDocumentation) {
  std::string rows;
  for (const Limit& limit : limits)
    rows += fmt::format("| `{}` | {} | {} |\n", limit.name, limit.value, limit.text);
  std::ifstream file("docs/limits.md");
  ASSERT_TRUE(file) << "docs/limits.md is missing";
  std::stringstream page;
  page << file.rdbuf();
  EXPECT_NE(page.str().find(rows), std::string::npos) << "docs/limits.md must hold these rows:\n"
                                                      << rows;
}

} // namespace
} // namespace vv::server

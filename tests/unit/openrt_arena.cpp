// openrt_arena.cpp: the arena allocator of render threads.
#include <gtest/gtest.h>

#include <cstdint>

#include "render/arena.h"

namespace openrt {
namespace {

TEST(Arena, BlocksAreAlignedAndApart) {
  Arena arena;
  auto* first = arena.take<uint8_t>(1);
  auto* second = arena.take<float>(lanes);
  auto* third = arena.take<float>(1);
  for (void* block : {static_cast<void*>(first), static_cast<void*>(second)})
    EXPECT_EQ(reinterpret_cast<uintptr_t>(block) % 64, 0u);
  EXPECT_GE(reinterpret_cast<uint8_t*>(second), first + 1);
  EXPECT_GE(third, second + lanes);
}

TEST(Arena, ReleasedMemoryIsTakenAgainAndEarlierBlocksKeepTheirValues) {
  Arena arena;
  auto* kept = arena.takeNumbers(lanes);
  void* released[2];
  for (void*& block : released) {
    ArenaScope scope(arena);
    block = arena.takeZero<float>(1000);
    arena.takeZero<float>(1 << 20); // more than a chunk
  }
  EXPECT_EQ(released[0], released[1]);
  for (uint32_t i = 0; i < lanes; i++) EXPECT_EQ(kept[i], i);
}

#ifdef __SANITIZE_ADDRESS__
TEST(Arena, TheAddressSanitizerKnowsTheBlocksInUse) {
  Arena arena;
  auto* kept = arena.take<uint8_t>(64);
  const auto forbidden = [](const void* at) { return __asan_address_is_poisoned(at) != 0; };
  EXPECT_FALSE(forbidden(kept + 63));
  EXPECT_TRUE(forbidden(kept + 64));
  const uint8_t *small, *large;
  {
    ArenaScope scope(arena);
    small = arena.take<uint8_t>(3);
    large = arena.take<uint8_t>(2 << 20);
    EXPECT_FALSE(forbidden(small + 2));
    EXPECT_TRUE(forbidden(small + 3));
    EXPECT_FALSE(forbidden(large + (2 << 20) - 1));
  }
  EXPECT_TRUE(forbidden(small));
  EXPECT_TRUE(forbidden(large));
  EXPECT_FALSE(forbidden(kept));
}
#endif

} // namespace
} // namespace openrt

// openrt_slivers.cpp: Tests what keeps rays from slivers that they miss: the rejection in single
// precision, which must never reject a hit, and the bounds of pieces, which must cover the
// triangle.
#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <random>

#include "backend/local/ray_triangle.h"
#include "backend/local/sliver_lanes.h"
#include "backend/local/sliver_pieces.h"

using namespace openrt;

namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();

class Random {
 public:
  double operator()(double low, double high) {
    return low + (high - low) * double(engine_()) / 4294967296.0;
  }
  Vec3d direction() {
    while (true) {
      const Vec3d v{(*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)};
      if (dot(v, v) > .01 && dot(v, v) < 1) return normalize(v);
    }
  }

 private:
  std::mt19937 engine_{7};
};

struct Triangle {
  Vec3d a, b, c;
  Vec3d at(double u, double v) const { return a * (1 - u - v) + b * u + c * v; }
};

// A triangle far longer than high, in an odd direction, with corners that are floats.
Triangle randomSliver(Random& random, double size) {
  const Vec3d along = random.direction(), up = normalize(cross(along, random.direction())),
              place = random.direction() * (size * random(0, 20));
  const double thin = std::exp2(random(-16, -6));
  const auto corner = [&](double x, double y) {
    return Vec3d(Vec3f(place + (along * x + up * (thin * y)) * size));
  };
  return {corner(-1, 0), corner(random(.5, 1), random(0, 1)), corner(random(-.5, 1), 1)};
}

struct Packet {
  float origin[3][16], direction[3][16];
  int valid[16];
  PacketLines lines(uint32_t size) const {
    return {
        {origin[0], origin[1], origin[2]}, {direction[0], direction[1], direction[2]}, valid, size};
  }
  void set(uint32_t i, const Vec3d& from, const Vec3d& d) {
    store(Vec3f(from), origin, i);
    store(Vec3f(d), direction, i);
    valid[i] = -1;
  }
};

// Returns whether any test of slivers.cpp could find a hit, if all edges of the triangle are open.
bool isPossible(const Triangle& s, const Packet& packet, uint32_t i) {
  const auto vector = [&](const float(&v)[3][16]) { return Vec3d{v[0][i], v[1][i], v[2][i]}; };
  const Vec3d o = vector(packet.origin), d = vector(packet.direction);
  const RelativeTriangle seen{s.a - o, s.b - o, s.c - o};
  TriangleHit at;
  return intersectTriangle(seen, d, at) ||
         closestPointToLine(seen, d, 7, at) <=
             0x1p-21 * largest(max(max(abs(seen.a), abs(seen.b)), abs(seen.c))) ||
         isHitInSinglePrecision(seen, d, 0, infinite);
}

TEST(Slivers, TheRejectionOfPacketsKeepsEveryHit) {
  Random random;
  size_t possible = 0;
  for (int n = 0; n < 6000; n++) {
    const double size = std::exp2(random(-20, 20)), speed = std::exp2(random(-30, 30));
    const Triangle s = randomSliver(random, size);
    const SliverOutline outline(s.a, s.b, s.c);
    Packet packet;
    for (uint32_t i = 0; i < 16; i++) {
      // On the triangle, on an edge or near it, at any angle.
      const double u = i % 4 == 0 ? 0 : random(0, 1), v = (1 - u) * (i % 4 == 1 ? 1 : random(0, 1));
      const Vec3d along = s.b - s.a,
                  d = normalize(random.direction() +
                                normalize(along) * (i % 2 ? std::exp2(random(0, 20)) : 0));
      const double near = i % 3 == 0 ? 0 : std::exp2(random(-24, 2));
      const Vec3d to = s.at(u, v) + random.direction() * (size * near);
      packet.set(i, to - d * (size * random(0, 4)), d * speed);
    }
    const uint32_t found = mayHit(outline, packet.lines(16));
    for (uint32_t i = 0; i < 16; i++) {
      if (!isPossible(s, packet, i)) continue;
      possible++;
      ASSERT_TRUE(found >> i & 1) << "sliver " << n << " ray " << i;
    }
    for (const uint32_t width : {1u, 4u, 8u})
      EXPECT_EQ(mayHit(outline, packet.lines(width)), found & ((1u << width) - 1)) << width;
  }
  EXPECT_GT(possible, 10000u);
}

TEST(Slivers, MostRaysInTheBoundsOfASliverAreRejected) {
  Random random;
  size_t possible = 0, kept = 0;
  constexpr int slivers = 1000;
  for (int n = 0; n < slivers; n++) {
    const Triangle s = randomSliver(random, 1);
    const Vec3d low = min(min(s.a, s.b), s.c), size = max(max(s.a, s.b), s.c) - low;
    Packet packet;
    for (uint32_t i = 0; i < 16; i++) {
      const Vec3d d = random.direction(),
                  to = low + size * Vec3d{random(0, 1), random(0, 1), random(0, 1)};
      packet.set(i, to - d * 4, d);
      possible += isPossible(s, packet, i);
    }
    kept += size_t(std::popcount(mayHit(SliverOutline(s.a, s.b, s.c), packet.lines(16))));
  }
  EXPECT_LT(kept - possible, 16u * slivers / 50);
}

TEST(Slivers, RaysThatAreNotTracedAreNotFound) {
  const SliverOutline outline({0, 0, 0}, {1, 0, 0}, {1, .001, 0});
  Packet packet;
  for (uint32_t i = 0; i < 16; i++) {
    packet.set(i, {.9, .0005, 1}, {0, 0, -1});
    packet.valid[i] = i % 3 ? -1 : 0;
  }
  for (uint32_t i = 0; i < 16; i++)
    EXPECT_EQ(mayHit(outline, packet.lines(16)) >> i & 1, i % 3 ? 1u : 0u);
}

// Numbers that leave the range of floats decide nothing.
TEST(Slivers, NothingIsRejectedWithNumbersOutOfRange) {
  Packet packet;
  for (const double size : {1e-20, 1e-14, 1e14, 1e18})
    for (const double speed : {1e-18, 1., 1e18}) {
      const SliverOutline outline({0, 0, 0}, {size, 0, 0}, {size, size / 1000, 0});
      for (uint32_t i = 0; i < 16; i++)
        packet.set(i, {.9 * size, .0005 * size, size}, {0, 0, -speed});
      EXPECT_EQ(mayHit(outline, packet.lines(16)), 0xffffu) << size << " " << speed;
    }
}

TEST(Slivers, PiecesCoverTheTriangleAndOwnEachPointOnce) {
  Random random;
  size_t cut = 0;
  for (int n = 0; n < 500; n++) {
    const Triangle s = randomSliver(random, 1);
    const uint8_t count = countPieces(s.a, s.b, s.c);
    EXPECT_TRUE(count <= 16 && std::has_single_bit(count));
    cut += count > 1;
    for (int i = 0; i < 100; i++) {
      const double u = random(0, 1), v = (1 - u) * random(0, 1);
      const Vec3d p = s.at(u, v);
      int owners = 0;
      for (uint8_t k = 0; k < count; k++) {
        if (!isInPiece(s.a, s.b, s.c, {k, count}, p)) continue;
        owners++;
        const Box box = boundsOfPiece(s.a, s.b, s.c, {k, count});
        EXPECT_LT(largest(max(box.low - p, p - box.high)), 1e-13);
      }
      EXPECT_EQ(owners, 1);
    }
  }
  EXPECT_GT(cut, 400u);
  // A sliver along an axis has a thin box already.
  EXPECT_EQ(countPieces({0, 0, 0}, {1, 0, 0}, {1, .001, 0}), 1);
}

} // namespace

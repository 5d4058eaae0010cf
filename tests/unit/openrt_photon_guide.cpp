// openrt_photon_guide.cpp: Tests the distribution of directions that photons give.
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "render/lights/photon_guide.h"

namespace openrt {
namespace {

class PhotonGuides : public testing::Test {
 protected:
  float random() { return float(numbers_() >> 8) * 0x1p-24f; }
  // Photons on the square from 0 0 0 to 1 1 0. Their light comes from near a point.
  std::vector<Photon> onASquare(size_t count, const Vec3f& from, float spread) {
    std::vector<Photon> photons(count);
    for (Photon& p : photons) {
      p.position = {random(), random(), 0};
      const Vec3f apart{spread * random(), spread * random(), spread * random()};
      p.direction = from + apart - p.position;
      p.last = p.total = length(p.direction);
      p.direction = normalize(p.direction);
      p.power = .1f + random();
    }
    return photons;
  }
  std::mt19937 numbers_{1};
};

// The mean of f / pdf over the samples is the integral of f over all directions.
TEST_F(PhotonGuides, ThePdfIsThatOfTheSamples) {
  const PhotonGuide guide(onASquare(5000, {.5f, .5f, 1}, 2));
  const Vec3f position{.3f, .6f, 0};
  const uint32_t cell = guide.find(position);
  ASSERT_NE(cell, PhotonGuide::none);
  const auto f = [](const Vec3f& d) { return d.z > 0 ? double(d.z) * d.z * (1 + d.x) : 0.0; };
  double sum = 0;
  constexpr int n = 200'000;
  for (int i = 0; i < n; i++) {
    Vec3f direction;
    const float pdf = guide.sample(cell, position, random(), random(), random(), direction);
    ASSERT_GT(pdf, 0);
    EXPECT_NEAR(length(direction), 1, 1e-5);
    sum += f(direction) / double(pdf) / n;
  }
  EXPECT_NEAR(sum, 2 * M_PI / 3, .02);
}

TEST_F(PhotonGuides, SharesScaleThePdfAndEndCells) {
  PhotonGuide guide(onASquare(200, {.5f, .5f, 1}, 1));
  const Vec3f position{.3f, .6f, 0}, up{0, 0, 1};
  const uint32_t cell = guide.find(position);
  ASSERT_NE(cell, PhotonGuide::none);
  EXPECT_EQ(guide.share(cell), 1);
  const float pdf = guide.pdf(cell, position, up);
  std::vector<float> shares(guide.cells(), .25f);
  guide.setShares(shares);
  EXPECT_EQ(guide.find(position), cell);
  EXPECT_FLOAT_EQ(guide.pdf(cell, position, up), pdf / 4);
  shares[cell] = 0;
  guide.setShares(shares);
  EXPECT_EQ(guide.find(position), PhotonGuide::none);
  EXPECT_FALSE(guide.empty());
  guide.setShares(std::vector<float>(shares.size(), 0));
  EXPECT_TRUE(guide.empty());
}

// Light from one point needs narrow lobes, wherever in the cell they are looked up.
TEST_F(PhotonGuides, LobesLeadToWhereTheLightCameFrom) {
  const Vec3f from{2, -1, 3};
  const PhotonGuide guide(onASquare(1000, from, 1e-6f));
  int near = 0, found = 0;
  for (int i = 0; i < 1000; i++) {
    const Vec3f position{random(), random(), 0};
    const uint32_t cell = guide.find(position);
    if (cell == PhotonGuide::none) continue; // in a corner
    found++;
    Vec3f direction;
    const float pdf = guide.sample(cell, position, random(), random(), random(), direction);
    EXPECT_FLOAT_EQ(pdf, guide.pdf(cell, position, direction));
    near += dot(direction, normalize(from - position)) > 1 - 1e-5f && pdf > 1000;
  }
  EXPECT_GT(found, 950);
  EXPECT_GT(near, .95 * found);
}

TEST_F(PhotonGuides, PlacesWithoutPhotonsHaveNoCell) {
  const PhotonGuide guide(onASquare(1000, {0, 0, 1}, 1));
  EXPECT_NE(guide.find({.5f, .5f, 0}), PhotonGuide::none);
  EXPECT_EQ(guide.find({.5f, .5f, 1}), PhotonGuide::none);
  EXPECT_EQ(guide.find({40, .5f, 0}), PhotonGuide::none);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(guide.find({nan, .5f, 0}), PhotonGuide::none);
}

TEST_F(PhotonGuides, TooFewAndUselessPhotonsTeachNothing) {
  EXPECT_TRUE(PhotonGuide({}).empty());
  EXPECT_TRUE(PhotonGuide(onASquare(7, {0, 0, 1}, 1)).empty());
  std::vector<Photon> photons = onASquare(20, {0, 0, 1}, 1);
  const float infinite = std::numeric_limits<float>::infinity();
  for (size_t i = 0; i < photons.size(); i++) {
    if (i % 4 == 0) photons[i].power = 0;
    if (i % 4 == 1) photons[i].position.x = infinite;
    if (i % 4 == 2) photons[i].direction.y = std::numeric_limits<float>::quiet_NaN();
    if (i % 4 == 3) photons[i].power = infinite;
  }
  EXPECT_TRUE(PhotonGuide(photons).empty());
}

// Flat mirrors show the emitter in one place, wherever on the mirror the light was reflected.
TEST_F(PhotonGuides, TheImageOfAnEmitterIsItsFocus) {
  const Vec3f image{.3f, .2f, -2};
  std::vector<Photon> photons = onASquare(1000, image, 0);
  for (Photon& p : photons) p.last *= .6f;
  const PhotonGuide guide(photons);
  const Vec3f position{.7f, .1f, 0}, wanted = normalize(image - position);
  const uint32_t cell = guide.find(position);
  ASSERT_NE(cell, PhotonGuide::none);
  EXPECT_GT(guide.pdf(cell, position, wanted), 1e5f);
}

// Light that a lens gathers comes from all sides of a focus behind the surface.
TEST_F(PhotonGuides, AFocusMayLieBehindTheSurface) {
  const Vec3f focus{.5f, .5f, -1};
  std::vector<Photon> photons(1000);
  for (Photon& p : photons) {
    p.position = {random(), random(), 0};
    p.direction = normalize(p.position - focus);
    p.last = .5f;
    p.total = 3;
    p.power = 1;
  }
  const PhotonGuide guide(photons);
  const Vec3f position{.7f, .1f, 0};
  const uint32_t cell = guide.find(position);
  ASSERT_NE(cell, PhotonGuide::none);
  Vec3f direction;
  for (int i = 0; i < 100; i++) {
    guide.sample(cell, position, random(), random() * .9f, random(), direction);
    EXPECT_GT(dot(direction, normalize(position - focus)), .97f);
  }
}

// Photons in one place, and light that comes from where it arrives, give no pdf that is not a
// number.
TEST_F(PhotonGuides, PhotonsInOnePlaceAreHarmless) {
  const PhotonGuide guide(std::vector<Photon>(100, {{1, 1, 1}, {0, 0, 1}, 1, 1, 1}));
  const uint32_t cell = guide.find({1, 1, 1});
  ASSERT_NE(cell, PhotonGuide::none);
  Vec3f direction;
  const float pdf = guide.sample(cell, {1, 1, 1}, .5f, .5f, .5f, direction);
  EXPECT_TRUE(std::isfinite(pdf) && pdf > 0);
  EXPECT_NEAR(length(direction), 1, 1e-5);
}

} // namespace
} // namespace openrt

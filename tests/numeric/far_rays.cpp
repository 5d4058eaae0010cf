// far_rays.cpp: instances and rays whose numbers Embree could not compute with: it transforms rays
// into the frame of an instance in single precision, and ends the process where they are not finite
// there or too large.
#include <cmath>
#include <limits>
#include <random>

#include "numeric/support.h"

namespace numeric {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

using FarRays = Scene;

// Returns an ellipsoid, which is drawn as an instance of the unit sphere.
RTid ellipsoid(const Vec& radii) {
  const RTid object = rtBeginObject(0);
  rtSphere(1);
  rtEndObject();
  rtPushMatrix();
  rtScaled(radii.x, radii.y, radii.z);
  const RTid instance = rtInstantiateObject(object);
  rtPopMatrix();
  return instance;
}

RThit cast(const RTray& ray) {
  RThit hit;
  rtCastRays(1, &ray, &hit);
  uint8_t occluded = 2;
  rtOccludedRays(1, &ray, &occluded);
  EXPECT_EQ(occluded, std::isfinite(hit.t));
  return hit;
}

TEST_F(FarRays, HitSmallInstancesFromAnywhere) {
  use(tilted(0));
  ellipsoid({1e-3, 5e-4, 1e-3});
  look();
  for (const double away : {1e2, 1e15, 1e16, 1e17, 1e18}) {
    SCOPED_TRACE(away);
    const auto z = float(away);
    EXPECT_NEAR(double(cast({{0, 0, z}, 0, {0, 0, -1}, infinity}).t), away, 1e-4 * away);
    EXPECT_NEAR(double(cast({{0, 0, z}, 0, {0, 0, -2}, infinity}).t), away / 2, 1e-4 * away);
    EXPECT_EQ(cast({{0, 0, z}, 0, {0, 0, 1}, infinity}).t, infinity);      // away from it
    EXPECT_EQ(cast({{0, 0, z}, 0, {0, 0, -1}, z / 2}).t, infinity);        // ends before it
    EXPECT_EQ(cast({{0, 0, z}, 2 * z, {0, 0, -1}, infinity}).t, infinity); // begins behind it
    EXPECT_EQ(cast({{1, 0, z}, 0, {0, 0, -1}, infinity}).t, infinity);     // passes it
  }
  EXPECT_EQ(stats().rejected.rays, 0u);
}

TEST_F(FarRays, HitSmallInstancesAlongDirectionsOfAnyLength) {
  use(tilted(0));
  ellipsoid({1e-3, 5e-4, 1e-3});
  look();
  for (const float length : {1e-15f, 1e-5f, 1.0f, 1e10f, 1e16f, 9e17f}) {
    SCOPED_TRACE(length);
    const float t = cast({{0, 0, 5}, 0, {0, 0, -length}, infinity}).t;
    EXPECT_NEAR(double(t) * double(length), 5 - 1e-3, 1e-5);
  }
  EXPECT_EQ(stats().rejected.rays, 0u);
}

TEST_F(FarRays, InstancesThatAreTooSmallForTheirDistanceAreNotDrawn) {
  use(tilted(0));
  ellipsoid({1, 2, 1});
  for (const auto& [size, x] : {std::pair{4e-15, 1e5}, {4e-14, 1e8}, {4e-12, 1e8}, {1e-12, 1e10}}) {
    SCOPED_TRACE(testing::Message() << size << " at " << x);
    rtPushMatrix();
    rtTranslated(x, 0, 0);
    const RTid small = ellipsoid({size, size / 2, size});
    rtPopMatrix();
    look();
    EXPECT_EQ(stats().rejected.instances, 1u);
    EXPECT_EQ(cast({{5, 0, 0}, 0, {1, 0, 0}, infinity}).t, infinity);
    rtDeleteInstance(small);
    look();
    EXPECT_EQ(stats().rejected.instances, 0u);
  }
}

// A matrix that flattens in a direction that is not an axis is singular in single precision.
TEST_F(FarRays, FlatInstancesAreHitOrCounted) {
  use(tilted(0));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const double flat : {1e-2, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-10, 1e-13})
    for (int i = 0; i < 20; i++) {
      rtPushMatrix();
      rtTranslated(0, 0, -5);
      rtRotated(180 * unit(random), unit(random), unit(random), unit(random));
      const RTid object = rtBeginObject(0);
      rtSphere(1);
      rtEndObject();
      rtScaled(1, 1, flat);
      rtRotated(180 * unit(random), unit(random), unit(random), unit(random));
      const RTid instance = place(object);
      rtPopMatrix();
      look();
      const float t = cast({{0, 0, 0}, 0, {0, 0, -1}, infinity}).t;
      const bool drawn = stats().rejected.instances == 0;
      if (flat >= 1e-5) {
        EXPECT_TRUE(drawn) << flat;
        EXPECT_NEAR(double(t), 5, 1) << flat;
      } else if (!drawn) {
        EXPECT_EQ(t, infinity) << flat;
      }
      rtDeleteInstance(instance);
      rtDeleteObject(object);
    }
}

} // namespace
} // namespace numeric

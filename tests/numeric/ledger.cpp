// ledger.cpp: what pictures leave out on purpose and report: RTstats.leftOut,
// RTstats.transport.unreachedLights, RTstats.rejected.hits. N18 of the accuracy catalogue, and the
// checks for slivers (N6).
#include "numeric/support.h"

namespace numeric {
namespace {

class Ledger : public Scene {
 protected:
  // Two mirrors that face each other; every image is followed.
  static void mirrors(double reflectance) {
    const Shader mirror =
        Shader("Mirror").set("reflectance", {reflectance, reflectance, reflectance});
    place(square(mirror));
    rtPushMatrix();
    rtTranslated(0, 0, 5);
    rtRotated(180, 1, 0, 0);
    place(square(mirror));
    rtPopMatrix();
    rtQuality(RT_TRANSPORT, RT_TRANSPORT_WHITTED);
  }
  static Rgba between() { return look(0, 0, 4); }
};

TEST_F(Ledger, WhatTheDepthLimitCuts) {
  mirrors(.9);
  for (const int depth : {1, 3, 10}) {
    rtQuality(RT_MAX_DEPTH, depth);
    between();
    expectClose(stats().leftOut.cutByDepth, 3 * std::pow(.9, depth + 1));
    EXPECT_EQ(stats().leftOut.cutByEnergy, 0);
  }
}

// D16: a ray that meets 25 mirrors before the lamp. The depth limit counts surfaces: below 25 the
// light is missing and the ledger has its throughput; from 25 on it is complete.
TEST_F(Ledger, D16AChainOf25ReflectionsNeedsADepthOf25) {
  constexpr double reflectance = .97;
  const Shader mirror =
      Shader("Mirror").set("reflectance", {reflectance, reflectance, reflectance});
  // Mirrors at z = 0 and 1; the ray goes down at 45 degrees and meets one of them at x = i - 1/2.
  const auto strip = [&](double z, bool down) {
    rtPushMatrix();
    rtTranslated(0, 0, z);
    if (down) rtRotated(180, 1, 0, 0);
    place(square(mirror, 1000));
    rtPopMatrix();
  };
  strip(0, false);
  strip(1, true);
  rtPushMatrix(); // the lamp stands across, after the 25th reflection
  rtTranslated(25, 0, .5);
  rtRotated(-90, 0, 1, 0);
  place(square(Shader("Diffuse").set("emission", {3, 3, 3}).set("reflectance", {0, 0, 0}), .5));
  rtPopMatrix();
  rtPushMatrix();
  rtLoadIdentity();
  rtLookAt(0, 0, .5, .5, 0, 0, 0, 1, 0);
  rtOrtho(1e-6);
  rtPopMatrix();
  const double throughput = std::pow(reflectance, 25);
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_WHITTED);
  for (const int depth : {24, 25, 26, 50}) {
    rtQuality(RT_MAX_DEPTH, depth);
    const Rgba seen = render();
    EXPECT_NEAR(double(seen.r), depth < 25 ? 0 : 3 * throughput, 1e-5 * 3 * throughput);
    EXPECT_NEAR(stats().leftOut.cutByDepth, depth < 25 ? 3 * throughput : 0, 1e-5 * 3 * throughput);
  }
}

TEST_F(Ledger, WhatTheEnergyCutCuts) {
  mirrors(.5);
  rtQualityf(RT_ENERGY_CUT, .01);
  between();
  expectClose(stats().leftOut.cutByEnergy, 3 * std::pow(.5, 7)); // the first power of .5 below .01
  EXPECT_EQ(stats().leftOut.cutByDepth, 0);
  rtQualityf(RT_ENERGY_CUT, 0);
  rtQuality(RT_MAX_DEPTH, 20);
  between();
  EXPECT_EQ(stats().leftOut.cutByEnergy, 0);
  EXPECT_GT(stats().leftOut.cutByDepth, 0);
}

TEST_F(Ledger, N18ClampingSaysWhatItTakesAway) {
  Shader lamp("Diffuse");
  lamp.set("emission", {5, 1, .5}).set("reflectance", {0, 0, 0});
  place(square(lamp));
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  rtQuality(RT_SAMPLES_PER_PIXEL, 16);
  expectColor(look(), {5, 1, .5});
  EXPECT_EQ(stats().leftOut.clipped, 0);
  rtQualityf(RT_CLAMP, 2);
  expectColor(look(), {2, 1, .5});
  expectClose(stats().leftOut.clipped, 3);
}

// A noisy picture. With and without clamping the paths are the same.
TEST_F(Ledger, N18WhatIsClippedIsWhatIsMissing) {
  const Shader floor("Diffuse");
  place(square(floor));
  Shader lamp("Diffuse");
  lamp.set("emission", {300, 300, 300}).set("reflectance", {0, 0, 0});
  rtPushMatrix();
  rtTranslated(0, 0, 1);
  rtRotated(180, 1, 0, 0);
  place(square(Shader("Glass"), 4));
  rtTranslated(0, 0, -.2);
  place(square(lamp, .1));
  rtPopMatrix();
  rtPushMatrix();
  rtTranslated(0, 0, .8);
  rtPerspective(50);
  rtPopMatrix();
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  rtQuality(RT_SAMPLES_PER_PIXEL, 32);
  const auto mean = [] {
    rtFrameBuffer(16, 16, RT_RGBA);
    rtRender();
    std::vector<float> rgba(4 * 256);
    rtReadPixels(RT_RGBA, rgba.data(), rgba.size());
    double sum = 0;
    for (size_t i = 0; i < rgba.size(); i++) sum += i % 4 == 3 ? 0 : double(rgba[i]) / 256;
    return sum;
  };
  const double all = mean();
  rtQualityf(RT_CLAMP, 2);
  const double rest = mean(), clipped = stats().leftOut.clipped;
  EXPECT_GT(clipped, .05 * all);
  expectClose(rest + clipped, all);
}

TEST_F(Ledger, LightsThatPathsCannotReachThroughGlass) {
  place(square(Shader("Diffuse")));
  use(point({0, 0, 3}, {0, 0, 1}));
  use(tilted(20));
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_PATH);
  look();
  EXPECT_EQ(stats().transport.unreachedLights, 0u);
  const RTid pane = place(square(Shader("Glass"), 1));
  look();
  EXPECT_EQ(stats().transport.unreachedLights, 2u);
  rtQuality(RT_TRANSPORT, RT_TRANSPORT_WHITTED);
  look();
  EXPECT_EQ(stats().transport.unreachedLights, 0u);
  rtDeleteInstance(pane);
}

// Triangles 10 units long and 1e-4 high in odd directions. Rays pass 2 % beside their end at
// grazing angles, where single precision reports some hits.
TEST_F(Ledger, N6WrongHitsOnSliversAreRejectedAndCounted) {
  constexpr int triangles = 200, each = 20;
  uint32_t state = 1;
  const auto random = [&] {
    state = state * 1664525u + 1013904223u;
    return double(state >> 8) / 16777216 - .5;
  };
  const auto direction = [&] {
    const double v[3] = {random(), random(), random()},
                 l = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    return Vec{v[0] / l, v[1] / l, v[2] / l};
  };
  const auto sum = [](Vec a, double s, Vec b) {
    return Vec{a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
  };
  const auto across = [](Vec a, Vec b) {
    const Vec c{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    const double l = std::sqrt(c.x * c.x + c.y * c.y + c.z * c.z);
    return Vec{c.x / l, c.y / l, c.z / l};
  };
  uint64_t found = 0, wrong = 0;
  for (int t = 0; t < triangles; t++) {
    const Vec along = direction(), up = across(along, direction()), normal = across(along, up),
              from = direction();
    const Vec end = sum(from, 10, along), tip = sum(end, 1e-4, up);
    const RTid object = rtBeginObject(0);
    rtBegin(RT_TRIANGLES);
    for (const Vec& v : {from, end, tip}) rtVertex3d(v.x, v.y, v.z);
    rtEnd();
    rtEndObject();
    const RTid instance = place(object);
    rtRender();
    std::vector<RTray> beside, on;
    for (int i = 0; i < each; i++) {
      const double grazing = 1.1 * pi / 180;
      const Vec d = sum(sum({}, std::cos(grazing), along), -std::sin(grazing), normal);
      const auto towards = [&](double share, double height, double far = 3) {
        const Vec at = sum(sum(from, 10 * share, along), height, up), o = sum(at, -far, d);
        return RTray{
            {float(o.x), float(o.y), float(o.z)}, 0, {float(d.x), float(d.y), float(d.z)}, 1e30f};
      };
      beside.push_back(towards(1.002 + .05 * i / each, 1e-4 * (i + .5) / each, 300));
      on.push_back(towards(.9, .45e-4));
    }
    std::vector<RThit> hits(each);
    rtCastRays(each, beside.data(), hits.data());
    for (const RThit& h : hits) wrong += std::isfinite(h.t);
    rtCastRays(each, on.data(), hits.data());
    for (const RThit& h : hits) found += std::isfinite(h.t) && std::fabs(h.t - 3) < 1e-2;
    rtDeleteInstance(instance);
    rtDeleteObject(object);
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(stats().rejected.hits, 0u) << "nothing was rejected";
  // Rays in floats may miss a triangle 1e-4 high; the share is measured.
  EXPECT_GT(found, triangles * each / 4u);
  printf("slivers: %.3f of the rays found, %llu wrong hits rejected\n",
         double(found) / (triangles * each),
         static_cast<unsigned long long>(stats().rejected.hits));
}

} // namespace
} // namespace numeric

// openrt_pilots.cpp: Tests the number of samples per tile, from synthetic pilots.
#include <gtest/gtest.h>

#include <vector>

#include "openrt/openrt.h"
#include "render/film/pilots.h"

using namespace openrt;

namespace {

// A picture of 16x8 pixels in two tiles.
class PilotsOf : public testing::Test {
 protected:
  PilotsOf() {
    frame_.width = 16;
    frame_.height = 8;
    frame_.tile = 8;
    frame_.samples = 4096;
    frame_.targetError = .1f;
    frame_.channels = RT_RGBA;
  }
  static PixelError error(float relative, bool trusted, bool constant, float colour = 1) {
    PixelError e;
    for (int k = 0; k < 3; k++) {
      e.mean[k] = colour;
      e.halfWidth[k] = relative * (colour + .01f);
    }
    e.noise.scale = 3 * colour + .03f;
    e.noise.finished = true;
    e.noise.random = !constant;
    e.samples = 32;
    e.trusted = trusted;
    e.constant = constant;
    e.relative = std::min(relative, 1.0f);
    return e;
  }
  void note(Pilots& pilots, uint32_t tile, const PixelError& e) {
    std::vector<PixelError> errors(64, e);
    pilots.note(tile, pixels(errors), errors);
  }
  static std::vector<PilotPixel> pixels(std::vector<PixelError>& errors) {
    std::vector<PilotPixel> out;
    for (PixelError& e : errors) out.push_back(pilotPixel(e, nullptr));
    return out;
  }
  std::vector<Pilots::Decision> decideAll(const PixelError& left, const PixelError& right,
                                          bool timed = false) {
    Pilots pilots(frame_, TileGrid(frame_), timed);
    note(pilots, 0, left);
    note(pilots, 1, right);
    return pilots.decideAll();
  }
  edit::FrameSettingsT frame_;
};

void expect(const Pilots::Decision& v, uint32_t samples, bool pilot) {
  EXPECT_EQ(v.samples, samples);
  EXPECT_EQ(v.pilot, pilot);
}

} // namespace

// Aims a tenth below the target, in steps of a quarter of an octave.
TEST_F(PilotsOf, NoiseFallsByTheRootOfTheSamples) {
  const auto v = decideAll(error(.08f, true, false), error(.24f, true, false));
  expect(v[0], 32, false);
  expect(v[1], 256, false); // 32 * (.24 / .09)^2 = 228
  expect(decideAll(error(.17f, true, false), error(.1f, true, false))[0], 128, false); // 114
  expect(decideAll(error(.1f, true, false), error(.1f, true, false))[0], 64, false);   // 39.5
}

TEST_F(PilotsOf, WhatIsFarFromThePilotIsAskedAgain) {
  const auto v = decideAll(error(.5f, true, false), error(.01f, true, false)); // 988
  expect(v[0], 64, true);
  expect(v[1], 32, false);
  frame_.samples = 512; // the maximum: no further pilot is needed
  expect(decideAll(error(.5f, true, false), error(.01f, true, false))[0], 512, false);
}

TEST_F(PilotsOf, WhoDoesNotTrustItselfIsAskedAgainWithMore) {
  const auto v = decideAll(error(.05f, false, false), error(.01f, true, false));
  expect(v[0], 64, true);
  expect(v[1], 32, false);
  // Half the uncertainty of the neighbouring tile is more than a quarter of the target.
  expect(decideAll(error(.08f, false, false), error(.01f, true, false))[1], 64, true);
}

TEST_F(PilotsOf, TheyAreAThirdOfTheSamplesAtMost) {
  for (const uint32_t most : {33u, 64u, 100u, 256u, 1000u, 4096u, 65536u}) {
    frame_.samples = most;
    Pilots pilots(frame_, TileGrid(frame_), false);
    note(pilots, 0, error(2, false, false));
    note(pilots, 1, error(2, false, false));
    Pilots::Decision v = pilots.decideAll()[0];
    uint32_t all = 0;
    for (std::vector<PixelError> errors(64, error(2, false, false)); v.pilot;
         v = pilots.decide(0, pixels(errors), v.samples)) {
      ASSERT_GT(v.samples, 0u);
      all += v.samples;
    }
    EXPECT_EQ(v.samples, most);
    EXPECT_LE(all, most / 3.0) << most;
  }
}

TEST_F(PilotsOf, UnderATimeLimitTheFirstOneDecides) {
  expect(decideAll(error(.05f, false, false), error(.01f, true, false), true)[0], 4096, false);
  expect(decideAll(error(.5f, true, false), error(.01f, true, false), true)[0], 1024, false);
}

// Constant pixels at the border and between the tiles count; their bound falls as 1 / samples.
TEST_F(PilotsOf, ConstantPixelsBesideAnEdgeCount) {
  Pilots pilots(frame_, TileGrid(frame_), false);
  std::vector<PixelError> black(64, error(0, true, true, 0));
  note(pilots, 0, black[0]);
  note(pilots, 1, error(0, true, true, 1));
  const auto v = pilots.decideAll();
  expect(v[0], 64, true);
  expect(v[1], 32, false); // reduces 3 / N by 3 / 3.03
  // 28 of the black pixels, at the rim, are in doubt by 3 / N * 3 / .03 each: 1456 samples.
  expect(pilots.decide(0, pixels(black), 256), 1536, false);
}

TEST_F(PilotsOf, PathsFromLampsDoNotGoAwayBySamples) {
  LightSums light;
  for (double& w : light.variance) w = .01;
  PixelError e = error(.1f, true, false);
  const PilotPixel p = pilotPixel(e, &light);
  EXPECT_NEAR(p.light, .211f, .001f);
  frame_.targetError = .05f; // cannot be reached: samples are added until they contribute a tenth
  Pilots pilots(frame_, TileGrid(frame_), false);
  const std::vector<PilotPixel> all(64, p);
  const std::vector<PixelError> errors(64, e);
  pilots.note(0, all, errors);
  pilots.note(1, all, errors);
  expect(pilots.decideAll()[0], 64, false);
}

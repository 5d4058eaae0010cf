// picture_live_upsample.cpp: previews have the pixels of the window, which are more than a frame
// has samples: what rests gets sharp, what moves stays sharp, and nothing of what has gone remains.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "unit/picture_live_frames.h"
#include "unit/same_bytes.h"

using namespace live_frames;
using picture::live::Reconstruction;
using picture::live::ShownSize;

namespace {

constexpr ShownSize window{96, 72};

// Returns a shot of fewer pixels that shows the same as a shot of the window.
Shot fewerPixels(Shot shot, int width = 40, int height = 30) {
  shot.width = width;
  shot.height = height;
  return shot;
}

Picture add(Reconstruction& reconstruction, const World& world, const Shot& shot,
            ShownSize shown = window, int lightStride = 1) {
  return reconstruction.add(render(world, shot), shot.camera, lightStride, nullptr, shown);
}

// Returns the error of the best picture of the pixels of a shot, scaled linearly to the window.
double errorOfScaling(const World& world, const Shot& small, const Shot& large) {
  const std::vector<float> pixels = converged(world, small), truth = converged(world, large);
  Picture scaled;
  scaled.width = large.width;
  scaled.height = large.height;
  for (int y = 0; y < large.height; y++)
    for (int x = 0; x < large.width; x++) {
      const double u = (x + 0.5) * small.width / large.width - 0.5,
                   v = (y + 0.5) * small.height / large.height - 0.5;
      const int left = std::clamp(int(std::floor(u)), 0, small.width - 2),
                top = std::clamp(int(std::floor(v)), 0, small.height - 2);
      for (int c = 0; c < 4; c++) {
        const auto at = [&](int dx, int dy) {
          return double(pixels[3 * size_t((top + dy) * small.width + left + dx) + size_t(c % 3)]);
        };
        const double p = u - left, q = v - top;
        scaled.planes[RT_RGBA].push_back(float((at(0, 0) * (1 - p) + at(1, 0) * p) * (1 - q) +
                                               (at(0, 1) * (1 - p) + at(1, 1) * p) * q));
      }
    }
  return rms(scaled, truth, inner(large));
}

// Stripes four pixels of the window wide, which frames of 40 x 30 pixels hardly resolve.
World stripes(uint32_t frame, double step) {
  return [=](Vec origin, Vec direction) {
    Hit hit = plane(origin, direction, 0, -infinite, infinite, {frame ? step : 0, 0, 0});
    const Vec p = origin + direction * hit.distance;
    const double w = 0.5 + 0.4 * std::sin(40 * (p.x - step * frame) + 3 * p.y);
    hit.albedo = {w, w, w};
    hit.name = 1;
    return hit;
  };
}

} // namespace

TEST(LiveUpsampling, ThePictureHasThePixelsOfTheWindow) {
  Reconstruction reconstruction;
  const World world = movingPlane(0, 0, true);
  const Shot shot = fewerPixels(shotAt({0, 0, 3}, 0));
  const Picture shown = add(reconstruction, world, shot);
  EXPECT_EQ(shown.width, 96);
  EXPECT_EQ(shown.height, 72);
  EXPECT_EQ(valuesOf(shown).size(), 4u * 96 * 72);
  EXPECT_TRUE(isShowable(shown));
  EXPECT_GT(reconstruction.facts().showing, 0);
  // It is never smaller than the frame.
  EXPECT_EQ(add(reconstruction, world, shot, {20, 72}).width, 40);
  EXPECT_THROW(add(reconstruction, world, shot, {65537, 72}), std::invalid_argument);
}

TEST(LiveUpsampling, AWindowOfTheFramesSizeIsNoOtherCase) {
  Reconstruction one, other;
  for (uint32_t k = 0; k < 6; k++) {
    const Shot shot = shotAt({0.02 * k, 0, 3}, k, k % 2 == 0);
    const Picture frame = render(turningBall(k, 0.03, true), shot);
    EXPECT_EQ(valuesOf(one.add(frame, shot.camera)),
              valuesOf(other.add(frame, shot.camera, 1, nullptr, window)));
  }
}

// At rest each pixel of the window gets samples of its own.
TEST(LiveUpsampling, WhatRestsGetsSharp) {
  const World world = stripes(0, 0);
  Reconstruction reconstruction;
  const Shot large = shotAt({0, 0, 3}, 0);
  const std::vector<float> truth = converged(world, large);
  const double scaled = errorOfScaling(world, fewerPixels(large), large);
  double soon = 0, late = 0;
  for (uint32_t k = 0; k < 96; k++) {
    late = rms(add(reconstruction, world, fewerPixels(shotAt({0, 0, 3}, k))), truth, inner(large));
    if (k == 31) soon = late;
  }
  EXPECT_LT(soon, 0.6 * scaled) << "after a second, and scaling has " << scaled;
  EXPECT_LT(late, 0.25 * scaled);
}

// A texture that no frame resolves moves by a part of a pixel a frame: what is shown lies within a
// tenth of a pixel of the truth, and is sharper than any scaling of so few pixels.
TEST(LiveUpsampling, ATranslatingTextureIsSharpToATenthOfAPixel) {
  for (const double step : {0.0137, 0.0437}) { // 0.4 and 1.3 pixels of the window
    Reconstruction reconstruction;
    Picture shown;
    for (uint32_t k = 0; k < 40; k++)
      shown = add(reconstruction, stripes(k, step), fewerPixels(shotAt({0, 0, 3}, k)));
    const Shot large = shotAt({0, 0, 3}, 39);
    const World world = stripes(39, step);
    const std::vector<float> truth = converged(world, large);
    EXPECT_NEAR(shiftOf(shown, truth, inner(large)), 0, 0.1) << step;
    EXPECT_LT(rms(shown, truth, inner(large)),
              0.9 * errorOfScaling(world, fewerPixels(large), large))
        << step;
  }
}

TEST(LiveUpsampling, AMovingCameraKeepsTheWorldInPlace) {
  Reconstruction reconstruction;
  Picture shown;
  Shot large;
  for (uint32_t k = 0; k < 40; k++) {
    large = shotAt({}, k);
    large.camera = cameraAt({0.01 * k, 0.004 * k, 3 - 0.004 * k}, 0.003 * k);
    shown = add(reconstruction, movingPlane(0, 0, true), fewerPixels(large));
  }
  const std::vector<float> truth = converged(movingPlane(0, 0, true), large);
  EXPECT_NEAR(shiftOf(shown, truth, inner(large)), 0, 0.1);
  EXPECT_LT(rms(shown, truth, inner(large)), 0.04);
}

// A white board slides away over a dark wall. Where the wall appears, nothing white remains.
TEST(LiveUpsampling, DisocclusionsHoldNoGhosts) {
  for (const int lightStride : {1, 2}) {
    constexpr double step = 0.15;
    const auto world = [](uint32_t k) -> World {
      return [k](Vec origin, Vec direction) {
        Hit board =
            plane(origin, direction, 0, -1 + step * k, 0.2 + step * k, {k ? step : 0, 0, 0});
        board.name = 1;
        if (std::isfinite(board.distance)) return board;
        Hit wall = plane(origin, direction, -1, -infinite, infinite);
        wall.name = 2;
        wall.light = 0.1;
        return wall;
      };
    };
    Reconstruction reconstruction;
    Picture shown;
    Shot large;
    for (uint32_t k = 0; k < 8; k++) {
      large = shotAt({0, 0, 3}, k);
      shown = add(reconstruction, world(k), fewerPixels(large), window, lightStride);
    }
    // The board's left edge moved from x = -1 to 0.05: pixels 19 to 49 of 96.
    const std::vector<float> truth = converged(world(7), large);
    EXPECT_LT(largest(shown, truth, {20, 8, 46, 64}), 2.0 / 255) << lightStride;
  }
}

// A red board passes before a grey wall that rests. Once it has passed, its colour is nowhere.
TEST(LiveUpsampling, WhatHasPassedLeavesNoColour) {
  Reconstruction reconstruction;
  constexpr double step = 0.09;
  for (uint32_t k = 0; k < 40; k++) {
    const World world = [k](Vec origin, Vec direction) {
      const double left = -2 + step * k;
      Hit hit = plane(origin, direction, 0.5, left, left + 0.6, {k ? step : 0, 0, 0});
      if (std::isfinite(hit.distance)) {
        hit.albedo = {0.8, 0, 0};
        hit.name = 2;
        return hit;
      }
      hit = plane(origin, direction, 0, -infinite, infinite);
      hit.albedo = {0.6, 0.6, 0.6};
      hit.name = 1;
      return hit;
    };
    const Picture shown = add(reconstruction, world, fewerPixels(shotAt({0, 0, 3}, k)));
    if (k < 20) continue;
    // The board's left edge at z = 0.5, in pixels of the window; a pixel of a frame has 2.4.
    const double left = 48 + (-2 + step * k) / (2 * std::tan(0.4) * 2.5) * 72;
    double red = 0;
    for (int y = 0; y < 72; y++)
      for (int x = 0; x < std::min(96, int(left) - 6); x++)
        red = std::max(red, double(colourAt(shown, x, y, 0) - colourAt(shown, x, y, 1)));
    EXPECT_LT(red, 0.02) << k;
  }
}

// A bright wire, thinner than a pixel of the window, before a dark wall, while the camera slides. A
// frame's sample meets it in one of four pixels. It is dimmer than the truth (decision 93), but its
// light does not flash from frame to frame.
TEST(LiveUpsampling, ThinThingsDoNotFlash) {
  const World world = [](Vec origin, Vec direction) {
    Hit wire = plane(origin, direction, 0.2, -0.012, 0.012);
    wire.name = 1;
    if (std::isfinite(wire.distance)) return wire;
    Hit wall = plane(origin, direction, 0, -infinite, infinite);
    wall.name = 2;
    wall.light = 0.05;
    return wall;
  };
  Reconstruction reconstruction;
  std::vector<double> before;
  double changes = 0, counted = 0;
  for (uint32_t k = 0; k < 48; k++) {
    const Shot large = shotAt({0.011 * k - 0.25, 0, 3}, k);
    const Picture shown = add(reconstruction, world, fewerPixels(large));
    const std::vector<float> truth = converged(world, large);
    std::vector<double> light;
    for (int y = 0; y < 72; y++) {
      double sum = 0, expected = 0;
      for (int x = 8; x < 88; x++) {
        sum += double(colourAt(shown, x, y, 0)) - 0.05;
        expected += double(truth[3 * size_t(y * 96 + x)]) - 0.05;
      }
      light.push_back(sum / expected);
    }
    if (k >= 24) {
      double mean = 0;
      for (size_t y = 0; y < light.size(); y++) {
        changes += std::abs(light[y] - before[y]);
        counted++;
        mean += light[y] / double(light.size());
      }
      EXPECT_GT(mean, 0.08) << k;
      EXPECT_LT(mean, 1.1) << k;
    }
    before = light;
  }
  // Frames without a history change by about 0.9 from one to the next.
  EXPECT_LT(changes / counted, 0.25);
}

TEST(LiveUpsampling, AChangeOfTheFramesSizeKeepsWhatWasShown) {
  const World world = stripes(0, 0);
  Reconstruction reconstruction;
  const Shot large = shotAt({0, 0, 3}, 0);
  const std::vector<float> truth = converged(world, large);
  double before = 0, after = 0;
  for (uint32_t k = 0; k < 65; k++) {
    const Shot shot = shotAt({0, 0, 3}, k);
    const Picture shown =
        add(reconstruction, world, k < 64 ? fewerPixels(shot) : fewerPixels(shot, 48, 36));
    (k < 64 ? before : after) = rms(shown, truth, inner(large));
  }
  EXPECT_LT(after, 1.1 * before);
}

TEST(LiveUpsampling, TheSameBytesOnAnyNumberOfThreads) {
  std::vector<std::vector<float>> shown;
  for (const int threads : {1, 2, 5}) {
    Reconstruction reconstruction(threads);
    Picture picture;
    for (uint32_t k = 0; k < 6; k++)
      picture = add(reconstruction, turningBall(k, 0.03, true),
                    fewerPixels(shotAt({0.02 * k, 0, 3}, k, true), k < 3 ? 40 : 33),
                    k < 5 ? window : ShownSize{101, 75}, 1 + int(k % 2));
    shown.push_back(valuesOf(picture));
  }
  EXPECT_EQ(shown[0], shown[1]);
  EXPECT_EQ(shown[0], shown[2]);
}

TEST(LiveUpsampling, TheSameBytesOnEveryInstructionSet) {
  openrt::test::expectSameBytes([](std::vector<float>& results) {
    Reconstruction reconstruction;
    for (uint32_t k = 0; k < 5; k++)
      results = valuesOf(add(reconstruction, turningBall(k, 0.03, false),
                             fewerPixels(shotAt({0.02 * k, 0, 3}, k, k % 2 == 0)), {97, 71}));
  });
}

TEST(LiveUpsampling, AnySizesAreRebuilt) {
  Reconstruction reconstruction;
  const std::pair<int, int> sizes[] = {{1, 1}, {1, 5}, {3, 2}, {17, 1}, {64, 48}, {2, 2}};
  for (const auto& [width, height] : sizes)
    for (const auto& [shownWidth, shownHeight] : sizes) {
      Shot shot = fewerPixels(shotAt({0, 0, 3}, 0, true), width, height);
      shot.camera.aspect = double(width) / height;
      const Picture shown =
          add(reconstruction, movingPlane(0, 0, true), shot, {shownWidth, shownHeight});
      ASSERT_EQ(shown.width, std::max(width, shownWidth));
      ASSERT_TRUE(isShowable(shown)) << width << " x " << height;
    }
}

// picture_live_reprojection.cpp: previews find surfaces again where they were in the frame before.
#include <gtest/gtest.h>

#include <limits>

#include "unit/picture_live_frames.h"

using namespace live_frames;
using picture::live::Reconstruction;

TEST(LiveReprojection, ATranslatingTextureStaysInPlace) {
  Reconstruction reconstruction;
  Picture shown;
  constexpr double step = 0.0437; // about 1.3 pixels a frame
  for (uint32_t k = 0; k < 12; k++)
    shown = reconstruction.add(render(movingPlane(k, step, true), shotAt({0, 0, 3}, k)),
                               cameraAt({0, 0, 3}));
  const Shot shot = shotAt({0, 0, 3}, 11);
  const std::vector<float> truth = converged(movingPlane(11, step, true), shot);
  EXPECT_NEAR(shiftOf(shown, truth, inner(shot)), 0, 0.05);
  EXPECT_LT(rms(shown, truth, inner(shot)), 0.03);
  EXPECT_GT(reconstruction.facts().reprojected, 0.97); // one column comes in
}

TEST(LiveReprojection, LightOnATranslatingPlaneIsAccumulatedInPlace) {
  constexpr double step = 0.0437;
  const Shot last = shotAt({0, 0, 3}, 23);
  const std::vector<float> truth = converged(movingPlane(23, step, false), last);
  double error[2];
  for (const bool told : {false, true}) { // without its motion the light would lag behind
    Reconstruction reconstruction;
    Picture shown;
    for (uint32_t k = 0; k < 24; k++) {
      Picture frame = render(movingPlane(k, step, false), shotAt({0, 0, 3}, k, true));
      if (!told) std::ranges::fill(frame.planes[RT_MOTION], 0.0f);
      shown = reconstruction.add(frame, last.camera);
    }
    error[told] = rms(shown, truth, inner(last));
    if (told) { EXPECT_NEAR(shiftOf(shown, truth, inner(last)), 0, 0.25); }
  }
  EXPECT_LT(error[1], 0.09);
  EXPECT_LT(error[1], 0.8 * error[0]);
}

TEST(LiveReprojection, ATurningBallStaysInPlace) {
  constexpr double step = 0.035; // 2 degrees a frame
  Reconstruction reconstruction;
  Picture shown;
  for (uint32_t k = 0; k < 12; k++)
    shown = reconstruction.add(render(turningBall(k, step, true), shotAt({0, 0, 3}, k)),
                               cameraAt({0, 0, 3}));
  const Shot shot = shotAt({0, 0, 3}, 11);
  const std::vector<float> truth = converged(turningBall(11, step, true), shot);
  const Part front{34, 22, 62, 50};
  EXPECT_NEAR(shiftOf(shown, truth, front), 0, 0.05);
  EXPECT_LT(rms(shown, truth, front), 0.03);
  EXPECT_GT(reconstruction.facts().reprojected, 0.97);
}

TEST(LiveReprojection, AMovingCameraFindsTheWorldAgain) {
  Reconstruction reconstruction;
  Picture shown;
  Shot shot;
  for (uint32_t k = 0; k < 12; k++) {
    shot = shotAt({0.03 * k, 0.01 * k, 3 - 0.02 * k}, k);
    shot.camera = cameraAt({0.03 * k, 0.01 * k, 3 - 0.02 * k}, 0.004 * k);
    shown = reconstruction.add(render(movingPlane(0, 0, true), shot), shot.camera);
  }
  const std::vector<float> truth = converged(movingPlane(0, 0, true), shot);
  EXPECT_NEAR(shiftOf(shown, truth, inner(shot)), 0, 0.05);
  EXPECT_LT(rms(shown, truth, inner(shot)), 0.03);
  EXPECT_GT(reconstruction.facts().reprojected, 0.95);
}

// A picture behind the world (--background FILE) is composited with each frame.
TEST(LiveReprojection, AFixedBackgroundStaysInItsPlaceWhileTheCameraTurns) {
  const World nothing = [](Vec, Vec) { return Hit(); };
  const auto errorOf = [&](bool isFixed) {
    Reconstruction reconstruction;
    double sum = 0;
    for (uint32_t k = 0; k < 12; k++) {
      Shot shot = shotAt({0, 0, 0}, k);
      shot.camera = cameraAt({0, 0, 0}, 0.02 * k);
      shot.camera.fixedBackground = isFixed;
      Picture frame = render(nothing, shot);
      std::vector<float>& rgba = frame.planes[RT_RGBA];
      for (int i = 0; i < shot.width * shot.height; i++) // stripes of four pixels
        for (int c = 0; c < 3; c++) rgba[size_t(4 * i + c)] = i % shot.width / 4 % 2 ? .8f : .1f;
      const Picture shown = reconstruction.add(frame, shot.camera);
      sum = 0;
      for (size_t i = 0; i < rgba.size(); i++)
        sum += std::abs(double(shown.planes.at(RT_RGBA)[i]) - double(rgba[i]));
      sum /= double(rgba.size());
    }
    return sum;
  };
  EXPECT_LT(errorOf(true), 1e-5);
  EXPECT_GT(errorOf(false), 0.05);
}

TEST(LiveReprojection, AParallelCameraFindsTheWorldAgain) {
  Reconstruction reconstruction;
  Picture shown;
  Shot shot;
  for (uint32_t k = 0; k < 12; k++) {
    shot = shotAt({}, k);
    shot.camera = cameraAt({0.04 * k, 0, 3}, 0, 0);
    shot.camera.settings.height = 2.5;
    shown = reconstruction.add(render(movingPlane(0, 0, true), shot), shot.camera);
  }
  const std::vector<float> truth = converged(movingPlane(0, 0, true), shot);
  EXPECT_NEAR(shiftOf(shown, truth, inner(shot)), 0, 0.05);
  EXPECT_GT(reconstruction.facts().reprojected, 0.97);
}

// A camera shader's rays are unknown: its frames are accumulated only while the camera rests.
TEST(LiveReprojection, ACameraShaderAccumulatesOnlyAtRest) {
  Reconstruction reconstruction;
  Shot shot = shotAt({0, 0, 3}, 0);
  int shader = 0; // only its address is compared
  const auto add = [&](double x) {
    shot.camera = cameraAt({x, 0, 3});
    shot.camera.settings.shader = reinterpret_cast<xvrml::Node*>(&shader);
    shot.number++;
    reconstruction.add(render(movingPlane(0, 0, true), shot), shot.camera);
    return reconstruction.facts().reprojected;
  };
  EXPECT_EQ(add(0), 0);
  EXPECT_EQ(add(0), 1);
  EXPECT_EQ(add(0.1), 0);
  EXPECT_EQ(add(0.1), 1);
}

TEST(LiveReprojection, WhatDidNotExistIsNotFound) {
  Reconstruction reconstruction;
  const Shot shot = shotAt({0, 0, 3}, 0);
  Picture frame = render(movingPlane(0, 0, true), shot);
  reconstruction.add(frame, shot.camera);
  EXPECT_EQ(reconstruction.facts().reprojected, 0);
  reconstruction.add(frame, shot.camera);
  EXPECT_EQ(reconstruction.facts().reprojected, 1);
  std::ranges::fill(frame.planes[RT_MOTION], std::numeric_limits<float>::quiet_NaN());
  reconstruction.add(frame, shot.camera);
  EXPECT_EQ(reconstruction.facts().reprojected, 0);
}

// A white board slides away over a dark wall. Where the wall appears, nothing white remains.
TEST(LiveReprojection, DisocclusionsHoldNoGhosts) {
  for (const bool noisy : {false, true}) {
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
    Shot shot;
    for (uint32_t k = 0; k < 8; k++) {
      shot = shotAt({0, 0, 3}, k, noisy);
      shown = reconstruction.add(render(world(k), shot), shot.camera);
    }
    // The board's left edge moved from x = -1 to 0.05: pixels 19 to 49 of 96.
    const std::vector<float> truth = converged(world(7), shot);
    const Part uncovered{20, 8, 47, 64};
    EXPECT_LT(largest(shown, truth, uncovered), noisy ? 0.12 : 1.0 / 255);
    EXPECT_LT(rms(shown, truth, uncovered), noisy ? 0.035 : 1.0 / 255);
  }
}

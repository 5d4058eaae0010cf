// picture_live_filter.cpp: in previews noise vanishes, and what has no noise stays as it is.
#include <gtest/gtest.h>

#include "unit/picture_live_frames.h"

using namespace live_frames;
using picture::live::Reconstruction;

TEST(LiveFilter, WithoutNoiseNothingChanges) {
  Reconstruction reconstruction;
  Shot shot = shotAt({0, 0, 3}, 0);
  shot.width = 200;
  shot.height = 150;
  shot.centred = true;
  const Picture frame = quietFrame(shot);
  for (int k = 0; k < 6; k++) {
    const Picture shown = reconstruction.add(frame, shot.camera);
    ASSERT_LT(largest(shown, colours(frame), {0, 0, shot.width, shot.height}), 0.5 / 255) << k;
  }
}

TEST(LiveFilter, WithoutNoiseAMovingCameraSeesSharpShadows) {
  Reconstruction reconstruction;
  Shot shot;
  Picture shown;
  for (uint32_t k = 0; k < 8; k++) {
    shot = shotAt({0.02 * k, 0, 3}, k);
    shown = reconstruction.add(quietFrame(shot), shot.camera);
  }
  // The shadow's edge on the floor is no wider than the pixels that it crosses.
  const std::vector<float> truth = converged(quietWorld(), shot);
  EXPECT_LT(rms(shown, truth, {0, 44, 96, 72}), 0.09);
  double wrong = 0;
  compare(shown, truth, {0, 44, 96, 72}, [&](float d, size_t) { wrong += std::abs(d) > 0.1; });
  EXPECT_LT(wrong / (3 * 96 * 28), 0.12);
}

TEST(LiveFilter, TheFirstFrameIsSmooth) {
  const World world = [](Vec origin, Vec direction) {
    Hit hit = plane(origin, direction, 0, -infinite, infinite);
    hit.albedo = {0.5, 0.5, 0.5};
    hit.name = 1;
    return hit;
  };
  const Shot shot = shotAt({0, 0, 3}, 5, true);
  const Picture frame = render(world, shot);
  const std::vector<float> truth = converged(world, shot);
  Reconstruction reconstruction;
  const Picture shown = reconstruction.add(frame, shot.camera);
  EXPECT_GT(rms(frame, truth, inner(shot)), 0.8);
  EXPECT_LT(rms(shown, truth, inner(shot)), 0.15);
}

TEST(LiveFilter, ShapesAndCreasesAreNotBlurred) {
  // Two walls of a different brightness, in one plane; then the same with a crease between them.
  for (const bool crease : {false, true}) {
    const World world = [crease](Vec origin, Vec direction) {
      Hit hit = plane(origin, direction, 0, -infinite, infinite);
      const bool right = origin.x + direction.x * hit.distance > 0;
      hit.light = right ? 1 : 0.2;
      hit.name = right && !crease ? 2 : 1;
      if (right && crease) hit.normal = {0.8, 0, 0.6};
      return hit;
    };
    Reconstruction reconstruction;
    Picture shown;
    Shot shot;
    for (uint32_t k = 0; k < 16; k++) {
      shot = shotAt({0, 0, 3}, k, true);
      shown = reconstruction.add(render(world, shot), shot.camera);
    }
    double left = 0, right = 0;
    for (int y = 8; y < 64; y++) {
      left += double(colourAt(shown, 45, y, 0)) / 56;
      right += double(colourAt(shown, 50, y, 0)) / 56;
    }
    EXPECT_NEAR(left, 0.2, 0.06);
    EXPECT_NEAR(right, 1, 0.15);
  }
}

TEST(LiveFilter, NoiseShrinksAndTheMeanStays) {
  const World world = movingPlane(0, 0, false);
  Reconstruction reconstruction;
  Picture shown;
  Shot shot;
  for (uint32_t k = 0; k < 16; k++) {
    shot = shotAt({0, 0, 3}, k, true);
    shown = reconstruction.add(render(world, shot), shot.camera);
  }
  const std::vector<float> truth = converged(world, shot);
  double sum = 0;
  compare(shown, truth, inner(shot), [&](float d, size_t) { sum += double(d); });
  // The mean is 0.5. The filter loses some of it, since most samples have no light at all.
  EXPECT_NEAR(sum / (80 * 56 * 3), 0, 0.04);
  EXPECT_LT(rms(shown, truth, inner(shot)), 0.09);
}

TEST(LiveFilter, RareBrightSamplesAreLimited) {
  const Shot shot = shotAt({0, 0, 3}, 0);
  Picture frame = render(movingPlane(0, 0, false), shot);
  const std::vector<float> truth = colours(frame);
  for (size_t pixel = 500; pixel < frame.planes[RT_NAME].size(); pixel += 511)
    std::fill_n(&frame.planes[RT_RGBA][4 * pixel], 3, 1e6f);
  Reconstruction reconstruction;
  EXPECT_LT(largest(reconstruction.add(frame, shot.camera), truth, inner(shot, 0)), 8);
}

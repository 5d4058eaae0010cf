// picture_live_changes.cpp: where nothing moves and no light is sampled, previews average up to 256
// frames. Changes there are nevertheless shown at once: textures, skies, sharp shadows, and
// what something that passed by has left.
#include <gtest/gtest.h>

#include "unit/picture_live_frames.h"

using namespace live_frames;
using picture::live::Reconstruction;

namespace {

constexpr uint32_t restingFrames = 40; // before the change
constexpr Part wholePicture{0, 0, 96, 72};

} // namespace

// A wall fills the picture and changes its colour: nothing of the old one remains at the border.
TEST(LiveChanges, AWallThatChangesItsColourDoesSoUpToTheBorder) {
  Reconstruction reconstruction;
  for (uint32_t k = 0; k < restingFrames + 3; k++) {
    const World world = [k](Vec origin, Vec direction) {
      Hit hit = plane(origin, direction, 0, -infinite, infinite);
      hit.albedo = k < restingFrames ? Vec{0.1, 0.1, 0.8} : Vec{0.8, 0.4, 0.2};
      hit.name = 1;
      return hit;
    };
    const Shot shot = shotAt({0, 0, 3}, k);
    const Picture shown = reconstruction.add(render(world, shot), shot.camera);
    if (k >= restingFrames) {
      EXPECT_LT(largest(shown, converged(world, shot, 1), wholePicture), 0.5 / 255) << k;
    }
  }
}

// The sky behind a resting ball changes: no ring of the old brightness remains around the ball.
TEST(LiveChanges, ASkyThatChangesLeavesNoRingAroundThings) {
  Reconstruction reconstruction;
  for (uint32_t k = 0; k < restingFrames + 12; k++) {
    const World world = [k](Vec origin, Vec direction) {
      Hit hit = ball(origin, direction, 0.6, 0);
      if (std::isfinite(hit.distance)) {
        hit.albedo = {0.05, 0.05, 0.05};
        hit.name = 2;
        return hit;
      }
      hit.light = k < restingFrames ? 1 : 0.6;
      return hit;
    };
    const Shot shot = shotAt({0, 0, 3}, k);
    const Picture shown = reconstruction.add(render(world, shot), shot.camera);
    if (k < restingFrames + 11) continue;
    double most = 0;
    for (int y = 0; y < shot.height; y++)
      for (int x = 0; x < shot.width; x++) most = std::max(most, double(colourAt(shown, x, y, 0)));
    EXPECT_LT(most, 0.7);
  }
}

// The edge of a sharp shadow moves over a wall by a pixel and a half a frame. It has no trail.
TEST(LiveChanges, ASharpShadowThatMovesLeavesNoTrail) {
  Reconstruction reconstruction;
  constexpr double step = 0.04;
  for (uint32_t k = 0; k < restingFrames + 20; k++) {
    const double edge = -0.5 + step * (k < restingFrames ? 0 : k - restingFrames + 1);
    const World world = [edge](Vec origin, Vec direction) {
      Hit hit = plane(origin, direction, 0, -infinite, infinite);
      hit.light = origin.x + direction.x * hit.distance < edge ? 1 : 0.02;
      hit.albedo = {0.8, 0.8, 0.8};
      hit.name = 1;
      return hit;
    };
    const Shot shot = shotAt({0, 0, 3}, k);
    const Picture shown = reconstruction.add(render(world, shot), shot.camera);
    if (k < restingFrames + 8) continue;
    double missing = 0; // light that has come and is not shown yet, in pixels
    const std::vector<float> truth = converged(world, shot);
    const Part part = inner(shot);
    compare(shown, truth, part, [&](float d, size_t) { missing -= double(std::min(d, 0.0f)); });
    EXPECT_LT(missing / 0.8 / 3 / (part.bottom - part.top), 1.5) << k;
  }
}

// A red board passes before the edge of a grey wall against a black sky. Once it has passed, its
// colour is nowhere.
TEST(LiveChanges, WhatHasPassedLeavesItsColourOnNoEdge) {
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
      if (origin.y + direction.y * hit.distance > 0.313) return Hit();
      hit.albedo = {0.6, 0.6, 0.6};
      hit.name = 1;
      return hit;
    };
    const Shot shot = shotAt({0, 0, 3}, k);
    const Picture shown = reconstruction.add(render(world, shot), shot.camera);
    if (k < 20) continue;
    // The board's left edge at z = 0.5, in pixels.
    const double left = 48 + (-2 + step * k) / (2 * std::tan(0.4) * 2.5) * 72;
    double red = 0;
    for (int y = 0; y < shot.height; y++)
      for (int x = 0; x < std::min(96, int(left) - 3); x++)
        red = std::max(red, double(colourAt(shown, x, y, 0) - colourAt(shown, x, y, 1)));
    EXPECT_LT(red, 0.02) << k;
  }
}

// A red board rests before the edge of a grey wall against a black sky, or on that wall, and is
// gone in one frame, as a choice of a Switch is. The pixels of its edges, which had shown it in
// part, show nothing of it.
TEST(LiveChanges, WhatVanishesLeavesItsColourOnNoEdge) {
  struct Case {
    int lightStride;
    double height;
  };
  for (const auto& [lightStride, height] : {Case{1, 0.5}, Case{2, 0.5}, Case{1, 0.001}}) {
    Reconstruction reconstruction;
    for (uint32_t k = 0; k < restingFrames + 3; k++) {
      const World world = [k, z = height](Vec origin, Vec direction) {
        Hit hit = plane(origin, direction, z, -0.313, 0.357);
        if (k < restingFrames && std::isfinite(hit.distance)) {
          hit.albedo = {0.8, 0, 0};
          hit.name = 2;
          return hit;
        }
        hit = plane(origin, direction, 0, -infinite, infinite);
        if (origin.y + direction.y * hit.distance > 0.313) return Hit();
        hit.albedo = {0.6, 0.6, 0.6};
        hit.name = 1;
        return hit;
      };
      const Shot shot = shotAt({0, 0, 3}, k);
      const Picture shown = reconstruction.add(render(world, shot), shot.camera, lightStride);
      if (k < restingFrames) continue;
      double red = 0;
      for (int y = 0; y < shot.height; y++)
        for (int x = 0; x < shot.width; x++)
          red = std::max(red, double(colourAt(shown, x, y, 0) - colourAt(shown, x, y, 1)));
      EXPECT_LT(red, 0.02) << k << ", light stride " << lightStride << ", height " << height;
    }
  }
}

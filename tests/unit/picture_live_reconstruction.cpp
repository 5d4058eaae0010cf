// picture_live_reconstruction.cpp: previews are rebuilt from noisy frames: surfaces are found again
// where they were, noise vanishes, and what has no noise stays as it is.
#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "tests/unit/picture_live_frames.h"
#include "tests/unit/same_bytes.h"

using namespace live_frames;
using picture::Picture;
using picture::live::FrameCamera;
using picture::live::Reconstruction;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

const std::vector<float>& valuesOf(const Picture& picture) { return picture.planes.at(RT_RGBA); }

float colourAt(const Picture& picture, int x, int y, int colour) {
  return valuesOf(picture).at(4 * size_t(y * picture.width + x) + size_t(colour));
}

// A part of the picture, in pixels.
struct Part {
  int left, top, right, bottom;
};
Part inner(const Shot& shot, int margin = 8) {
  return {margin, margin, shot.width - margin, shot.height - margin};
}

// Calls use(difference, pixel) for each colour of a part.
template <class Use>
void compare(const Picture& picture, const std::vector<float>& truth, Part part, const Use& use) {
  for (int y = part.top; y < part.bottom; y++)
    for (int x = part.left; x < part.right; x++)
      for (int c = 0; c < 3; c++) {
        const size_t pixel = size_t(y * picture.width + x);
        use(colourAt(picture, x, y, c) - truth.at(3 * pixel + size_t(c)), pixel);
      }
}

double rms(const Picture& picture, const std::vector<float>& truth, Part part) {
  double sum = 0, n = 0;
  compare(picture, truth, part, [&](float d, size_t) {
    sum += double(d) * d;
    n++;
  });
  return std::sqrt(sum / n);
}

double largest(const Picture& picture, const std::vector<float>& truth, Part part) {
  double most = 0;
  compare(picture, truth, part,
          [&](float d, size_t) { most = std::max(most, std::abs(double(d))); });
  return most;
}

// Returns by how many pixels the picture lies to the right of the truth: least squares of the
// difference against the truth's slope.
double shiftOf(const Picture& picture, const std::vector<float>& truth, Part part) {
  double slopes = 0, products = 0;
  for (int y = part.top; y < part.bottom; y++)
    for (int x = part.left; x < part.right; x++) {
      const size_t pixel = size_t(y * picture.width + x);
      const double slope = (double(truth[3 * (pixel + 1)]) - double(truth[3 * (pixel - 1)])) / 2;
      slopes += slope * slope;
      products += slope * (double(colourAt(picture, x, y, 0)) - double(truth[3 * pixel]));
    }
  return -products / slopes;
}

std::vector<float> colours(const Picture& frame) {
  std::vector<float> rgb;
  for (size_t i = 0; i < valuesOf(frame).size(); i++)
    if (i % 4 != 3) rgb.push_back(valuesOf(frame)[i]);
  return rgb;
}

// A wave over a surface, about ten pixels long in these pictures.
double wave(double u, double v) { return 0.5 + 0.2 * std::sin(9 * u) + 0.2 * std::sin(7 * v + u); }

// A plane that moves to the right by `step` a frame; its texture moves with it.
World movingPlane(uint32_t frame, double step, bool textured) {
  return [=](Vec origin, Vec direction) {
    Hit hit = plane(origin, direction, 0, -infinite, infinite, {frame ? step : 0, 0, 0});
    const Vec p = origin + direction * hit.distance;
    const double w = wave(p.x - step * frame, p.y);
    (textured ? hit.albedo : hit.normal) = textured ? Vec{w, w, w} : hit.normal;
    if (!textured) hit.light = w;
    hit.name = 1;
    return hit;
  };
}

World turningBall(uint32_t frame, double step, bool textured) {
  return [=](Vec origin, Vec direction) {
    Hit hit = ball(origin, direction, 1, frame ? step : 0);
    if (!std::isfinite(hit.distance)) return hit;
    const Vec local = turned(origin + direction * hit.distance, -step * frame);
    const double w = wave(std::atan2(local.x, local.z), 2 * local.y);
    if (textured)
      hit.albedo = {w, w, w};
    else
      hit.light = w;
    hit.name = 2;
    return hit;
  };
}

Shot shotAt(Vec eye, uint32_t number, bool noisy = false) {
  Shot shot;
  shot.camera = cameraAt(eye);
  shot.number = number;
  shot.noisy = noisy;
  return shot;
}

} // namespace

// --- LiveReprojection ---

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

// --- LiveFilter ---

namespace {

// A checkered floor with a sharp shadow, a lamp, and a picture of the sky behind. Nothing is
// sampled.
World quietWorld() {
  return [](Vec origin, Vec direction) {
    Hit hit;
    const double t = (-1 - origin.y) / direction.y;
    const Vec p = origin + direction * t;
    const Hit lamp = ball(origin - Vec{0.8, 0.6, 0}, direction, 0.4, 0);
    if (std::isfinite(lamp.distance)) {
      hit = lamp;
      hit.albedo = {0, 0, 0};
      hit.name = 3;
    } else if (t > 0 && t < 20) {
      hit.distance = t;
      hit.normal = {0, 1, 0};
      hit.name = 1;
      const bool dark = (int(std::floor(p.x * 2)) + int(std::floor(p.z * 2))) % 2 != 0;
      hit.albedo = dark ? Vec{0.1, 0.2, 0.05} : Vec{0.8, 0.7, 0.6};
      hit.light = p.x + 0.3 * p.z > -0.4 ? 1 : 0.15;
    } else {
      hit.light = 0.3 + 0.2 * direction.y;
    }
    return hit;
  };
}

// The lamp shines, though its albedo is black.
Picture quietFrame(const Shot& shot) {
  Picture frame = render(quietWorld(), shot);
  for (size_t i = 0; i < frame.planes[RT_NAME].size(); i++)
    if (frame.planes[RT_NAME][i] == 3) std::fill_n(&frame.planes[RT_RGBA][4 * i], 3, 5.0f);
  return frame;
}

} // namespace

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

// --- LiveReconstruction ---

TEST(LiveReconstruction, AtRestItConvergesToTheMeanOfTheSamples) {
  Reconstruction reconstruction;
  constexpr uint32_t frames = 96;
  std::vector<float> mean;
  Picture shown;
  Shot shot;
  for (uint32_t k = 0; k < frames; k++) {
    shot = shotAt({0, 0, 3}, k);
    const Picture frame = quietFrame(shot);
    const std::vector<float> rgb = colours(frame);
    mean.resize(rgb.size());
    for (size_t i = 0; i < rgb.size(); i++) mean[i] += std::min(rgb[i], 1.0f) / float(frames);
    shown = reconstruction.add(frame, shot.camera);
  }
  EXPECT_EQ(reconstruction.facts().reprojected, 1);
  // At a pixel that is half lamp the mean depends on the lamp's brightness: beside it only.
  const Part floor{0, 40, 96, 72};
  EXPECT_LT(rms(shown, mean, floor), 0.025);
  double sum = 0;
  compare(shown, mean, floor, [&](float d, size_t) { sum += double(d); });
  EXPECT_NEAR(sum / (96 * 32 * 3), 0, 0.002);
  const Picture raw = quietFrame(shot);
  EXPECT_GT(rms(raw, mean, floor), 4 * rms(shown, mean, floor));
}

TEST(LiveReconstruction, AChangeOfSizeKeepsWhatWasAccumulated) {
  const World world = movingPlane(0, 0, false);
  for (const int width : {96, 48, 61}) {
    Reconstruction reconstruction;
    Shot shot;
    for (uint32_t k = 0; k < 12; k++) {
      shot = shotAt({0, 0, 3}, k, true);
      reconstruction.add(render(world, shot), shot.camera);
    }
    shot.width = 2 * width;
    shot.height = width * 3 / 2;
    shot.camera.aspect = double(shot.width) / shot.height;
    shot.number = 12;
    const Picture frame = render(world, shot);
    const std::vector<float> truth = converged(world, shot);
    Picture shown = reconstruction.add(frame, shot.camera);
    EXPECT_EQ(shown.width, shot.width);
    EXPECT_EQ(shown.height, shot.height);
    EXPECT_GT(reconstruction.facts().history, 9);
    const double kept = rms(shown, truth, inner(shot));
    reconstruction.reset();
    shown = reconstruction.add(frame, shot.camera);
    EXPECT_LT(kept, 0.12) << width;
    EXPECT_LT(kept, 0.8 * rms(shown, truth, inner(shot))) << width;
  }
}

TEST(LiveReconstruction, ResetForgets) {
  const Shot first = shotAt({0, 0, 3}, 0, true), second = shotAt({0, 0, 3}, 1, true);
  const Picture frame = render(movingPlane(0, 0, false), second);
  Reconstruction used, fresh;
  used.add(render(turningBall(0, 0, true), first), first.camera);
  used.reset();
  EXPECT_EQ(valuesOf(used.add(frame, second.camera)), valuesOf(fresh.add(frame, second.camera)));
  EXPECT_EQ(used.facts().reprojected, 0);
  EXPECT_EQ(used.facts().history, 1);
}

TEST(LiveReconstruction, TheSameBytesOnAnyNumberOfThreads) {
  std::vector<std::vector<float>> shown;
  for (const int threads : {1, 2, 5}) {
    Reconstruction reconstruction(threads);
    Picture picture;
    for (uint32_t k = 0; k < 6; k++) {
      Shot shot = shotAt({0.02 * k, 0, 3}, k, true);
      shot.width = k < 3 ? 96 : 77;
      picture = reconstruction.add(render(turningBall(k, 0.03, false), shot), shot.camera);
    }
    shown.push_back(valuesOf(picture));
  }
  EXPECT_EQ(shown[0], shown[1]);
  EXPECT_EQ(shown[0], shown[2]);
}

TEST(LiveReconstruction, TheSameBytesOnEveryInstructionSet) {
  openrt::test::expectSameBytes([](std::vector<float>& results) {
    Reconstruction reconstruction;
    for (uint32_t k = 0; k < 5; k++) {
      const Shot shot = shotAt({0.02 * k, 0, 3}, k, k % 2 == 0);
      results =
          valuesOf(reconstruction.add(render(turningBall(k, 0.03, false), shot), shot.camera));
    }
  });
}

TEST(LiveReconstruction, ASuddenChangeOfLightIsFollowed) {
  for (const double later : {0.2, 4.0}) {
    const auto world = [&](uint32_t k) -> World {
      return [light = k < 16 ? 1.0 : later](Vec origin, Vec direction) {
        Hit hit = plane(origin, direction, 0, -infinite, infinite);
        hit.albedo = {0.2, 0.2, 0.2};
        hit.light = light;
        hit.name = 1;
        return hit;
      };
    };
    Reconstruction reconstruction;
    Picture shown;
    for (uint32_t k = 0; k < 19; k++) {
      const Shot shot = shotAt({0, 0, 3}, k, true);
      shown = reconstruction.add(render(world(k), shot), shot.camera);
    }
    double sum = 0;
    for (size_t i = 0; i < valuesOf(shown).size(); i += 4) sum += double(valuesOf(shown)[i]);
    EXPECT_NEAR(sum / (96 * 72), 0.2 * later, 0.2 * 0.1 * later) << "after three frames";
  }
}

TEST(LiveReconstruction, LightThatFadesDoesNotLag) {
  Reconstruction reconstruction;
  Picture shown;
  double light = 1;
  for (uint32_t k = 0; k < 40; k++, light *= 0.97) {
    const Shot shot = shotAt({0, 0, 3}, k, true);
    const World world = [&](Vec origin, Vec direction) {
      Hit hit = plane(origin, direction, 0, -infinite, infinite);
      hit.light = light;
      hit.name = 1;
      return hit;
    };
    shown = reconstruction.add(render(world, shot), shot.camera);
  }
  light /= 0.97;
  double sum = 0;
  for (size_t i = 0; i < valuesOf(shown).size(); i += 4) sum += double(valuesOf(shown)[i]);
  // The mean over 16 frames would be 20 % too bright.
  EXPECT_NEAR(sum / (96 * 72), light, 0.05 * light);
}

TEST(LiveReconstruction, APixelWithoutSamplesKeepsItsColour) {
  Reconstruction reconstruction;
  const Shot shot = shotAt({0, 0, 3}, 0);
  Picture frame = quietFrame(shot);
  for (int k = 0; k < 4; k++) reconstruction.add(frame, shot.camera);
  const std::vector<float> before = colours(frame);
  for (int y = 20; y < 60; y++)
    for (int x = 30; x < 70; x++) {
      const size_t pixel = size_t(y * shot.width + x);
      for (auto& [channel, plane] : frame.planes) {
        const size_t numbers = plane.size() / (96 * 72);
        std::fill_n(&plane[pixel * numbers], numbers,
                    channel == RT_DEPTH ? std::numeric_limits<float>::infinity() : 0.0f);
      }
    }
  const Picture shown = reconstruction.add(frame, shot.camera);
  EXPECT_LT(largest(shown, before, {0, 0, 96, 72}), 0.5 / 255);
  reconstruction.reset();
  EXPECT_EQ(colourAt(reconstruction.add(frame, shot.camera), 50, 40, 0), 0);
}

TEST(LiveReconstruction, ThePictureIsOfTheFramesKind) {
  const Shot shot = shotAt({0, 0, 3}, 0);
  for (const bool linear : {false, true}) {
    Picture frame = render(movingPlane(0, 0, true), shot);
    frame.linear = linear;
    frame.planes[RT_RGBA][3] = 0.25f;
    Reconstruction reconstruction;
    const Picture shown = reconstruction.add(frame, shot.camera);
    EXPECT_EQ(shown.linear, linear);
    EXPECT_EQ(shown.planes.size(), 1u);
    EXPECT_EQ(valuesOf(shown).size(), 4u * 96 * 72);
    EXPECT_EQ(valuesOf(shown)[3], 0.25f);
    EXPECT_GT(reconstruction.facts().seconds, 0);
  }
}

TEST(LiveReconstruction, SmallFramesAreRebuilt) {
  Reconstruction reconstruction;
  for (const auto& [width, height] : {std::pair(1, 1), {1, 5}, {3, 2}, {17, 1}, {64, 48}, {2, 2}}) {
    Shot shot = shotAt({0, 0, 3}, 0, true);
    shot.width = width;
    shot.height = height;
    shot.camera.aspect = double(width) / height;
    const Picture shown = reconstruction.add(render(movingPlane(0, 0, true), shot), shot.camera);
    for (const float v : valuesOf(shown)) ASSERT_TRUE(std::isfinite(v) && v >= 0);
  }
}

TEST(LiveReconstruction, BadFramesAreRefused) {
  Reconstruction reconstruction;
  const Shot shot = shotAt({0, 0, 3}, 0);
  const Picture good = render(movingPlane(0, 0, true), shot);
  for (const auto& [channel, plane] : good.planes) {
    Picture without = good, shorter = good;
    without.planes.erase(channel);
    shorter.planes[channel].pop_back();
    EXPECT_THROW(reconstruction.add(without, shot.camera), std::invalid_argument) << channel;
    EXPECT_THROW(reconstruction.add(shorter, shot.camera), std::invalid_argument) << channel;
  }
  for (const int size : {0, -1, 65537}) {
    Picture other = good;
    other.width = size;
    EXPECT_THROW(reconstruction.add(other, shot.camera), std::invalid_argument);
    other.width = good.width;
    other.height = size;
    EXPECT_THROW(reconstruction.add(other, shot.camera), std::invalid_argument);
  }
  EXPECT_NO_THROW(reconstruction.add(good, shot.camera));
}

TEST(LiveReconstruction, NumbersThatAreNoneNeverShow) {
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(),
                       std::numeric_limits<float>::infinity(),
                       -std::numeric_limits<float>::infinity(),
                       std::numeric_limits<float>::max(),
                       -std::numeric_limits<float>::max(),
                       std::numeric_limits<float>::denorm_min(),
                       -1};
  Reconstruction reconstruction;
  const Shot shot = shotAt({0, 0, 3}, 0, true);
  const Picture good = render(movingPlane(0, 0, true), shot);
  for (const auto& [channel, ignored] : good.planes)
    for (const float v : bad)
      for (const size_t every : {1, 7}) {
        Picture frame = good;
        for (size_t i = 0; i < frame.planes[channel].size(); i += every)
          frame.planes[channel][i] = v;
        for (const Picture* next : {&std::as_const(frame), &std::as_const(frame), &good})
          for (const float shown : valuesOf(reconstruction.add(*next, shot.camera)))
            ASSERT_TRUE(std::isfinite(shown) && shown >= 0) << channel << ' ' << v;
      }
}

TEST(LiveReconstruction, CamerasThatAreNoneOnlyForget) {
  const double bad[] = {std::nan(""), infinite, 1e300, 0};
  const Shot shot = shotAt({0, 0, 3}, 0, true);
  const Picture frame = render(movingPlane(0, 0, true), shot);
  Reconstruction reconstruction;
  for (const double v : bad)
    for (int place = 0; place < 19; place++) {
      FrameCamera camera = shot.camera;
      (place < 16    ? camera.settings.matrix[place]
       : place == 16 ? camera.settings.fovy
       : place == 17 ? camera.settings.height
                     : camera.aspect) = v;
      for (const FrameCamera* next : {&std::as_const(camera), &shot.camera})
        for (const float shown : valuesOf(reconstruction.add(frame, *next)))
          ASSERT_TRUE(std::isfinite(shown) && shown >= 0) << place << ' ' << v;
    }
}

// picture_live_reconstruction.cpp: what previews accumulate, what they forget, and frames of any
// size and with any numbers.
#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "unit/picture_live_frames.h"
#include "unit/same_bytes.h"

using namespace live_frames;
using picture::live::FrameCamera;
using picture::live::Reconstruction;

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

// Gaps of a tenth of a pixel are met by few samples, whose surface was rarely seen before.
TEST(LiveReconstruction, ThinGapsDoNotShowAsDots) {
  const World world = [](Vec origin, Vec direction) {
    Hit hit = plane(origin, direction, 0, -infinite, infinite);
    const double x = origin.x + direction.x * hit.distance;
    hit.name = 1;
    if (std::abs(x - 0.5 * std::round(x / 0.5)) < 0.0013) {
      hit = plane(origin, direction, -0.5, -infinite, infinite);
      hit.light = 0;
      hit.name = 2;
    }
    return hit;
  };
  Reconstruction reconstruction;
  for (uint32_t k = 0; k < 40; k++) {
    const Shot shot = shotAt({0, 0, 3}, k);
    const Picture shown = reconstruction.add(render(world, shot), shot.camera);
    if (k >= 24) { EXPECT_LT(largest(shown, converged(world, shot), inner(shot, 1)), 0.5) << k; }
  }
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
    ASSERT_TRUE(isShowable(shown)) << width << " x " << height;
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
          ASSERT_TRUE(isShowable(reconstruction.add(*next, shot.camera))) << channel << ' ' << v;
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
        ASSERT_TRUE(isShowable(reconstruction.add(frame, *next))) << place << ' ' << v;
    }
}

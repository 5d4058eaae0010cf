// picture_live_sparse.cpp: previews of frames in which light is followed in one pixel of each block
// (RT_LIGHT_STRIDE) are as sharp as the guides of all pixels.
#include <gtest/gtest.h>

#include "unit/picture_live_frames.h"
#include "unit/same_bytes.h"

using namespace live_frames;
using picture::live::Reconstruction;

// Takes the light from all pixels but one of each block, as RT_LIGHT_STRIDE does, unless they see
// the environment. `number` of the frame: consecutive ones visit all pixels of a block.
static void takeLight(Picture& frame, int stride, uint32_t number) {
  const uint32_t places = uint32_t(stride) * uint32_t(stride), step = stride == 3 ? 4 : 1;
  for (int y = 0; y < frame.height; y++)
    for (int x = 0; x < frame.width; x++) {
      const auto pixel = size_t(y * frame.width + x);
      const auto first = uint32_t(random(uint32_t(y / stride), uint32_t(x / stride), 9) * places);
      const auto place = uint32_t((y % stride) * stride + x % stride);
      if (place == (first + number * step) % places ||
          !std::isfinite(frame.planes[RT_DEPTH][pixel]))
        continue;
      std::fill_n(&frame.planes[RT_RGBA][4 * pixel], 4, 0.0f);
      frame.planes[RT_SAMPLES][pixel] = 0;
    }
}

static Picture sparse(const World& world, const Shot& shot, int stride) {
  Picture frame = render(world, shot);
  takeLight(frame, stride, shot.number);
  return frame;
}

// A textured wall that a ball in front covers partly, under uniform light; the sky beyond.
static World texturedWorld(double wallLight, double ballLight) {
  return [=](Vec origin, Vec direction) {
    Hit hit = ball(origin, direction, 0.5, 0);
    if (std::isfinite(hit.distance)) {
      hit.albedo = {0.9, 0.3, 0.1};
      hit.light = ballLight;
      hit.name = 2;
      return hit;
    }
    hit = plane(origin, direction, -1, -infinite, 1.5);
    if (!std::isfinite(hit.distance)) {
      hit.light = 0.4 + 0.1 * direction.y;
      return hit;
    }
    const Vec p = origin + direction * hit.distance;
    const bool dark = (int(std::floor(p.x * 6)) + int(std::floor(p.y * 6))) % 2 != 0;
    hit.albedo = dark ? Vec{0.1, 0.2, 0.3} : Vec{0.8, 0.7, 0.6};
    hit.light = wallLight;
    hit.name = 1;
    return hit;
  };
}

// A wall with the shadow that something with an oblique edge throws in the light of a point.
static World shadowWorld(uint32_t frame = 0, double step = 0) {
  return [=](Vec origin, Vec direction) {
    Hit hit = plane(origin, direction, 0, -infinite, infinite);
    const Vec p = origin + direction * hit.distance;
    hit.light = p.x + 0.3 * p.y > step * frame ? 1 : 0.2;
    hit.albedo = {0.6, 0.6, 0.6};
    hit.name = 1;
    return hit;
  };
}

class SparseLight : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Strides, SparseLight, testing::Values(2, 3, 4));

TEST_P(SparseLight, UniformLightOnTexturesComesOutExactly) {
  // 97 x 71 is no multiple of any stride. The light differs at the silhouette.
  Shot shot = shotAt({0, 0, 3}, 0);
  shot.width = 97;
  shot.height = 71;
  shot.camera = cameraAt({0, 0, 3}, 0, 0.8, 97.0 / 71);
  shot.centred = true;
  const World world = texturedWorld(0.7, 2);
  const std::vector<float> truth = colours(render(world, shot));
  Reconstruction reconstruction;
  for (; shot.number < 20; shot.number++) {
    const Picture shown =
        reconstruction.add(sparse(world, shot, GetParam()), shot.camera, GetParam());
    size_t wrong = 0;
    compare(shown, truth, {0, 0, 97, 71}, [&](float d, size_t) { wrong += std::abs(d) > 1e-4f; });
    // In the first frames, few pixels of the silhouette have no light of their own surface nearby.
    ASSERT_LE(wrong, shot.number < 2 ? 40u : shot.number < 16 ? 12u : 0u) << shot.number;
  }
}

TEST_P(SparseLight, EdgesAndTexturesAreAsSharpInMotionAsWithAllLight) {
  Reconstruction all, few;
  Picture shown[2];
  Shot shot;
  for (uint32_t k = 0; k < 16; k++) {
    shot = shotAt({0.01 * k, 0, 3}, k);
    const World world = texturedWorld(0.7, 0.5);
    shown[0] = all.add(render(world, shot), shot.camera);
    shown[1] = few.add(sparse(world, shot, GetParam()), shot.camera, GetParam());
  }
  const std::vector<float> truth = converged(texturedWorld(0.7, 0.5), shot);
  EXPECT_LT(rms(shown[1], truth, inner(shot)), 1.2 * rms(shown[0], truth, inner(shot)));
}

TEST_P(SparseLight, TheEnvironmentIsShownAsItIs) {
  const World sky = [](Vec, Vec direction) {
    Hit hit;
    hit.light = 0.5 + 0.4 * std::sin(80 * direction.x) * std::sin(60 * direction.y);
    return hit;
  };
  Shot shot = shotAt({0, 0, 3}, 0);
  Reconstruction reconstruction;
  const Picture shown = reconstruction.add(sparse(sky, shot, GetParam()), shot.camera, GetParam());
  EXPECT_LT(largest(shown, colours(render(sky, shot)), {0, 0, 96, 72}), 1e-5);
}

TEST_P(SparseLight, AnObjectThinnerThanABlockKeepsItsColour) {
  // A post about one pixel wide, much brighter than the wall behind it.
  const World world = [](Vec origin, Vec direction) {
    Hit hit = plane(origin, direction, 0.5, -0.012, 0.012);
    if (std::isfinite(hit.distance)) {
      hit.light = 5;
      hit.name = 2;
    } else {
      hit = plane(origin, direction, -1, -infinite, infinite);
      hit.light = 0.2;
      hit.name = 1;
    }
    hit.albedo = {0.5, 0.5, 0.5};
    return hit;
  };
  Shot shot = shotAt({0.004, 0, 3}, 0);
  shot.centred = true;
  Reconstruction all, few;
  Picture shown[2];
  for (; shot.number < 20; shot.number++) {
    shown[0] = all.add(render(world, shot), shot.camera);
    shown[1] = few.add(sparse(world, shot, GetParam()), shot.camera, GetParam());
  }
  const std::vector<float> truth = colours(shown[0]);
  ASSERT_GT(*std::ranges::max_element(truth), 2); // the post is seen at all
  EXPECT_LT(largest(shown[1], truth, inner(shot)), 0.05);
}

TEST_P(SparseLight, SomethingThinInMotionHasTheLightOfNothingElse) {
  // Posts of about half a pixel, much darker than the wall behind them.
  const World world = [](Vec origin, Vec direction) {
    Hit hit = plane(origin, direction, 0.5, -infinite, infinite);
    const Vec p = origin + direction * hit.distance;
    hit.light = 0.2;
    hit.name = 2;
    if (p.x - 0.3 * std::floor(p.x / 0.3) > 0.012) {
      hit = plane(origin, direction, -1, -infinite, infinite);
      hit.light = 5;
      hit.name = 1;
    }
    hit.albedo = {0.5, 0.5, 0.5};
    return hit;
  };
  Reconstruction reconstruction;
  for (uint32_t k = 0; k < 16; k++) {
    const Shot shot = shotAt({0.013 * k, 0, 3}, k);
    const Picture shown =
        reconstruction.add(sparse(world, shot, GetParam()), shot.camera, GetParam());
    for (int y = 0; y < 72; y++)
      for (int x = 0; x < 96; x++) {
        ASSERT_GT(colourAt(shown, x, y, 0), 0.099) << k << ", " << x << ' ' << y;
        ASSERT_LT(colourAt(shown, x, y, 0), 2.51) << k << ", " << x << ' ' << y;
      }
  }
}

TEST_P(SparseLight, TheShadowOfAPointLightGetsSharpAtRest) {
  Shot shot = shotAt({0, 0, 3}, 0);
  Reconstruction reconstruction;
  Picture shown;
  for (; shot.number < 64; shot.number++)
    shown = reconstruction.add(sparse(shadowWorld(), shot, GetParam()), shot.camera, GetParam());
  const std::vector<float> truth = converged(shadowWorld(), shot);
  // Pixels that the edge crosses have had few samples of their own, and so have those whose corner
  // it cuts.
  compare(shown, truth, inner(shot), [&](float d, size_t pixel) {
    const bool crossed = truth[3 * pixel] > 0.13f && truth[3 * pixel] < 0.59f,
               beside = truth[3 * (pixel - 1)] != truth[3 * (pixel + 1)];
    ASSERT_LT(std::abs(d), crossed  ? 0.4f
                           : beside ? 0.15f
                                    : 0.002f)
        << pixel % 96 << ' ' << pixel / 96;
  });
}

TEST_P(SparseLight, ShadowsStaySharpInMotion) {
  Reconstruction reconstruction;
  Picture shown;
  Shot shot;
  for (uint32_t k = 0; k < 40; k++) {
    shot = shotAt({0.004 * k, 0, 3}, k);
    shown = reconstruction.add(sparse(shadowWorld(), shot, GetParam()), shot.camera, GetParam());
  }
  const std::vector<float> truth = converged(shadowWorld(), shot);
  size_t wrong = 0;
  compare(shown, truth, inner(shot), [&](float d, size_t) { wrong += std::abs(d) > 0.1f; });
  EXPECT_LT(wrong / 3, 3 * 56u); // three pixels in each of the 56 rows
}

TEST_P(SparseLight, AShadowThatMovesLeavesNoneBehind) {
  Reconstruction reconstruction;
  Picture shown;
  Shot shot;
  constexpr double step = 0.03; // about one pixel
  for (uint32_t k = 0; k < 30; k++) {
    shot = shotAt({0, 0, 3}, k);
    shown =
        reconstruction.add(sparse(shadowWorld(k, step), shot, GetParam()), shot.camera, GetParam());
  }
  // Farther than three blocks from the edge everything is as it is now.
  const std::vector<float> now = converged(shadowWorld(29, step), shot);
  for (int y = 8; y < 64; y++)
    for (int x = 12; x < 84; x++) {
      const auto at = [&](int dx) { return now[3 * size_t(y * 96 + x + dx)]; };
      const int away = 3 * GetParam();
      if (at(-away) != at(away)) continue;
      EXPECT_NEAR(colourAt(shown, x, y, 0), at(0), 0.05) << x << ' ' << y;
    }
}

TEST_P(SparseLight, NoiseShrinksAndTheMeanStays) {
  const World world = movingPlane(0, 0, false);
  Reconstruction reconstruction;
  Picture shown;
  Shot shot;
  for (uint32_t k = 0; k < 24; k++) {
    shot = shotAt({0, 0, 3}, k, true);
    shown = reconstruction.add(sparse(world, shot, GetParam()), shot.camera, GetParam());
  }
  const std::vector<float> truth = converged(world, shot);
  double sum = 0;
  compare(shown, truth, inner(shot), [&](float d, size_t) { sum += double(d); });
  EXPECT_NEAR(sum / (80 * 56 * 3), 0, 0.08); // the mean is 0.5
  EXPECT_LT(rms(shown, truth, inner(shot)), 0.2);
}

TEST_P(SparseLight, LightOfPathsFromLampsIsTheMeanOfThePixelsWithoutLight) {
  const World world = texturedWorld(0.5, 0.5);
  Shot shot = shotAt({0, 0, 3}, 0);
  shot.centred = true;
  Picture frame = sparse(world, shot, GetParam());
  for (size_t i = 0; i < frame.planes[RT_SAMPLES].size(); i++)
    if (frame.planes[RT_SAMPLES][i] == 0)
      for (size_t c = 0; c < 3; c++)
        frame.planes[RT_RGBA][4 * i + c] = 0.25f * frame.planes[RT_ALBEDO][3 * i + c];
  Reconstruction reconstruction;
  const Picture shown = reconstruction.add(frame, shot.camera, GetParam());
  const std::vector<float> truth = colours(render(texturedWorld(0.75, 0.75), shot));
  size_t wrong = 0;
  compare(shown, truth, {8, 8, 30, 64}, [&](float d, size_t) { wrong += std::abs(d) > 0.01f; });
  EXPECT_EQ(wrong, 0u);
}

TEST_P(SparseLight, TheSameBytesOnAnyNumberOfThreads) {
  Reconstruction one(1), four(4);
  for (uint32_t k = 0; k < 6; k++) {
    const Shot shot = shotAt({0.02 * k, 0, 3}, k, k % 2 == 0);
    const Picture frame = sparse(quietWorld(), shot, GetParam());
    EXPECT_EQ(valuesOf(one.add(frame, shot.camera, GetParam())),
              valuesOf(four.add(frame, shot.camera, GetParam())));
  }
}

TEST_P(SparseLight, TheSameBytesOnEveryInstructionSet) {
  openrt::test::expectSameBytes([](std::vector<float>& results) {
    Reconstruction reconstruction;
    for (uint32_t k = 0; k < 5; k++) {
      const Shot shot = shotAt({0.02 * k, 0, 3}, k, k % 2 == 0);
      results = valuesOf(reconstruction.add(sparse(turningBall(k, 0.03, false), shot, GetParam()),
                                            shot.camera, GetParam()));
    }
  });
}

TEST_P(SparseLight, PixelsWithoutLightAreOpaque) {
  const Shot shot = shotAt({0, 0, 3}, 0);
  Reconstruction reconstruction;
  const Picture shown =
      reconstruction.add(sparse(texturedWorld(1, 1), shot, GetParam()), shot.camera, GetParam());
  for (size_t i = 3; i < valuesOf(shown).size(); i += 4) ASSERT_EQ(valuesOf(shown)[i], 1);
}

TEST_P(SparseLight, SmallFramesAreRebuilt) {
  for (const int size : {1, 2, 3, 5}) {
    Reconstruction reconstruction;
    for (uint32_t k = 0; k < 20; k++) {
      Shot shot = shotAt({0, 0, 3}, k);
      shot.width = size;
      shot.height = 6 - size;
      const Picture shown =
          reconstruction.add(sparse(quietWorld(), shot, GetParam()), shot.camera, GetParam());
      ASSERT_TRUE(isShowable(shown));
    }
  }
}

TEST(SparseLightStrides, AChangeKeepsWhatWasAccumulated) {
  const World world = movingPlane(0, 0, false);
  Reconstruction reconstruction;
  Shot shot;
  Picture shown;
  const auto add = [&](int stride) {
    shot = shotAt({0, 0, 3}, shot.number + 1, true);
    shown = reconstruction.add(sparse(world, shot, stride), shot.camera, stride);
  };
  for (int k = 0; k < 16; k++) add(3);
  for (const int stride : {1, 1, 2, 4, 3, 1}) {
    add(stride);
    EXPECT_GT(reconstruction.facts().reprojected, 0.9) << stride;
    EXPECT_GT(reconstruction.facts().history, 10) << stride;
  }
  EXPECT_LT(rms(shown, converged(world, shot), inner(shot)), 0.2);
}

TEST(SparseLightStrides, OthersAreRefused) {
  const Shot shot = shotAt({0, 0, 3}, 0);
  const Picture frame = render(quietWorld(), shot);
  Reconstruction reconstruction;
  for (const int stride : {-1, 0, 5})
    EXPECT_THROW(reconstruction.add(frame, shot.camera, stride), std::invalid_argument);
}

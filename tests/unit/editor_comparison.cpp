// editor_comparison.cpp: Tests how still pictures are compared with one that was kept, and what a
// rectangle of a picture measures, against closed forms and by pictures of noise.
#include <cmath>
#include <random>

#include "edit/comparison.h"
#include "edit/region.h"
#include "holm.h"
#include "student.h"
#include "unit/editor_support.h"

namespace {

using namespace editor_test;
using namespace vv;
using picture::Picture;
using Shown = Comparison::Shown;

Picture grey(int width, int height, float luminance, float halfWidth, bool trusted = true) {
  Picture picture;
  const size_t pixels = size_t(width) * size_t(height);
  picture.width = width;
  picture.height = height;
  picture.planes[RT_RGBA].assign(4 * pixels, luminance);
  picture.planes[RT_ERROR].assign(3 * pixels, halfWidth);
  picture.planes[RT_SAMPLES].assign(pixels, 100);
  picture.planes[RT_TRUST].assign(pixels, trusted ? 1.f : 0.f);
  return picture;
}

void set(Picture& picture, size_t pixel, float luminance) {
  std::fill_n(&picture.planes[RT_RGBA][4 * pixel], 3, luminance);
}

picture::PixelReading reading(float luminance, float halfWidth) {
  return readPixel(grey(1, 1, luminance, halfWidth), 0, 0);
}

// A picture of the light 10 whose pixels are the means of so many replicates, with Student's
// interval of each.
Picture noise(int side, int replicates, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Picture picture = grey(side, side, 0, 0);
  for (size_t i = 0; i < size_t(side) * size_t(side); ++i) {
    double sum = 0, squares = 0;
    for (int k = 0; k < replicates; ++k) {
      const double x = normal(random);
      sum += x;
      squares += x * x;
    }
    const double mean = sum / replicates;
    const double variance = (squares - replicates * mean * mean) / (replicates - 1);
    set(picture, i, float(10 + mean));
    std::fill_n(&picture.planes[RT_ERROR][3 * i], 3,
                float(student::quantile95(replicates - 1) * std::sqrt(variance / replicates)));
  }
  return picture;
}

// --- Changes ---

TEST(Changes, TheChanceOfAChangeIsThatOfStudent) {
  // Half-widths of 8 replicates: 2.36462 standard errors. Against an exact reading t has 7 degrees
  // of freedom, whose two-sided 1 % quantile is 3.49948.
  const Difference one = differenceBetween(reading(10, 0), reading(13.49948f, 2.36462f));
  EXPECT_NEAR(one.value, 3.49948, 1e-5);
  EXPECT_NEAR(one.halfWidth, 2.36462, 1e-5);
  EXPECT_NEAR(one.chance, .01, 1e-5);
  // Between equal ones t has 14 degrees of freedom, and 1 % is at 2.97684. Readings of very many
  // replicates have the half-width 1.95996, and 1.36 %, which is more.
  const auto root = float(std::sqrt(2.));
  const Difference two =
      differenceBetween(reading(10 + root * 2.97684f, 2.36462f), reading(10, 2.36462f));
  EXPECT_NEAR(two.value, -4.20989, 1e-4);
  EXPECT_NEAR(two.chance, .0136092, 1e-5);
  EXPECT_EQ(differenceBetween(reading(10, 3), reading(14.9f, 4)).chance, 1) << "contains 0";
  EXPECT_EQ(differenceBetween(reading(10, 0), reading(10, 0)).chance, 1);
  EXPECT_EQ(differenceBetween(reading(10, 0), reading(10.1f, 0)).chance, 0);
  EXPECT_EQ(differenceBetween(reading(10, INFINITY), reading(100, 1)).chance, 1);
}

TEST(Changes, HolmGoesOnToTheFirstThatMayBeChance) {
  EXPECT_EQ(holm::significantOf({.04, .001, .012, .9, .018}, changeLevel),
            (std::vector<size_t>{1, 2}));
  EXPECT_EQ(holm::significantOf({.04}, changeLevel), (std::vector<size_t>{0}));
  EXPECT_EQ(holm::significantOf({.04, .04}, changeLevel), (std::vector<size_t>{}));
  EXPECT_TRUE(holm::significantOf({}, changeLevel).empty());
}

TEST(Changes, PixelsThatHaveChangedAreFound) {
  const Picture before = grey(8, 4, 10, .1f);
  Picture now = before;
  set(now, 3, 15);
  set(now, 8, 4);
  set(now, 9, 10.05f);
  set(now, 20, 50);
  now.planes[RT_TRUST][20] = 0;
  const ChangePicture changes = compare(before, now);
  EXPECT_EQ(changes.significant, 2u);
  EXPECT_EQ(changes.judged, 31u);
  EXPECT_FLOAT_EQ(changes.changes[3], 5);
  EXPECT_FLOAT_EQ(changes.changes[8], -6);
  EXPECT_EQ(changes.changes[9], 0);
  EXPECT_EQ(changes.changes[20], 0) << "not trusted";
  EXPECT_FLOAT_EQ(changes.most, 5);
  EXPECT_FLOAT_EQ(changes.least, -6);
  const std::vector<uint8_t> bytes = drawChanges(changes, std::vector<uint8_t>(3 * 32, 200));
  EXPECT_GT(bytes[9], bytes[11] + 60) << "orange";
  EXPECT_EQ(bytes[26], 255) << "blue: the largest change has its full colour";
  EXPECT_EQ(bytes[26] - bytes[24], 255 - 70);
  EXPECT_EQ(bytes[27], bytes[29]) << "grey";
  EXPECT_LT(bytes[27], 100) << "dimmed";
}

// Promised: with a probability of 95 % no pixel of a picture is called changed by chance.
TEST(Changes, NoiseIsNoChange) {
  std::mt19937 random(1);
  for (const int replicates : {8, 16, 31}) {
    int wrong = 0;
    constexpr int pictures = 300;
    for (int i = 0; i < pictures; ++i)
      wrong +=
          compare(noise(16, replicates, random), noise(16, replicates, random)).significant > 0;
    // Above .05 * 300 by three standard deviations.
    EXPECT_LE(wrong, 26) << replicates;
  }
}

// The same for a few readings with many replicates, as probes have them.
TEST(Changes, NoiseOfAFewReadingsIsNoChange) {
  std::mt19937 random(1);
  int wrong = 0;
  constexpr int pictures = 4000;
  for (int i = 0; i < pictures; ++i)
    wrong += compare(noise(2, 64, random), noise(2, 64, random)).significant > 0;
  // Above .05 * 4000 by three standard deviations.
  EXPECT_LE(wrong, 242);
}

TEST(Changes, AChangeOfTheWholePictureIsFoundUnderNoise) {
  std::mt19937 random(1);
  Picture now = noise(16, 16, random);
  for (size_t i = 0; i < 256; ++i) set(now, i, now.planes[RT_RGBA][4 * i] + 5); // 20 deviations
  EXPECT_GT(compare(noise(16, 16, random), now).significant, 200u);
}

// --- A ---

struct KeptPicture : testing::Test {
  EditView view = front();
  Comparison comparison;
  void keep(const Picture& picture, uint64_t frame) {
    comparison.ask(0, view);
    EXPECT_TRUE(comparison.wantsPicture());
    EXPECT_TRUE(comparison.take(picture, frame, 0, view, false));
    EXPECT_EQ(comparison.takeMessage(), "A is kept");
    EXPECT_FALSE(comparison.wantsPicture());
  }
};

TEST_F(KeptPicture, ItIsShownInThePlaceOfThePresentOne) {
  EXPECT_THROW(comparison.toggle(Shown::a), xvrml::EditError);
  keep(grey(4, 2, 1, 0), 7);
  comparison.take(grey(4, 2, 0, 0), 8, 1, view, false);
  EXPECT_EQ(comparison.cover().width, 0);
  comparison.toggle(Shown::a);
  EXPECT_EQ(comparison.cover().width, 4);
  EXPECT_EQ(comparison.cover().rgb, std::vector<uint8_t>(24, 255));
  comparison.toggle(Shown::wiper);
  comparison.setWiper(-.5);
  EXPECT_DOUBLE_EQ(comparison.coverPart(), .25);
  comparison.toggle(Shown::wiper);
  EXPECT_EQ(comparison.shown(), Shown::present);
  EXPECT_EQ(comparison.cover().width, 0);
}

TEST_F(KeptPicture, ItIsRefinedWithItsFrame) {
  keep(grey(4, 2, 1, .5f), 7);
  EXPECT_TRUE(comparison.take(grey(4, 2, 1, .1f), 7, 0, view, false));
  EXPECT_EQ(comparison.takeMessage(), "");
  EXPECT_TRUE(comparison.take(grey(4, 2, 1, .1f), 7, 0, view, true));
  EXPECT_NE(comparison.takeMessage().find("all its samples"), std::string::npos);
  EXPECT_FALSE(comparison.take(grey(4, 2, 5, .1f), 8, 1, view, false));
  comparison.toggle(Shown::difference);
  EXPECT_TRUE(comparison.wantsPicture());
  EXPECT_EQ(comparison.changes(), nullptr);
  comparison.take(grey(4, 2, 2, 0), 8, 1, view, false);
  ASSERT_NE(comparison.changes(), nullptr);
  EXPECT_EQ(comparison.changes()->significant, 8u) << "by the narrower error bars";
  comparison.follow(view, 4, 2, {}, true);
  EXPECT_EQ(comparison.changes(), nullptr) << "the world has changed again";
  EXPECT_EQ(comparison.cover().width, 0);
}

TEST_F(KeptPicture, AnEditBeforeItsPictureIsThereIsSaid) {
  comparison.ask(3, view);
  EXPECT_FALSE(comparison.take(grey(4, 2, 1, 0), 7, 4, view, false));
  EXPECT_FALSE(comparison.hasA());
  EXPECT_NE(comparison.takeMessage().find("not kept"), std::string::npos);
}

TEST_F(KeptPicture, OtherViewsAndSizesAreNotCompared) {
  EXPECT_FALSE(comparison.whyNot(view, 4, 2).empty());
  keep(grey(4, 2, 1, 0), 7);
  EXPECT_EQ(comparison.whyNot(view, 4, 2), "");
  EXPECT_NE(comparison.whyNot(view, 8, 4), "");
  comparison.toggle(Shown::a);
  EditView other = view;
  other.camera.matrix[12] = .1;
  comparison.follow(other, 4, 2, {}, true);
  EXPECT_EQ(comparison.shown(), Shown::present);
  EXPECT_NE(comparison.takeMessage().find("cannot be compared"), std::string::npos);
  comparison.toggle(Shown::difference);
  comparison.take(grey(4, 2, 9, 0), 9, 1, other, false);
  EXPECT_EQ(comparison.changes(), nullptr);
}

// --- Rectangles ---

TEST(Rectangles, TheirPixelsAreThoseWithTheirMiddleInside) {
  const auto expect = [](const PixelRectangle& r, int left, int top, int width, int height) {
    EXPECT_EQ(r.left, left);
    EXPECT_EQ(r.top, top);
    EXPECT_EQ(r.width, width);
    EXPECT_EQ(r.height, height);
  };
  expect(pixelsOf(regionBetween(-1, -1, 1, 1), 8, 4), 0, 0, 8, 4);
  expect(pixelsOf(regionBetween(9, 9, -9, -9), 8, 4), 0, 0, 8, 4);
  expect(pixelsOf(regionBetween(0, 0, 1, 1), 8, 4), 4, 0, 4, 2);
  expect(pixelsOf(regionBetween(-.95, .6, -.7, .9), 8, 4), 0, 0, 1, 1);
  expect(pixelsOf(regionBetween(1, -1, 1, -1), 8, 4), 7, 3, 1, 1);
  // All pixels of neighbouring rectangles are counted once.
  const PixelRectangle left = pixelsOf(regionBetween(-1, -1, .1, 1), 7, 7),
                       right = pixelsOf(regionBetween(.1, -1, 1, 1), 7, 7);
  EXPECT_EQ(left.width, right.left);
  EXPECT_EQ(left.width + right.width, 7);
}

TEST(Rectangles, TheyHaveTheMeanTheRangeAndTheUniformity) {
  Picture picture = grey(4, 4, 10, .8f);
  set(picture, 5, 4);
  set(picture, 6, 20);
  const RegionReading all = readRegion(picture, regionBetween(-1, -1, 1, 1));
  EXPECT_FLOAT_EQ(all.mean.luminance, (14 * 10 + 24) / 16.f);
  EXPECT_FLOAT_EQ(float(all.least), 4);
  EXPECT_FLOAT_EQ(float(all.most), 20);
  EXPECT_NEAR(all.uniformity(), 4 / (164 / 16.), 1e-6);
  EXPECT_TRUE(all.mean.trusted);
  // Independent pixels: .8 / sqrt(16), and six tenths that all of them may be wrong by.
  EXPECT_NEAR(double(all.mean.luminanceHalfWidth), 1.6 * .2, 1e-6);
  const RegionReading one = readRegion(picture, regionBetween(-.49, .49, -.01, .01));
  EXPECT_FLOAT_EQ(one.mean.luminance, 4);
  EXPECT_FLOAT_EQ(one.mean.luminanceHalfWidth, .8f);
}

TEST(Rectangles, WhatIsNotTrustedMayErrInOneDirection) {
  const Picture picture = grey(4, 4, 10, .8f, false);
  const RegionReading all = readRegion(picture, regionBetween(-1, -1, 1, 1));
  EXPECT_FALSE(all.mean.trusted);
  EXPECT_NEAR(double(all.mean.luminanceHalfWidth), .8, 1e-6);
}

TEST(Rectangles, TheIntervalHoldsUnderNoise) {
  std::mt19937 random(1);
  int held = 0;
  for (int i = 0; i < 300; ++i) {
    const RegionReading all = readRegion(noise(16, 16, random), regionBetween(-1, -1, 1, 1));
    held += std::abs(double(all.mean.luminance) - 10) <= double(all.mean.luminanceHalfWidth);
  }
  EXPECT_GE(held, 285);
}

TEST(Rectangles, TheShapesThatAreSeenInThemAreSelected) {
  EditedWorld world("#VRML V2.0 utf8\n"
                    "DEF A Transform { translation -2 0 0 children DEF SA Shape { geometry Box { } "
                    "} }\n"
                    "DEF B Transform { translation 2 0 0 children DEF SB Shape { geometry Box { } "
                    "} }\n"
                    "DEF C Transform { translation 2 0 -4 children DEF SC Shape { geometry Box { } "
                    "} }\n");
  const EditView view = front();
  selectIn(world.editor, view, regionBetween(-1, -1, 1, 1), false);
  EXPECT_EQ(world.editor.selection().size(), 3u) << "the one behind is seen beside the other";
  selectIn(world.editor, view, regionBetween(-1, -.5, 0, .5), false);
  ASSERT_EQ(world.editor.selection().size(), 1u);
  EXPECT_EQ(world.editor.selected(), world.node("SA").get());
  selectIn(world.editor, view, regionBetween(.35, .1, .6, -.1), true);
  EXPECT_EQ(world.editor.selection().size(), 2u);
  EXPECT_EQ(world.editor.selected(), world.node("SB").get());
  selectIn(world.editor, view, regionBetween(-.1, .8, .1, .9), false);
  EXPECT_TRUE(world.editor.selection().empty());
}

TEST(Views, AreEqualWhereTheyShowTheSame) {
  EditView a, b;
  EXPECT_EQ(a, b);
  b.camera.matrix[12] = -0.0;
  EXPECT_EQ(a, b);
  b.camera.matrix[12] = 1;
  EXPECT_NE(a, b);
  a.camera.matrix[12] = b.camera.matrix[12] = std::nan("");
  EXPECT_EQ(a, b) << "a camera always equals itself";
  b.aspect = 2;
  EXPECT_NE(a, b);
}

} // namespace

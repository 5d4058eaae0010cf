// picture_live_display.cpp: Tests what is shown of a frame while it is not finished. A still
// picture fades in over a preview, gets better steadily, and ends as it is; viewers do not see each
// other's pictures.
#include <gtest/gtest.h>

#include <cmath>

#include "libpicture/false_colour.h"
#include "libpicture/live/display.h"

using namespace picture;
using live::Display;
using live::ShownFrame;
using live::stillWeight;
using Purpose = LiveFrame::Purpose;

namespace {

// A picture of display values with the same number of samples everywhere.
Picture pictureOf(const std::vector<float>& values, int width, float samples) {
  Picture picture;
  picture.width = width;
  picture.height = int(values.size()) / width;
  picture.linear = false;
  for (const float v : values)
    picture.planes[RT_RGBA].insert(picture.planes[RT_RGBA].end(), {v, v, v, 1});
  picture.planes[RT_SAMPLES].assign(values.size(), samples);
  return picture;
}

Picture uniform(double byte, float samples = 1, int width = 4, int height = 3) {
  return pictureOf(std::vector<float>(size_t(width * height), float(byte / 255)), width, samples);
}

ShownFrame stillFrame(uint64_t number, int samples = 256, uint32_t viewer = 0) {
  return {number, Purpose::still, viewer, samples};
}
ShownFrame preview(uint64_t number, uint32_t viewer = 0) {
  return {number, Purpose::preview, viewer, 1};
}

LivePicture show(Display& display, const Picture& picture, const ShownFrame& frame, bool whole,
                 double seconds = 0) {
  LivePicture out;
  display.show(picture, frame, whole, seconds, out);
  EXPECT_EQ(out.rgb.size(), size_t(3 * out.shownWidth * out.shownHeight));
  return out;
}

} // namespace

TEST(LiveDisplay, theWeightOfAStillPictureGrowsToOne) {
  for (const int wanted : {1, 2, 16, 256, 65536}) {
    double before = 0;
    for (double samples = 0; samples <= wanted; samples += wanted / 64.0) {
      const double weight = stillWeight(samples, wanted, 0);
      EXPECT_GE(weight, before);
      EXPECT_LE(weight, 1);
      before = weight;
    }
    EXPECT_EQ(before, 1) << wanted;
    EXPECT_EQ(stillWeight(wanted / 4.0 + 1, wanted, 0), wanted <= 256 ? 1 : before);
  }
  EXPECT_LT(stillWeight(1, 256, 0), 0.02); // no leap to one sample
  EXPECT_EQ(stillWeight(64, 65536, 0), 1); // nobody waits for thousands of samples
  double before = 0;
  for (double seconds = 0; seconds < 5; seconds += 0.1) {
    const double weight = stillWeight(5, 256, seconds);
    EXPECT_GE(weight, before);
    before = weight;
  }
  EXPECT_EQ(before, 1);                     // unbiased within five seconds
  EXPECT_LE(stillWeight(2, 256, 1e9), 0.5); // but not with two samples
}

TEST(LiveDisplay, aStillPictureFadesInAndEndsAsItIs) {
  Display display;
  const LivePicture moving = show(display, uniform(200), preview(1), true);
  EXPECT_TRUE(moving.preview);
  EXPECT_EQ(moving.rgb[0], 200);
  int before = 200;
  for (const int samples : {1, 2, 4, 8, 16, 32, 63}) {
    const LivePicture fading =
        show(display, uniform(100, float(samples)), stillFrame(2), false, 0.1);
    EXPECT_TRUE(fading.preview) << samples;
    EXPECT_EQ(fading.samples, samples);
    EXPECT_LT(fading.rgb[0], before) << samples;
    EXPECT_GE(fading.rgb[0], 100);
    before = fading.rgb[0];
  }
  const LivePicture alone = show(display, uniform(100, 64), stillFrame(2), false, 0.1);
  EXPECT_FALSE(alone.preview);
  EXPECT_EQ(alone.rgb, displayBytes(uniform(100)));
  // A picture that is finished early, too.
  show(display, uniform(200), preview(3), true);
  const LivePicture finished = show(display, uniform(100, 1), stillFrame(4), true);
  EXPECT_FALSE(finished.preview);
  EXPECT_EQ(finished.rgb, displayBytes(uniform(100)));
}

// A preview is biased, a still picture is noisy. The picture that is shown gets better with every
// sample.
TEST(LiveDisplay, whatIsShownGetsBetterSteadily) {
  constexpr int width = 64, height = 64;
  constexpr double truth = 128, bias = 20, noise = 60;
  Display display;
  const auto errorOf = [](const LivePicture& picture) {
    double sum = 0;
    for (const uint8_t byte : picture.rgb) sum += (byte - truth) * (byte - truth);
    return std::sqrt(sum / double(picture.rgb.size()));
  };
  double before = errorOf(show(display, uniform(truth + bias, 1, width, height), preview(1), true));
  EXPECT_NEAR(before, bias, 1);
  uint32_t state = 1;
  for (int samples = 1; samples <= 256; samples *= 2) {
    std::vector<float> values;
    for (int i = 0; i < width * height; ++i) {
      double sum = 0; // the sum of twelve uniform numbers: nearly normal, with variance 1
      for (int k = 0; k < 12; ++k)
        sum += double(state = state * 1664525 + 1013904223) / 4294967296.0;
      values.push_back(float((truth + (sum - 6) * noise / std::sqrt(samples)) / 255));
    }
    const double error = errorOf(
        show(display, pictureOf(values, width, float(samples)), stillFrame(2), samples == 256));
    EXPECT_LT(error, before + 0.1) << samples;
    before = error;
  }
  EXPECT_LT(before, 5);
}

// The preview is wrong in its right half. There the still picture takes its place; on the left it
// would only bring noise: nowhere does it bring more than the preview is wrong.
TEST(LiveDisplay, aStillPictureBringsNoMoreNoiseThanThePreviewIsWrong) {
  constexpr int width = 128, height = 96;
  constexpr double truth = 128, noise = 60;
  const auto biasAt = [](int x) { return x < width / 2 ? 1.0 : 40.0; };
  Display display;
  std::vector<float> biased;
  for (int i = 0; i < width * height; ++i)
    biased.push_back(float((truth + biasAt(i % width)) / 255));
  show(display, pictureOf(biased, width, 1), preview(1), true);
  std::vector<double> sums(size_t(width) * height);
  uint32_t state = 1;
  double wrong[2] = {};
  for (int samples = 1; samples <= 64; ++samples) { // the same samples, and more and more of them
    std::vector<float> values;
    for (double& sum : sums) {
      double normal = -6; // the sum of twelve uniform numbers
      for (int k = 0; k < 12; ++k)
        normal += double(state = state * 1664525 + 1013904223) / 4294967296.0;
      sum += truth + normal * noise;
      values.push_back(float(sum / samples / 255));
    }
    // After a while the weight of time is one.
    const LivePicture shown = show(display, pictureOf(values, width, float(samples)), stillFrame(2),
                                   false, samples < 3 ? 0.1 : 9);
    if (samples < 4) continue;
    for (const bool right : {false, true}) {
      double sum = 0;
      for (int y = 0; y < height; ++y) // away from where both halves meet
        for (int x = right ? 80 : 0; x < (right ? width : 48); ++x) {
          const double d = shown.rgb[3 * size_t(y * width + x)] - truth;
          sum += d * d;
        }
      wrong[right] = std::sqrt(sum / (48.0 * height));
    }
    EXPECT_LT(wrong[0], 3) << samples; // alone it would be 30 at 4 samples, and 8 at 64
    EXPECT_LT(wrong[1], 31) << samples;
    EXPECT_TRUE(shown.preview);
  }
  EXPECT_LT(wrong[1], 10);
}

TEST(LiveDisplay, pixelsWithoutSamplesShowWhatWasThere) {
  Display display;
  show(display, uniform(200, 1, 2, 2), preview(1), true);
  Picture half = uniform(100, 256, 4, 4);
  for (size_t i = 0; i < 8; ++i) half.planes[RT_SAMPLES][i] = 0;
  const LivePicture picture = show(display, half, stillFrame(2), false);
  EXPECT_EQ(picture.covered, 0.5);
  EXPECT_TRUE(picture.preview);
  EXPECT_EQ(picture.rgb.front(), 200);
  EXPECT_EQ(picture.rgb.back(), 100);
}

// Without a preview before, samples are shown at once.
TEST(LiveDisplay, stillPicturesDoNotFadeOverEachOther) {
  Display display;
  EXPECT_EQ(show(display, uniform(50, 1), stillFrame(1), false).rgb[0], 50);
  show(display, uniform(200, 256), stillFrame(1), true);
  const LivePicture next = show(display, uniform(100, 1), stillFrame(2), false);
  EXPECT_EQ(next.rgb[0], 100);
  EXPECT_FALSE(next.preview);
  show(display, uniform(30), {3, Purpose::rawPreview, 0, 1}, true);
  EXPECT_EQ(show(display, uniform(60, 1), stillFrame(4), false).rgb[0], 60);
}

// A still frame that is cancelled leaves a mixture behind. The next one fades over that.
TEST(LiveDisplay, whatAMixtureLeavesIsAPreview) {
  Display display;
  show(display, uniform(200), preview(1), true);
  const LivePicture first = show(display, uniform(100, 32), stillFrame(2), false);
  EXPECT_EQ(first.rgb[0], 150);
  const LivePicture next = show(display, uniform(100, 1), stillFrame(3), false);
  EXPECT_TRUE(next.preview);
  EXPECT_NEAR(next.rgb[0], 149, 1);
}

TEST(LiveDisplay, viewersSeeTheirOwnPictures) {
  Display display;
  show(display, uniform(200), preview(1, 7), true);
  show(display, uniform(20), preview(2, 8), true);
  EXPECT_GT(show(display, uniform(100, 1), stillFrame(3, 256, 7), false).rgb[0], 190);
  EXPECT_LT(show(display, uniform(100, 1), stillFrame(4, 256, 8), false).rgb[0], 30);
  // The viewer that was away for longest is forgotten.
  for (uint32_t viewer = 10; viewer < 10 + live::mostRecentViewers - 1; ++viewer)
    show(display, uniform(200), preview(5 + viewer, viewer), true);
  EXPECT_EQ(show(display, uniform(100, 1), stillFrame(100, 256, 7), false).rgb[0], 100);
}

TEST(LiveDisplay, picturesAreScaledBetweenTheCentersOfPixels) {
  const std::vector<uint8_t> two = {0, 10, 250, 200, 110, 50};
  EXPECT_EQ(live::scaled(two, 2, 1, 2, 1), two);
  const std::vector<uint8_t> wide = live::scaled(two, 2, 1, 8, 3);
  ASSERT_EQ(wide.size(), 8u * 3 * 3);
  for (int y = 0; y < 3; ++y) {
    const uint8_t* row = wide.data() + size_t(y) * 24;
    EXPECT_EQ(row[0], 0);
    EXPECT_EQ(row[21], 200);
    for (int x = 1; x < 8; ++x) {
      EXPECT_GE(row[3 * x], row[3 * x - 3]);
      EXPECT_LE(row[3 * x + 2], row[3 * x - 1]);
    }
    EXPECT_NEAR(row[9] + row[12], 200, 3); // symmetric about the middle
  }
  const std::vector<uint8_t> grey(3 * 35 * 21, 77);
  EXPECT_EQ(live::scaled(grey, 35, 21, 9, 64), std::vector<uint8_t>(3 * 9 * 64, 77));
}

// A finished still picture has the scale that its file would have. The others keep that of the last
// finished one, so that colours do not flicker while something moves.
TEST(LiveDisplay, falseColoursKeepTheirScaleInMotion) {
  Display display;
  const auto inFalseColours = [](ShownFrame frame, double end) {
    frame.falseColour = end;
    return frame;
  };
  const auto endOf = [&](double byte, const ShownFrame& frame, bool whole) {
    return 255 * show(display, uniform(byte), frame, whole).scaleEnd;
  };
  EXPECT_NEAR(endOf(100, inFalseColours(preview(1), 0), true), 100, .01);
  EXPECT_NEAR(endOf(200, inFalseColours(preview(2), 0), true), 100, .01);
  EXPECT_NEAR(endOf(200, inFalseColours(stillFrame(3), 0), false), 100, .01);
  EXPECT_NEAR(endOf(200, inFalseColours(stillFrame(3), 0), true), 200, .01);
  EXPECT_NEAR(endOf(50, inFalseColours(preview(4), 0), true), 200, .01);
  EXPECT_NEAR(endOf(50, inFalseColours(preview(5, 1), 0), true), 50, .01) << "another viewer's";
  EXPECT_EQ(endOf(50, preview(6), true), 0) << "own colours";
  EXPECT_NEAR(endOf(50, inFalseColours(preview(7), 0), true), 50, .01) << "chosen anew";
  EXPECT_NEAR(endOf(50, inFalseColours(preview(8), 9), true), 9 * 255, .01) << "given";

  const LivePicture own = show(display, uniform(128), preview(9), true),
                    shown = show(display, uniform(128), inFalseColours(preview(10), 1), true);
  EXPECT_EQ(own.rgb[0], own.rgb[1]);
  EXPECT_EQ(shown.rgb, displayBytes(falseColours(uniform(128), 1, Legend::apart)));
  EXPECT_EQ(shown.width, own.width) << "without the legend";

  // Previews have the isolines of the size that they are shown in; a still picture has that size.
  ShownFrame larger = inFalseColours(preview(11), 1);
  larger.shownWidth = 2 * own.width;
  larger.shownHeight = 3 * own.height;
  const LivePicture enlarged = show(display, uniform(128), larger, true);
  EXPECT_EQ(enlarged.width, own.width) << "the frame keeps its size";
  EXPECT_EQ(enlarged.shownWidth, 2 * own.width);
  EXPECT_EQ(enlarged.shownHeight, 3 * own.height);
  EXPECT_EQ(enlarged.rgb.size(), 6 * own.rgb.size());
}

// picture_live_sparse_previews.cpp: LiveRenderer with frames in which light is followed in one
// pixel of each block: they cost less, are previews all the same, and leave nothing in still
// pictures.
#include "unit/live_previews.h"

using namespace live_previews;

namespace {

LiveFrame sparseOf(int stride, int width = 66, int height = 48) {
  LiveFrame frame = previewOf(0, width, height);
  frame.lightStride = stride;
  return frame;
}

// The mean of all bytes.
double meanOf(const LivePicture& picture) {
  double sum = 0;
  for (const uint8_t byte : picture.rgb) sum += byte;
  return sum / double(picture.rgb.size());
}

class LiveSparseLight : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Strides, LiveSparseLight, testing::Values(2, 3, 4));

} // namespace

TEST_P(LiveSparseLight, picturesShownArePreviews) {
  const auto browser = browserOf();
  LiveRenderer live(*browser, settingsOf());
  for (int i = 0; i < 6; ++i) {
    moveTo(*browser, .1 * i);
    const LivePicture picture = finish(live, sparseOf(GetParam()));
    EXPECT_TRUE(picture.preview);
    EXPECT_EQ(picture.lightStride, GetParam());
    EXPECT_GT(picture.rebuilding, 0);
    EXPECT_EQ(picture.stats.error.pixels, 0u); // no error bar comes from a preview
  }
  Picture copied;
  EXPECT_FALSE(live.copy(copied)); // for a file, there is no picture yet
}

// Rays are followed from one pixel of each block, and the picture is as bright as with light
// everywhere.
TEST_P(LiveSparseLight, theLightOfFewerRaysFillsThePicture) {
  const auto show = [](int stride, uint64_t& rays) {
    const auto browser = browserOf();
    LiveRenderer live(*browser, settingsOf());
    LivePicture picture;
    for (int i = 0; i < 32; ++i) picture = finish(live, sparseOf(stride));
    rays = picture.stats.rays.shadow + picture.stats.rays.secondary;
    return meanOf(picture);
  };
  uint64_t all = 0, few = 0;
  const double dense = show(1, all), sparse = show(GetParam(), few);
  EXPECT_GT(few, 0u);
  EXPECT_LT(double(few), 1.5 * double(all) / (GetParam() * GetParam()));
  EXPECT_NEAR(sparse, dense, .03 * dense);
}

// The bytes of a still picture do not depend on the sparse frames before it.
TEST_P(LiveSparseLight, theStillPictureAfterwardsHasTheBytesOfTheHeadlessOne) {
  const uint32_t channels = RT_RGBA | RT_DEPTH | RT_NORMAL | RT_SAMPLES | RT_VARIANCE;
  const auto browser = browserOf(), other = browserOf();
  LiveRenderer live(*browser, settingsOf(channels, 5));
  for (const int samples : {1, 24}) {
    for (int i = 0; i < 5; ++i) {
      moveTo(*browser, .2 * i);
      finish(live, seenFrom(sparseOf(GetParam(), 40 + 9 * i, 30 + 7 * i), *browser, .1 * i));
    }
    moveTo(*browser, -.4);
    moveTo(*other, -.4);
    LiveFrame frame = frameOf(Purpose::still, 66, 48, samples);
    const Picture expected = headless(*other, settingsOf(channels, 5), frame);
    frame.lightStride = GetParam(); // means nothing in a still one
    const LivePicture picture = finish(live, frame);
    EXPECT_FALSE(picture.preview);
    EXPECT_EQ(picture.rgb, displayBytes(expected));
    Picture copied;
    ASSERT_TRUE(live.copy(copied));
    EXPECT_EQ(copied.planes, expected.planes);
  }
}

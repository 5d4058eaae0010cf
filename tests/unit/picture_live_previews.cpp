// picture_live_previews.cpp: Tests previews of LiveRenderer. They are rebuilt frame by frame, each
// viewer's for itself, and follow what moves. Nothing of them enters a still picture, which has the
// bytes of the headless one whatever was shown before.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "libpicture/cluster.h"
#include "libpicture/live/display.h"
#include "libpicture/live/previews.h"
#include "unit/live_previews.h"

using namespace picture;
using namespace live_previews;

namespace {

RenderSettings clustered() {
  RenderSettings settings = settingsOf();
  ClusterSettings cluster;
  cluster.workers = "127.0.0.1:1"; // nobody answers there: this process renders alone
  settings.cluster = std::make_shared<Cluster>(cluster, settings);
  return settings;
}

// The mean difference of two pictures of the same size in a rectangle of pixels.
double differenceIn(const LivePicture& a, const std::vector<uint8_t>& b, int left, int top,
                    int right, int bottom) {
  double sum = 0;
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) {
      const size_t byte = 3 * (size_t(y) * size_t(a.width) + size_t(x));
      sum += std::abs(int(a.rgb.at(byte)) - int(b.at(byte)));
    }
  return sum / ((right - left) * (bottom - top));
}

// The mean difference of the bytes of two pictures.
double difference(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += std::abs(int(a[i]) - int(b.at(i)));
  return sum / double(a.size());
}

} // namespace

TEST(LivePreview, saysWhatItIs) {
  const auto browser = browserOf();
  LiveRenderer live(*browser, settingsOf());
  for (int i = 0; i < 3; ++i) {
    const LivePicture preview = finish(live, previewOf());
    EXPECT_TRUE(preview.preview);
    EXPECT_EQ(preview.samples, 1);
    EXPECT_GT(preview.rebuilding, 0);
    EXPECT_LE(preview.overhead + preview.rebuilding, preview.seconds * (1 + 1e-9));
    EXPECT_EQ(preview.stats.error.pixels, 0u); // no error bar comes from a preview
  }
  const LivePicture still = finish(live, frameOf(Purpose::still, 64, 48, 4));
  EXPECT_FALSE(still.preview);
  EXPECT_EQ(still.rebuilding, 0);
}

// The bytes of a still picture do not depend on what was shown before.
TEST(LivePreview, aStillPictureAfterPreviewsHasTheBytesOfTheHeadlessOne) {
  const uint32_t channels = RT_RGBA | RT_DEPTH | RT_NAME | RT_NORMAL | RT_VARIANCE;
  const auto browser = browserOf(), other = browserOf();
  LiveRenderer live(*browser, settingsOf(channels, 5));
  for (int i = 0; i < 6; ++i) {
    moveTo(*browser, .2 * i);
    const LiveFrame frame = frameOf(i % 3 == 2 ? Purpose::rawPreview : Purpose::preview, 40 + 9 * i,
                                    30 + 7 * i, 1 + i % 2);
    finish(live, seenFrom(frame, *browser, .1 * i));
  }
  for (const int samples : {1, 24}) {
    const LiveFrame frame = frameOf(Purpose::still, 64, 48, samples);
    moveTo(*browser, -.4);
    moveTo(*other, -.4);
    const Picture expected = headless(*other, settingsOf(channels, 5), frame);
    const LivePicture picture = finish(live, frame);
    EXPECT_EQ(picture.rgb, displayBytes(expected));
    Picture copied;
    ASSERT_TRUE(live.copy(copied));
    EXPECT_EQ(copied.planes, expected.planes);
    EXPECT_EQ(copied.names, expected.names);
    finish(live, previewOf());
  }
}

TEST(LivePreview, aCopyIsNeverAPreview) {
  const auto browser = browserOf();
  LiveRenderer live(*browser, settingsOf());
  Picture copied;
  finish(live, previewOf());
  finish(live, frameOf(Purpose::rawPreview));
  EXPECT_FALSE(live.copy(copied));
  const uint64_t number = live.start(frameOf(Purpose::still, 64, 48, 4));
  waitFor(live);
  uint64_t of = 0;
  ASSERT_TRUE(live.copy(copied, &of));
  EXPECT_EQ(of, number);
  const Picture still = copied;
  for (int i = 0; i < 3; ++i) {
    moveTo(*browser, .3 * i);
    finish(live, previewOf(0, 32, 24));
    finish(live, frameOf(Purpose::rawPreview, 32, 24));
    ASSERT_TRUE(live.copy(copied, &of));
    EXPECT_EQ(of, number);
    EXPECT_EQ(copied.planes, still.planes);
  }
  // While a preview is in flight, too.
  live.start(frameOf(Purpose::preview, 512, 384, 4096));
  while (live.state() == State::mapping) nap();
  ASSERT_TRUE(live.copy(copied, &of));
  EXPECT_EQ(of, number);
  live.cancel();
  waitFor(live);
}

// Raw samples are those of a picture with the seed of their frame; they differ from frame to frame.
TEST(LivePreview, rawSamplesAreShownAsTheyAre) {
  const auto browser = browserOf(), other = browserOf();
  LiveRenderer live(*browser, settingsOf(RT_RGBA, 7));
  const LiveFrame frame = frameOf(Purpose::rawPreview);
  std::vector<uint8_t> before;
  for (int i = 0; i < 3; ++i) {
    const LivePicture picture = finish(live, frame);
    EXPECT_FALSE(picture.preview);
    EXPECT_EQ(picture.rebuilding, 0);
    RenderSettings settings = settingsOf(RT_RGBA, 7 + int(picture.number));
    settings.quality.set(RT_JITTER, 1);
    EXPECT_EQ(picture.rgb, displayBytes(headless(*other, settings, frame)));
    EXPECT_NE(picture.rgb, before);
    before = picture.rgb;
  }
}

TEST(LivePreview, accumulatesWhatStandsStill) {
  const auto browser = browserOf(), other = browserOf();
  LiveRenderer live(*browser, settingsOf());
  const std::vector<uint8_t> truth =
      displayBytes(headless(*other, settingsOf(), frameOf(Purpose::still, 64, 48, 512)));
  const auto errorOf = [&](const LivePicture& picture) { // error of the box
    return differenceIn(picture, truth, 30, 18, 34, 30);
  };
  const double first = errorOf(finish(live, previewOf()));
  LivePicture last;
  for (int i = 0; i < 24; ++i) last = finish(live, previewOf());
  EXPECT_LT(errorOf(last), 0.7 * first);
}

// A box that moves by more than its own width from frame to frame takes its accumulated light
// along. Without RT_MOTION it would be as noisy as in its first frame.
TEST(LivePreview, followsAnObjectThatMoves) {
  constexpr int frames = 9, width = 128, height = 96;
  constexpr double from = -3, step = .75;
  const auto truth = browserOf();
  moveTo(*truth, from + step * (frames - 1));
  const std::vector<uint8_t> converged =
      displayBytes(headless(*truth, settingsOf(), frameOf(Purpose::still, width, height, 1024)));
  // Both pictures have the same samples in the end: the frame has the same number, thus seed.
  const auto errorAtTheEnd = [&](int seed, bool watched) {
    const auto browser = browserOf();
    LiveRenderer live(*browser, settingsOf(RT_RGBA, seed));
    LivePicture picture;
    for (int i = 0; i < frames; ++i) {
      moveTo(*browser, from + step * i);
      // If it was not watched, the last frame is the first one of its viewer.
      picture = finish(live, previewOf(watched || i == frames - 1 ? 1 : 2, width, height));
    }
    return differenceIn(picture, converged, 109, 36, 115, 60); // inside of the box
  };
  double followed = 0, fresh = 0;
  for (const int seed : {0, 1000, 2000, 3000}) {
    followed += errorAtTheEnd(seed, true);
    fresh += errorAtTheEnd(seed, false);
  }
  EXPECT_LT(followed, 0.9 * fresh);
}

// Two viewers of a world at rest: what one sees does not depend on the other.
TEST(LivePreview, viewersAccumulateForThemselves) {
  const auto see = [](bool two) {
    const auto browser = browserOf();
    LiveRenderer live(*browser, settingsOf());
    std::vector<std::vector<uint8_t>> pictures;
    for (int i = 0; i < 6; ++i) {
      pictures.push_back(finish(live, seenFrom(previewOf(1), *browser, .05 * i)).rgb);
      // Frames between take a number, and with it a seed.
      const LiveFrame between = two ? previewOf(2, 80, 60) : frameOf(Purpose::rawPreview);
      finish(live, seenFrom(between, *browser, 1 - .1 * i));
    }
    return pictures;
  };
  EXPECT_EQ(see(true), see(false));
}

// Two viewers of a moving world take turns at different instants, or each at every instant. The
// picture of one does not depend on the other: it has what it would have accumulated alone.
TEST(LivePreview, viewersOfAMovingWorldAccumulateForThemselves) {
  const auto see = [](bool two, double later) {
    const auto browser = browserOf();
    LiveRenderer live(*browser, settingsOf());
    std::vector<std::vector<uint8_t>> pictures;
    for (int i = 0; i < 6; ++i) {
      moveTo(*browser, .4 * i - 1);
      pictures.push_back(finish(live, previewOf(1)).rgb);
      moveTo(*browser, .4 * i - 1 + later);
      // Frames between take a number, and with it a seed.
      finish(live, two ? previewOf(2, 80, 60) : frameOf(Purpose::rawPreview));
    }
    return pictures;
  };
  EXPECT_EQ(see(true, .2), see(false, .2));
  EXPECT_EQ(see(true, 0), see(false, 0));
}

// The motion of a frame is that since the viewer's still frame. Its last preview is older, so
// nothing of it may be used.
TEST(LivePreview, aViewerBeginsAnewIfTheWorldMovedForAStillPicture) {
  const auto see = [](uint32_t last) {
    const auto browser = browserOf();
    LiveRenderer live(*browser, settingsOf());
    for (int i = 0; i < 4; ++i) finish(live, previewOf(1));
    moveTo(*browser, 1);
    LiveFrame still = frameOf(Purpose::still);
    still.viewer = 1;
    finish(live, still);
    moveTo(*browser, 2);
    return finish(live, previewOf(last)).rgb;
  };
  EXPECT_EQ(see(1), see(3));
}

TEST(LivePreview, anotherWorldBeginsAnew) {
  const auto see = [](uint32_t first) {
    const auto browser = browserOf();
    LiveRenderer live(*browser, settingsOf());
    for (int i = 0; i < 4; ++i) finish(live, previewOf(first));
    browser->replaceWorld({});
    return finish(live, previewOf(1)).rgb;
  };
  EXPECT_EQ(see(1), see(2));
}

TEST(LivePreview, sizesMayChange) {
  const auto browser = browserOf();
  LiveRenderer live(*browser, settingsOf());
  for (const auto& [width, height] :
       {std::pair{64, 48}, {128, 96}, {32, 24}, {1, 1}, {100, 10}, {64, 48}})
    EXPECT_TRUE(finish(live, previewOf(0, width, height)).preview) << width;
}

// A preview that is cancelled is not shown, and what was accumulated goes on.
TEST(LivePreview, aCancelledOneIsDropped) {
  const auto browser = browserOf(), other = browserOf();
  LiveRenderer live(*browser, settingsOf());
  finish(live, previewOf());
  for (const Purpose purpose : {Purpose::preview, Purpose::rawPreview}) {
    live.start(frameOf(purpose, 512, 384, 65536));
    while (live.state() == State::mapping) nap();
    live.cancel();
    waitFor(live);
    LivePicture picture;
    while (live.look(picture)) EXPECT_FALSE(picture.ended) << "a cancelled preview ends unseen";
    EXPECT_EQ(live.takeFailure(), "");
  }
  for (int i = 0; i < 20; ++i) {
    live.start(previewOf());
    std::this_thread::sleep_for(std::chrono::microseconds(100 * i));
    live.cancel();
    waitFor(live);
    LivePicture picture;
    while (live.look(picture)) EXPECT_TRUE(picture.finished);
  }
  EXPECT_TRUE(finish(live, previewOf()).preview);
  const LiveFrame still = frameOf(Purpose::still, 64, 48, 4);
  EXPECT_EQ(finish(live, still).rgb, displayBytes(headless(*other, settingsOf(), still)));
}

TEST(LivePreview, aFailureIsToldOnceAndOver) {
  const auto browser = browserOf();
  LiveRenderer live(*browser, settingsOf());
  finish(live, previewOf());
  live.start(previewOf(0, 70000, 48)); // wider than any picture may be
  waitFor(live);
  LivePicture picture;
  EXPECT_FALSE(live.look(picture));
  EXPECT_NE(live.takeFailure(), "");
  EXPECT_EQ(live.takeFailure(), "");
  EXPECT_TRUE(finish(live, previewOf()).preview);
}

// Frames that overlap are rebuilt in their order.
TEST(LivePreview, overlapsOnACluster) {
  constexpr int frames = 10;
  const auto browser = browserOf(), other = browserOf();
  LiveRenderer live(*browser, clustered());
  LivePicture picture;
  uint64_t seen = 0;
  int started = 0, overlapping = 0;
  const auto look = [&] {
    while (live.look(picture)) {
      EXPECT_TRUE(picture.preview && picture.finished);
      EXPECT_EQ(picture.number, ++seen);
      EXPECT_EQ(picture.width, 64 + int(picture.number));
    }
  };
  while (started < frames) {
    look();
    const State state = live.state();
    if (state != State::idle && state != State::ready) {
      nap();
      continue;
    }
    overlapping += state == State::ready;
    moveTo(*browser, .1 * ++started);
    EXPECT_EQ(live.start(previewOf(0, 64 + started, 48)), uint64_t(started));
  }
  waitFor(live);
  look();
  EXPECT_EQ(seen, uint64_t(frames));
  EXPECT_GT(overlapping, 0);
  EXPECT_EQ(live.takeFailure(), "");
  const LiveFrame still = frameOf(Purpose::still, 64, 48, 8);
  moveTo(*other, .1 * frames);
  EXPECT_EQ(finish(live, still).rgb, displayBytes(headless(*other, settingsOf(), still)));
}

TEST(LivePreview, fewViewersAreRemembered) {
  live::Previews previews(1);
  Picture frame;
  frame.width = frame.height = 8;
  for (const Channel& channel : channelTable())
    if ((live::previewChannels | RT_RGBA | RT_SAMPLES) & channel.bit)
      frame.planes[channel.bit].assign(size_t(64 * channel.components), 1);
  live::FrameCamera camera;
  for (int k = 0; k < 16; ++k) camera.settings.matrix[k] = k % 5 == 0;
  for (uint32_t viewer = 0; viewer < 2 * live::mostRecentViewers; ++viewer) {
    previews.rebuild(viewer, frame, camera, 1, {});
    EXPECT_LE(previews.viewers(), live::mostRecentViewers);
  }
  const size_t before = previews.viewers();
  previews.forget(2 * live::mostRecentViewers - 1);
  EXPECT_EQ(previews.viewers(), before - 1);
  // A picture that cannot be rebuilt is forgotten, too.
  frame.planes.erase(RT_MOTION);
  EXPECT_THROW(previews.rebuild(2 * live::mostRecentViewers - 2, frame, camera, 1, {}),
               std::invalid_argument);
  EXPECT_EQ(previews.viewers(), before - 2);
}

TEST(LivePreview, stepsOfTheWorldAreNumbered) {
  live::WorldSteps steps;
  EXPECT_EQ(steps.begin(0).before, 0u); // there is no frame before
  const live::WorldStep rest = steps.begin(0);
  EXPECT_EQ(rest.before, rest.now);
  steps.change();
  steps.change(); // a frame that was cancelled before it began
  const live::WorldStep other = steps.begin(7);
  EXPECT_EQ(other.before, 0u); // another viewer's frames do not count
  const live::WorldStep moved = steps.begin(0);
  EXPECT_EQ(moved.before, rest.now);
  EXPECT_NE(moved.now, rest.now);
  EXPECT_EQ(moved.now, other.now);
  steps.beginAnew();
  const live::WorldStep anew = steps.begin(0);
  EXPECT_EQ(anew.before, 0u);
  EXPECT_GT(anew.now, moved.now);
}

// Once nothing moves, the still picture fades in over the preview.
TEST(LiveCompletion, theStillPictureFadesInOverThePreview) {
  const auto browser = browserOf(), other = browserOf();
  LiveRenderer live(*browser, settingsOf());
  LivePicture preview;
  for (int i = 0; i < 8; ++i) preview = finish(live, previewOf(0, 512, 384));
  constexpr int many = 65536;
  live.start(frameOf(Purpose::still, 512, 384, many));
  LivePicture picture;
  double weight = 0;
  while (weight < 1) {
    if (!live.look(picture)) {
      nap();
      continue;
    }
    ASSERT_FALSE(picture.finished);
    weight = live::stillWeight(picture.samples, many, picture.seconds);
    if (picture.covered < 1) continue;
    // Noise keeps some of it for longer.
    EXPECT_TRUE(picture.preview || weight == 1) << picture.samples << ", " << picture.seconds;
    if (weight < .05) { EXPECT_LT(difference(picture.rgb, preview.rgb), 8); }
  }
  live.cancel();
  waitFor(live);
  // A finished one is shown as it is.
  while (live.look(picture)) {}
  finish(live, previewOf(0, 512, 384));
  const LiveFrame still = frameOf(Purpose::still, 512, 384, 4);
  const LivePicture end = finish(live, still);
  EXPECT_FALSE(end.preview);
  EXPECT_EQ(end.rgb, displayBytes(headless(*other, settingsOf(), still)));
}

// The first picture of a world is a small preview without noise, not a part of a large one.
TEST(LiveCompletion, aPreviewInFlightIsNotShown) {
  const auto browser = browserOf();
  LiveRenderer live(*browser, settingsOf());
  live.start(frameOf(Purpose::preview, 512, 384, 4096));
  while (live.state() == State::mapping) nap();
  LivePicture picture;
  for (int i = 0; i < 50; ++i, nap()) EXPECT_FALSE(live.look(picture));
  live.cancel();
  waitFor(live);
}

// window_pacing.cpp: Tests frame pacing. The frame rate holds during motion, picture sizes do not
// flicker, and a still view is rendered at full quality.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "libpicture/live/pacing.h"

using namespace picture;

namespace {

// A machine with a fixed rendering speed.
struct Machine {
  double pixel, overhead = 0;
  double unsteady = 0; // relative variation of the time per frame
  double rebuilt = 0;  // seconds to rebuild a pixel of a preview
  double unlit = 0;    // seconds of a pixel without its light
  int count = 0;
  double rebuilding(const FrameSize& f) const { return rebuilt * f.width * f.height; }
  double seconds(const FrameSize& f) {
    const double wave = 1 + unsteady * ((count++ * 7919 % 13) / 6.0 - 1);
    const double light = pixel / (f.lightStride * f.lightStride);
    return overhead + (unlit + light) * f.width * f.height * f.samples * wave + rebuilding(f);
  }
};

// While light is sampled, pictures of a quarter of the window and smaller ones may take half as
// long again.
constexpr double slower = 1.5;

constexpr int width = 800, height = 600;
constexpr double full = double(width) * height;

// Renders frames during motion; returns the seconds of each.
std::vector<double> move(Pacing& pacing, Machine& machine, int frames,
                         std::vector<FrameSize>* sizes = nullptr,
                         Pacing::Light light = Pacing::Light::sampled) {
  std::vector<double> out;
  for (int i = 0; i < frames; ++i) {
    const FrameSize f = pacing.next(width, height, true, 64, light);
    const double seconds = machine.seconds(f);
    pacing.took(f, seconds, seconds, machine.overhead, f.samples, machine.rebuilding(f));
    out.push_back(seconds);
    if (sizes) sizes->push_back(f);
  }
  return out;
}

// Machines behind a network link. They render one frame after the other, and the link adds a
// latency. The next frame is started with the window's next step; at most `most` are in flight.
struct Link {
  double pixel, latency;
  size_t most = 2;
  double unsteady = 0;
  struct Run {
    std::vector<FrameSize> sizes;
    std::vector<double> ends;
    double rate() const { // frames per second in the second half of the run
      const size_t half = ends.size() / 2;
      return double(ends.size() - 1 - half) / (ends.back() - ends[half]);
    }
    int changes() const {
      int n = 0;
      for (size_t i = sizes.size() / 2; i < sizes.size(); ++i) n += !(sizes[i] == sizes[i - 1]);
      return n;
    }
  };
  Run move(Pacing& pacing, double fps, size_t frames) const {
    Run run;
    std::vector<double> starts;
    double next = 0, free = 0;
    size_t told = 0;
    for (size_t i = 0; i < frames; ++i) {
      const double start = i < most ? next : std::max(next, run.ends[i - most]);
      for (; told < i && run.ends[told] <= start; ++told) {
        const double from = told == 0 ? starts[0] : std::max(starts[told], run.ends[told - 1]);
        const double to =
            told + 1 < i ? std::min(starts[told + 1], run.ends[told]) : run.ends[told];
        pacing.took(run.sizes[told], run.ends[told] - starts[told], to - from, 0,
                    run.sizes[told].samples);
      }
      const FrameSize f = pacing.next(width, height, true, 64);
      const double wave = 1 + unsteady * (double(i * 7919 % 13) / 6 - 1);
      free = std::max(free, start + latency / 2) + pixel * f.width * f.height * f.samples * wave;
      starts.push_back(start);
      run.sizes.push_back(f);
      run.ends.push_back(free + latency / 2);
      next = std::max(next + 1 / fps, start);
    }
    return run;
  }
};

} // namespace

TEST(Pacing, whatStandsStillIsRenderedWhole) {
  Pacing pacing(30);
  EXPECT_EQ(pacing.next(width, height, false, 64), (FrameSize{width, height, 64}));
  Machine slow{1 / full};
  move(pacing, slow, 20);
  EXPECT_EQ(pacing.next(width, height, false, 64), (FrameSize{width, height, 64}));
  EXPECT_EQ(pacing.next(0, -1, false, 0), (FrameSize{1, 1, 1}));
}

TEST(Pacing, theFrameRateHolds) {
  for (const double fps : {10.0, 30.0, 60.0})
    for (const double wholePicture : {0.0001, 0.01, 0.05, 0.1, 0.3, 1.0}) {
      Pacing pacing(fps);
      Machine machine{wholePicture / full, 0.001};
      std::vector<FrameSize> sizes;
      const std::vector<double> seconds = move(pacing, machine, 60, &sizes);
      const FrameSize last = sizes.back();
      const bool least = last.width == 100 && last.height == 75;
      const double allowed = (last.width <= width / 4 ? slower : 1) / fps;
      EXPECT_TRUE(seconds.back() <= allowed || least) << fps << ", " << wholePicture;
      const bool most = last.samples == 16;
      EXPECT_TRUE(seconds.back() >= 0.3 / fps || most)
          << fps << ", " << wholePicture; // the available time is used
    }
}

// Rebuilding a picture is part of a frame's time, and more samples do not make it longer.
TEST(Pacing, theTimeOfRebuildingCounts) {
  Pacing pacing(30), other(30);
  Machine machine{0.01 / full}, rebuilding{0.01 / full, 0, 0, 0.04 / full};
  std::vector<FrameSize> sizes, smaller;
  move(pacing, machine, 60, &sizes);
  EXPECT_LE(move(other, rebuilding, 60, &smaller).back(), 1 / 30.0);
  EXPECT_EQ(sizes.back().width, width);
  EXPECT_LT(smaller.back().width, width);
  EXPECT_GT(smaller.back().width, width / 2);
  const FrameSize one{width, height, 1}, four{width, height, 4};
  EXPECT_NEAR(other.predicted(one), 0.05, 1e-3);
  EXPECT_NEAR(other.predicted(four), 0.08, 1e-3);
  // A rebuilding that takes longer than the frame is not believed.
  const double before = other.predicted(one);
  other.took(one, 0.1, 0.1, 0.05, 1, 0.06);
  other.took(one, 0.1, 0.1, 0, 1, std::nan(""));
  EXPECT_EQ(other.predicted(one), before);
}

// The shown picture has the pixels of the window, and fewer where these would take more than half
// of a frame's time. Frames have what is left of it.
TEST(Pacing, theSizeOfWhatIsShownHasATimeOfItsOwn) {
  // seconds of a picture as large as the window
  for (const double whole : {0.002, 0.01, 0.04, 0.3}) {
    Pacing pacing(30);
    double showing = 0, frame = 0;
    FrameSize shown, before;
    for (int k = 0; k < 60; k++) {
      const FrameSize size = pacing.next(width, height, true, 64);
      before = shown;
      shown = pacing.shown(width, height);
      EXPECT_NEAR(double(shown.width) / shown.height, 4.0 / 3, 0.01);
      showing = whole * shown.width * shown.height / full;
      frame = showing + 0.1 * size.width * size.height * size.samples / full;
      pacing.took(size, frame, frame, 0, size.samples, showing, showing);
    }
    EXPECT_EQ(shown, before) << "it does not swing";
    EXPECT_LT(showing, 0.5 / 30 * 1.15) << whole;
    EXPECT_LT(frame, 1.6 / 30) << whole;
    EXPECT_EQ(shown.width == width, whole < 0.015) << whole;
  }
}

// The frame rate falls before pictures shrink below a quarter, but not far.
TEST(Pacing, aQuarterIsKeptAtALowerRate) {
  Pacing pacing(30);
  Machine machine{0.6 / full}; // 37.5 ms for a quarter in each direction
  std::vector<FrameSize> sizes;
  const std::vector<double> seconds = move(pacing, machine, 60, &sizes);
  EXPECT_EQ(sizes.back().width, width / 4);
  EXPECT_GT(seconds.back(), 1 / 30.0);
  EXPECT_LT(seconds.back(), 1 / 20.0);
  machine.pixel *= 1.5;
  sizes.clear();
  EXPECT_LT(move(pacing, machine, 60, &sizes).back(), 1 / 20.0);
  EXPECT_LT(sizes.back().width, width / 4);
}

// Without sampled light a picture keeps its full size as long as the rate does not fall far.
TEST(Pacing, directLightKeepsTheFullSize) {
  for (const auto& [wholePicture, keeps] : {std::pair{0.038, true}, {0.06, false}}) {
    Pacing direct(30), sampled(30);
    Machine machine{wholePicture / full};
    std::vector<FrameSize> sizes, others;
    const double seconds = move(direct, machine, 60, &sizes, Pacing::Light::direct).back();
    move(sampled, machine, 60, &others);
    EXPECT_EQ(sizes.back().width == width, keeps);
    EXPECT_LT(others.back().width, width);
    EXPECT_LT(seconds, 1 / 20.0);
  }
}

// Where pictures are rebuilt, light becomes sparse before they shrink, and shrinking pictures keep
// it sparse: they need their size more.
TEST(Pacing, rebuiltPicturesLoseLightBeforeSize) {
  for (const auto& [light, widest, unlit] :
       {std::tuple{Pacing::Light::sparseDirect, 2, 0.5}, {Pacing::Light::sparse, 2, 0.15}}) {
    int last = 0;
    bool between = false;
    for (double wholePicture = 0.005; wholePicture < 0.5; wholePicture *= 1.2) {
      SCOPED_TRACE(wholePicture);
      Pacing pacing(30), raw(30);
      Machine machine{wholePicture / full};
      machine.unlit = unlit * machine.pixel;
      std::vector<FrameSize> sizes, others;
      const double seconds = move(pacing, machine, 60, &sizes, light).back();
      move(raw, machine, 60, &others, rawOf(light));
      const FrameSize f = sizes.back();
      EXPECT_LT(seconds, 1 / 20.0);
      EXPECT_GE(f.lightStride, last);
      EXPECT_LE(f.lightStride, widest);
      EXPECT_TRUE(f.width == width || f.lightStride == widest);
      EXPECT_EQ(others.back().lightStride, 1);
      EXPECT_GE(f.width, others.back().width);
      between |= f.width == width && f.lightStride == widest;
      last = f.lightStride;
    }
    EXPECT_TRUE(between);
    EXPECT_EQ(last, widest);
  }
}

TEST(Pacing, theTransportTellsTheLight) {
  RTstats stats{};
  stats.rays.camera = 1;
  for (const RTenum transport : {RT_TRANSPORT_DIRECT, RT_TRANSPORT_WHITTED}) {
    stats.transport.chosen = transport;
    EXPECT_EQ(lightOf(stats, true), Pacing::Light::sparseDirect);
    EXPECT_EQ(lightOf(stats, false), Pacing::Light::direct);
  }
  stats.transport.chosen = RT_TRANSPORT_PATH;
  EXPECT_EQ(lightOf(stats, true), Pacing::Light::sparse);
  EXPECT_EQ(lightOf(stats, false), Pacing::Light::sampled);
  for (const bool rebuilt : {true, false})
    EXPECT_EQ(rawOf(lightOf(stats, rebuilt)), Pacing::Light::sampled);
}

// Between motion and rest a picture is larger than those of the motion, but never a long wait.
TEST(Pacing, aPictureThatSettlesIsLarger) {
  for (double wholePicture = 0.002; wholePicture < 2; wholePicture *= 1.3) {
    Pacing pacing(30);
    Machine machine{wholePicture / full, 0.002};
    std::vector<FrameSize> sizes;
    move(pacing, machine, 60, &sizes);
    const FrameSize settling = pacing.settle(width, height, 64);
    const auto work = [](const FrameSize& f) { return f.width * f.height * f.samples; };
    EXPECT_GE(work(settling), work(sizes.back())) << wholePicture;
    EXPECT_LE(machine.seconds(settling), 0.1) << wholePicture;
    EXPECT_GE(settling.width, sizes.back().width) << wholePicture;
  }
  Pacing unknown(30); // its first frame has not ended
  const FrameSize first = unknown.next(width, height, true, 64);
  EXPECT_EQ(unknown.settle(width, height, 64), first);
  const Pacing fresh(30);
  EXPECT_LE(fresh.settle(width, height, 2).samples, 2);
  EXPECT_EQ(fresh.settle(0, -1, 0), (FrameSize{1, 1, 1}));
}

TEST(Pacing, sizesAreBounded) {
  Machine hopeless{1};
  for (const auto& [w, h] :
       {std::pair{800, 600}, {3840, 2160}, {100, 90}, {64, 64}, {10, 7}, {2000, 20}}) {
    Pacing pacing(30);
    FrameSize f;
    for (int i = 0; i < 30; ++i) {
      f = pacing.next(w, h, true, 16);
      const double seconds = hopeless.seconds(f);
      pacing.took(f, seconds, seconds, 0, 1);
    }
    for (const auto& [side, whole] : {std::pair{f.width, w}, {f.height, h}}) {
      EXPECT_LE(side, whole);
      EXPECT_GE(side, (whole + 7) / 8);
      EXPECT_GE(side, std::min(whole, 64));
    }
    EXPECT_TRUE(f.width <= (w + 7) / 8 ||
                std::min(f.width, f.height) <= 64); // no larger than necessary
    // With the same aspect ratio.
    EXPECT_NEAR(double(f.width) / f.height, double(w) / h, .02 * w / h);
    EXPECT_EQ(f.samples, 1);
  }
}

TEST(Pacing, cheapScenesGetMoreSamplesAtFullSize) {
  Pacing pacing(30);
  Machine quick{0.002 / full};
  std::vector<FrameSize> sizes;
  move(pacing, quick, 60, &sizes);
  EXPECT_EQ(sizes.back().width, width);
  EXPECT_GE(sizes.back().samples, 8);
  for (int i = 0; i < 10; ++i)
    // No more samples than for a still picture.
    EXPECT_LE(pacing.next(width, height, true, 2).samples, 2);
}

TEST(Pacing, sizesDoNotFlicker) {
  for (double wholePicture = 0.002; wholePicture < 0.5; wholePicture *= 1.13) {
    Pacing pacing(30);
    Machine machine{wholePicture / full, 0.002, 0.12};
    std::vector<FrameSize> sizes;
    move(pacing, machine, 200, &sizes);
    int changes = 0;
    for (size_t i = 100; i < sizes.size(); ++i) changes += !(sizes[i] == sizes[i - 1]);
    EXPECT_LE(changes, 1) << wholePicture;
  }
}

TEST(Pacing, aSceneThatBecomesSlowIsFollowedAtOnceAndBackByAndBy) {
  Pacing pacing(30);
  Machine machine{0.02 / full};
  std::vector<FrameSize> sizes;
  move(pacing, machine, 30);
  machine.pixel *= 20;
  EXPECT_LE(move(pacing, machine, 4).back(), 1 / 30.0);
  machine.pixel /= 20;
  move(pacing, machine, 100, &sizes);
  EXPECT_EQ(sizes.back().width, width);
  for (size_t i = 1; i < sizes.size(); ++i)
    EXPECT_LE(sizes[i].width, 1.3 * sizes[i - 1].width) << "a leap";
}

TEST(Pacing, whatWasLearntWhileStillCountsWhenItMoves) {
  Pacing pacing(30);
  // Cancelled after three samples of a second each.
  pacing.took({width, height, 64}, 3.0, 3.0, 0, 3);
  const FrameSize first = pacing.next(width, height, true, 64);
  EXPECT_LE(first.width * first.height / full, 1 / 25.0);
}

TEST(Pacing, readingTheWorldIsNotHelpedByFewerPixels) {
  Pacing pacing(30);
  Machine machine{0.01 / full, 0.2};
  std::vector<FrameSize> sizes;
  move(pacing, machine, 40, &sizes);
  EXPECT_EQ(sizes.back().width, width); // 0.2 s or 0.21 s
}

// Nothing is known of a world before its first picture. A world of ten times the cost of a heavy
// one must not hold the user up, and a quick one must soon fill the window.
TEST(Pacing, theFirstPictureIsSmallAndTheNextOnesGrow) {
  for (const auto light : {Pacing::Light::sampled, Pacing::Light::sparse, Pacing::Light::direct,
                           Pacing::Light::sparseDirect})
    for (const double wholePicture : {0.004, 0.02, 0.2, 1.0, 5.0}) {
      SCOPED_TRACE(wholePicture);
      Pacing pacing(30);
      Machine machine{wholePicture / full, 0.001};
      std::vector<FrameSize> sizes;
      const std::vector<double> seconds = move(pacing, machine, 12, &sizes, light);
      EXPECT_LE(sizes[0].width, width / 8);
      EXPECT_EQ(sizes[0].samples, 1);
      for (const double one : seconds) EXPECT_LE(one, 0.1);
      for (size_t i = 1; i < sizes.size(); ++i) EXPECT_GE(sizes[i].width, sizes[i - 1].width);
      EXPECT_TRUE(sizes[2].width == width || wholePicture > 0.02);
    }
}

// A small picture has costs that do not grow with its size, so that a pixel of it seems to be dear.
TEST(Pacing, theFirstPicturesGrowAsTheirPixelsBecomeCheaper) {
  Pacing pacing(30);
  std::vector<FrameSize> sizes;
  for (int i = 0; i < 8; ++i) {
    const FrameSize f = pacing.next(width, height, true, 64);
    const double seconds = .006 + .015 * f.width * f.height / full;
    pacing.took(f, seconds, seconds, 0, f.samples);
    sizes.push_back(f);
  }
  EXPECT_EQ(sizes.back().width, width);
}

// A world is built once, in seconds. Its pictures need not wait as long for that again.
TEST(Pacing, whatIsBuiltOnceDoesNotSlowLaterPictures) {
  for (const auto light : {Pacing::Light::sampled, Pacing::Light::sparse, Pacing::Light::direct}) {
    Pacing pacing(30);
    Machine machine{2 / full, 5};
    move(pacing, machine, 1, nullptr, light);
    machine.overhead = 0.002;
    EXPECT_LE(machine.seconds(pacing.settle(width, height, 64)), 0.1);
    for (const double seconds : move(pacing, machine, 20, nullptr, light)) EXPECT_LE(seconds, 0.06);
  }
}

TEST(Pacing, oddTimesAreNoReason) {
  Pacing pacing(30);
  const FrameSize before = pacing.next(width, height, true, 16);
  pacing.took(before, -1, -1, 0, 1);
  pacing.took(before, std::nan(""), 1, 0, 1);
  pacing.took(before, 1, std::nan(""), 0, 1);
  pacing.took(before, 1, 1, 2, 1);
  pacing.took(before, 0.001, 0.001, 0, 0);
  EXPECT_EQ(pacing.next(width, height, true, 16), before);
  EXPECT_EQ(pacing.predicted(before), 0);
}

TEST(Pacing, framesThatOverlapKeepTheRateAndTheirSize) {
  constexpr double fps = 30;
  for (const double latency : {0.0, .001, .004, .01, .02, .03, .04, .06})
    for (double wholePicture = 0.002; wholePicture < 0.5; wholePicture *= 1.13) {
      Pacing pacing(fps);
      // A refined picture was shown before.
      pacing.took({width, height, 64}, 64 * wholePicture, 64 * wholePicture, 0, 64);
      const Link link{wholePicture / full, latency, 2, 0.05};
      const Link::Run run = link.move(pacing, fps, 200);
      EXPECT_LE(run.changes(), 1) << wholePicture << ", " << latency;
      const double wanted = run.sizes.back().width <= width / 4 ? fps / slower : fps;
      EXPECT_GE(run.rate(), .97 * std::min(wanted, 2 / (latency + 1e-9)))
          << wholePicture << ", " << latency;
    }
}

// With one frame at a time the window waits for the link: pictures are as small as possible and
// late.
TEST(Pacing, aSlowLinkDoesNotMakePicturesSmallWhereFramesOverlap) {
  constexpr double fps = 30, latency = .04, wholePicture = .02;
  const auto run = [&](size_t most) {
    Pacing pacing(fps);
    pacing.took({width, height, 64}, 64 * wholePicture + latency, 64 * wholePicture + latency, 0,
                64);
    return Link{wholePicture / full, latency, most}.move(pacing, fps, 200);
  };
  const Link::Run overlapping = run(2), one = run(1);
  EXPECT_EQ(overlapping.sizes.back().width, width);
  EXPECT_NEAR(overlapping.rate(), fps, .5);
  EXPECT_LT(one.sizes.back().width, width / 2);
  EXPECT_LT(one.rate(), 25);
}

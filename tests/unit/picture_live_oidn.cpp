// picture_live_oidn.cpp: Tests the filter of previews by Open Image Denoise: how the library is
// found, what it is given, which previews get it, and what happens when it fails. A fake library
// (tests/oidn) takes its place; one test uses the real one where it is installed.
#include <gtest/gtest.h>

#include <dlfcn.h>

#include <algorithm>
#include <chrono>
#include <numeric>

#include "libpicture/live/denoise_choice.h"
#include "libpicture/live/oidn.h"
#include "libpicture/live/oidn_lender.h"
#include "libpicture/live/previews.h"
#include "oidn/fake_oidn.h"
#include "unit/picture_live_frames.h"

using namespace live_frames;
using namespace picture::live;

namespace {

using Library = std::shared_ptr<const OidnLibrary>;

std::string fileOf(const std::string& name) {
  return std::string(FAKE_OIDN_FOLDER) + "/fake_oidn" + name + ".so";
}
Library usable() { return OidnLibrary::load(fileOf("")); }
Library slow() { return OidnLibrary::load(fileOf("_slow")); }
Library failing() { return OidnLibrary::load(fileOf("_failing")); }
Library broken() { throw OidnError("the library is broken"); }
Library absent() { return nullptr; }

// Returns what the fake library has counted so far. Its counts stay between tests of one process.
FakeOidnCounts countsOf(const std::string& name = "") {
  void* const handle = dlopen(fileOf(name).c_str(), RTLD_NOW | RTLD_NOLOAD);
  EXPECT_NE(handle, nullptr);
  const FakeOidnCounts counts = *static_cast<FakeOidnCounts*>(dlsym(handle, "fakeOidnCounts"));
  dlclose(handle);
  return counts;
}

std::string problemOf(const std::string& file) {
  try {
    const Library library = OidnLibrary::load(file);
    return library ? "" : "absent";
  } catch (const OidnError& error) { return error.what(); }
}

OidnImages gradient(int width, int height) {
  OidnImages images;
  images.resize(width, height);
  std::iota(images.colour.begin(), images.colour.end(), 0.0f);
  return images;
}

// A wall, lit by chance if the shot is noisy.
Hit wall(Vec origin, Vec direction) { return plane(origin, direction, 0, -9, 9); }

// Returns the standard deviation of red from its mean.
double deviationOf(const std::vector<float>& rgba) {
  double sum = 0, squares = 0;
  for (size_t i = 0; i < rgba.size(); i += 4) {
    sum += rgba[i];
    squares += double(rgba[i]) * rgba[i];
  }
  const double count = double(rgba.size()) / 4, mean = sum / count;
  return std::sqrt(squares / count - mean * mean);
}

Picture frameOf(uint32_t number, bool isNoisy) {
  Shot shot;
  shot.camera = cameraAt({0, 0, 4});
  shot.number = number;
  shot.noisy = isNoisy;
  return render(wall, shot);
}

// Waits for the trial of a lender and returns what it lends then.
OidnFilter* lentAfterTrial(OidnLender& lender, DenoiseSwitch& viewer, double pixels,
                           double allowed) {
  const auto begin = std::chrono::steady_clock::now();
  OidnFilter* filter = lender.filterFor(viewer, pixels, allowed);
  while (lender.isTrying() && std::chrono::steady_clock::now() - begin < std::chrono::minutes(1))
    filter = lender.filterFor(viewer, pixels, allowed);
  EXPECT_FALSE(lender.isTrying());
  return filter;
}

} // namespace

// --- The library ---

TEST(Oidn, ALibraryIsLoadedAndNamed) {
  const Library library = usable();
  ASSERT_TRUE(library);
  EXPECT_EQ(library->name(), "Open Image Denoise 2.4.99");
}

TEST(Oidn, ALibraryThatIsNotInstalledIsNoError) {
  EXPECT_EQ(OidnLibrary::load("libNoSuchOpenImageDenoise.so.2"), nullptr);
}

TEST(Oidn, FilesThatCannotBeUsedSayWhy) {
  EXPECT_NE(problemOf("/nowhere/libOpenImageDenoise.so").find("/nowhere"), std::string::npos);
  EXPECT_NE(problemOf("./README.md").find("README.md"), std::string::npos);
  EXPECT_NE(problemOf(fileOf("_incomplete")).find("no function oidnExecuteFilter"),
            std::string::npos);
  EXPECT_NE(problemOf(fileOf("_old")).find("1.4.3"), std::string::npos);
  EXPECT_NE(problemOf(fileOf("_without_device")).find("the fake has no device"), std::string::npos);
}

// --- The filter ---

TEST(Oidn, ImagesOfEachSizeGoThereAndBack) {
  {
    OidnFilter filter(usable(), 3, OidnQuality::balanced);
    for (const auto& [width, height] : {std::pair(7, 5), std::pair(7, 5), std::pair(40, 1)}) {
      OidnImages images = gradient(width, height);
      filter.denoise(images);
      const FakeOidnCounts counts = countsOf();
      EXPECT_EQ(counts.width, width);
      EXPECT_EQ(counts.height, height);
      for (size_t i = 0; i < images.colour.size(); i++)
        EXPECT_FLOAT_EQ(images.colour[i], float(3 * (width * height - 1)) / 2 + float(i % 3));
    }
    const FakeOidnCounts counts = countsOf();
    EXPECT_EQ(counts.threads, 3);
    EXPECT_EQ(counts.affinity, 0);
    EXPECT_EQ(counts.quality, 5);
    EXPECT_EQ(counts.buffers, 1);
    EXPECT_EQ(counts.filters, 1);
  }
  const FakeOidnCounts counts = countsOf();
  EXPECT_EQ(counts.buffers, 0);
  EXPECT_EQ(counts.filters, 0);
  EXPECT_EQ(counts.devices, 0);
}

TEST(Oidn, AFailureLeavesTheImagesAsTheyWere) {
  OidnFilter filter(failing(), 1, OidnQuality::fast);
  OidnImages images = gradient(4, 4);
  const std::vector<float> before = images.colour;
  EXPECT_THROW(filter.denoise(images), OidnError);
  EXPECT_EQ(images.colour, before);
  EXPECT_EQ(countsOf("_failing").buffers, 0);
}

// --- Reconstruction ---

TEST(Oidn, OnlyNoisyFramesAreDenoised) {
  OidnFilter filter(usable(), 1, OidnQuality::fast);
  Reconstruction with, without;
  const FrameCamera camera = cameraAt({0, 0, 4});
  for (uint32_t n = 0; n < 3; n++) {
    const Picture frame = frameOf(n, false);
    EXPECT_EQ(valuesOf(with.add(frame, camera, 1, &filter)), valuesOf(without.add(frame, camera)));
    EXPECT_FALSE(with.facts().denoised);
  }
  Reconstruction noisy;
  const Picture rebuilt = noisy.add(frameOf(3, true), camera, 1, &filter);
  EXPECT_TRUE(noisy.facts().denoised);
  EXPECT_GT(noisy.facts().denoising, 0);
  EXPECT_LE(noisy.facts().denoising, noisy.facts().seconds);
  // The fake gives every pixel the mean. Half of that counts: the noise is halved.
  Reconstruction own;
  const std::vector<float> alone = valuesOf(own.add(frameOf(3, true), camera));
  EXPECT_LT(deviationOf(valuesOf(rebuilt)), 0.6 * deviationOf(alone));
  EXPECT_GT(deviationOf(valuesOf(rebuilt)), 0.4 * deviationOf(alone));
}

TEST(Oidn, SparseLightIsDenoisedByCell) {
  OidnFilter filter(usable(), 1, OidnQuality::fast);
  Reconstruction reconstruction;
  reconstruction.add(frameOf(0, true), cameraAt({0, 0, 4}), 3, &filter);
  ASSERT_TRUE(reconstruction.facts().denoised);
  EXPECT_EQ(countsOf().width, 32);
  EXPECT_EQ(countsOf().height, 24);
}

TEST(Oidn, WhereItFailsTheOwnFilterCounts) {
  OidnFilter filter(failing(), 1, OidnQuality::fast);
  Reconstruction with, without;
  const FrameCamera camera = cameraAt({0, 0, 4});
  const Picture frame = frameOf(0, true);
  EXPECT_EQ(valuesOf(with.add(frame, camera, 1, &filter)), valuesOf(without.add(frame, camera)));
  EXPECT_FALSE(with.facts().denoised);
  EXPECT_NE(with.facts().problem.find("cannot filter"), std::string::npos);
}

// --- The choice ---

TEST(Oidn, AChoiceWithinItsLimitsStays) {
  DenoiseSwitch viewer;
  EXPECT_FALSE(viewer.next(std::numeric_limits<double>::infinity(), 0.01)); // not measured
  EXPECT_FALSE(viewer.next(0.009, 0.01));                                   // in time, but no room
  EXPECT_TRUE(viewer.next(0.006, 0.01));
  EXPECT_TRUE(viewer.next(0.009, 0.01));
  EXPECT_FALSE(viewer.next(0.011, 0.01));
  EXPECT_FALSE(viewer.next(0.001, 0.01)); // it waits
  EXPECT_FALSE(viewer.next(0.001, 0));    // nothing is allowed
}

TEST(Oidn, TheChoiceDoesNotSwing) {
  DenoiseSwitch viewer;
  constexpr int frames = 100000;
  int changes = 0;
  bool before = false;
  for (uint32_t n = 0; n < frames; n++) {
    // A machine on which the library is too slow as soon as it is used.
    const bool now = viewer.next(before ? 0.02 : 0.001, 0.01);
    changes += now != before;
    before = now;
  }
  EXPECT_GT(changes, 4);
  EXPECT_LE(changes, 2 * std::log2(double(frames) / DenoiseSwitch::firstPause) + 4);
}

TEST(Oidn, TimeFollowsTheMeasurements) {
  DenoiseTime time;
  EXPECT_EQ(time.of(100), std::numeric_limits<double>::infinity());
  time.took(100, 0.5);
  EXPECT_DOUBLE_EQ(time.of(200), 1);
  for (int k = 0; k < 50; k++) time.took(1000, 1);
  EXPECT_NEAR(time.of(1), 0.001, 1e-6);
  time.took(0, 1); // no picture
  EXPECT_NEAR(time.of(1), 0.001, 1e-6);
}

TEST(Oidn, AFastLibraryIsLentAfterATrial) {
  OidnLender lender(picture::Denoiser::automatic, 1, usable);
  DenoiseSwitch viewer;
  EXPECT_NE(lentAfterTrial(lender, viewer, 100, 1), nullptr);
  EXPECT_NE(lender.filterFor(viewer, 100, 1), nullptr);
  EXPECT_EQ(lender.filterFor(viewer, 100, 0), nullptr); // a frame without time for it
  lender.failed("it broke");
  EXPECT_EQ(lender.filterFor(viewer, 100, 1), nullptr);
  EXPECT_EQ(lender.takeProblem(), "it broke");
  EXPECT_EQ(lender.takeProblem(), "");
}

// 50 ms for 160x120 pixels are 2.6 microseconds for one.
TEST(Oidn, ASlowLibraryIsLentOnlyForSmallPictures) {
  OidnLender lender(picture::Denoiser::automatic, 1, slow);
  DenoiseSwitch viewer, other;
  EXPECT_EQ(lentAfterTrial(lender, viewer, 640 * 480, denoisingInMotion(30)), nullptr);
  for (int k = 0; k < 100; k++)
    EXPECT_EQ(lender.filterFor(viewer, 640 * 480, denoisingInMotion(30)), nullptr);
  EXPECT_NE(lender.filterFor(other, 20, denoisingInMotion(30)), nullptr);
}

TEST(Oidn, NothingIsLentWithoutAUsableLibrary) {
  DenoiseSwitch viewer;
  for (const picture::Denoiser wanted : {picture::Denoiser::automatic, picture::Denoiser::oidn}) {
    OidnLender without(wanted, 1, absent), wrong(wanted, 1, broken);
    EXPECT_EQ(lentAfterTrial(without, viewer, 1, 1), nullptr);
    EXPECT_EQ(without.takeProblem().empty(), wanted == picture::Denoiser::automatic);
    EXPECT_EQ(lentAfterTrial(wrong, viewer, 1, 1), nullptr);
    EXPECT_EQ(wrong.takeProblem(), "the library is broken");
    EXPECT_EQ(wrong.filterFor(viewer, 1, 1), nullptr);
    EXPECT_EQ(wrong.takeProblem(), ""); // told once
  }
  // The own filter does not even look for the library.
  OidnLender own(picture::Denoiser::own, 1, broken);
  EXPECT_EQ(own.filterFor(viewer, 1, 1), nullptr);
  EXPECT_EQ(own.takeProblem(), "");
}

TEST(Oidn, PreviewsSayWhatHasFilteredThem) {
  const FrameCamera camera = cameraAt({0, 0, 4});
  Previews own(1), with(1, picture::Denoiser::oidn, usable),
      without(1, picture::Denoiser::oidn, failing);
  const Picture frame = frameOf(0, true);
  const Picture expected = own.rebuild(0, frame, camera, 1, {});
  EXPECT_EQ(own.denoisedBy(), "");
  EXPECT_NE(valuesOf(with.rebuild(0, frame, camera, 1, {})), valuesOf(expected));
  EXPECT_EQ(with.denoisedBy(), "Open Image Denoise 2.4.99");
  EXPECT_EQ(valuesOf(without.rebuild(0, frame, camera, 1, {})), valuesOf(expected));
  EXPECT_EQ(without.denoisedBy(), "");
  EXPECT_NE(without.takeProblem().find("cannot filter"), std::string::npos);
}

// --- The real library ---

TEST(Oidn, TheRealLibraryRemovesNoiseAndGivesTheSameBytes) {
  const Library library = OidnLibrary::find();
  if (!library) GTEST_SKIP() << "Open Image Denoise is not installed";
  const FrameCamera camera = cameraAt({0, 0, 4});
  std::vector<float> first;
  for (int run = 0; run < 2; run++) {
    OidnFilter filter(library, 2, OidnQuality::fast);
    Reconstruction reconstruction;
    Picture rebuilt;
    for (uint32_t n = 0; n < 4; n++) {
      rebuilt = reconstruction.add(frameOf(n, true), camera, 1, &filter);
      EXPECT_TRUE(reconstruction.facts().denoised);
      EXPECT_EQ(reconstruction.facts().problem, "");
    }
    const auto& rgba = valuesOf(rebuilt);
    EXPECT_LT(deviationOf(rgba), 0.2); // that of the samples is more than 1
    if (run == 0)
      first = rgba;
    else
      EXPECT_EQ(rgba, first);
  }
}

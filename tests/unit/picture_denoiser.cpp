// picture_denoiser.cpp: Tests how finished pictures are denoised: which channels the result has,
// what it says about itself, alpha, colours that the filter cannot be given, and failures. A fake
// library (tests/oidn) gives every pixel the mean of the image.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "libpicture/denoiser.h"
#include "libpicture/live/oidn.h"

using namespace picture;

namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();

std::shared_ptr<const live::OidnLibrary> fake(const std::string& fault = "") {
  return live::OidnLibrary::load(std::string(FAKE_OIDN_FOLDER) + "/fake_oidn" + fault + ".so");
}

// Returns a picture whose red is `red` and whose other colours are 0.25, alpha 1.
Picture pictureOf(int width, int height, const std::vector<float>& red) {
  Picture picture;
  picture.width = width;
  picture.height = height;
  for (const float v : red)
    for (const float c : {v, 0.25f, 0.25f, 1.0f}) picture.planes[RT_RGBA].push_back(c);
  return picture;
}

float redAt(const Picture& picture, size_t pixel) { return picture.planes.at(RT_RGBA)[4 * pixel]; }
float alphaAt(const Picture& picture, size_t pixel) {
  return picture.planes.at(RT_RGBA)[4 * pixel + 3];
}

} // namespace

TEST(Denoiser, ThePictureSaysWhatItIs) {
  Picture noisy = pictureOf(2, 1, {0, 1});
  noisy.planes[RT_DEPTH] = {3, 4};
  for (const uint32_t channel : {RT_ERROR, RT_VARIANCE}) noisy.planes[channel].resize(6);
  noisy.planes[RT_TRUST].resize(2);
  noisy.names = {"", "Ball"};
  PictureDenoiser denoiser(fake(), 1);
  const Picture made = denoiser.denoised(noisy);
  EXPECT_EQ(made.denoisedBy, "Open Image Denoise 2.4.99");
  EXPECT_EQ(made.note, "denoised by Open Image Denoise 2.4.99, biased");
  EXPECT_FLOAT_EQ(redAt(made, 0), 0.5f);
  EXPECT_FLOAT_EQ(redAt(made, 1), 0.5f);
  EXPECT_EQ(made.planes.count(RT_ERROR) + made.planes.count(RT_VARIANCE) +
                made.planes.count(RT_TRUST),
            0u);
  EXPECT_EQ(made.planes.at(RT_DEPTH), noisy.planes.at(RT_DEPTH));
  EXPECT_EQ(made.names, noisy.names);
  EXPECT_EQ(redAt(noisy, 0), 0) << "the picture before stays as it is";
  EXPECT_EQ(noisy.note, "");
}

TEST(Denoiser, GuidesAreGivenOnlyIfBothAreThere) {
  Picture noisy = pictureOf(1, 1, {0.5f});
  PictureDenoiser denoiser(fake(), 1);                // the fake refuses guides of one kind
  noisy.planes[RT_ALBEDO] = {2, 0.5f, std::nanf("")}; // neither may reach the filter
  EXPECT_FLOAT_EQ(redAt(denoiser.denoised(noisy), 0), 0.5f);
  noisy.planes[RT_NORMAL] = {0, 0, infinite};
  EXPECT_FLOAT_EQ(redAt(denoiser.denoised(noisy), 0), 0.5f);
}

TEST(Denoiser, AlphaChangesAtBordersOnly) {
  // two rows: covered, covered, half covered, open, open, open
  Picture noisy = pictureOf(6, 2, std::vector<float>(12, 0.5f));
  std::vector<float>& rgba = noisy.planes[RT_RGBA];
  const float alphas[] = {1, 1, 0.5f, 0, 0, 0};
  double mean = 0;
  noisy.transparent = true;
  for (size_t i = 0; i < 12; i++) {
    rgba[4 * i + 3] = alphas[i % 6];
    if (alphas[i % 6] == 0) std::fill_n(&rgba[4 * i], 3, 0.0f);
    mean += double(alphas[i % 6]) / 12;
  }
  PictureDenoiser denoiser(fake(), 1);
  const Picture made = denoiser.denoised(noisy);
  for (const size_t row : {0u, 6u}) {
    EXPECT_EQ(alphaAt(made, row), 1);
    for (size_t i = 1; i <= 3; i++) EXPECT_FLOAT_EQ(alphaAt(made, row + i), float(mean)) << i;
    EXPECT_EQ(alphaAt(made, row + 4), 0);
    EXPECT_EQ(redAt(made, row + 5), 0) << "nothing is seen there";
  }
  noisy.transparent = false; // files have no alpha, so it is not worth the time
  EXPECT_EQ(alphaAt(denoiser.denoised(noisy), 2), 0.5f);
}

TEST(Denoiser, WholeAlphaStaysWhole) {
  Picture noisy = pictureOf(2, 1, {1, 1}); // a border without partial coverage has no noise
  noisy.planes[RT_RGBA][3] = 0;
  noisy.transparent = true;
  PictureDenoiser denoiser(fake(), 1);
  const Picture made = denoiser.denoised(noisy);
  EXPECT_EQ(alphaAt(made, 0), 0);
  EXPECT_EQ(alphaAt(made, 1), 1);
}

TEST(Denoiser, UnitsDoNotMatter) {
  PictureDenoiser denoiser(fake(), 1);
  for (const float unit : {1e-30f, 1e-6f, 1.0f, 1e6f, 1e30f}) {
    Picture noisy = pictureOf(2, 1, {unit, 3 * unit});
    for (const size_t i : {1u, 2u, 5u, 6u}) noisy.planes[RT_RGBA][i] = unit;
    EXPECT_FLOAT_EQ(redAt(denoiser.denoised(noisy), 0), 2 * unit) << unit;
  }
}

TEST(Denoiser, TheSunStaysAsItIs) {
  std::vector<float> red(64, 1);
  red[7] = 1e30f;
  PictureDenoiser denoiser(fake(), 1);
  const Picture made = denoiser.denoised(pictureOf(8, 8, red));
  EXPECT_EQ(redAt(made, 7), 1e30f);
  EXPECT_LE(redAt(made, 8), 0x1p20f) << "what the filter gets is bounded";
}

TEST(Denoiser, EveryColourIsFiniteAfterwards) {
  PictureDenoiser broken(fake("_nan"), 1);
  const Picture made = broken.denoised(pictureOf(2, 2, {std::nanf(""), infinite, -infinite, 1}));
  for (const float v : made.planes.at(RT_RGBA)) EXPECT_TRUE(std::isfinite(v));
  EXPECT_EQ(redAt(made, 0), 0);
  const Picture black = broken.denoised(pictureOf(1, 1, {0}));
  EXPECT_EQ(redAt(black, 0), 0);
}

TEST(Denoiser, FailuresAreErrors) {
  PictureDenoiser failing(fake("_failing"), 1), poor(fake("_without_memory"), 1);
  EXPECT_THROW(failing.denoised(pictureOf(1, 1, {1})), RenderError);
  EXPECT_THROW(poor.denoised(pictureOf(32, 1, std::vector<float>(32, 1))), std::bad_alloc);
  EXPECT_THROW(failing.denoised(Picture{}), std::runtime_error) << "no colours";
}

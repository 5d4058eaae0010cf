// picture_hdr.cpp: Tests that Radiance pictures hold the numbers of a picture, whatever its width.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "libpicture/files/formats.h"
#include "openrt/openrt.h"
#include "xvrml/radiance.h"

using namespace picture;

namespace {

Picture pictureOf(int width, int height, float (*valueAt)(int i)) {
  Picture picture;
  picture.width = width;
  picture.height = height;
  picture.linear = true;
  std::vector<float>& rgba = picture.planes[RT_RGBA];
  for (int i = 0; i < 4 * width * height; ++i) rgba.push_back(valueAt(i));
  return picture;
}

xvrml::RadianceImage readAgain(const Picture& picture) {
  const std::string bytes = encodeHdr(picture);
  return xvrml::decodeRadiance(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
}

// Returns a colour of a read picture; its rows run from the bottom up.
float colourAt(const xvrml::RadianceImage& image, int x, int y, int c) {
  return image.rgb[size_t(3 * ((image.height - 1 - y) * image.width + x) + c)];
}

void expectSame(const Picture& picture) {
  const xvrml::RadianceImage image = readAgain(picture);
  ASSERT_EQ(image.width, picture.width);
  ASSERT_EQ(image.height, picture.height);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const float* given = rgbaOf(picture).data() + 4 * (y * picture.width + x);
      const float largest = std::max({given[0], given[1], given[2]});
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(colourAt(image, x, y, c), given[c], largest / 250) << x << ' ' << y;
    }
}

} // namespace

TEST(Hdr, holdsNumbersOfAllSizes) {
  const auto value = [](int i) {
    return float(std::ldexp(1 + (i * 37 % 101) / 101.0, i % 60 - 30));
  };
  for (const int width : {1, 7, 8, 9, 127, 128, 129, 300}) expectSame(pictureOf(width, 5, value));
}

TEST(Hdr, runsOfAllLengthsAreReadAgain) {
  // runs of 1, 2, 3 ... pixels of one colour
  expectSame(pictureOf(700, 2, [](int i) { return float(int(std::sqrt(i / 4 % 700 * 2.0)) + 1); }));
  const Picture even = pictureOf(600, 100, [](int) { return 3.5f; });
  expectSame(even);
  EXPECT_LT(encodeHdr(even).size(), 600u * 100u / 10);
}

TEST(Hdr, rowsTooWideForRunsAreReadAgain) {
  expectSame(pictureOf(32768, 1, [](int i) { return float(i % 11 + 1); }));
}

TEST(Hdr, numbersThatAreNoRadianceBecomeBlackOrTheLargest) {
  const float values[] = {-1, NAN, 0, 1, INFINITY, 1, -INFINITY, 1};
  Picture picture = pictureOf(2, 1, [](int) { return 0.0f; });
  picture.planes[RT_RGBA].assign(std::begin(values), std::end(values));
  const xvrml::RadianceImage image = [&] {
    Picture first = picture;
    first.width = 1;
    first.planes[RT_RGBA].resize(4);
    return readAgain(first);
  }();
  for (const float v : image.rgb) EXPECT_EQ(v, 0);
  const std::string bytes = encodeHdr(picture);
  const auto* pixel = reinterpret_cast<const uint8_t*>(bytes.data() + bytes.size() - 4);
  EXPECT_GE(pixel[0], 128); // the mantissa of the largest number
  EXPECT_GE(pixel[3], 254); // its exponent
}

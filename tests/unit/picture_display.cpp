// picture_display.cpp: Tests that display bytes follow the curve of IEC 61966-2-1, whichever way
// they are computed.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "libpicture/files/picture.h"
#include "openrt/openrt.h"

using namespace picture;

namespace {

std::vector<uint8_t> bytesOf(const std::vector<float>& values, bool linear) {
  Picture picture;
  picture.width = int(values.size());
  picture.height = 1;
  picture.linear = linear;
  for (const float v : values)
    picture.planes[RT_RGBA].insert(picture.planes[RT_RGBA].end(), {v, 0, 1, 1});
  const std::vector<uint8_t> rgb = displayBytes(picture);
  std::vector<uint8_t> out;
  for (size_t i = 0; i < rgb.size(); i += 3) out.push_back(rgb[i]);
  return out;
}

} // namespace

TEST(Display, bytesAreThoseOfTheFormula) {
  std::vector<float> values;
  for (uint32_t bits = std::bit_cast<uint32_t>(1e-6f); bits < std::bit_cast<uint32_t>(1.0f);
       bits += 997)
    values.push_back(std::bit_cast<float>(bits));
  const std::vector<uint8_t> bytes = bytesOf(values, true);
  for (size_t i = 0; i < values.size(); i++) {
    const float v = values[i],
                curve = v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
    ASSERT_EQ(bytes[i], uint8_t(curve * 255 + 0.5f)) << v;
  }
}

TEST(Display, whatIsNoColourIsBlackOrWhite) {
  const float inf = INFINITY;
  const std::vector<float> odd = {-inf,   -1,          -0.0f, 0,   std::nanf(""),
                                  1e-40f, 0.99999994f, 1,     1.5, inf};
  const std::vector<uint8_t> expected = {0, 0, 0, 0, 0, 0, 255, 255, 255, 255};
  EXPECT_EQ(bytesOf(odd, true), expected);
  EXPECT_EQ(bytesOf(odd, false), expected);
  EXPECT_EQ(bytesOf({0.5f, 0.25f}, false), (std::vector<uint8_t>{128, 64}));
}

// picture_cryptomatte.cpp: Tests the layers and attributes of Cryptomatte against their
// specification.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>

#include "libpicture/files/cryptomatte.h"
#include "openrt/openrt.h"

using namespace picture;

namespace {

constexpr size_t components = 16;

float asFloat(std::string_view name) { return std::bit_cast<float>(cryptomatteHash(name)); }

// Returns a picture of one row, with the pairs of number and share of each pixel.
Picture pictureOf(const std::vector<std::vector<float>>& pixels, std::vector<std::string> names) {
  Picture picture;
  picture.width = int(pixels.size());
  picture.height = 1;
  picture.names = std::move(names);
  std::vector<float>& plane = picture.planes[RT_COVERAGE];
  for (const std::vector<float>& pixel : pixels) {
    plane.insert(plane.end(), pixel.begin(), pixel.end());
    plane.insert(plane.end(), components - pixel.size(), 0.0f);
  }
  return picture;
}

std::vector<float> firstOf(const std::vector<float>& layers, size_t pixel, size_t count) {
  const auto begin = layers.begin() + std::ptrdiff_t(components * pixel);
  return {begin, begin + std::ptrdiff_t(count)};
}

} // namespace

// The values are those of the author's program.
TEST(Cryptomatte, HashesAreThoseOfMurmurHash3) {
  EXPECT_EQ(cryptomatteHash("hello"), 0x248bfa47u);
  EXPECT_EQ(cryptomatteHash("hello, world"), 0x149bbb7fu);
  EXPECT_EQ(cryptomatteHash("The quick brown fox jumps over the lazy dog"), 0x2e4ff723u);
  EXPECT_EQ(cryptomatteHash("abc"), 0xb3dd93fau);
  EXPECT_EQ(cryptomatteHash("aaaa"), 0x7eeed987u) << "four bytes: no tail";
}

TEST(Cryptomatte, HashesAreNormalFloats) {
  EXPECT_EQ(cryptomatteHash(""), 1u << 23) << "the hash 0 has the exponent 0";
  uint32_t changed = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::string name = "Shape" + std::to_string(i);
    ASSERT_TRUE(std::isnormal(asFloat(name))) << name;
    const uint32_t exponent = cryptomatteHash(name) >> 23 & 255;
    changed += exponent == 1 || exponent == 254;
  }
  EXPECT_NEAR(changed, 20000 * 4 / 256, 80) << "twice as many as of other exponents";
}

TEST(Cryptomatte, PlanesAreNamedInLayersOfFour) {
  const Channel& channel = *findChannel("cryptomatte");
  ASSERT_EQ(channel.components, int(components));
  for (size_t c = 0; c < components; ++c)
    EXPECT_EQ(channel.exr[c],
              "CryptoObject0" + std::to_string(c / 4) + "." + std::string(1, "RGBA"[c % 4]));
}

TEST(Cryptomatte, NumbersBecomeHashesOfNames) {
  const std::vector<float> layers =
      cryptomatteLayers(pictureOf({{2, .5f, 1, .25f}, {}}, {"", "Floor", "Ball"}));
  EXPECT_EQ(firstOf(layers, 0, 6),
            (std::vector<float>{asFloat("Ball"), .5f, asFloat("Floor"), .25f, 0, 0}));
  EXPECT_EQ(firstOf(layers, 1, components), std::vector<float>(components, 0.0f));
}

TEST(Cryptomatte, ShapesOfOneNameAreOneObject) {
  const std::vector<float> layers =
      cryptomatteLayers(pictureOf({{3, .375f, 1, .25f, 2, .25f}}, {"", "Tree", "Tree", "Floor"}));
  EXPECT_EQ(firstOf(layers, 0, 6),
            (std::vector<float>{asFloat("Tree"), .5f, asFloat("Floor"), .375f, 0, 0}));
}

TEST(Cryptomatte, AttributesNameTheLayerAndEachShape) {
  std::map<std::string, std::string> found;
  for (const auto& [key, value] :
       cryptomatteAttributes(pictureOf({{}}, {"", "hello", "say \"abc\"", "hello"})))
    found[key] = value;
  // The digits are the first seven of the hash of "CryptoObject".
  const std::string key = "cryptomatte/3ae39a5/";
  EXPECT_EQ(found.size(), 4u);
  EXPECT_EQ(found[key + "name"], "CryptoObject") << found.begin()->first;
  EXPECT_EQ(found[key + "hash"], "MurmurHash3_32");
  EXPECT_EQ(found[key + "conversion"], "uint32_to_float32");
  EXPECT_TRUE(found[key + "manifest"].starts_with("{\"hello\":\"248bfa47\",\"say \\\"abc\\\"\":\""))
      << found[key + "manifest"];
}

// U+FFFD stands for each byte that is none.
TEST(Cryptomatte, NamesAreUtf8) {
  const Picture picture = pictureOf({{1, 1}}, {"", "W\xfcrfel \xc3\xbc"});
  EXPECT_EQ(cryptomatteLayers(picture)[0], asFloat("W\xef\xbf\xbdrfel \xc3\xbc"));
  for (const auto& [key, value] : cryptomatteAttributes(picture))
    if (key.ends_with("manifest")) {
      EXPECT_TRUE(value.starts_with("{\"W\xef\xbf\xbdrfel \xc3\xbc\":\"")) << value;
    }
}

TEST(Cryptomatte, ShapesWithoutNamesAreCalledByTheirNumbers) {
  const Picture picture = pictureOf({{42, 1}}, {});
  EXPECT_EQ(cryptomatteLayers(picture)[0], asFloat("42"));
  for (const auto& [key, value] : cryptomatteAttributes(picture))
    if (key.ends_with("manifest")) { EXPECT_TRUE(value.starts_with("{\"42\":\"")) << value; }
}

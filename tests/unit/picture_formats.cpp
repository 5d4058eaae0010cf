// picture_formats.cpp: Tests that the table of file formats agrees with what its encoders do. A new
// row is tested without a change here.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "libpicture/files/formats.h"
#include "openrt/openrt.h"

using namespace picture;

namespace {

// Returns a transparent picture of one colour, large enough that a JPEG differs with the colour.
Picture pictureOf(float alpha, bool linear) {
  Picture picture;
  picture.width = picture.height = 8;
  picture.linear = linear;
  picture.transparent = true;
  for (int i = 0; i < 64; ++i)
    picture.planes[RT_RGBA].insert(picture.planes[RT_RGBA].end(), {0.2f, 0.1f, 0.05f, alpha});
  return picture;
}

} // namespace

TEST(Formats, suffixesAreLowerCaseAndTaken) {
  std::set<std::string_view> taken;
  for (const Format& format : formatTable()) {
    SCOPED_TRACE(format.name);
    EXPECT_FALSE(format.suffixes[0].empty());
    for (const std::string_view suffix : format.suffixes) {
      if (suffix.empty()) continue;
      EXPECT_EQ(suffix.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789"), suffix.npos);
      EXPECT_TRUE(taken.insert(suffix).second) << suffix;
      EXPECT_EQ(formatNamed(suffix), &format);
      EXPECT_EQ(formatOf("folder.d/a." + std::string(suffix)), &format);
    }
  }
}

TEST(Formats, namesAreReadInAnyCase) {
  EXPECT_EQ(formatNamed("JpEg"), formatNamed("jpg"));
  for (const char* path : {"", "png", "a.", "a.png/b", "a.docx"})
    EXPECT_EQ(formatOf(path), nullptr) << path;
  EXPECT_EQ(formatNamed(""), nullptr);
}

TEST(Formats, thoseThatKeepAlphaAreThoseWhoseBytesFollowIt) {
  for (const Format& format : formatTable())
    EXPECT_EQ(format.encode(pictureOf(0.5f, true)) != format.encode(pictureOf(0.75f, true)),
              format.keepsAlpha)
        << format.name;
}

TEST(Formats, thoseWithTheCurveEncodeLinearColoursAsDisplayValues) {
  for (const Format& format : formatTable()) {
    const Picture linear = pictureOf(1, true);
    Picture display = linear;
    display.linear = false;
    for (float& value : display.planes[RT_RGBA])
      if (value < 1) value = 1.055f * std::pow(value, 1 / 2.4f) - 0.055f;
    EXPECT_EQ(format.encode(linear) == format.encode(display), format.appliesCurve) << format.name;
  }
}

TEST(Formats, textsListTheTable) {
  const std::string suffixes = formatSuffixes(), alpha = formatsWith(&Format::keepsAlpha);
  for (const Format& format : formatTable()) {
    EXPECT_NE(suffixes.find(format.suffixes[0]), suffixes.npos) << format.name;
    EXPECT_EQ(alpha.find(format.name) != alpha.npos, format.keepsAlpha) << format.name;
  }
}

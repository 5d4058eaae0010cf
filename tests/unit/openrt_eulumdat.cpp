// openrt_eulumdat.cpp: Tests reading EULUMDAT files: their symmetries, units, and invalid texts.
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "../../plugins/shaders/eulumdat.h"

namespace {

// A file with intensities at gamma 0 and 90 of the planes that it contains: 100 * (1 + plane) and
// 0.
std::string file(int symmetry, int planes, const std::string& flux = "2000",
                 const std::string& factor = "1") {
  std::string text =
      "maker\n3\n" + std::to_string(symmetry) + "\n" + std::to_string(planes) + "\n" +
      std::to_string(planes > 1 ? 360 / planes : 0) +
      "\n2\n90\nreport\nname\nnumber\nfile\ndate\n600\n600\n50\n600\n600\n0\n0\n0\n0\n"
      "100\n80\n" +
      factor + "\n0\n1\n1\nlamp\n" + flux + "\n3000\n80\n20\n";
  for (int i = 0; i < 10; i++) text += ".5\n";
  for (int i = 0; i < planes; i++) text += std::to_string(360 * i / planes) + "\n";
  text += "0\n90\n";
  const auto stored = eulumdat::planesOf(size_t(symmetry), size_t(planes));
  for (size_t i = 0; i < stored.count; i++)
    text += std::to_string(100 * (1 + (stored.first + i) % size_t(planes))) + "\n0\n";
  return text;
}

photometry::Photometry good(const std::string& text) {
  photometry::Photometry p;
  int line = 0;
  const char* message = eulumdat::parse(text, p, line);
  EXPECT_EQ(message, nullptr) << message << " in line " << line;
  return p;
}

std::string bad(const std::string& text) {
  photometry::Photometry p;
  int line = 0;
  const char* message = eulumdat::parse(text, p, line);
  return message ? message + (" " + std::to_string(line)) : std::string();
}

TEST(Eulumdat, IntensitiesAreForAThousandLumen) {
  const photometry::Photometry p = good(file(1, 4));
  for (const double around : {0., 77., 300.}) {
    EXPECT_FLOAT_EQ(p.intensity(0, around), 200);
    EXPECT_FLOAT_EQ(p.intensity(45, around), 100);
    EXPECT_FLOAT_EQ(p.intensity(90, around), 0);
  }
  EXPECT_FLOAT_EQ(good(file(1, 4, "500", "1.5")).intensity(0, 0), 75);
  EXPECT_FLOAT_EQ(good(file(1, 4, "500,5")).intensity(0, 0), 50.05f) << "decimal comma";
}

TEST(Eulumdat, Symmetries) {
  const auto at = [](const photometry::Photometry& p, double around) {
    return double(p.intensity(0, around)) / 200 - 1; // number of the plane of eight
  };
  const photometry::Photometry all = good(file(0, 8)), along = good(file(2, 8)),
                               across = good(file(3, 8)), both = good(file(4, 8));
  for (int i = 0; i < 8; i++) {
    EXPECT_NEAR(at(all, 45 * i), i, 1e-5);
    EXPECT_NEAR(at(along, 45 * i), i <= 4 ? i : 8 - i, 1e-5);
    EXPECT_NEAR(at(both, 45 * i), i <= 2 ? i : i <= 4 ? 4 - i : i <= 6 ? i - 4 : 8 - i, 1e-5);
    // Planes 6, 7, 0, 1, 2 are in the file; 3, 4 and 5 mirror 1, 0 and 7.
    const int mirrored[] = {0, 1, 2, 1, 0, 7, 6, 7};
    EXPECT_NEAR(at(across, 45 * i), mirrored[i], 1e-5) << i;
  }
  EXPECT_NEAR(at(all, 22.5), .5, 1e-5);
  EXPECT_NEAR(at(all, 337.5), 3.5, 1e-5) << "between the last plane and the first";
}

TEST(Eulumdat, SetsOfLampsAreAlternatives) {
  std::string text = file(1, 1);
  const std::string one = "1\n1\nlamp\n2000\n3000\n80\n20\n";
  const size_t at = text.find(one);
  text.replace(at, one.size(), "2\n1\nlamp\n2000\n3000\n80\n20\n1\nother\n9000\n3000\n80\n90\n");
  EXPECT_FLOAT_EQ(good(text).intensity(0, 0), 200);
}

TEST(Eulumdat, WhatIsWrongIsSaid) {
  EXPECT_EQ(bad(""), "this is not an EULUMDAT file: line 2 is the type of luminaire, 0 to 3 0");
  EXPECT_EQ(bad("a\n3\n5\n"), "the symmetry is a number from 0 to 4 3");
  EXPECT_EQ(bad("a\n3\n0\n1e9\n"), "the number of C-planes is out of range: 1 to 4096 4");
  EXPECT_EQ(bad("a\n3\n4\n6\n"), "the number of C-planes does not fit the symmetry 4");
  EXPECT_NE(bad(file(1, 4, "x")).find("luminous flux"), std::string::npos);
  EXPECT_NE(bad(file(1, 4, "-5")).find("luminous flux"), std::string::npos);
  EXPECT_NE(bad(file(1, 4, "5", "nan")).find("conversion factor"), std::string::npos);
  EXPECT_NE(bad(file(1, 4, "1e30", "1e30")).find("too large"), std::string::npos);
  EXPECT_NE(bad(file(1, 4, "0")).find("luminous flux"), std::string::npos);
  EXPECT_NE(bad(file(1, 4, "5", "0")).find("conversion factor"), std::string::npos);
  const std::string text = file(0, 4);
  EXPECT_NE(bad(text.substr(0, text.size() - 3)).find("an intensity is missing"),
            std::string::npos);
  std::string negative = text;
  negative.replace(negative.rfind("400"), 3, "-40");
  EXPECT_NE(bad(negative).find("an intensity is negative"), std::string::npos);
  std::string planes = text;
  planes.replace(planes.find("0\n90\n180\n"), 9, "0\n90\n80\n");
  EXPECT_NE(bad(planes).find("C-planes must rise"), std::string::npos);
}

// With a count that is too small, angles would be read as intensities.
TEST(Eulumdat, NumbersThatAreLeftOverAreRefused) {
  const std::string text = file(0, 4);
  EXPECT_NE(bad(text + "5\n").find("more intensities than"), std::string::npos);
  EXPECT_NE(bad(text + "\n\n5").find("more intensities than"), std::string::npos);
  std::string rows = text; // one intensity per plane instead of two
  rows.replace(rows.find("\n2\n90\nreport"), 2, "\n1");
  EXPECT_NE(bad(rows).find("more intensities than"), std::string::npos);
  for (const char* end : {"\n\n", "\x1a", "a comment\n", "\r\n"})
    EXPECT_FLOAT_EQ(good(text + end).intensity(0, 0), 200);
}

TEST(Eulumdat, LinesOfEverySystem) {
  for (const char* end : {"\r\n", "\r"}) {
    std::string text = file(0, 4);
    for (size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += std::strlen(end))
      text.replace(at, 1, end);
    EXPECT_TRUE(eulumdat::looksLike(text));
    EXPECT_FLOAT_EQ(good(text).intensity(0, 0), 200);
  }
}

TEST(Eulumdat, IsToldFromIes) {
  EXPECT_TRUE(eulumdat::looksLike(file(1, 1)));
  EXPECT_FALSE(eulumdat::looksLike("IESNA91\nTILT=NONE\n1 1"));
  EXPECT_FALSE(eulumdat::looksLike("1986\n1\n1\nTILT=NONE\n1 1")) << "keywords may be numbers";
  EXPECT_FALSE(eulumdat::looksLike("1986\r1\r1\rtilt = none\r1 1"));
  EXPECT_FALSE(eulumdat::looksLike("#VRML V2.0 utf8\nShape {}"));
  EXPECT_FALSE(eulumdat::looksLike(""));
}

// Tries every prefix of a good file, and every byte of it changed.
TEST(Eulumdat, NoTextEndsBadly) {
  const std::string text = file(3, 4);
  for (size_t i = 0; i < text.size(); i++) {
    bad(text.substr(0, i));
    for (const char c : {'\0', '-', '9', '\n', '\xff'}) {
      std::string changed = text;
      changed[i] = c;
      photometry::Photometry p;
      int line = 0;
      if (eulumdat::parse(changed, p, line)) continue;
      for (const double down : {0., 30., 100.})
        EXPECT_TRUE(std::isfinite(p.intensity(down, 7 * double(i))));
    }
  }
}

} // namespace

// openrt_ies.cpp: Tests reading IES files of measured luminaires, their symmetries, and invalid
// texts.
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "../../plugins/shaders/ies.h"

namespace {

std::string file(const std::string& first, const std::string& rest) {
  return first + "\n[TEST] 1\n[LUMINAIRE] none\nTILT=NONE\n" + rest;
}

ies::Photometry good(const std::string& text) {
  ies::Photometry p;
  int line = 0;
  const char* message = ies::parse(text, p, line);
  EXPECT_EQ(message, nullptr) << message << " in line " << line;
  return p;
}

std::string bad(const std::string& text) {
  ies::Photometry p;
  int line = 0;
  const char* message = ies::parse(text, p, line);
  return message ? message + (" " + std::to_string(line)) : std::string();
}

const std::string head = "IESNA:LM-63-2002";

TEST(Ies, AllDirectionsAlike) {
  const ies::Photometry p =
      good(file(head, "1 1000 2 3 1 1 2 0 0 0\n.5 1 100\n0 90 180\n0\n100, 100,\r\n 100"));
  for (const double down : {0., 45., 180.})
    for (const double around : {0., -170., 359., 720.})
      EXPECT_FLOAT_EQ(p.intensity(down, around), 100);
  EXPECT_NEAR(p.flux(), 400 * M_PI, .1);
}

TEST(Ies, FactorsOfOldAndNewFiles) {
  const std::string rest = "1 -1 3 2 1 1 2 0 0 0\n.5 .25 100\n0 90\n0\n100 0";
  EXPECT_FLOAT_EQ(good(file("IESNA:LM-63-1995", rest)).intensity(0, 0), 150)
      << "the second factor is for future use";
  EXPECT_FLOAT_EQ(good(file("IESNA91", rest)).intensity(0, 0), 37.5);
  EXPECT_FLOAT_EQ(good("a luminaire of 1986\nTILT=NONE\n" + rest).intensity(0, 0), 37.5);
}

TEST(Ies, BetweenAnglesAndBeyond) {
  const ies::Photometry p = good(file(head, "1 1 1 2 1 1 1 0 0 0 1 1 1 0 90 0 100 0"));
  EXPECT_FLOAT_EQ(p.intensity(45, 10), 50);
  EXPECT_FLOAT_EQ(p.intensity(90, 10), 0);
  EXPECT_EQ(p.intensity(90.1, 10), 0) << "nothing was measured there";
}

TEST(Ies, Symmetries) {
  const std::string one = "1 1 1 1 ", two = " 1 2 0 0 0 1 1 1 0 "; // one vertical angle: 0
  const ies::Photometry quarter = good(file(head, one + "2" + two + "0 90  10 20"));
  for (const double around : {30., 150., 210., 330., -30.})
    EXPECT_NEAR(quarter.intensity(0, around), 10 + 10 / 3., 1e-4) << around;
  const ies::Photometry half = good(file(head, one + "3" + two + "0 90 180  10 20 40"));
  EXPECT_NEAR(half.intensity(0, 135), 30, 1e-4);
  EXPECT_NEAR(half.intensity(0, 225), 30, 1e-4);
  const ies::Photometry whole =
      good(file(head, one + "5" + two + "0 90 180 270 360  10 20 30 40 10"));
  EXPECT_NEAR(whole.intensity(0, 225), 35, 1e-4);
  EXPECT_NEAR(whole.intensity(0, 315), 25, 1e-4);
  const ies::Photometry open =
      good(file(head, one + "4" + two + "0 90 180 270  10 20 30 40")); // the angle 360 is left out
  EXPECT_NEAR(open.intensity(0, 315), 25, 1e-4);
  const ies::Photometry across = good(file(head, one + "3" + two + "90 180 270  10 20 30"));
  EXPECT_NEAR(across.intensity(0, 45), 15, 1e-4);
  EXPECT_NEAR(across.intensity(0, 315), 25, 1e-4);
}

TEST(Ies, TheFactorOfTheTiltIsInterpolated) {
  const std::string text = "IESNA91\nTILT=INCLUDE\n1\n3\n0 40 90\n1 .5 .8\n"
                           "1 1 1 2 1 1 1 0 0 0 1 1 1 0 90 0 100 100";
  for (const auto& [tilt, factor] :
       {std::pair(0., 1.), {20., .75}, {40., .5}, {65., .65}, {120., .8}}) {
    ies::Photometry p;
    int line = 0;
    ASSERT_EQ(ies::parse(text, p, line, tilt), nullptr);
    EXPECT_NEAR(p.intensity(0, 0), 100 * factor, 1e-4) << tilt;
  }
}

// Each shape of LM-63-2002 and LM-63-1995 is seen along the three axes.
TEST(Ies, NegativeSizesAreDiameters) {
  constexpr double disc = M_PI / 4;
  const std::string older = "IESNA:LM-63-1995";
  const struct {
    std::string version, sizes; // width, length, height
    double down, along, across; // areas
  } shapes[] = {{head, "2 4 0", 8, 0, 0},
                {head, "2 4 3", 8, 6, 12},
                {head, "-2 -2 0", disc * 4, 0, 0},
                {head, "-2 -4 0", disc * 8, 0, 0},
                {head, "-2 -4 3", disc * 8, 6, 12},
                {head, "-2 -2 -2", disc * 4, disc * 4, disc * 4},
                {head, "-2 -4 -3", disc * 8, disc * 6, disc * 12},
                {head, "-2 4 -3", 8, disc * 6, 12},
                {head, "2 -4 -3", 8, 6, disc * 12},
                {head, "-2 0 -3", 0, disc * 6, 0},
                {head, "0 -4 -3", 0, 0, disc * 12},
                {older, "-2 0 0", disc * 4, 0, 0},
                {older, "-2 0 3", disc * 4, 6, 6},
                {older, "-2 0 -2", disc * 4, disc * 4, disc * 4},
                {older, "0 4 -3", 12, disc * 9, 12},
                {older, "2 0 -3", 6, 6, disc * 9}};
  for (const auto& shape : shapes) {
    const photometry::Opening o =
        good(file(shape.version, "1 1 1 1 1 1 2 " + shape.sizes + " 1 1 1 0 0 5")).opening;
    SCOPED_TRACE(shape.sizes);
    EXPECT_TRUE(o.exists());
    EXPECT_NEAR(o.projected(1, 0, 0), shape.down, 1e-9);
    EXPECT_NEAR(o.projected(0, 1, 0), shape.along, 1e-9);
    EXPECT_NEAR(o.projected(0, 0, -1), shape.across, 1e-9);
  }
}

// Parallel rays that meet an opening cover the area that is seen of it.
TEST(Ies, RaysMeetTheAreaThatIsSeen) {
  for (const char* sizes : {"2 4 3", "-2 -4 3", "-2 -4 -3", "-2 4 -3", "2 -4 -3", "-2 0 -3"}) {
    const photometry::Opening o =
        good(file(head, std::string("1 1 1 1 1 1 2 ") + sizes + " 1 1 1 0 0 5")).opening;
    SCOPED_TRACE(sizes);
    for (const double turn : {.3, 1.9, 4.})
      for (const double lift : {.4, -1.1}) {
        const double c = std::cos(lift), s = std::sin(lift), x = std::cos(turn), y = std::sin(turn);
        const photometry::Coordinates to = {s, c * x, c * y}, right = {0, -y, x},
                                      up = {c, -s * x, -s * y};
        int met = 0;
        constexpr int side = 200;
        constexpr double cell = 6. / side;
        for (int i = 0; i < side * side; i++) {
          const double u = (i % side + .5) * cell - 3, v = (i / side + .5) * cell - 3;
          photometry::Coordinates from, along;
          for (size_t k = 0; k < 3; k++) {
            from[k] = 9 * to[k] + u * right[k] + v * up[k];
            along[k] = -2 * to[k];
          }
          const double distance = o.meet(from, along);
          met += std::isfinite(distance);
          EXPECT_GT(distance, 2); // in lengths of `along`, from 9 m away
        }
        EXPECT_NEAR(met * cell * cell, o.projected(to[0], to[1], to[2]), .1);
      }
  }
}

// Types A and B differ in which angle turns around the polar axis: away from the axes, the same two
// angles are two directions (CIE 121-1996).
TEST(Ies, TypesAAndBTellDirectionsByOtherAngles) {
  constexpr double degree = M_PI / 180;
  const std::string rest = " 1 0 0 0 1 1 1  -40 0 40  -60 0 60  1 2 3 4 5 6 7 8 9";
  const ies::Photometry a = good(file(head, "1 1 1 3 3 3" + rest)),
                        b = good(file(head, "1 1 1 3 3 2" + rest));
  EXPECT_EQ(a.type, ies::Type::A);
  EXPECT_EQ(b.type, ies::Type::B);
  const auto typeA = [&](double across, double up) {
    return a.towards(std::cos(across) * std::cos(up), std::sin(across) * std::cos(up),
                     std::sin(up));
  };
  const auto typeB = [&](double across, double up) {
    return b.towards(std::cos(across) * std::cos(up), std::sin(across),
                     std::cos(across) * std::sin(up));
  };
  for (const double across : {-50., -20., 10., 55.})
    for (const double up : {-35., 0., 25.}) {
      const double expected = 5 + across / 20 + up / 40;
      EXPECT_NEAR(typeA(across * degree, up * degree), expected, 1e-4);
      EXPECT_NEAR(typeB(across * degree, up * degree), expected, 1e-4);
    }
  EXPECT_EQ(a.towards(-1, 0, 0), 0) << "nothing was measured behind the lamp";
  const ies::Photometry half = good(file(head, "1 1 1 1 2 3 1 0 0 0 1 1 1  0  0 90  10 40"));
  EXPECT_NEAR(half.intensity(0, -45), 25, 1e-4) << "one side stands for both";
}

TEST(Ies, WhatIsWrongIsSaid) {
  const std::string numbers = "1 1 1 2 1 1 1 0 0 0 1 1 1 0 90 0 ";
  EXPECT_EQ(bad(""),
            "the profile is empty: give the text of an IES LM-63 or EULUMDAT file, or lumen 1");
  EXPECT_EQ(bad("#VRML V2.0 utf8\nShape {}"), "this is not an IES file: there is no line TILT= 2");
  EXPECT_EQ(bad("IESNA91\nTILT=INCLUDE\n4 1 0 1"),
            "TILT=INCLUDE needs the lamp's position (1, 2 or 3) and the number of tilt angles 3");
  EXPECT_NE(bad("IESNA91\nTILT=INCLUDE\n1 2\n90 0\n1 1").find("must be rising"), std::string::npos);
  EXPECT_NE(bad("IESNA91\nTILT=INCLUDE\n1 2\n0 90\n1 -1").find("tilt factor"), std::string::npos);
  EXPECT_NE(bad("IESNA91\nTILT=INCLUDE\n1 1e9\n0").find("tilt angles"), std::string::npos);
  EXPECT_NE(bad("IESNA91\nTILT=../../etc/passwd\n" + numbers).find("only TILT=NONE"),
            std::string::npos);
  EXPECT_EQ(bad(file(head, numbers + "1")),
            "a candela value is missing, not a number, or too large 5");
  EXPECT_EQ(bad(file(head, numbers + "1 -1")), "a candela value is negative 5");
  EXPECT_NE(bad(file(head, numbers + "1 nan")).find("candela"), std::string::npos);
  EXPECT_NE(bad(file(head, numbers + "1 1e39")).find("candela"), std::string::npos);
  EXPECT_NE(bad(file(head, "1 1 1 4000 4000 1 1 0 0 0 1 1 1")).find("number of angles"),
            std::string::npos);
  EXPECT_NE(bad(file(head, "1 1 1 1e9 1 1 1 0 0 0 1 1 1")).find("number of angles"),
            std::string::npos);
  EXPECT_NE(bad(file(head, "1 1 1 1.5 1 1 1 0 0 0 1 1 1")).find("number of angles"),
            std::string::npos);
  EXPECT_NE(bad(file(head, "1 1 1 -1 1 1 1 0 0 0 1 1 1")).find("number of angles"),
            std::string::npos);
  EXPECT_NE(bad(file(head, "1 1 1 2 1 4 1 0 0 0 1 1 1 0 90 0 1 1")).find("photometric type"),
            std::string::npos);
  EXPECT_NE(bad(file(head, "1 1 1 2 1 3 1 0 0 0 1 1 1 0 91 0 1 1")).find("types A and B"),
            std::string::npos);
  EXPECT_NE(bad(file(head, "1 1 1 1 2 2 1 0 0 0 1 1 1 0 5 90 1 1")).find("types A and B"),
            std::string::npos);
  EXPECT_NE(bad(file(head, "1 1 1 2 1 1 1 0 0 0 1 1 1 90 0 0 1 1")).find("must rise"),
            std::string::npos);
  EXPECT_NE(bad(file(head, "1 1 1 2 1 1 1 0 0 0 1 1 1 0 181 0 1 1")).find("must rise"),
            std::string::npos);
  EXPECT_NE(bad(file(head, "1 1 1 1 2 1 1 0 0 0 1 1 1 0 0 45 1 1")).find("must run"),
            std::string::npos);
  EXPECT_NE(bad(file(head, "1 1 -1 1 1 1 1 0 0 0 1 1 1 0 0 1")).find("ballast factor is not"),
            std::string::npos);
  EXPECT_NE(bad(file(head, "1 1 0 1 1 1 1 0 0 0 1 1 1 0 0 1")).find("multiplier or a ballast"),
            std::string::npos);
  EXPECT_NE(bad(file(head, "1 1 1 2 1 3 1 0 0 0 1 1 1 -9 9 0 1 1")).find("two horizontal angles"),
            std::string::npos);
  EXPECT_NE(bad(file(head, "1 1 x")).find("description"), std::string::npos);
}

// Numbers that are left over would be somebody else's values: a wrong count, or decimal commas.
TEST(Ies, NumbersThatAreLeftOverAreRefused) {
  const std::string numbers = "1 1 1 2 1 1 1 0 0 0 1 1 1 0 90 0 ";
  EXPECT_NE(bad(file(head, numbers + "1 2 3")).find("more numbers than"), std::string::npos);
  EXPECT_NE(bad(file(head, numbers + "1,5 2,5")).find("decimal commas 5"), std::string::npos);
  EXPECT_NE(bad(file(head, numbers + "1.5.5 2")).find("candela"), std::string::npos);
  EXPECT_NE(bad(file(head, numbers + "0x64 2")).find("candela"), std::string::npos);
  for (const char* end : {"\r\n\r\n", " ", "\x1a", "\n\x1a", "\nEND\n", "\nend of file 1"})
    EXPECT_FLOAT_EQ(good(file(head, numbers + "7 8" + end)).intensity(0, 0), 7);
}

TEST(Ies, LinesOfEverySystemAndTiltInEverySpelling) {
  const std::string text = file(head, "1 1 1 2 1 1 1 0 0 0\n1 .5 1\n0 90\n0\n7 8");
  const auto replaced = [](std::string in, const std::string& from, const std::string& to) {
    for (size_t at = 0; (at = in.find(from, at)) != std::string::npos; at += to.size())
      in.replace(at, from.size(), to);
    return in;
  };
  for (const char* end : {"\r\n", "\r"}) {
    EXPECT_FLOAT_EQ(good(replaced(text, "\n", end)).intensity(0, 0), 7);
    EXPECT_NE(bad(replaced(text + "x", "\n", end)).find(" 9"), std::string::npos);
  }
  for (const char* tilt : {"TILT = NONE", "TILT= none ", "  tilt =\tNone"})
    EXPECT_FLOAT_EQ(good(replaced(text, "TILT=NONE", tilt)).intensity(0, 0), 7);
  EXPECT_FLOAT_EQ(good("\xef\xbb\xbf" + text).intensity(0, 0), 7) << "a byte order mark";
  EXPECT_NE(bad(replaced(text, "TILT=NONE", "TILTED=NONE")).find("no line TILT="),
            std::string::npos);
}

// Tries every prefix of a good file, and every byte of it changed.
TEST(Ies, NoTextEndsBadly) {
  const std::string text =
      file(head, "1 1 1 3 3 1 1 0 0 0 1 1 1 0 45 90 0 90 180 1 2 3 4 5 6 7 8 9");
  for (size_t i = 0; i < text.size(); i++) {
    bad(text.substr(0, i));
    for (const char c : {'\0', '-', '9', '\n', '\xff'}) {
      std::string changed = text;
      changed[i] = c;
      ies::Photometry p;
      int line = 0;
      if (ies::parse(changed, p, line)) continue;
      for (const double down : {0., 30., 100.})
        EXPECT_TRUE(std::isfinite(p.intensity(down, 7 * double(i))));
    }
  }
}

} // namespace

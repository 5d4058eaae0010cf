// picture_sky.cpp: Tests daylight: standard skies against closed forms, the sun against published
// positions, measured skies, weather files, and the words of --sky.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "libpicture/files/picture.h"
#include "libpicture/sky/epw.h"
#include "libpicture/sky/perez.h"
#include "libpicture/sky/sky.h"

using namespace picture;

namespace {

constexpr double pi = std::numbers::pi;
const Direction south = directionOf({40, 180});

// Returns the integral of exp(b / u) u over u from 0 to 1 by Simpson's rule. It is the exponential
// integral of order 3.
double exponentialIntegral(double b) {
  constexpr int parts = 20000;
  double sum = 0;
  for (int i = 1; i <= parts; ++i) {
    const double u = double(i) / parts, value = std::exp(b / u) * u;
    sum += value * (i == parts ? 1 : i % 2 ? 4 : 2);
  }
  return sum / (3.0 * parts);
}

// Returns the illuminance of a surface with this normal by a picture.
double illuminance(const xvrml::RadianceImage& image, const Direction& normal) {
  double sum = 0;
  for (int row = 0; row < image.height; ++row) {
    const double down = pi * (1 - (row + .5) / image.height);
    for (int column = 0; column < image.width; ++column) {
      const double turn = pi * (2 * (column + .5) / image.width - 1);
      const Direction d{std::sin(down) * std::sin(turn), std::cos(down),
                        -std::sin(down) * std::cos(turn)};
      const double cosine = d[0] * normal[0] + d[1] * normal[1] + d[2] * normal[2];
      if (cosine > 0)
        sum += double(image.rgb[3 * (size_t(row) * size_t(image.width) + size_t(column))]) *
               cosine * std::sin(down);
    }
  }
  return sum * pi / image.height * 2 * pi / image.width;
}

std::string epwOf(const std::string& row) {
  return "LOCATION,London,-,GBR,IWEC,037760,51.15,-0.18,0.0,62.0\n"
         "DESIGN CONDITIONS,0\nDATA PERIODS,1,1,Data,Sunday, 1/ 1,12/31\n" +
         row;
}
const std::string noon = "1995,6,21,13,60,?9,20.0,11.0,56,101325,1100,1330,330,750,600,200,"
                         "9999,9999,9999\n";

std::string refusal(const std::string& words) {
  try {
    readSky(words);
  } catch (const std::invalid_argument& wrong) {
    return wrong.what();
  } catch (const InputError& e) { return std::string("file: ") + e.what(); }
  return "";
}

} // namespace

TEST(Sky, overcastSkiesHaveTheIlluminanceOfTheirClosedForms) {
  EXPECT_NEAR(horizontalIlluminance(standardSky(traditionalSky), south), 7 * pi / 9, 1e-5);
  EXPECT_NEAR(horizontalIlluminance(standardSky(5), south), pi, 1e-9); // an even sky
  EXPECT_NEAR(horizontalIlluminance(standardSky(1), south),
              pi * (1 + 2 * 4 * exponentialIntegral(-.7)), 1e-5);
  EXPECT_NEAR(horizontalIlluminance(standardSky(3), south),
              pi * (1 + 2 * 1.1 * exponentialIntegral(-.8)), 1e-5);
}

// The standard gives luminances relative to the zenith.
TEST(Sky, standardSkiesAreThoseOfTheEquation) {
  // type 1 falls from the zenith to about a third at the horizon
  const SkyLuminance overcast = standardSky(1);
  EXPECT_NEAR(overcast.at(1e-9, 0) / overcast.at(1, 0), 1 / (1 + 4 * std::exp(-.7)), 1e-12);
  // type 12, the clear sky of CIE: 0.91 + 10 exp(-3 x) + 0.45 cos^2 x, (1 - exp(-0.32 / cos Z))
  const SkyLuminance clear = standardSky(12);
  for (const double x : {.1, .7, 1.5, 2.5}) {
    const double indicatrix = .91 + 10 * std::exp(-3 * x) + .45 * std::cos(x) * std::cos(x);
    EXPECT_NEAR(clear.at(.5, x) / ((1 - std::exp(-.64)) * indicatrix), 1, .001);
  }
  for (int type = 1; type <= traditionalSky; ++type)
    for (const double up : {1e-6, .01, .3, 1.0})
      for (const double x : {0.0, 1.0, 3.14}) EXPECT_GT(standardSky(type).at(up, x), 0) << type;
}

// J. Meeus, "Astronomical Algorithms", example 25.a: 13 October 1992, 0 h: declination -7.78507.
// The sun culminates at Greenwich 90 degrees less the latitude, plus the declination, high.
TEST(Sun, hasTheDeclinationOfMeeus) {
  double highest = -90;
  for (int minute = 0; minute < 60; ++minute)
    highest = std::max(
        highest, sunPosition({0, 180}, momentOf(1992, 10, 12, 23.3 + minute / 60.0, 0)).altitude);
  EXPECT_NEAR(90 - highest, 7.785, .01);
}

// I. Reda, A. Andreas, "Solar position algorithm for solar radiation applications", NREL 2003, A.5:
// topocentric elevation without refraction 39.872046, azimuth 194.340241.
TEST(Sun, standsWhereNrelSays) {
  const SunPosition sun =
      sunPosition({39.742476, -105.1786}, momentOf(2003, 10, 17, 12.508333, -7));
  EXPECT_NEAR(sun.altitude, 39.872046, .01);
  EXPECT_NEAR(sun.azimuth, 194.340241, .01);
}

TEST(Sun, timesAreReadWithTheirZones) {
  const Moment summer = readMoment("2026-06-21T12:00+02:00"),
               same = readMoment("2026-06-21T10:00Z");
  EXPECT_NEAR(summer.days, same.days, 1e-9);
  EXPECT_EQ(summer.dayOfYear, 172);
  EXPECT_EQ(readMoment("2024-12-31T00:00Z").dayOfYear, 366);
  for (const char* wrong :
       {"", "2026-06-21", "2026-06-21T12:00", "2026-02-30T12:00Z", "2026-06-21T24:00Z",
        "2026-06-21T12:00+2:00", "2026-06-21T12:00ZZ", "-026-06-21T12:00Z", "2026-6-21T12:00Z",
        "2026-06-21T12:00+02:00x", "2026-06-21T12:0"})
    EXPECT_THROW(readMoment(wrong), std::invalid_argument) << wrong;
}

TEST(Sun, northIsBeforeAndEastToTheRight) {
  EXPECT_NEAR(directionOf({0, 0})[2], -1, 1e-12);
  EXPECT_NEAR(directionOf({0, 90})[0], 1, 1e-12);
  EXPECT_NEAR(directionOf({0, 0}, 90)[0], 1, 1e-12);
  EXPECT_NEAR(directionOf({90, 77})[1], 1, 1e-12);
}

// The luminous efficacies of daylight are 90 to 130 lm/W; clear skies are bluer than the sun.
TEST(Perez, measuredSkiesHaveTheIlluminanceOfDaylight) {
  const std::pair<double, double> measured[] = {{0, 150}, {300, 250}, {850, 100}};
  for (const auto& [direct, diffuse] : measured) {
    const PerezSky sky = perezSky({direct, diffuse, 50, 172, 11});
    EXPECT_GT(sky.diffuseHorizontal / diffuse, 100);
    EXPECT_LT(sky.diffuseHorizontal / diffuse, 145);
    if (direct > 0) {
      EXPECT_GT(sky.directNormal / direct, 85);
      EXPECT_LT(sky.directNormal / direct, 120);
    }
  }
  EXPECT_THROW(perezSky({500, 0, 50}), std::invalid_argument);
}

// An overcast sky is brightest in the zenith, a clear one about the sun.
TEST(Perez, theDistributionFollowsTheClearness) {
  const Direction sun = directionOf({40, 180}), away = directionOf({40, 0});
  const double apart = angleBetween(sun, away), up = sun[1];
  const SkyLuminance overcast = perezSky({0, 150, 40, 172, 11}).luminance,
                     clear = perezSky({850, 90, 40, 172, 11}).luminance;
  EXPECT_GT(overcast.at(1, 50 * pi / 180) / overcast.at(.2, 50 * pi / 180), 1.3);
  EXPECT_LT(overcast.at(up, 0) / overcast.at(up, apart), 2);
  EXPECT_GT(clear.at(up, .05) / clear.at(up, apart), 10);
}

TEST(Perez, allSkiesOfADayHaveLight) {
  for (const double altitude : {2.0, 30.0, 60.0, 85.0})
    for (const double diffuse : {30.0, 100.0, 300.0})
      for (const double direct : {0.0, 200.0, 800.0}) {
        const PerezSky sky = perezSky({direct, diffuse, altitude, 100, 11});
        const double e = horizontalIlluminance(sky.luminance, directionOf({altitude, 180}));
        EXPECT_TRUE(e > 0 && std::isfinite(e)) << altitude << ' ' << diffuse << ' ' << direct;
      }
}

TEST(Weather, anHourIsReadByItsColumns) {
  const WeatherHour hour = weatherHour(epwOf(noon), "06-21T12:30");
  EXPECT_EQ(hour.place.latitude, 51.15);
  EXPECT_EQ(hour.place.longitude, -.18);
  EXPECT_EQ(hour.directNormal, 600);
  EXPECT_EQ(hour.diffuseHorizontal, 200);
  EXPECT_EQ(hour.dewPoint, 11);
  EXPECT_EQ(hour.moment.dayOfYear, 172);
  EXPECT_NEAR(sunPosition(hour.place, hour.moment).altitude, 62, .5); // 90 - 51.15 + 23.44
}

TEST(Weather, wrongFilesAndTimesAreRefused) {
  const auto why = [](const std::string& text, const char* time) -> std::string {
    try {
      weatherHour(text, time);
    } catch (const std::invalid_argument& wrong) { return wrong.what(); }
    return "";
  };
  for (const char* time : {"", "06-21", "6-21T12:30", "13-01T12:30", "06-21T24:00", "06-21T12:60"})
    EXPECT_NE(why(epwOf(noon), time).find("06-21T14:30 was expected"), std::string::npos) << time;
  EXPECT_EQ(why(epwOf(noon), "06-22T12:30"), "it has no such hour");
  EXPECT_NE(why("hello", "06-21T12:30").find("begins without LOCATION"), std::string::npos);
  EXPECT_NE(why("LOCATION,a,b\n", "06-21T12:30").find("latitude"), std::string::npos);
  std::string missing = noon;
  missing.replace(missing.find(",600,"), 5, ",9999,");
  EXPECT_NE(why(epwOf(missing), "06-21T12:30").find("direct normal"), std::string::npos);
  for (const char* wrong : {"600x", "600 1", "6e999", "nan", "+-600", "0x258", ""}) {
    std::string text = noon;
    text.replace(text.find(",600,") + 1, 3, wrong);
    EXPECT_NE(why(epwOf(text), "06-21T12:30").find("direct normal"), std::string::npos) << wrong;
    text = noon;
    text.replace(text.find(",11.0,") + 1, 4, wrong);
    EXPECT_NE(why(epwOf(text), "06-21T12:30").find("dew point"), std::string::npos) << wrong;
  }
  for (const char* good : {" 600", "+600", "600 ", "6e2"}) {
    std::string text = noon;
    text.replace(text.find(",600,") + 1, 3, good);
    EXPECT_EQ(weatherHour(epwOf(text), "06-21T12:30").directNormal, 600) << good;
  }
  EXPECT_NE(why(epwOf(noon), "06-21T-0:30").find("was expected after the @"), std::string::npos);
  for (size_t end = 0; end < noon.size(); end += 3) // a file that was cut off
    why(epwOf(noon.substr(0, end)), "06-21T12:30");
}

TEST(SkyWords, saySkiesAndSuns) {
  const Sky overcast = readSky("cie:16,lux=8000,ground=0");
  EXPECT_TRUE(overcast.isOvercast());
  EXPECT_EQ(overcast.outdoors(), 8000);
  const Sky clear = readSky("cie:12,sun=30/90,lux=12000,direct=80000,north=10");
  EXPECT_FALSE(clear.isOvercast());
  EXPECT_NEAR(clear.outdoors(), 52000, 1e-6);
  EXPECT_EQ(clear.north, 10);
  const Sky timed = readSky("cie:12,place=39.742476/-105.1786,time=2003-10-17T12:30-07:00");
  EXPECT_NEAR(timed.sun.azimuth, 194.2, .1);
  EXPECT_GT(readSky("perez:600/200,sun=60/180").direct, 50000);
}

TEST(SkyWords, sayThatTheSunHasSet) {
  for (const char* words : {"cie:12,sun=0/90,direct=80000", "cie:12,sun=-4/90,direct=80000",
                            "perez:60/20,sun=-.1/60", "perez:60/20,sun=0/60"}) {
    const Sky sky = readSky(words);
    EXPECT_EQ(sky.direct, 0) << words;
    EXPECT_NE(warningOf(sky).find("not above the horizon"), std::string::npos) << words;
  }
  for (const char* words :
       {"cie:12,sun=0/90", "cie:12,sun=.1/90,direct=80000", "cie:1", "perez:0/20,sun=-1/60"})
    EXPECT_EQ(warningOf(readSky(words)), "") << words;
}

TEST(SkyWords, thatAreWrongSayWhatWasExpected) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "was expected"},
      {"cie", "cie: a number from 1 to 16"},
      {"cie:0", "from 1 to 16"},
      {"cie:1.5", "whole number"},
      {"cie:12", "depends on the sun"},
      {"cie:1,direct=5", "direct needs sun"},
      {"cie:1,sun=91/0", "sun: a number from -90 to 90"},
      {"cie:1,sun=9", "slash"},
      {"cie:1,lux=-1", "lux: a number"},
      {"cie:1,lux=nan", "lux: a number"},
      {"cie:1,lux=1e-40", "lux: 0, or a number from 1e-06"},
      {"cie:1,sun=9/0,direct=1e-9", "direct: 0, or a number from 1e-06"},
      {"cie:1,luxx=1", "was expected, not \"luxx\""},
      {"cie:1,", "was expected, not \"\""},
      {"cie:1,place=50/8", "together"},
      {"cie:1,sun=5/5,place=50/8,time=2026-01-01T12:00Z", "not by both"},
      {"cie:1,dew=3", "dew belongs to perez"},
      {"perez:1", "slash"},
      {"perez:600/200", "perez needs sun"},
      {"perez:600/0,sun=60/180", "no diffuse light"},
      {"perez:600/200,sun=60/180,lux=5", "lux and direct belong to cie"},
      {"epw:", "was expected"},
      {"epw:no-such-file.epw@06-21T12:00", "file: cannot read no-such-file.epw"},
      {"epw:no-such-file.epw", "06-21T14:30 was expected"},
      {"moon:1", "cie:TYPE"},
  };
  for (const auto& [words, expected] : cases)
    EXPECT_NE(refusal(words).find(expected), std::string::npos) << words << ": " << refusal(words);
}

TEST(SkyPicture, hasTheIlluminancesThatAreAskedFor) {
  const Direction up{0, 1, 0}, down{0, -1, 0};
  for (const int type : {1, 5, 12, 15, 16}) {
    const Sky sky = readSky(fmt::format("cie:{},sun=35/120,lux=10000,ground=.3", type));
    const xvrml::RadianceImage image = pictureOf(sky);
    EXPECT_NEAR(illuminance(image, up), 10000, 5) << type;
    EXPECT_NEAR(illuminance(image, down), 3000, 2) << type;
  }
}

TEST(SkyPicture, hasASunOfTheRightLight) {
  const SunPosition suns[] = {{40, 123.4}, {3, 0}, {89.5, 270}, {60, 180.05}};
  for (const SunPosition& sun : suns) {
    const Sky sky = readSky(
        fmt::format("cie:5,sun={}/{},lux=0,direct=90000,ground=0", sun.altitude, sun.azimuth));
    const xvrml::RadianceImage image = pictureOf(sky);
    EXPECT_NEAR(illuminance(image, directionOf(sun)), 90000, 9) << sun.azimuth;
    EXPECT_NEAR(illuminance(image, {0, 1, 0}), sky.outdoors(), .002 * 90000) << sun.azimuth;
    int lit = 0;
    for (size_t i = 0; i < image.rgb.size(); i += 3) lit += image.rgb[i] > 0;
    EXPECT_GT(lit, 4);
  }
}

// sky_text.cpp: Reads the words of --sky: a kind of sky, and words KEY=VALUE behind commas.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "libpicture/sky/epw.h"
#include "libpicture/sky/perez.h"
#include "libpicture/sky/sky.h"
#include "number_text.h"

namespace picture {

namespace {

using Text = std::string_view;

[[noreturn]] void refuse(const std::string& why) { throw std::invalid_argument(why); }

double numberOf(Text word, Text text, double least, double most) {
  double value = 0;
  if (!isNumber(text, value) || !(value >= least && value <= most))
    refuse(fmt::format("{}: a number from {} to {} was expected, not \"{}\"", word, least, most,
                       text));
  return value;
}

constexpr double leastLux = 1e-6; // a thousandth of a sky of stars

// Returns the two parts of a text at its only slash.
std::array<Text, 2> halves(Text word, Text text) {
  const size_t slash = text.find('/');
  if (slash == text.npos)
    refuse(
        fmt::format("{}: two numbers with a slash between were expected, not \"{}\"", word, text));
  return {text.substr(0, slash), text.substr(slash + 1)};
}

// The values of the words.
struct Words {
  std::optional<SunPosition> sun;
  std::optional<Place> place;
  std::optional<Moment> moment;
  std::optional<double> diffuse, direct, dewPoint;
  double ground = .2, north = 0;
};

void readWord(Text word, Words& words) {
  const size_t equals = word.find('=');
  const Text key = word.substr(0, equals),
             value = equals == word.npos ? Text() : word.substr(equals + 1);
  const auto number = [&](double least, double most) { return numberOf(key, value, least, most); };
  const auto illuminance = [&] {
    const double lux = number(0, 1e9);
    if (lux > 0 && lux < leastLux)
      refuse(fmt::format("{}: 0, or a number from {} to 1e9 was expected, not \"{}\"", key,
                         leastLux, value));
    return lux;
  };
  const auto two = [&](double most0, double least1, double most1) {
    const auto [first, second] = halves(key, value);
    return std::array{numberOf(key, first, -most0, most0), numberOf(key, second, least1, most1)};
  };
  if (key == "sun") {
    const auto [altitude, azimuth] = two(90, -360, 360);
    words.sun = {altitude, azimuth};
  } else if (key == "place") {
    const auto [latitude, longitude] = two(90, -180, 180);
    words.place = {latitude, longitude};
  } else if (key == "time") {
    words.moment = readMoment(value);
  } else if (key == "lux") {
    words.diffuse = illuminance();
  } else if (key == "direct") {
    words.direct = illuminance();
  } else if (key == "dew") {
    words.dewPoint = number(-90, 60);
  } else if (key == "ground") {
    words.ground = number(0, 1);
  } else if (key == "north") {
    words.north = number(-360, 360);
  } else {
    refuse(fmt::format("sun, place, time, lux, direct, dew, ground or north was expected, not "
                       "\"{}\"",
                       key));
  }
}

Words readWords(Text text) {
  Words words;
  while (!text.empty()) {
    text.remove_prefix(1); // the comma
    const Text word = text.substr(0, text.find(','));
    readWord(word, words);
    text.remove_prefix(word.size());
  }
  if (words.place.has_value() != words.moment.has_value())
    refuse("place and time are given together");
  if (words.sun && words.place) refuse("the sun stands by sun, or by place and time, not by both");
  if (words.place) words.sun = sunPosition(*words.place, *words.moment);
  return words;
}

void setStandard(Text type, const Words& words, Sky& sky) {
  if (words.dewPoint) refuse("dew belongs to perez");
  sky.type = int(numberOf("cie", type, 1, traditionalSky));
  if (fmt::format("{}", sky.type) != type)
    refuse(fmt::format("cie: a whole number from 1 to {} was expected, not \"{}\"", traditionalSky,
                       type));
  sky.luminance = standardSky(sky.type);
  if (sky.luminance.c != 0 && !words.sun)
    refuse(fmt::format("cie:{} depends on the sun: give sun=ALTITUDE/AZIMUTH, or place and time",
                       sky.type));
  if (words.direct.value_or(0) > 0 && !words.sun)
    refuse("direct needs sun=ALTITUDE/AZIMUTH, or place and time");
  sky.diffuse = words.diffuse.value_or(sky.diffuse);
  const double direct = words.direct.value_or(0);
  sky.hasSet = direct > 0 && words.sun->altitude <= 0;
  sky.direct = sky.hasSet ? 0 : direct;
}

void setMeasured(const Irradiance& measured, const Words& words, Sky& sky) {
  if (words.diffuse || words.direct) refuse("lux and direct belong to cie");
  const PerezSky made = perezSky(measured);
  sky.hasSet = measured.directNormal > 0 && measured.sunAltitude <= 0;
  sky.luminance = made.luminance;
  sky.diffuse = made.diffuseHorizontal;
  sky.direct = made.directNormal;
}

void setPerez(Text numbers, const Words& words, Sky& sky) {
  const auto [direct, diffuse] = halves("perez", numbers);
  Irradiance measured{numberOf("perez", direct, 0, 2000), numberOf("perez", diffuse, 0, 2000)};
  if (!words.sun) refuse("perez needs sun=ALTITUDE/AZIMUTH, or place and time");
  measured.sunAltitude = words.sun->altitude;
  if (words.moment) measured.dayOfYear = words.moment->dayOfYear;
  measured.dewPoint = words.dewPoint.value_or(measured.dewPoint);
  setMeasured(measured, words, sky);
}

void setWeather(Text file, Text time, const Words& words, Sky& sky) {
  if (words.sun || words.dewPoint) refuse("a weather file says sun, place, time and dew");
  const WeatherHour hour = readWeatherHour(std::string(file), time);
  sky.sun = sunPosition(hour.place, hour.moment);
  setMeasured({hour.directNormal, hour.diffuseHorizontal, sky.sun.altitude, hour.moment.dayOfYear,
               hour.dewPoint},
              words, sky);
}

// The parts of "KIND:VALUE,WORDS"; a weather file ends at its last @, so it may have commas.
struct Parts {
  Text kind, value, file, words;
};

Parts partsOf(Text text) {
  Parts parts;
  const size_t colon = text.find(':');
  parts.kind = text.substr(0, colon);
  Text rest = colon == text.npos ? Text() : text.substr(colon + 1);
  if (parts.kind == "epw") {
    const size_t at = rest.rfind('@');
    parts.file = rest.substr(0, at);
    rest.remove_prefix(at == rest.npos ? rest.size() : at + 1);
  }
  const size_t comma = std::min(rest.find(','), rest.size());
  parts.value = rest.substr(0, comma);
  parts.words = rest.substr(comma);
  return parts;
}

} // namespace

std::string fileOfSky(const std::string& text) { return std::string(partsOf(text).file); }

Sky readSky(const std::string& text) {
  const Parts parts = partsOf(text);
  const Words words = readWords(parts.words);
  Sky sky;
  if (words.sun) sky.sun = *words.sun;
  sky.ground = words.ground;
  sky.north = words.north;
  if (parts.kind == "cie")
    setStandard(parts.value, words, sky);
  else if (parts.kind == "perez")
    setPerez(parts.value, words, sky);
  else if (parts.kind == "epw" && !parts.file.empty())
    setWeather(parts.file, parts.value, words, sky);
  else
    refuse(fmt::format("{} was expected, not \"{}\"", skyForms, text));
  const double whole = horizontalIlluminance(sky.luminance, directionOf(sky.sun, sky.north));
  if (!(whole > 0) || !std::isfinite(whole))
    refuse("this sky has no light: the model does not reach so far");
  return sky;
}

} // namespace picture

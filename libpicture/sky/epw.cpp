#include "libpicture/sky/epw.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "file_contents.h"
#include "libpicture/files/picture.h"
#include "number_text.h"

namespace picture {

namespace {

constexpr size_t mostBytes = 16 << 20; // a year of minutes takes less

// The fields of a line that are read, counted from 0.
enum Header { latitude = 6, longitude = 7, zone = 8 };
enum Column { year = 0, month = 1, day = 2, hour = 3, dewPoint = 7, direct = 14, diffuse = 15 };

[[noreturn]] void refuse(const std::string& why) { throw std::invalid_argument(why); }

std::string_view takeLine(std::string_view& text) {
  const size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

// Returns a field of a line; nothing if it is missing or no number.
std::optional<double> numberAt(std::string_view line, int field) {
  for (; field > 0; --field) {
    const size_t comma = line.find(',');
    if (comma == line.npos) return {};
    line.remove_prefix(comma + 1);
  }
  std::string_view text = line.substr(0, line.find(','));
  constexpr std::string_view blanks = " \t\r";
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  text = text.substr(0, text.find_last_not_of(blanks) + 1);
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0;
  if (!isNumber(text, value)) return {};
  return value;
}

// Returns a field of a line that is within a range. what: for the message.
double numberAt(std::string_view line, int field, const char* what, double least, double most) {
  const std::optional<double> value = numberAt(line, field);
  if (!value || !(*value >= least && *value <= most))
    refuse(fmt::format("{} is missing, or not from {} to {}", what, least, most));
  return *value;
}

struct Wanted {
  int month = 1, day = 1;
  double hours = 0; // since midnight
};

Wanted wantedOf(std::string_view time) {
  const auto two = [&](size_t at) {
    int value = -1;
    const bool is = at + 2 <= time.size() && time[at] != '-' && isNumber(time.substr(at, 2), value);
    return is ? value : -1;
  };
  const int month = two(0), day = two(3), hours = two(6), minutes = two(9);
  if (time.size() != 11 || time[2] != '-' || time[5] != 'T' || time[8] != ':' || month < 1 ||
      month > 12 || day < 1 || day > 31 || hours < 0 || hours > 23 || minutes < 0 || minutes > 59)
    refuse(fmt::format("a time such as 06-21T14:30 was expected after the @, not \"{}\"", time));
  return {month, day, hours + minutes / 60.0};
}

// Returns the line of the hour. Hours of the file are counted from 1 and named by their end.
std::string_view lineOf(std::string_view text, const Wanted& wanted) {
  const double ends = std::floor(wanted.hours) + 1;
  while (!text.empty()) {
    const std::string_view line = takeLine(text);
    if (numberAt(line, year) && numberAt(line, month) == wanted.month &&
        numberAt(line, day) == wanted.day && numberAt(line, hour) == ends)
      return line;
  }
  refuse("it has no such hour");
}

} // namespace

WeatherHour weatherHour(std::string_view text, std::string_view time) {
  const Wanted wanted = wantedOf(time);
  const std::string_view head = takeLine(text);
  if (!head.starts_with("LOCATION,")) refuse("it is no weather file: it begins without LOCATION");
  WeatherHour out;
  out.place = {numberAt(head, latitude, "the latitude", -90, 90),
               numberAt(head, longitude, "the longitude", -180, 180)};
  const double clock = numberAt(head, zone, "the time zone", -14, 14);
  const std::string_view line = lineOf(text, wanted);
  out.moment = momentOf(int(numberAt(line, year, "the year", 1900, 2100)), wanted.month, wanted.day,
                        wanted.hours, clock);
  // 9999 stands for a value that is missing.
  out.directNormal = numberAt(line, direct, "the direct normal radiation", 0, 2000);
  out.diffuseHorizontal = numberAt(line, diffuse, "the diffuse horizontal radiation", 0, 2000);
  const double dew = numberAt(line, dewPoint, "the dew point", -90, 100);
  out.dewPoint = dew < 60 ? dew : 11; // 99.9 stands for a value that is missing
  return out;
}

WeatherHour readWeatherHour(const std::string& path, std::string_view time) {
  wantedOf(time);
  std::string text;
  try {
    text = fileContents(path, mostBytes);
    return weatherHour(text, time);
  } catch (const std::bad_alloc&) { throw; } catch (const std::exception& wrong) {
    throw InputError(path, wrong.what());
  }
}

} // namespace picture

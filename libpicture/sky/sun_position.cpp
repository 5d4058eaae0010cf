#include "libpicture/sky/sun_position.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace picture {

namespace {

constexpr double degree = std::numbers::pi / 180;

[[noreturn]] void refuse(std::string_view text) {
  throw std::invalid_argument("a time such as 2026-06-21T12:00+02:00 or 2026-06-21T10:00Z was "
                              "expected, not \"" +
                              std::string(text) + "\"");
}

// Reads the fields of a time from the left.
class Fields {
 public:
  explicit Fields(std::string_view text) : whole_(text), rest_(text) {}
  // Reads a number of exactly so many digits, and the character behind it; 0: none is asked for.
  int number(size_t digits, char then, int least, int most) {
    int value = 0;
    const auto end = rest_.data() + std::min(digits, rest_.size());
    const auto read = std::from_chars(rest_.data(), end, value);
    const bool isWhole = rest_.size() >= digits && read.ec == std::errc() && read.ptr == end &&
                         rest_[0] != '-' && value >= least && value <= most;
    if (!isWhole) refuse(whole_);
    rest_.remove_prefix(digits);
    if (then != 0 && !take(then)) refuse(whole_);
    return value;
  }
  bool take(char c) {
    if (rest_.empty() || rest_[0] != c) return false;
    rest_.remove_prefix(1);
    return true;
  }
  bool isEmpty() const { return rest_.empty(); }
  std::string_view whole() const { return whole_; }

 private:
  std::string_view whole_, rest_;
};

} // namespace

Moment momentOf(int year, int month, int day, double hours, double zone) {
  using namespace std::chrono;
  const year_month_day date{std::chrono::year(year), std::chrono::month(unsigned(month)),
                            std::chrono::day(unsigned(day))};
  if (!date.ok()) throw std::invalid_argument("there is no such date");
  const sys_days midnight(date), base(std::chrono::year(2000) / January / 1),
      newYear(date.year() / January / 1);
  Moment moment;
  moment.days = double((midnight - base).count()) + (hours - zone) / 24;
  moment.dayOfYear = int((midnight - newYear).count()) + 1;
  return moment;
}

Moment readMoment(std::string_view text) {
  Fields fields(text);
  const int year = fields.number(4, '-', 1900, 2100), month = fields.number(2, '-', 1, 12),
            day = fields.number(2, 'T', 1, 31), hour = fields.number(2, ':', 0, 23),
            minute = fields.number(2, 0, 0, 59);
  double zone = 0;
  if (!fields.take('Z')) {
    const double sign = fields.take('+') ? 1 : fields.take('-') ? -1 : 0;
    if (sign == 0) refuse(text);
    const int hours = fields.number(2, ':', 0, 14), minutes = fields.number(2, 0, 0, 59);
    zone = sign * (hours + minutes / 60.0);
  }
  if (!fields.isEmpty()) refuse(text);
  try {
    return momentOf(year, month, day, hour + minute / 60.0, zone);
  } catch (const std::invalid_argument&) { refuse(text); }
}

SunPosition sunPosition(const Place& place, const Moment& moment) {
  const double days = moment.days - .5; // since noon, the epoch J2000.0
  const double t = days / 36525;        // Julian centuries; the sun moves little in a minute of TT
  const double meanLongitude = 280.46646 + t * (36000.76983 + t * .0003032),
               anomaly = (357.52911 + t * (35999.05029 - t * .0001537)) * degree;
  const double centre = (1.914602 - t * (.004817 + t * .000014)) * std::sin(anomaly) +
                        (.019993 - t * .000101) * std::sin(2 * anomaly) +
                        .000289 * std::sin(3 * anomaly);
  const double node = (125.04 - 1934.136 * t) * degree;
  const double longitude =
      (meanLongitude + centre - .00569 - .00478 * std::sin(node)) * degree; // apparent
  const double obliquity = (23.4392911 - .0130042 * t + .00256 * std::cos(node)) * degree;
  const double ascension =
      std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude));
  const double declination = std::asin(std::sin(obliquity) * std::sin(longitude));
  const double sidereal = 280.46061837 + 360.98564736629 * days; // at Greenwich, in degrees
  const double hour = (sidereal + place.longitude) * degree - ascension,
               latitude = place.latitude * degree;
  const double up = std::sin(latitude) * std::sin(declination) +
                    std::cos(latitude) * std::cos(declination) * std::cos(hour);
  const double east = -std::cos(declination) * std::sin(hour),
               north = std::cos(latitude) * std::sin(declination) -
                       std::sin(latitude) * std::cos(declination) * std::cos(hour);
  const double azimuth = std::atan2(east, north) / degree;
  return {std::atan2(up, std::hypot(east, north)) / degree, azimuth < 0 ? azimuth + 360 : azimuth};
}

Direction directionOf(const SunPosition& sun, double north) {
  const double turn = (sun.azimuth + north) * degree, up = sun.altitude * degree;
  return {std::cos(up) * std::sin(turn), std::sin(up), -std::cos(up) * std::cos(turn)};
}

} // namespace picture

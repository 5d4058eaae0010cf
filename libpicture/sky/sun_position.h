// sun_position.h: Where the sun stands at a place and a time: J. Meeus, "Astronomical Algorithms",
// 2nd ed., chapters 12, 13, 22 and 25, within .01 degrees for 1900 to 2100. Pure functions.
// [any thread]
#pragma once

#include <string_view>

#include "libpicture/sky/luminance.h"

namespace picture {

struct Place {
  double latitude = 0, longitude = 0; // degrees, north and east positive
};

// A moment, in days of Universal Time since the beginning of 1 January 2000.
struct Moment {
  double days = 0;
  int dayOfYear = 1; // in the date as it is written, from 1
};

// Returns the moment of a date of the Gregorian calendar. hours: since its midnight; zone: hours
// that its clock is ahead of Universal Time. Throws std::invalid_argument if there is no such date.
Moment momentOf(int year, int month, int day, double hours, double zone);
// Reads "2026-06-21T12:00+02:00" or "2026-06-21T10:00Z". Throws std::invalid_argument.
Moment readMoment(std::string_view text);

struct SunPosition {
  double altitude = 0, azimuth = 0; // degrees; azimuth from north by east. Refraction is left out.
  bool operator==(const SunPosition&) const = default;
};
SunPosition sunPosition(const Place& place, const Moment& moment);

// Returns the direction of the sun. north: degrees that north is turned from -z towards +x, where
// +x is east without it.
Direction directionOf(const SunPosition& sun, double north = 0);

} // namespace picture

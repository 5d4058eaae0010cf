// epw.h: Reads an hour of a weather file of EnergyPlus (.epw): "Auxiliary Programs" of EnergyPlus,
// chapter "EnergyPlus Weather File (EPW) Data Dictionary". The file is untrusted: what is read of
// it is bounded. [any thread]
#pragma once

#include <string>
#include <string_view>

#include "libpicture/sky/sun_position.h"

namespace picture {

struct WeatherHour {
  Place place;
  Moment moment;
  double directNormal = 0, diffuseHorizontal = 0; // W/m2
  double dewPoint = 0;                            // degrees Celsius
};

// Returns the hour that "06-21T14:30" lies in, in the local standard time of the file. `text` is
// the content of a file. Throws std::invalid_argument that says what is wrong.
WeatherHour weatherHour(std::string_view text, std::string_view time);
// Reads the file at a path. Throws InputError (files/picture.h), and for the time
// std::invalid_argument.
WeatherHour readWeatherHour(const std::string& path, std::string_view time);

} // namespace picture

// perez.h: The sky of measured irradiances. Its distribution: R. Perez, R. Seals, J. Michalsky,
// "All-weather model for sky luminance distribution", Solar Energy 50 (1993). Its illuminances:
// R. Perez et al., "Modeling daylight availability and irradiance components from direct and global
// irradiance", Solar Energy 44 (1990). Pure functions. [any thread]
#pragma once

#include "libpicture/sky/luminance.h"

namespace picture {

struct Irradiance {
  double directNormal = 0, diffuseHorizontal = 0; // W/m2
  double sunAltitude = 0;                         // degrees
  int dayOfYear = 0;                              // for the distance of the sun; 0: the mean one
  double dewPoint = 11; // degrees Celsius; 11 stands for 2 cm of water in the air
};

struct PerezSky {
  SkyLuminance luminance;
  double directNormal = 0, diffuseHorizontal = 0; // lux
};

// Returns the sky of irradiances. Throws std::invalid_argument if there is no diffuse light.
PerezSky perezSky(const Irradiance& measured);

} // namespace picture

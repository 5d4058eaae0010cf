// sky.h: Daylight as an environment: the words of --sky, and the picture of radiance that they
// make, with the sun in it. That picture is sampled as every other sky (docs/decisions/0064). [any
// thread]
#pragma once

#include <string>

#include "libpicture/sky/luminance.h"
#include "libpicture/sky/sun_position.h"
#include "xvrml/radiance.h"

namespace picture {

struct Sky {
  SkyLuminance luminance;
  int type = 0;             // standard skies: 1 to 16; 0: a sky of measured irradiances
  SunPosition sun{45, 180}; // where it stands, whether it shines or not
  double diffuse = 10000;   // illuminance of a horizontal plane by the sky without the sun, lux
  double direct = 0;        // illuminance of a plane that faces the sun, by the sun, lux
  bool hasSet = false;      // the sun was to shine, but is not above the horizon; direct is 0
  double ground = .2;       // reflectance of what is below the horizon
  double north = 0;         // degrees that north is turned from -z towards +x

  // Returns the illuminance in lux of a horizontal plane that nothing obstructs.
  double outdoors() const;
  // Returns whether daylight factors are defined under this sky: an overcast one, without sun.
  bool isOvercast() const { return (type == 1 || type == traditionalSky) && direct == 0; }
  bool operator==(const Sky&) const = default;
};

// Reads the words of --sky. Throws std::invalid_argument that says what was expected, and
// InputError (files/picture.h) for a weather file.
Sky readSky(const std::string& text);
inline constexpr const char* skyForms =
    "cie:TYPE (1 to 16), perez:DIRECT/DIFFUSE (W/m2) or epw:FILE@MM-DDTHH:MM";
// Returns what the user should know about a sky, as one line; empty: nothing.
std::string warningOf(const Sky& sky);
// Returns the file that the words name; empty: none.
std::string fileOfSky(const std::string& text);

// Returns the picture: longitude and latitude, with its middle towards -z, in cd/m2.
xvrml::RadianceImage pictureOf(const Sky& sky);

} // namespace picture

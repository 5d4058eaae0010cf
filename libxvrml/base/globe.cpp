#include "base/globe.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

namespace xvrml {
namespace {

// Ellipsoids by the code of ISO/IEC 19775-1 Table 25.3: half of the major axis in metres, and the
// reciprocal of the flattening.
struct Ellipsoid {
  std::string_view code;
  double a, reciprocal;
  double e2() const { return (2 - 1 / reciprocal) / reciprocal; } // square of the eccentricity
};
constexpr Ellipsoid ellipsoids[] = {{"WE", 6378137, 298.257223563},
                                    {"AA", 6377563.396, 299.3249646},
                                    {"AM", 6377340.189, 299.3249646},
                                    {"AN", 6378160, 298.25},
                                    {"BN", 6377483.865, 299.1528128},
                                    {"BR", 6377397.155, 299.1528128},
                                    {"CC", 6378206.4, 294.9786982},
                                    {"CD", 6378249.145, 293.465},
                                    {"EA", 6377276.345, 300.8017},
                                    {"EB", 6377298.556, 300.8017},
                                    {"EC", 6377301.243, 300.8017},
                                    {"ED", 6377295.664, 300.8017},
                                    {"EE", 6377304.063, 300.8017},
                                    {"EF", 6377309.613, 300.8017},
                                    {"FA", 6378155, 298.3},
                                    {"HE", 6378200, 298.3},
                                    {"HO", 6378270, 297},
                                    {"ID", 6378160, 298.247},
                                    {"IN", 6378388, 297},
                                    {"KA", 6378245, 298.3},
                                    {"RF", 6378137, 298.257222101},
                                    {"SA", 6378160, 298.25},
                                    {"WD", 6378135, 298.26}};

struct Geodetic {
  double latitude = 0, longitude = 0, height = 0; // radians, metres
};

// Holds what the strings of a geoSystem say.
struct System {
  enum class Kind : uint8_t { none, geodetic, utm, geocentric } kind = Kind::none;
  Ellipsoid ellipsoid = ellipsoids[0];
  int zone = 0;
  bool south = false;
  bool swapped = false; // the longitude or the easting comes first
};

// Returns the number of a zone of UTM, "Z10"; 0 for every other text.
int zoneOf(std::string_view text) {
  if (text.size() < 2 || text.size() > 3 || text[0] != 'Z') return 0;
  int zone = 0;
  for (const char c : text.substr(1)) {
    if (c < '0' || c > '9') return 0;
    zone = 10 * zone + (c - '0');
  }
  return zone <= 60 ? zone : 0;
}

System systemOf(const MFString& geoSystem) {
  System system;
  for (const std::string& word : geoSystem) {
    if (word == "GD" || word == "GDC") system.kind = System::Kind::geodetic;
    if (word == "GC" || word == "GCC") system.kind = System::Kind::geocentric;
    if (word == "UTM") system.kind = System::Kind::utm;
    if (word == "S") system.south = true;
    if (word == "longitude_first" || word == "easting_first") system.swapped = true;
    if (const int zone = zoneOf(word)) system.zone = zone;
    for (const Ellipsoid& one : ellipsoids)
      if (word == one.code) system.ellipsoid = one;
  }
  if (system.kind == System::Kind::utm && system.zone == 0) system.kind = System::Kind::none;
  return system;
}

// Returns latitude and longitude of a place in Universal Transverse Mercator (Snyder 1987, Map
// Projections: a working manual, equations 3-24, 3-26, 7-19, 8-12 and 8-17 to 8-25).
Geodetic fromUtm(double northing, double easting, const System& system) {
  const double a = system.ellipsoid.a, e2 = system.ellipsoid.e2(), e4 = e2 * e2, e6 = e4 * e2;
  constexpr double scale = 0.9996;
  const double m = (northing - (system.south ? 1e7 : 0)) / scale,
               mu = m / (a * (1 - e2 / 4 - 3 * e4 / 64 - 5 * e6 / 256)), root = std::sqrt(1 - e2),
               e1 = (1 - root) / (1 + root), e12 = e1 * e1;
  const double foot = mu + (1.5 * e1 - 27 * e1 * e12 / 32) * std::sin(2 * mu) +
                      (21 * e12 / 16 - 55 * e12 * e12 / 32) * std::sin(4 * mu) +
                      151 * e1 * e12 / 96 * std::sin(6 * mu) +
                      1097 * e12 * e12 / 512 * std::sin(8 * mu);
  const double sine = std::sin(foot), cosine = std::cos(foot), tangent = std::tan(foot);
  const double ep2 = e2 / (1 - e2), c = ep2 * cosine * cosine, t = tangent * tangent,
               left = 1 - e2 * sine * sine, n = a / std::sqrt(left),
               r = a * (1 - e2) / (left * std::sqrt(left)), d = (easting - 5e5) / (n * scale),
               d2 = d * d, d4 = d2 * d2;
  const double latitude =
      foot - n * tangent / r *
                 (d2 / 2 - (5 + 3 * t + 10 * c - 4 * c * c - 9 * ep2) * d4 / 24 +
                  (61 + 90 * t + 298 * c + 45 * t * t - 252 * ep2 - 3 * c * c) * d4 * d2 / 720);
  const double east = (d - (1 + 2 * t + c) * d * d2 / 6 +
                       (5 - 2 * c + 28 * t - 3 * c * c + 8 * ep2 + 24 * t * t) * d * d4 / 120) /
                      cosine;
  const double middle = (system.zone * 6 - 183) * std::numbers::pi / 180;
  return {latitude, middle + east, 0};
}

// Returns latitude, longitude and height of geocentric metres (Bowring 1976), whose error is below
// a millimetre near the ellipsoid.
Geodetic fromGeocentric(const Vec3d& p, const Ellipsoid& ellipsoid) {
  const double a = ellipsoid.a, e2 = ellipsoid.e2(), b = a * std::sqrt(1 - e2);
  const double out = std::hypot(p.x, p.y);
  if (out == 0 && p.z == 0) return {0, 0, -a};
  const double angle = std::atan2(p.z * a, out * b), sine = std::sin(angle),
               cosine = std::cos(angle);
  Geodetic place;
  place.latitude = std::atan2(p.z + e2 / (1 - e2) * b * sine * sine * sine,
                              std::max(0.0, out - e2 * a * cosine * cosine * cosine));
  place.longitude = std::atan2(p.y, p.x);
  return place; // the height is that of the given metres
}

Vec3d toGeocentric(const Geodetic& place, const Ellipsoid& ellipsoid) {
  const double e2 = ellipsoid.e2(), sine = std::sin(place.latitude),
               cosine = std::cos(place.latitude), n = ellipsoid.a / std::sqrt(1 - e2 * sine * sine);
  return {(n + place.height) * cosine * std::cos(place.longitude),
          (n + place.height) * cosine * std::sin(place.longitude),
          (n * (1 - e2) + place.height) * sine};
}

} // namespace

bool comesEastFirst(const MFString& geoSystem) { return systemOf(geoSystem).swapped; }

std::optional<GlobePlace> placeOnGlobe(const MFString& geoSystem, const Vec3d& coordinates) {
  const System system = systemOf(geoSystem);
  constexpr double degree = std::numbers::pi / 180;
  const double first = system.swapped ? coordinates.y : coordinates.x,
               second = system.swapped ? coordinates.x : coordinates.y;
  Geodetic place;
  switch (system.kind) {
  case System::Kind::none: return std::nullopt;
  case System::Kind::geodetic: place = {first * degree, second * degree, coordinates.z}; break;
  case System::Kind::utm:
    place = fromUtm(first, second, system);
    place.height = coordinates.z;
    break;
  case System::Kind::geocentric: place = fromGeocentric(coordinates, system.ellipsoid); break;
  }
  const bool given = system.kind == System::Kind::geocentric;
  const Vec3d center = given ? coordinates : toGeocentric(place, system.ellipsoid);
  const auto fits = [](double number) { return std::abs(number) < 1e12; }; // false for NaN
  if (!fits(center.x) || !fits(center.y) || !fits(center.z)) return std::nullopt;
  const double sine = std::sin(place.latitude), cosine = std::cos(place.latitude),
               sineOf = std::sin(place.longitude), cosineOf = std::cos(place.longitude);
  return GlobePlace{center,
                    {-sineOf, cosineOf, 0},
                    {cosine * cosineOf, cosine * sineOf, sine},
                    {sine * cosineOf, sine * sineOf, -cosine}};
}

} // namespace xvrml

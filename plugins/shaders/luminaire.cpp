// luminaire.cpp: the light Luminaire, a measured lamp: its intensity by direction comes from the
// text of an IES or EULUMDAT file. [render]
#include <cstdio>
#include <new>

#include "eulumdat.h"
#include "ies.h"
#include "openrt/openrts.hpp"

namespace {

struct Luminaire : rts::LightSource<Luminaire> {
  static constexpr const char* text =
      "a measured luminaire: one candela is a radiant intensity of 1";
  rts::Param<rts::String> profile{
      "profile", "text of an ANSI/IES LM-63 or EULUMDAT file; without it the lamp shines evenly"};
  rts::Param<rts::Color> color{"color", {1, 1, 1}, "multiplies the measured intensity"};
  rts::Param<float> intensity{"intensity", 1, "multiplies the measured intensity", 0, 1e9f};
  rts::Param<float> lumen{"lumen", 0,
                          "luminous flux of the luminaire, to which the measured intensity is "
                          "scaled; 0: as measured",
                          0, 1e12f};
  rts::Param<float> maintenance{
      "maintenance", 1,
      "maintenance factor: the share of the flux that is left when lamps and surfaces have aged", 0,
      1};
  rts::Param<float> tilt{"tilt", 0, "degrees by which the luminaire is tilted, for TILT=INCLUDE", 0,
                         180};
  rts::Param<rts::Vec3> location{"location", {0, 0, 0}, "place of the photometric centre"};
  rts::Param<rts::Vec3> direction{
      "direction",
      {0, 0, -1},
      "towards vertical angle 0: down, as the luminaire hangs; types A and B: forward"};
  rts::Param<rts::Vec3> reference{
      "reference",
      {1, 0, 0},
      "towards horizontal angle 0; angles grow counter-clockwise seen from above; types A and B: "
      "to the right"};

  rts::Param<int> shown{"shown", 1,
                        "1: the luminous opening that the profile tells is seen where the "
                        "luminaire hangs; 0: it is not",
                        0, 1};

  // Computed by prepare.
  const photometry::Photometry* photometry;
  rts::Vec3 down, zero, ninety; // orthonormal axes of the photometric angles
  float flux;
  double factor; // multiplies all intensities
  char message[200];

  const char* prepare() {
    auto* made = new (std::nothrow) photometry::Photometry;
    if (!made) return "out of memory";
    photometry = made;
    int line = 0;
    const char* problem = nullptr;
    try {
      problem = read(*made, line);
    } catch (const std::bad_alloc&) { problem = "out of memory"; }
    if (problem) {
      if (line > 0)
        std::snprintf(message, sizeof message, "profile, line %d: %s", line, problem);
      else
        std::snprintf(message, sizeof message, "%s", problem);
      release(); // frees the memory even if the host does not call release() after a refusal
      return message;
    }
    down = rts::normalize(direction);
    if (!(rts::length(down) > 0)) down = {0, 0, -1};
    const rts::Vec3 other = std::fabs(down.x) < .9f ? rts::Vec3{1, 0, 0} : rts::Vec3{0, 1, 0};
    const rts::Vec3 given = *reference - rts::dot(*reference, down) * down;
    zero = rts::normalize(rts::length(given) > 1e-6f * rts::length(*reference)
                              ? given
                              : other - rts::dot(other, down) * down);
    ninety = rts::cross(zero, down); // up x zero
    flux = float(made->flux());
    factor = double(*intensity) * double(*maintenance);
    return nullptr;
  }
  // Reads the profile and applies `lumen`. Returns null or a message; `line` is then its line, or
  // 0.
  const char* read(photometry::Photometry& out, int& line) const {
    const std::string_view text = *profile;
    if (text.empty() && *lumen > 0) {
      out.vertical = {0, 180};
      out.horizontal = {0};
      out.candela = {1, 1};
    } else if (const char* problem = eulumdat::looksLike(text)
                                         ? eulumdat::parse(text, out, line)
                                         : ies::parse(text, out, line, double(*tilt))) {
      return problem;
    }
    if (*lumen == 0) return nullptr;
    line = 0;
    const double own = out.flux();
    if (!(own > 0)) return "lumen: the profile has no light that could be scaled";
    return out.scale(double(*lumen) / own) ? nullptr : "lumen: the intensity would be too large";
  }
  void release() {
    delete photometry;
    photometry = nullptr;
  }

  // A light's colour is the radiance of a white Lambertian surface that faces it: irradiance / pi.
  rts::Illumination illuminate(rts::Vec3 point) const {
    const rts::Vec3 way = point - *location;
    const double d = rts::dot(way, down), x = rts::dot(way, zero), y = rts::dot(way, ninety);
    const double square = d * d + x * x + y * y;
    if (!photometry || !(square > 1e-30)) return {};
    const double seen = double(photometry->towards(d, x, y)) * factor / (M_PI * square);
    return {-way, *color * float(std::fmin(seen, 1e30)), {}};
  }
  // The luminance of the opening is the intensity over the area that is seen of it. A direction in
  // which the luminaire does not shine shows nothing.
  rts::Opening opening(rts::Vec3 origin, rts::Vec3 direction) const {
    if (!photometry || !*shown || !photometry->opening.exists()) return {};
    const auto axes = [this](rts::Vec3 v) {
      return photometry::Coordinates{rts::dot(v, down), rts::dot(v, zero), rts::dot(v, ninety)};
    };
    const photometry::Coordinates from = axes(origin - *location), along = axes(direction);
    const double distance = photometry->opening.meet(from, along),
                 length = std::hypot(along[0], along[1], along[2]);
    if (!std::isfinite(distance)) return {};
    const double a = -along[0] / length, x = -along[1] / length, y = -along[2] / length,
                 luminance = double(photometry->towards(a, x, y)) * factor /
                             photometry->opening.projected(a, x, y);
    if (!(luminance > 0)) return {};
    return {float(distance), *color * float(std::fmin(luminance, 1e30))};
  }
  rts::Extent extent() const {
    rts::Extent e;
    e.position = location;
    e.direction = down;
    e.power = flux * float(factor) * (color->r + color->g + color->b) / 3;
    return e;
  }
};

} // namespace

RTS_PLUGIN(Luminaire)

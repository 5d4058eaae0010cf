// luminaire.cpp: the light Luminaire, a measured lamp: its intensity by direction comes from the
// text of an IES file. [render]
#include <cstdio>
#include <new>

#include "ies.h"
#include "openrt/openrts.hpp"

namespace {

struct Luminaire : rts::LightSource<Luminaire> {
  static constexpr const char* text =
      "a measured luminaire: one candela is a radiant intensity of 1";
  rts::Param<rts::String> profile{
      "profile", "text of an ANSI/IES LM-63 file of photometric type C, TILT=NONE"};
  rts::Param<rts::Color> color{"color", {1, 1, 1}, "multiplies the measured intensity"};
  rts::Param<float> intensity{"intensity", 1, "multiplies the measured intensity", 0, 1e9f};
  rts::Param<rts::Vec3> location{"location", {0, 0, 0}, "place of the photometric centre"};
  rts::Param<rts::Vec3> direction{
      "direction", {0, 0, -1}, "towards vertical angle 0: down, as the luminaire hangs"};
  rts::Param<rts::Vec3> reference{
      "reference",
      {1, 0, 0},
      "towards horizontal angle 0; angles grow counter-clockwise seen from above"};

  // Computed by prepare.
  const ies::Photometry* photometry;
  rts::Vec3 down, zero, ninety; // orthonormal axes of the photometric angles
  float flux;
  char message[200];

  const char* prepare() {
    auto* made = new (std::nothrow) ies::Photometry;
    if (!made) return "out of memory";
    photometry = made;
    int line = 0;
    const char* problem = nullptr;
    try {
      problem = ies::parse(*profile, *made, line);
    } catch (const std::bad_alloc&) { problem = "out of memory"; }
    if (problem) {
      std::snprintf(message, sizeof message, "profile, line %d: %s", line, problem);
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
    return nullptr;
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
    constexpr double degrees = 180 / M_PI;
    const double vertical = std::atan2(std::sqrt(x * x + y * y), d) * degrees,
                 horizontal = std::atan2(y, x) * degrees;
    const double seen =
        double(photometry->intensity(vertical, horizontal)) * double(*intensity) / (M_PI * square);
    return {-way, *color * float(std::fmin(seen, 1e30)), {}};
  }
  rts::Extent extent() const {
    rts::Extent e;
    e.position = location;
    e.direction = down;
    e.power = flux * *intensity * (color->r + color->g + color->b) / 3;
    return e;
  }
};

} // namespace

RTS_PLUGIN(Luminaire)

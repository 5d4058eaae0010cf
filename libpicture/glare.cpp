#include "libpicture/glare.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace picture {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

// Returns 8 log10(0.25 / background x sum), at least 0 (CIE 117, equation 1).
double ratingOf(double sum, double background) {
  if (!(sum > 0)) return 0;
  if (!(background > 0)) return infinite;
  return std::max(0.0, 8 * std::log10(.25 / background * sum));
}

} // namespace

// Above the line of sight: S. Guth, "Computing visual comfort ratings for a specific interior
// lighting installation", 1966, in the form of the IESNA Lighting Handbook. Below: T. Iwata, M.
// Tokura, "Position index for a glare source located below the line of vision", 1997.
double positionIndex(const Observer& observer, Vec towards) {
  const double forward = dot(towards, observer.view);
  if (!(forward > 0)) return infinite;
  const Vec aside = towards + observer.view * -forward,
            up = observer.up + observer.view * -dot(observer.up, observer.view);
  const double off = std::atan2(length(aside), forward), // angle from the line of sight
      above = dot(aside, up);
  if (above < 0) {
    const double slope = std::tan(off);
    return 1 + (slope < .6 ? .8 : 1.2) * slope;
  }
  constexpr double degrees = 180 / std::numbers::pi;
  const double s = off * degrees,
               t = std::atan2(length(cross(aside, up)), above) * degrees; // from the vertical
  return std::exp((35.2 - .31889 * t - 1.22 * std::exp(-2 * t / 9)) * 1e-3 * s +
                  (21 + .26667 * t - .002963 * t * t) * 1e-5 * s * s);
}

void GlareSources::add(const Observer& observer, const SeenLuminaire& seen) {
  const double forward = dot(seen.towards, observer.view);
  if (!(forward > 0) || !(seen.area > 0) || !(seen.distance > 0)) return;
  const double square = seen.distance * seen.distance,
               index = positionIndex(observer, seen.towards);
  illuminance += seen.intensity * forward / square;
  // L^2 w / p^2 with L = I / A and w = A / d^2
  sum += seen.intensity * seen.intensity / (seen.area * square * index * index);
}

// The rating falls with the background, so its interval is that of the background, transformed. The
// direct light is known exactly.
GlareRating glareRating(const GlareSources& sources, double eye, double halfWidth) {
  constexpr double pi = std::numbers::pi;
  const double background = (eye - sources.illuminance) / pi, half = halfWidth / pi;
  GlareRating out;
  out.value = ratingOf(sources.sum, background);
  if (sources.sum > 0)
    out.halfWidth = std::max(ratingOf(sources.sum, background - half) - out.value,
                             out.value - ratingOf(sources.sum, background + half));
  if (std::isnan(out.halfWidth)) out.halfWidth = infinite;
  return out;
}

} // namespace picture

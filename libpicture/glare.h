// glare.h: The unified glare rating of luminaires: CIE 117:1995, "Discomfort Glare in Interior
// Lighting", as EN 12464-1 asks for it. Pure functions. [any thread]
#pragma once

#include <cstdint>
#include <vector>

#include "libpicture/luminaires.h"

namespace picture {

// An eye, and where it looks: unit vectors.
struct Observer {
  Vec eye, view, up;
};

// Returns Guth's position index of a source in the direction `towards`, a unit vector; infinite for
// one that is not in front.
double positionIndex(const Observer& observer, Vec towards);

// The luminaires that an observer sees.
struct GlareSources {
  double sum = 0;         // the sum of L^2 w / p^2 in cd^2 / (m^4 sr)
  double illuminance = 0; // by their direct light at the eye, on a plane across the view, lux
  void add(const Observer& observer, const SeenLuminaire& seen);
};

struct GlareRating {
  double value = 0, halfWidth = 0; // 95 %; infinite: the background may be black
};
// Returns the rating. eye: illuminance at the eye by all light, and its half-width. Ratings below 0
// are 0.
GlareRating glareRating(const GlareSources& sources, double eye, double halfWidth);

} // namespace picture

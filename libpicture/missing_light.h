// missing_light.h: Finds light that light samples miss, by pictures whose paths take none and find
// emitters by hitting them alone. Pure function for vv --audit. [any thread]
#pragma once

#include <cstddef>
#include <vector>

namespace picture {

struct MissingLight {
  // Mean of the pictures without light samples minus that of the others, in parts of the latter (of
  // 1 if it is 0), and the half-width of its 95 % interval.
  double more = 0, interval = 0;
  bool inPicture = false;        // the whole picture has more light than chance explains
  size_t tiles = 0, inTiles = 0; // tiles of the picture; those that have more light
  bool any() const { return inPicture || inTiles > 0; }
};

// Compares two series of pictures (RT_RGBA) in which only the seed differs: `sampled` with light
// samples, `hit` without. At least two pictures each. A difference counts from 1 % on. Less light
// in `hit` means nothing, because paths seldom hit small emitters.
MissingLight findMissingLight(const std::vector<std::vector<float>>& sampled,
                              const std::vector<std::vector<float>>& hit, int width, int height,
                              int tileEdge);

} // namespace picture

// differences.h: the differences between the pixels of two pictures, without what their files have
// rounded, and how far those of neighbours are alike. Pure functions of noise_test.cpp. [any
// thread]
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libpicture/files/picture.h"

namespace picture {

// Half-width of a 95 % interval in standard errors.
inline constexpr double halfWidthOfNormal = 1.959963985;

// Tells whether a picture has the channels error and trust.
bool hasErrors(const Picture& picture);

struct Differences {
  int width = 0, height = 0;
  // For each colour, the second picture less the first one, and the first one. A difference within
  // the rounding of the files is 0, and so are all of a pixel that is not finite.
  std::array<std::vector<float>, 3> of, before;
  uint64_t notFinite = 0; // pixels that one picture or both have no finite number for
  uint64_t oneSided = 0;  // such pixels for which the other picture has a finite number
  Differences(const Picture& a, const Picture& b);
  bool isFinite(size_t pixel) const { return !isInfinite_[pixel]; }

 private:
  std::vector<bool> isInfinite_;
};

struct Correlation {
  double factor = 1; // as NoiseTest::correlation
  bool isSmooth = false;
};

// Returns how far the differences of neighbours are alike, from their order alone: a change of the
// mean leaves that of most neighbours as it is. If they are more alike than by a reconstruction
// filter, they are smooth, and the factor is 1.
Correlation correlationOf(const Differences& differences);

} // namespace picture

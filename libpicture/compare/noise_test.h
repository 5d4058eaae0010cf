// noise_test.h: Tells whether two pictures of a scene differ by their noise alone, at a stated rate
// of false alarms. Decision 94 has the reasons. Pure functions, for vv compare. [any thread]
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "libpicture/files/picture.h"

namespace picture {

// The probability that pictures without any difference but noise are called different.
inline constexpr double falseAlarmRate = 1e-6;

// Pictures of fewer pixels a side cannot be judged.
inline constexpr int fewestSide = 8;

enum class Noise : uint8_t {
  unknown, // one picture may have more noise than the other
  equal    // both have as many samples, of the same kind: they could be exchanged
};

// A place whose mean differs by more than noise explains.
struct ChangedPlace {
  int x = 0, y = 0, width = 0, height = 0; // pixels, from the left upper corner
  int colour = 0;                          // 0 red, 1 green, 2 blue, 3 luminance
  double before = 0, change = 0; // mean of the first picture, and what the second has more
  double chance = 1;             // probability of such a difference by noise
};

// Returns "red", "green", "blue" or "luminance".
const char* changedColour(const ChangedPlace& place);

// The mean change of a square of pixels that would have been found in half of all squares.
struct SmallestChange {
  int width = 0, height = 0; // pixels
  double change = 0;         // infinite: none would
};

struct NoiseTest {
  bool isSame = true;
  size_t squares = 0, pixels = 0; // tests of the means of squares, and of single pixels
  size_t found = 0;               // tests that found a difference
  // The variance of a sum of pixels, divided by the sum of their variances. It is above 1 where a
  // reconstruction filter gives samples to several pixels.
  double correlation = 1;
  // Differences are more alike than those of a reconstruction filter: a change, or the pictures
  // were denoised. The rate of false alarms does not hold for the latter.
  bool isSmooth = false;
  uint64_t different = 0;            // pixels that differ by more than the files have rounded
  uint64_t notFinite = 0;            // pixels left out because a value is not finite
  uint64_t oneSided = 0;             // those of them that are finite in one picture: never noise
  std::vector<ChangedPlace> changes; // the surest first, at most 5, which do not overlap
  std::vector<SmallestChange> least; // from small squares to the whole picture
};

// Compares the means of squares of 8x8 pixels and more. If both pictures have the channels error
// and trust, single pixels are judged by them, too. The pictures have rgba, one size, and both
// radiance or both display colours; their samples are independent.
// rate: that of false alarms.
NoiseTest testNoise(const Picture& a, const Picture& b, Noise noise, double rate = falseAlarmRate);

// Returns the difference of each colour of each pixel in standard errors, from -99 to 99: from the
// error bars if both pictures have some, otherwise from the 7x7 pixels around.
std::vector<float> standardErrors(const Picture& a, const Picture& b);

} // namespace picture

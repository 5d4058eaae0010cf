// comparison.h: Compares two pictures of any renderer: reads them, judges their differences, and
// says so as JSON. For vv compare and for Python. [any thread]
#pragma once

#include <array>
#include <optional>
#include <stdexcept>
#include <string>

#include "libpicture/compare/flip.h"
#include "libpicture/compare/noise_test.h"
#include "libpicture/coverage.h"
#include "libpicture/files/picture.h"

namespace picture {

// Pictures cannot be compared, or not as it is asked for. The text names them.
struct CompareError : std::runtime_error {
  using runtime_error::runtime_error;
};

// The facts that files do not have.
struct ComparisonFacts {
  std::optional<std::array<int, 2>> samples; // per pixel, of each picture
  // Error bars are made of the channel variance: that of samples if `samples` or the channel
  // samples tells how many, otherwise that of the pixel.
  bool byVariance = false;
};

// Two pictures, and how they differ: the second less the first.
struct Comparison {
  std::array<std::string, 2> names;
  std::array<Picture, 2> pictures;
  Noise noise = Noise::unknown;
  NoiseTest test;
  Difference difference;
  Flip flip;

  bool usesErrorBars() const;
  double biasInterval() const; // half-width, which allows for pixels that are alike
};

// Reads a picture with the channels that a comparison uses. Throws InputError.
Picture readForComparison(const std::string& path);
// names: for messages. The pictures have rgba; those with error and trust are judged by them.
// Throws CompareError.
Comparison comparisonOf(std::array<std::string, 2> names, std::array<Picture, 2> pictures,
                        const ComparisonFacts& facts);
std::string comparisonJson(const Comparison& comparison);

} // namespace picture

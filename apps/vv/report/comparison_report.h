// comparison_report.h: Says how two pictures differ (vv compare). [main thread]
#pragma once

#include <array>
#include <string>

#include "libpicture/compare/flip.h"
#include "libpicture/compare/noise_test.h"
#include "libpicture/coverage.h"
#include "libpicture/files/picture.h"

namespace vv {

// Two pictures, and how they differ: the second less the first.
struct Comparison {
  std::array<std::string, 2> paths;
  picture::Picture a, b;
  picture::Noise noise = picture::Noise::unknown;
  picture::NoiseTest test;
  picture::Difference difference;
  picture::Flip flip;
};

std::string comparisonText(const Comparison& comparison);
std::string comparisonJson(const Comparison& comparison);

} // namespace vv

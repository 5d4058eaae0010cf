// as_printed.h: A float of a file as the number that its author wrote. Sums of such numbers are
// those that a person expects: 0.05 and 0.01 are 0.06, and not 0.060000002. [any thread]
#pragma once

#include <cstdlib>

#include <fmt/format.h>

namespace vv {

// Returns the shortest decimal number that reads as this float: 0.1, not 0.10000000149.
inline double asPrinted(float number) {
  return std::strtod(fmt::format("{}", number).c_str(), nullptr);
}

} // namespace vv

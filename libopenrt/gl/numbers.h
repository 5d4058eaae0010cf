// numbers.h: Turns the floating-point numbers of calls into integers, whatever they are.
#pragma once

#include <cmath>
#include <limits>

#include "openrt/gl_types.h"

namespace rtgl {

// Returns the nearest integer, or the end of the range; 0 for NaN.
inline GLint toInteger(double number) {
  constexpr double least = std::numeric_limits<GLint>::min(),
                   most = std::numeric_limits<GLint>::max();
  if (!(number > least)) return std::isnan(number) ? 0 : std::numeric_limits<GLint>::min();
  return number < most ? static_cast<GLint>(std::lround(number))
                       : std::numeric_limits<GLint>::max();
}

// Returns the value of an enumeration, or a name; a value that nothing has for what is none.
inline GLuint toName(double number) {
  constexpr GLuint none = std::numeric_limits<GLuint>::max();
  return number >= 0 && number < none ? static_cast<GLuint>(number) : none;
}

} // namespace rtgl

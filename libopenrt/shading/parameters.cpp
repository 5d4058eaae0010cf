// parameters.cpp: types and ranges of shader parameters. Pure functions, any thread.
#include "shading/parameters.h"

#include <cmath>

namespace openrt {
namespace {

std::string problem(const RtsParam& param, double value) {
  const bool ranged = param.minimum != 0 || param.maximum != 0, finite = std::isfinite(value);
  if (finite && (!ranged || (value >= param.minimum && value <= param.maximum))) return {};
  const std::string what = std::string("parameter ") + param.name + ": ";
  if (!finite) return what + "not finite";
  return what + std::to_string(value) + " is outside " + std::to_string(param.minimum) + " .. " +
         std::to_string(param.maximum);
}

} // namespace

size_t parameterFloats(RtsType type) {
  switch (type) {
  case RTS_FLOAT: return 1;
  case RTS_VEC2: return 2;
  case RTS_VEC3:
  case RTS_COLOR: return 3;
  case RTS_VEC4: return 4;
  case RTS_MATRIX: return 16;
  default: return 0;
  }
}

std::string valueProblem(const RtsParam& param, std::span<const float> values) {
  for (float v : values)
    if (std::string text = problem(param, v); !text.empty()) return text;
  return {};
}

std::string valueProblem(const RtsParam& param, int value) { return problem(param, value); }

} // namespace openrt

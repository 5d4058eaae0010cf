// parameters.h: types and valid values of shader parameters. Used by the API to check values from
// the application, and by the reader of recordings to check values from a file. Pure functions.
#pragma once

#include <span>
#include <string>

#include "openrt/openrts.h"

namespace openrt {

// Returns the number of floats of a parameter type; 0 for types that are not floats, and for lists,
// which have any number.
size_t parameterFloats(RtsType type);

// Returns why the values are invalid (not finite or out of range), or an empty string.
std::string valueProblem(const RtsParam& param, std::span<const float> values);
std::string valueProblem(const RtsParam& param, int value);

} // namespace openrt

// parameters.h: what values a class's parameter takes. Used by the API for what an application
// sets, and by the reader of recordings for what a file claims. Pure functions.
#pragma once

#include <span>
#include <string>

#include "openrt/openrts.h"

namespace openrt {

// Floats that a parameter of this type has; 0 for types of another kind and for lists, which have
// any number.
size_t parameterFloats(RtsType type);

// Why the parameter cannot have these values, or an empty text: not finite, or out of its range.
std::string valueProblem(const RtsParam& param, std::span<const float> values);
std::string valueProblem(const RtsParam& param, int value);

} // namespace openrt

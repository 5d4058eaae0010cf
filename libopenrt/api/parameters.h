// parameters.h: Handles shader parameters in API calls: checks handles and types, and sets values
// per triangle and per vertex. Called on the application's thread.
#pragma once

#include <initializer_list>
#include <span>

#include "api/context.h"

namespace openrt {

// Returns the RT_PER_* value of a parameter.
inline RTenum frequencyOf(const RtsClass& table, uint32_t index) {
  return table.frequency ? table.frequency[index] : RTenum(RT_PER_SHADER);
}

// Returns the class's parameter with this handle. Throws RT_INVALID_PARAMETER if there is none or
// if its type is not in the list.
const RtsParam& declaredParameter(const RtsClass& table, int handle,
                                  std::initializer_list<RtsType> types);

inline bool inList(const Context& c) { return c.definition && c.definition->builder.inList(); }

// Sets, between rtBegin and rtEnd, the value for the following triangles or vertices. Returns false
// outside rtBegin and rtEnd, and for per-shader parameters.
bool setVaryingValue(Context& c, int handle, std::initializer_list<RtsType> types,
                     std::span<const float> values);

} // namespace openrt

// parameters.h: parameters of shaders as the API's calls name them: handles, types, and values of a
// geometry's own. Application thread.
#pragma once

#include <initializer_list>
#include <span>

#include "api/context.h"

namespace openrt {

// RT_PER_* of a parameter.
inline RTenum frequencyOf(const RtsClass& table, uint32_t index) {
  return table.frequency ? table.frequency[index] : RTenum(RT_PER_SHADER);
}

// The class's parameter with this handle, which must be of one of these types: else
// RT_INVALID_PARAMETER.
const RtsParam& declaredParameter(const RtsClass& table, int handle,
                                  std::initializer_list<RtsType> types);

inline bool inList(const Context& c) { return c.definition && c.definition->builder.inList(); }

// Between rtBegin and rtEnd: sets the value for the triangles or vertices that follow. False
// outside lists, and for a parameter of the whole shader.
bool setOwnValue(Context& c, int handle, std::initializer_list<RtsType> types,
                 std::span<const float> values);

} // namespace openrt

// transports.h: the one table of light transports (RT_TRANSPORT_*) and of what distinguishes them.
// [any thread]
#pragma once

#include <cstddef>
#include <iterator>

#include "openrt/frame.h"

namespace openrt {

struct TransportTraits {
  const char* name;
  bool tracesPaths; // follows light between surfaces, with random decisions
  bool tracesLight; // follows light from lamps, too
};

// Indexed by RT_TRANSPORT_*. RT_TRANSPORT_AUTO is resolved before a frame is rendered.
inline constexpr TransportTraits transports[] = {
    {"auto", false, false}, {"direct", false, false}, {"whitted", false, false},
    {"path", true, false},  {"light", true, true},
};
static_assert(std::size(transports) == size_t(RT_TRANSPORT_LIGHT) + 1);
inline constexpr const char* transportChoices = "auto direct whitted path light";

constexpr bool isTransport(RTenum transport) { return transport < std::size(transports); }
constexpr bool tracesPaths(RTenum transport) {
  return isTransport(transport) && transports[transport].tracesPaths;
}

} // namespace openrt

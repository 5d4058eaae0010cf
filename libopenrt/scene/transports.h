// transports.h: the one table of light transports (RT_TRANSPORT_*) and of what distinguishes them.
// [any thread]
#pragma once

#include <cstddef>
#include <iterator>

#include "openrt/frame.h"

namespace openrt {

struct TransportTraits {
  bool tracesPaths; // the transport follows light between surfaces, with random decisions
};

// Both are in the order of RT_TRANSPORT_*. RT_TRANSPORT_AUTO is resolved before a frame is
// rendered.
inline constexpr const char* transportChoices = "auto direct whitted path light";
inline constexpr TransportTraits transports[] = {{false}, {false}, {false}, {true}, {true}};
static_assert(std::size(transports) == size_t(RT_TRANSPORT_LIGHT) + 1);

constexpr bool isTransport(RTenum transport) { return transport < std::size(transports); }
constexpr bool tracesPaths(RTenum transport) {
  return isTransport(transport) && transports[transport].tracesPaths;
}

} // namespace openrt

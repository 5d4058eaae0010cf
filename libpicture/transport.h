// transport.h: Names and describes transports, and the light that they omit. [any thread]
#pragma once

#include <string>
#include <vector>

#include "openrt/openrt.h"

namespace picture {

// "path" for RT_TRANSPORT_PATH and so on; "plug-in" for others
const char* transportName(RTenum transport);

// Returns what the library knows about RT_TRANSPORT_*. For other numbers every member is 0.
RTtransportInfo transportInfo(RTenum transport);

// A kind of light that a transport omits in a scene.
struct OmittedLight {
  const char* name; // identifier for programs: "sky" and so on
  const char* text; // description for people
};
// leaves: RTstats.transport.leavesOut.
std::vector<OmittedLight> omittedLights(RTenum transport, uint32_t leaves);
std::vector<std::string> omittedLightNames(const RTstats& stats);

} // namespace picture

// transport.h: Converts transports to and from their names, and describes them. [any thread]
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "openrt/openrt.h"

namespace picture {

std::string transportNames(); // returns "auto, direct, whitted, path or light"

std::optional<int> transportNamed(std::string_view name); // returns the RT_TRANSPORT_* value
// "path" for RT_TRANSPORT_PATH and so on; "plug-in" for others
const char* transportName(RTenum transport);

// Returns what the library knows about RT_TRANSPORT_*. For other numbers every member is 0.
RTtransportInfo transportInfo(RTenum transport);

// A kind of light that a transport omits in a scene.
struct OmittedLight {
  const char* name; // identifier for programs: "sky" and so on
  const char* text; // description for people
};
// leaves: RTstats.transportLeavesOut.
std::vector<OmittedLight> omittedLights(RTenum transport, uint32_t leaves);
std::vector<std::string> omittedLightNames(const RTstats& stats);

} // namespace picture

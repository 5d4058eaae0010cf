// transport.h: the transports by name. [any thread]
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "openrt/openrt.h"

namespace picture {

inline constexpr const char* transportNames = "auto, direct, whitted, path or light";

std::optional<int> transportNamed(std::string_view name); // RT_TRANSPORT_*
const char* transportName(RTenum transport); // "path" of RT_TRANSPORT_PATH ...; "plug-in" of others

// A kind of light that a transport leaves out of a scene.
struct LeftOut {
  const char* name; // for programs: "sky" ...
  const char* text; // for people
};
// leaves: RTstats.transportLeavesOut.
std::vector<LeftOut> leftOutBy(RTenum transport, uint32_t leaves);
std::vector<std::string> leftOutNames(const RTstats& stats);

} // namespace picture

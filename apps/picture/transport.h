// transport.h: the transports by name. [any thread]
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "openrt/openrt.h"

namespace picture {

inline constexpr const char* transportNames = "auto, direct, whitted, path or light";

std::optional<int> transportNamed(std::string_view name); // RT_TRANSPORT_*
const char* transportName(RTenum transport);              // "path" of RT_TRANSPORT_PATH ...; "plug-in" of others

} // namespace picture

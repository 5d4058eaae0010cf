// transport_words.h: Describes the light transport in words and as JSON. [any thread]
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "libpicture/renderer.h"

namespace vv {

// Returns how accurate a picture with the transport of these statistics is, and which of the
// scene's light it omits.
std::string transportClaim(const RTstats& stats, const picture::RenderSettings& settings);

// Returns the transport of a picture as JSON: which, why, what it claims and what it leaves out.
nlohmann::ordered_json transportJson(const RTstats& stats, const picture::RenderSettings& settings);

} // namespace vv

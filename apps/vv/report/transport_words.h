// transport_words.h: Describes the light transport in words. [any thread]
#pragma once

#include <string>

#include "libpicture/renderer.h"

namespace vv {

// Returns how accurate a picture with the transport of these statistics is, and which of the
// scene's light it omits.
std::string transportClaim(const RTstats& stats, const picture::RenderSettings& settings);

} // namespace vv

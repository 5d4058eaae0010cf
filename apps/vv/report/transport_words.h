// transport_words.h: how light was followed, in words. [any thread]
#pragma once

#include <string>

#include "libpicture/renderer.h"

namespace vv {

// Says how exact a picture is that the transport of these statistics made, and which of the scene's
// light it leaves out.
std::string transportClaim(const RTstats& stats, const picture::RenderSettings& settings);

} // namespace vv

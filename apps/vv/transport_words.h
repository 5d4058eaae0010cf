// transport_words.h: how light was followed, in words. [any thread]
#pragma once

#include <string>

#include "picture/renderer.h"

namespace vv {

// What a picture made by this transport is, and what it leaves out.
std::string transportClaim(RTenum transport, const picture::RenderSettings& settings);

} // namespace vv

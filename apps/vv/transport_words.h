// transport_words.h: how light was followed, in words. [any thread]
#pragma once

#include <string>

#include "picture/renderer.h"

namespace vv {

// "path" of RT_TRANSPORT_PATH ...
const char* transportName(RTenum transport);
// What a picture made by this transport is, and what it leaves out.
std::string transportClaim(RTenum transport, const picture::RenderSettings& settings);

} // namespace vv

// overlay.h: what the window tells of the picture, in lines of text. Pure functions. [any thread]
#pragma once

#include <string>
#include <vector>

#include "window/session.h"

namespace vv {

enum class OverlayLevel : uint8_t { none, brief, all };

// A line beginning with a tab is of less weight.
std::vector<std::string> overlayLines(const SessionFacts& facts, bool paused, OverlayLevel level);
std::vector<std::string> helpLines();

} // namespace vv

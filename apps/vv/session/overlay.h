// overlay.h: Formats information about the picture as lines of text. Pure functions.
// [any thread]
#pragma once

#include <string>
#include <vector>

#include "session/session.h"

namespace vv {

enum class OverlayLevel : uint8_t { none, brief, all };

// A line that begins with a tab is drawn in a weaker colour.
// Says what has filtered a preview. denoisedBy: as in LivePicture.
std::string filterText(const std::string& denoisedBy);

std::vector<std::string> overlayLines(const SessionFacts& facts, bool paused, OverlayLevel level);
// Lists the keys of the window, or of its editor.
std::vector<std::string> helpLines(bool isEditing);

} // namespace vv

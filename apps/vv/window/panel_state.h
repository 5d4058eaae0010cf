// panel_state.h: Keeps the widths of the editor's panels between sessions, in a small file of the
// user's state folder. [any thread]
#pragma once

#include <string>

namespace vv {

struct PanelWidths {
  float outline = 0, sheet = 0; // in units of the desktop; 0: the user has not chosen one
  bool operator==(const PanelWidths&) const = default;
};

// Returns the file: vv/panels in $XDG_STATE_HOME or ~/.local/state; "" if there is no such folder.
std::string panelStateFile();
// Reads the file. Whatever is no width in it is ignored, and a file that cannot be read.
PanelWidths readPanelWidths(const std::string& file);
// Writes the file, if that is possible.
void writePanelWidths(const std::string& file, const PanelWidths& widths);

} // namespace vv

// save_edits.h: Writes the edited file of a world, for vv and the Python binding. [the thread that
// owns the world]
#pragma once

#include <string>

#include "xvrml/edit.h"

namespace picture {

// Writes a world's file with all edits, atomically, to a regular file. path: where to; "" or the
// world's own path saves the edits. overwrite: also replaces the world's file if another program
// has written to it since it was read. Throws xvrml::EditError if there is no right text or the
// file was written to, and std::runtime_error, which names the file and the reason, if it cannot be
// written.
void saveEdits(xvrml::Editor& editor, const xvrml::World& world, const std::string& path,
               bool overwrite);

} // namespace picture

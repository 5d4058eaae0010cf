// import.h: Puts other files into the world that is edited. [the browser's thread, while the world
// can be used]
#pragma once

#include <string>

#include "edit/world_editor.h"

namespace vv {

// Adds an Inline with the content of a file, a world or a mesh, as one step, and selects it. Its
// URL is relative, and it gets the name of the file. file: a relative path counts from the folder
// of the world's file, and ~ is the user's home folder. Throws xvrml::EditError if the file cannot
// be read as a world, or is this one's.
void importFile(WorldEditor& editor, const std::string& file);

} // namespace vv

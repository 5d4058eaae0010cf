// window.h: Runs vv's window. [main thread]
#pragma once

#include <string>
#include <vector>

#include "options/options.h"

namespace vv {

// Opens the window and returns an exit code when it is closed; error messages have been printed.
// `arguments` are those of the command line. Throws Failure if there is no display, or if vv was
// built without windows.
int runWindow(const Options& options, const std::vector<std::string>& arguments);

// Returns the library that opens the window, with its version; "": vv was built without windows.
std::string windowLibrary();

// Returns the library that draws the editor, with its version; "": vv was built without it.
std::string editorLibrary();

} // namespace vv

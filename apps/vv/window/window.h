// window.h: vv's window. [main thread]
#pragma once

#include <string>
#include <vector>

#include "options/options.h"

namespace vv {

// Opens the window and returns an exit code when it is closed; what went wrong has been said.
// arguments: of the command line. Throws Failure where there is no display, or where vv was built
// without windows.
int runWindow(const Options& options, const std::vector<std::string>& arguments);

} // namespace vv

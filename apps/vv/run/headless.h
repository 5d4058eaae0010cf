// headless.h: Runs every job of vv that needs no window: load, check, list, write and render. [main
// thread]
#pragma once

#include "options/options.h"

namespace vv {

// Returns an exit code; error messages have been printed.
int runHeadless(const Options& options, const std::string& commandLine);

} // namespace vv

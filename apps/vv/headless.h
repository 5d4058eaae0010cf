// headless.h: everything vv does without a window: load, check, list, write, render. [main thread]
#pragma once

#include "options/options.h"

namespace vv {

// Returns an exit code; what went wrong has been said.
int runHeadless(const Options& options, const std::string& commandLine);

} // namespace vv

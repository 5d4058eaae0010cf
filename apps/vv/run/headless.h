// headless.h: Runs what needs no window: load, check, inspect, write and render. [main thread]
#pragma once

#include "options/options.h"
#include "run/inspect.h"

namespace vv {

// Returns an exit code; error messages have been printed.
int runHeadless(const Options& options, const std::string& commandLine,
                const Inspection& inspection);

} // namespace vv

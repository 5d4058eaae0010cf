// headless.h: Runs what needs no window: load, check, inspect, write and render. [main thread]
#pragma once

#include "options/options.h"
#include "run/inspect.h"

namespace vv {

// Returns an exit code; error messages have been printed.
// words: the command line; the first is the program.
int runHeadless(const Options& options, const std::vector<std::string>& words,
                const Inspection& inspection);

} // namespace vv

// jobs.h: Runs what the command line asks for: a job of the table, or else pictures, checks, the
// window. [main thread]
#pragma once

#include <string>
#include <vector>

#include "options/options.h"

namespace vv {

// Returns an exit code. `words` are those of the command line. Throws Failure and UsageError.
int runJob(Options options, const std::vector<std::string>& words);

} // namespace vv

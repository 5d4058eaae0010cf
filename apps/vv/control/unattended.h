// unattended.h: Runs a world that nobody looks at, for the clients of --control: its time passes,
// Scripts and sensors work, and pictures are rendered when a client asks for one. [main thread]
#pragma once

#include "options/options.h"

namespace vv::control {

// Returns an exit code; error messages have been printed. Throws Failure and UsageError.
int runUnattended(const Options& options);

} // namespace vv::control

// read_script.h: Reads the input script that the command line names. [main thread]
#pragma once

#include "options/options.h"

namespace vv {

// Reads the script of --input, if there is one. A still picture shows the end of it by default.
// Throws Failure with exitInput.
void readScript(Options& options);

} // namespace vv

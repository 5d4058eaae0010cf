// exit_code.h: Says why vv ends, and with which exit code. [main thread]
#pragma once

#include "options/options.h"

namespace vv {

// Prints the exception that is being handled, and returns the exit code that it ends vv with:
// exitTryAgain where memory, threads or file descriptors are short. Call it in a catch block.
// options: names the option of a file that turned out to be unusable; null if there are none yet.
int sayException(const Options* options);

} // namespace vv

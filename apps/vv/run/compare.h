// compare.h: vv compare: tells whether two pictures, of any renderer, differ by more than their
// noise. No world is read. [main thread]
#pragma once

#include "options/options.h"

namespace vv {

// Returns exitDone if they do not, and exitProblems if they do. Throws Failure for files that
// cannot be read or compared.
int runCompare(const Options& options);

} // namespace vv

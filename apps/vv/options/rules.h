// rules.h: which options can be used together.
#pragma once

#include "options.h"

namespace vv {

// Throws UsageError if options of the command line contradict each other, or one lacks what it
// needs. The first broken rule is reported.
void checkTogether(const Options& options);

} // namespace vv

// film_join.h: vv film --join: makes a film of pictures in files, such as those that the jobs of a
// farm have written. No world is read. [main thread]
#pragma once

#include "options/options.h"

namespace vv {

// Returns an exit code. Throws Failure, which names the picture that cannot be used.
int joinFilm(const Options& options);

} // namespace vv

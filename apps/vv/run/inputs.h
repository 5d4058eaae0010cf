// inputs.h: Checks, before anything is rendered, the files and folders that the command line names
// beside the world. [main thread]
#pragma once

#include "options/options.h"

namespace vv {

// Throws Failure with exitInput if a picture of --environment, --background or --compare cannot be
// read, or if that of --compare has another size than the picture to make.
void checkInputs(const Options& options);

// Prints a warning for each folder of --shader-path, --script-path and --node-path that is missing.
void warnOfFolders(const Options& options);
// Prints a warning if the sun of --sky was to shine and is not above the horizon.
void warnOfSky(const Options& options);

} // namespace vv

// write_world.h: Writes the world of --write: as VRML97 or X3D, or as an export. [main thread]
#pragma once

#include "options/options.h"
#include "xvrml/browser.h"

namespace vv {

// An export has the world at the time of --time, and says what its format has nothing for. Throws
// std::runtime_error.
void writeWorld(const Options& options, xvrml::Browser& browser);

} // namespace vv

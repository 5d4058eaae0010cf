// radiance.h: pictures of radiance, for light from all around: files that the user names on the
// command line. [any thread]
#pragma once

#include <string>

#include "xvrml/radiance.h"

namespace picture {

// Reads what worlds may name too, and every OpenEXR file that OpenEXR's library can read: the file
// is the user's own. Throws std::runtime_error.
xvrml::RadianceImage readRadiance(const std::string& path);

} // namespace picture

// radiance.h: Reads environment maps that the user names on the command line. [any thread]
#pragma once

#include <string>

#include "xvrml/radiance.h"

namespace picture {

// Reads the formats that worlds may name, and every OpenEXR file that OpenEXR's library can read;
// the file is the user's own, so it is trusted. Throws InputError (picture.h).
xvrml::RadianceImage readRadiance(const std::string& path);

} // namespace picture

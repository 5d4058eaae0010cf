// url.h: parses URLs, and rewrites relative ones for another file. resolveUrl() of xvrml/world.h is
// implemented beside these functions. [any thread]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "xvrml/types.h"

namespace xvrml {

// Returns the scheme of "scheme:rest" in lower case, "" if there is none. A single letter is a
// drive of old Windows paths.
std::string urlScheme(std::string_view url);

// Rewrites relative URLs that count from the file `from` so that they lead to the same files when
// they count from the file `to`. Files with relative paths are in or beside the current directory.
// URLs with a scheme, absolute paths and "#name" stay as they are.
void rebaseUrls(MFString& urls, const std::string& from, const std::string& to);

} // namespace xvrml

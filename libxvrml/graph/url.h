// url.h: parses URLs. Functions of xvrml/world.h about URLs are implemented beside this one.
// [any thread]
#pragma once

#include <string>
#include <string_view>

namespace xvrml {

// Returns the scheme of "scheme:rest" in lower case, "" if there is none. A single letter is a
// drive of old Windows paths.
std::string urlScheme(std::string_view url);

} // namespace xvrml

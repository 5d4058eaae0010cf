// url.h: parts of URLs, as the loader and those who look for programs of Scripts need them. Pure; any thread.
#pragma once

#include <string>
#include <string_view>

namespace xvrml {

// The scheme of "scheme:rest" in lower case, empty if there is none. One letter is a drive of old Windows paths.
std::string urlScheme(std::string_view url);

} // namespace xvrml

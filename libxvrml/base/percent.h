// percent.h: decodes bytes that a URL writes as %XX (RFC 3986 2.1). [any thread]
#pragma once

#include <string>
#include <string_view>

namespace xvrml {

// Returns the text with each %XX as its byte. A % without two hexadecimal digits stays.
std::string percentDecoded(std::string_view text);

} // namespace xvrml

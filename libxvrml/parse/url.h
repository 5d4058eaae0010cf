// url.h: parsing of URLs, for the loader and for the code that loads the programs of Scripts. Pure
// functions, any thread.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace xvrml {

// Returns the scheme of "scheme:rest" in lower case, "" if there is none. A single letter is a
// drive of old Windows paths.
std::string urlScheme(std::string_view url);

// The content of a data: URL (RFC 2397). decodeDataUrl returns false, and the reason in `why`, if
// the URL is none or holds more than `most` bytes.
struct DataUrl {
  std::string type; // MIME type in lower case, without parameters; may be empty
  std::string bytes;
};
bool decodeDataUrl(std::string_view url, uint64_t most, DataUrl& out, std::string& why);

} // namespace xvrml

// url.h: parts of URLs, as the loader and those who look for programs of Scripts need them. Pure;
// any thread.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace xvrml {

// The scheme of "scheme:rest" in lower case, empty if there is none. One letter is a drive of old
// Windows paths.
std::string urlScheme(std::string_view url);

// What a data: URL holds (RFC 2397). False, and why, if it is none, or holds more than `most`
// bytes.
struct DataUrl {
  std::string type; // in lower case, without parameters; may be empty
  std::string bytes;
};
bool decodeDataUrl(std::string_view url, uint64_t most, DataUrl& out, std::string& why);

} // namespace xvrml

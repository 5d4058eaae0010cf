// data_url.h: data: URLs, of which Scripts, pictures and the buffers of glTF make use. [any thread]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace xvrml {

bool isDataUrl(std::string_view url); // without regard to case
// The content of a data: URL (RFC 2397). decodeDataUrl returns false, and the reason in `why`, if
// the URL is none or holds more than `most` bytes.
struct DataUrl {
  std::string type; // MIME type in lower case, without parameters; may be empty
  std::string bytes;
};
bool decodeDataUrl(std::string_view url, uint64_t most, DataUrl& out, std::string& why);

} // namespace xvrml

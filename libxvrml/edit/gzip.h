// gzip.h: packs the text of a file. [any thread]
#pragma once

#include <string>
#include <string_view>

namespace xvrml {

// Returns the bytes of a gzip file with this text. Throws std::bad_alloc.
std::string packed(std::string_view text);

} // namespace xvrml

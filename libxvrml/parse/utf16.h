// utf16.h: finds VRML and ClassicVRML texts that were saved in UTF-16, and converts them to UTF-8,
// which their standards ask for. Pure functions, any thread.
#pragma once

#include <string_view>

#include "parse/source.h"

namespace xvrml {

// Returns whether bytes begin with the byte-order mark of UTF-16 and the '#' of a header. XML in
// UTF-16 begins with another character; its reader converts it.
bool isUtf16Vrml(std::string_view bytes);

// Appends the UTF-8 of such bytes to `out`, which is empty. Half of a surrogate pair becomes
// U+FFFD. Returns false if the budget of `out` has not enough left. Throws std::bad_alloc.
bool convertUtf16(std::string_view bytes, TextBuffer& out);

} // namespace xvrml

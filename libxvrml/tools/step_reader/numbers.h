// numbers.h: finds numbers of STEP files that Open CASCADE does not stand. [one thread]
#pragma once

#include <string_view>

namespace xvrml::decoding {

// Throws std::runtime_error with the line of the first number (ISO 10303-21, 6.4.2) that is beyond
// the range of double precision, or a word such as NAN. Open CASCADE takes it as infinite or no
// number, and divides such surfaces for ever.
void checkNumbers(std::string_view file);

} // namespace xvrml::decoding

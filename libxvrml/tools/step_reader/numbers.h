// numbers.h: checks the numbers of a STEP file before Open CASCADE reads them. [one thread]
#pragma once

#include <cstdint>
#include <span>

namespace xvrml::decoding {

// Throws std::runtime_error that names the line if a number is not finite, or has a magnitude
// beyond 1e30: Open CASCADE would compute for ever.
void checkNumbers(std::span<const uint8_t> file);

} // namespace xvrml::decoding

// cryptomatte.h: what OpenEXR files hold of the channel cryptomatte: layers of hashes and shares,
// and the attributes that name them. Reference: J. Friedman, A. C. Jones, "Cryptomatte
// Specification", version 1.2.0, Psyop, 2018. [any thread]
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "libpicture/files/picture.h"

namespace picture {

// Returns the hash of a name: MurmurHash3_x86_32 of its bytes with the seed 0 (A. Appleby, 2011),
// with one bit of the exponent changed where the float of these bits would not be a normal number.
uint32_t cryptomatteHash(std::string_view name);

// Returns the channel with hashes in the place of numbers. Shapes of one name become one. Bytes of
// names that are not UTF-8 count as U+FFFD, as in the manifest.
std::vector<float> cryptomatteLayers(const Picture& picture);

// Returns the attributes, as pairs of key and value.
std::vector<std::pair<std::string, std::string>> cryptomatteAttributes(const Picture& picture);

} // namespace picture

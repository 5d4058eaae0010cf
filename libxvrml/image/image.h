// image.h: pictures that worlds name: PNG, JPEG, GIF (first frame), by content. [any thread]
#pragma once

#include <string>

#include "xvrml/limits.h"
#include "xvrml/types.h"

namespace xvrml {

// Decodes a picture to 8 bits a component, rows from the bottom up, components 1 (grey), 2 (grey, alpha), 3, 4 as the
// file has them (palettes expand; a palette or tRNS transparency gives alpha; 16 bits are rounded).
// Throws std::runtime_error saying what is wrong (missing, not a picture, damaged, beyond limits.imagePixels).
Image readImage(const std::string& path, const Limits& limits);
Image decodeImage(const uint8_t* bytes, size_t size, const Limits& limits);

} // namespace xvrml

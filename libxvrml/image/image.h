// image.h: reads pictures of worlds: PNG, JPEG, GIF (first frame), WebP, BMP and TGA, recognised by
// content. [any thread]
#pragma once

#include <cstdint>
#include <string>

#include "base/budget.h"
#include "xvrml/limits.h"
#include "xvrml/types.h"

namespace xvrml {

// The memory that a decoded picture may use. It is checked before anything of that size is
// allocated.
struct ImageRoom {
  const Limits& limits;
  // For the decoded picture: the rest of the total for a world's pictures.
  uint64_t bytes = ~uint64_t(0);
  // The world's budget; decoders compare with it and reserve nothing. It also has the process that
  // decodes foreign formats.
  Budget* budget = nullptr;
};

// Decode a picture to 8 bits per component, with rows from the bottom up. The components are those
// of the file: 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA. Palettes are expanded; transparency of a
// palette or a tRNS chunk becomes alpha; 16 bits are rounded. Throw std::runtime_error with the
// reason: missing, not a picture, damaged, or too large for the room.
Image readImage(const std::string& path, const ImageRoom& room);
Image decodeImage(const uint8_t* bytes, size_t size, const ImageRoom& room);
inline Image readImage(const std::string& path, const Limits& limits) {
  return readImage(path, ImageRoom{limits});
}
inline Image decodeImage(const uint8_t* bytes, size_t size, const Limits& limits) {
  return decodeImage(bytes, size, ImageRoom{limits});
}

} // namespace xvrml

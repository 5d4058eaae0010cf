// image.h: pictures that worlds name: PNG, JPEG, GIF (first frame), by content. [any thread]
#pragma once

#include <cstdint>
#include <string>

#include "base/budget.h"
#include "xvrml/limits.h"
#include "xvrml/types.h"

namespace xvrml {

// What a decoded picture may take, checked before anything of its size is allocated.
struct ImageRoom {
  const Limits& limits;
  uint64_t bytes =
      ~uint64_t(0); // of the decoded picture: what is left of the total of a world's pictures
  const Budget* budget = nullptr; // of the world; decoders ask it and take nothing
};

// Decodes a picture to 8 bits a component, rows from the bottom up, components 1 (grey), 2 (grey,
// alpha), 3, 4 as the file has them (palettes expand; a palette or tRNS transparency gives alpha;
// 16 bits are rounded). Throws std::runtime_error saying what is wrong (missing, not a picture,
// damaged, too large for the room).
Image readImage(const std::string& path, const ImageRoom& room);
Image decodeImage(const uint8_t* bytes, size_t size, const ImageRoom& room);
inline Image readImage(const std::string& path, const Limits& limits) {
  return readImage(path, ImageRoom{limits});
}
inline Image decodeImage(const uint8_t* bytes, size_t size, const Limits& limits) {
  return decodeImage(bytes, size, ImageRoom{limits});
}

} // namespace xvrml

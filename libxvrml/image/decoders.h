// decoders.h: one function a picture format, chosen by image.cpp. Each gives rows from the bottom
// up or throws std::runtime_error; none prints, exits or leaves anything behind. [any thread]
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include "image/image.h"
#include "xvrml/radiance.h"

namespace xvrml {

// Returns the bytes of a regular file of at most limits.fileBytes; throws std::runtime_error.
std::vector<uint8_t> readPictureFile(const std::string& path, const ImageRoom& room);
inline std::vector<uint8_t> readPictureFile(const std::string& path, const Limits& limits) {
  return readPictureFile(path, ImageRoom{limits});
}

Image decodePng(std::span<const uint8_t> bytes, const ImageRoom& room);
Image decodeJpeg(std::span<const uint8_t> bytes, const ImageRoom& room);
Image decodeGif(std::span<const uint8_t> bytes, const ImageRoom& room);

inline constexpr uint64_t maximumImageSide = 65536; // what a texture can have

// Throws std::runtime_error for sizes of no pixels, of a side above maximumImageSide or of more
// pixels than limits.imagePixels. Decoders call it before they allocate anything that grows with
// the picture.
void checkImageSize(uint64_t width, uint64_t height, const Limits& limits, const char* format);
// Does the same, and throws if `components` bytes a pixel, and `working` bytes while the picture is
// decoded, are more than the room holds.
void checkImageSize(uint64_t width, uint64_t height, uint64_t components, uint64_t working,
                    const ImageRoom& room, const char* format);
// Throws std::runtime_error if the file is shorter than any file that holds a picture of this size.
void checkFileSize(uint64_t fileBytes, uint64_t leastBytes, const char* format);

// Rows arrive from the top; the pixels grow with them, so that a header that promises much and a
// file that holds little cost little.
void flipRows(Image& image);

// The same for pictures of radiance; their size is refused where a quarter of limits.imagePixels is
// too little.
RadianceImage decodeExr(std::span<const uint8_t> bytes, const Limits& limits);
void checkRadianceSize(int64_t width, int64_t height, const Limits& limits);
void flipRows(RadianceImage& image);

} // namespace xvrml

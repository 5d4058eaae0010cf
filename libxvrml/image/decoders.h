// decoders.h: one function a picture format, chosen by image.cpp. Each gives rows from the bottom up or throws
// std::runtime_error; none prints, exits or leaves anything behind. [any thread]
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include "image/image.h"
#include "xvrml/radiance.h"

namespace xvrml {

// Returns the bytes of a regular file of at most limits.fileBytes; throws std::runtime_error.
std::vector<uint8_t> readPictureFile(const std::string& path, const Limits& limits);

Image decodePng(std::span<const uint8_t> bytes, const Limits& limits);
Image decodeJpeg(std::span<const uint8_t> bytes, const Limits& limits);
Image decodeGif(std::span<const uint8_t> bytes, const Limits& limits);

// Refuses sizes of no pixels or more than limits.imagePixels, before anything is allocated for them.
void checkImageSize(uint64_t width, uint64_t height, const Limits& limits, const char* format);

// Rows arrive from the top; the pixels grow with them, so that a header that promises much and a file that holds little cost
// little.
void flipRows(Image& image);

// The same for pictures of radiance; their size is refused where a quarter of limits.imagePixels is too little.
RadianceImage decodeExr(std::span<const uint8_t> bytes, const Limits& limits);
void checkRadianceSize(int64_t width, int64_t height, const Limits& limits);
void flipRows(RadianceImage& image);

} // namespace xvrml

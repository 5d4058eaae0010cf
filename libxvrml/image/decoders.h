// decoders.h: one function per picture format, chosen by image.cpp. Each returns rows from the
// bottom up or throws std::runtime_error. None prints, ends the process or leaks. [any thread]
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "image/image.h"
#include "xvrml/radiance.h"

namespace xvrml {

// Returns the bytes of a regular file, or of a data: URL, of at most limits.fileBytes; throws
// std::runtime_error.
std::vector<uint8_t> readPictureFile(const std::string& path, const ImageRoom& room);
inline std::vector<uint8_t> readPictureFile(const std::string& path, const Limits& limits) {
  return readPictureFile(path, ImageRoom{limits});
}

// Returns the media type of a picture by its first bytes, "image/png"; "" if it is none that is
// read.
std::string_view mediaTypeOf(std::span<const uint8_t> bytes);
// Decodes a picture of colours or of radiances, whichever it is. Throws std::runtime_error.
std::variant<Image, RadianceImage> decodePicture(std::span<const uint8_t> bytes,
                                                 const ImageRoom& room);

Image decodePng(std::span<const uint8_t> bytes, const ImageRoom& room);
Image decodeJpeg(std::span<const uint8_t> bytes, const ImageRoom& room);
Image decodeGif(std::span<const uint8_t> bytes, const ImageRoom& room);

inline constexpr uint64_t maximumImageSide = 65536; // largest side of a texture

// The picture has more pixels than limits.imagePixels.
struct TooManyPixels : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Throws std::runtime_error if the picture has no pixels, a side above maximumImageSide, or and
// TooManyPixels. Decoders call it before they allocate memory for the picture.
void checkImageSize(uint64_t width, uint64_t height, const Limits& limits, const char* format);
// Does the same. Also throws if `components` bytes per pixel, plus `working` bytes during decoding,
// exceed what `room` allows.
void checkImageSize(uint64_t width, uint64_t height, uint64_t components, uint64_t working,
                    const ImageRoom& room, const char* format);
// Throws std::runtime_error if the file is shorter than any file that holds a picture of this size.
void checkFileSize(uint64_t fileBytes, uint64_t leastBytes, const char* format);

// Flips the rows, which are decoded from the top. Pixels are appended row by row, so that a large
// header with little data costs little.
void flipRows(Image& image);

// The same for radiance pictures. checkRadianceSize refuses more pixels than a quarter of
// limits.imagePixels.
RadianceImage decodeRadiance(std::span<const uint8_t> bytes, const ImageRoom& room);
void checkRadianceSize(int64_t width, int64_t height, const Limits& limits);
void flipRows(RadianceImage& image);

} // namespace xvrml

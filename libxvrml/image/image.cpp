// image.cpp: reads picture files, and recognises their format by content.
#include "image/image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "base/data_url.h"
#include "base/regular_file.h"
#include "image/decoders.h"
#include "image/foreign.h"

namespace xvrml {

void checkImageSize(uint64_t width, uint64_t height, const Limits& limits, const char* format) {
  if (width == 0 || height == 0)
    throw std::runtime_error(fmt::format("{} picture without pixels", format));
  if (width > maximumImageSide || height > maximumImageSide)
    throw std::runtime_error(fmt::format(
        "{} picture of {} x {} pixels: a side has at most {}, see the limit 'imagePixels' ({})",
        format, width, height, maximumImageSide, limits.imagePixels));
  if (width * height > limits.imagePixels)
    throw TooManyPixels(
        fmt::format("{} picture of {} x {} pixels is beyond the limit 'imagePixels' ({})", format,
                    width, height, limits.imagePixels));
}

void checkImageSize(uint64_t width, uint64_t height, uint64_t components, uint64_t working,
                    const ImageRoom& room, const char* format) {
  checkImageSize(width, height, room.limits, format);
  const uint64_t bytes = width * height * components; // below 2^35 because of maximumImageSide
  if (bytes > room.bytes)
    throw std::runtime_error(
        fmt::format("{} picture of {} x {} pixels takes {} bytes: all pictures of a world together "
                    "take at most 4 bytes for each pixel of the limit 'imagePixels' ({})",
                    format, width, height, bytes, room.limits.imagePixels));
  if (room.budget && bytes + working > room.budget->left())
    throw std::runtime_error(fmt::format("{} picture of {} x {} pixels takes {} bytes: together "
                                         "with the rest of the world, more than {}",
                                         format, width, height, bytes + working,
                                         room.budget->name()));
}

void checkFileSize(uint64_t fileBytes, uint64_t leastBytes, const char* format) {
  if (fileBytes < leastBytes)
    throw std::runtime_error(fmt::format("damaged {} picture: too short for its size", format));
}

void flipRows(Image& image) {
  size_t rowBytes = size_t(image.width) * size_t(image.components), height = size_t(image.height);
  for (size_t y = 0; y < height / 2; y++) {
    uint8_t* top = image.pixels.data() + y * rowBytes;
    std::swap_ranges(top, top + rowBytes, image.pixels.data() + (height - 1 - y) * rowBytes);
  }
}

std::string_view mediaTypeOf(std::span<const uint8_t> bytes) {
  const auto startsWith = [&](std::string_view magic) {
    return bytes.size() >= magic.size() &&
           std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
  };
  if (startsWith("\x89PNG\r\n\x1a\n")) return "image/png";
  if (startsWith("\xff\xd8\xff")) return "image/jpeg";
  if (startsWith("GIF87a") || startsWith("GIF89a")) return "image/gif";
  if (!looksLikeRadiance(bytes.data(), bytes.size())) {
    const ForeignFormat* const foreign = foreignFormat(bytes);
    return foreign ? foreign->mediaType : std::string_view();
  }
  return bytes[0] == '#'   ? "image/vnd.radiance"
         : bytes[0] == 'P' ? "image/x-portable-floatmap"
                           : "image/x-exr";
}

Image decodeImage(const uint8_t* bytes, size_t size, const ImageRoom& room) {
  const std::span<const uint8_t> content(bytes, size);
  const std::string_view type = mediaTypeOf(content);
  if (type == "image/png") return decodePng(content, room);
  if (type == "image/jpeg") return decodeJpeg(content, room);
  if (type == "image/gif") return decodeGif(content, room);
  if (const ForeignFormat* foreign = foreignFormat(content))
    return decodeForeign(*foreign, content, room);
  if (size == 0) throw std::runtime_error("the file is empty");
  if (!type.empty()) throw std::runtime_error("a picture of radiance cannot be used here");
  throw std::runtime_error(
      "not a PNG, JPEG, GIF, WebP, BMP or TGA picture, nor one of radiance (.hdr, .pfm, .exr)");
}

std::variant<Image, RadianceImage> decodePicture(std::span<const uint8_t> bytes,
                                                 const ImageRoom& room) {
  if (looksLikeRadiance(bytes.data(), bytes.size())) return decodeRadiance(bytes, room);
  return decodeImage(bytes.data(), bytes.size(), room);
}

std::vector<uint8_t> readPictureFile(const std::string& path, const ImageRoom& room) {
  if (isDataUrl(path)) {
    DataUrl data;
    std::string why;
    const uint64_t most = room.budget ? room.budget->left() : room.limits.fileBytes;
    if (!decodeDataUrl(path, std::min(most, room.limits.fileBytes), data, why))
      throw std::runtime_error(why);
    return {data.bytes.begin(), data.bytes.end()};
  }
  const RegularFile file(path);
  if (file.size() > room.limits.fileBytes)
    throw std::runtime_error(fmt::format("{} bytes are beyond the limit 'fileBytes' ({})",
                                         file.size(), room.limits.fileBytes));
  if (room.budget && file.size() > room.budget->left())
    throw std::runtime_error(
        fmt::format("{} bytes are, together with the rest of the world, more than {}", file.size(),
                    room.budget->name()));
  std::vector<uint8_t> bytes(size_t(file.size()) + 1);
  bytes.resize(file.read(0, bytes.data(), size_t(file.size())));
  return bytes;
}

Image readImage(const std::string& path, const ImageRoom& room) {
  const std::vector<uint8_t> bytes = readPictureFile(path, room);
  return decodeImage(bytes.data(), bytes.size(), room);
}

Image loadImage(const std::string& path, const Limits& limits) { return readImage(path, limits); }

} // namespace xvrml

// image.cpp: reads picture files and finds their format by content.
#include "image/image.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "image/decoders.h"

namespace xvrml {

void checkImageSize(uint64_t width, uint64_t height, const Limits& limits, const char* format) {
  if (width == 0 || height == 0) throw std::runtime_error(fmt::format("{} picture without pixels", format));
  if (width > INT32_MAX || height > INT32_MAX || width * height > limits.imagePixels)
    throw std::runtime_error(fmt::format("{} picture of {} x {} pixels is beyond the limit 'imagePixels' ({})", format, width,
                                         height, limits.imagePixels));
}

void flipRows(Image& image) {
  size_t rowBytes = size_t(image.width) * size_t(image.components), height = size_t(image.height);
  for (size_t y = 0; y < height / 2; y++) {
    uint8_t* top = image.pixels.data() + y * rowBytes;
    std::swap_ranges(top, top + rowBytes, image.pixels.data() + (height - 1 - y) * rowBytes);
  }
}

Image decodeImage(const uint8_t* bytes, size_t size, const Limits& limits) {
  std::span<const uint8_t> content(bytes, size);
  auto startsWith = [&](std::string_view magic) {
    return size >= magic.size() && std::memcmp(bytes, magic.data(), magic.size()) == 0;
  };
  if (startsWith("\x89PNG\r\n\x1a\n")) return decodePng(content, limits);
  if (startsWith("\xff\xd8\xff")) return decodeJpeg(content, limits);
  if (startsWith("GIF87a") || startsWith("GIF89a")) return decodeGif(content, limits);
  if (size == 0) throw std::runtime_error("the file is empty");
  if (looksLikeRadiance(bytes, size)) throw std::runtime_error("a picture of radiance cannot be used here");
  throw std::runtime_error("not a PNG, JPEG or GIF picture, nor one of radiance (.hdr, .pfm, .exr)");
}

std::vector<uint8_t> readPictureFile(const std::string& path, const Limits& limits) {
  struct stat info;
  if (stat(path.c_str(), &info) != 0) throw std::runtime_error(std::strerror(errno));
  if (!S_ISREG(info.st_mode)) throw std::runtime_error("not a file"); // a pipe or device could wait for ever
  if (uint64_t(info.st_size) > limits.fileBytes)
    throw std::runtime_error(fmt::format("{} bytes are beyond the limit 'fileBytes' ({})", info.st_size, limits.fileBytes));
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) throw std::runtime_error(std::strerror(errno));
  std::vector<uint8_t> bytes(size_t(info.st_size) + 1);
  bytes.resize(std::fread(bytes.data(), 1, size_t(info.st_size), file.get()));
  if (std::ferror(file.get())) throw std::runtime_error("cannot be read");
  return bytes;
}

Image readImage(const std::string& path, const Limits& limits) {
  const std::vector<uint8_t> bytes = readPictureFile(path, limits);
  return decodeImage(bytes.data(), bytes.size(), limits);
}

Image loadImage(const std::string& path, const Limits& limits) { return readImage(path, limits); }

} // namespace xvrml

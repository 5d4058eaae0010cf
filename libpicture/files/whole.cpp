#include "libpicture/files/whole.h"

#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>

#include <zlib.h>

#include "xvrml/radiance.h"

namespace picture {

namespace {

uint32_t bigEndian(std::string_view bytes, size_t at) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) value = value << 8 | uint8_t(bytes[at + i]);
  return value;
}

// Checks the chunks of a PNG file with their check sums (PNG 1.2, 3.2), up to IEND.
bool isWholePng(std::string_view bytes) {
  constexpr std::string_view signature("\x89PNG\r\n\x1a\n", 8);
  if (!bytes.starts_with(signature)) return false;
  for (size_t at = signature.size(); at + 12 <= bytes.size();) {
    const size_t length = bigEndian(bytes, at);
    if (length > bytes.size() - at - 12) return false;
    const std::string_view typeAndData = bytes.substr(at + 4, 4 + length);
    const auto sum =
        crc32(0, reinterpret_cast<const Bytef*>(typeAndData.data()), uInt(typeAndData.size()));
    if (uint32_t(sum) != bigEndian(bytes, at + 8 + length)) return false;
    at += 12 + length;
    if (typeAndData.starts_with("IEND")) return at == bytes.size();
  }
  return false;
}

bool isWholeJpeg(std::string_view bytes) {
  return bytes.starts_with("\xff\xd8") && bytes.ends_with("\xff\xd9");
}

// Checks that a PPM or PFM file has the bytes that its header asks for.
bool isWholePixmap(std::string_view bytes, int bytesOfPixel) {
  const std::string head(bytes.substr(0, 64));
  char kind = 0, rest[16] = {};
  int width = 0, height = 0, used = 0;
  if (std::sscanf(head.c_str(), "P%c %9d %9d %15s%n", &kind, &width, &height, rest, &used) != 4)
    return false;
  return width > 0 && height > 0 &&
         bytes.size() == size_t(used) + 1 + size_t(width) * size_t(height) * size_t(bytesOfPixel);
}

bool isWholeHdr(std::string_view bytes) {
  try {
    xvrml::decodeRadiance(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
    return true;
  } catch (const std::exception&) { return false; }
}

} // namespace

bool isWholePicture(const std::string& path, const Format& format) {
  if (format.encode == encodeExr) try {
      readExr(path);
      return true;
    } catch (const std::exception&) { return false; }
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  std::ifstream file(path, std::ios::binary);
  if (!file) return false;
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (format.encode == encodePng) return isWholePng(bytes);
  if (format.encode == encodeHdr) return isWholeHdr(bytes);
  if (format.encode == encodeJpeg) return isWholeJpeg(bytes);
  return isWholePixmap(bytes, format.encode == encodePfm ? 12 : 3);
}

} // namespace picture

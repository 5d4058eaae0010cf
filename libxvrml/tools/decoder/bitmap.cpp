// bitmap.cpp: decodes BMP and TGA pictures with stb_image, which has no message for a file
// that it reads wrongly, and shows what its memory held before in place of missing pixels.
#include <algorithm>
#include <cstdlib>
#include <limits>
#include <memory>
#include <stdexcept>

#if __has_include(<stb/stb_image.h>)
#define WITH_STB
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 65536
#include <stb/stb_image.h>
#endif

#include "answer.h"

namespace xvrml::decoding {

#ifdef WITH_STB
namespace {

using Bytes = std::span<const uint8_t>;

struct Picture {
  uint64_t width, height, components;
};

// Returns a number of a file, with zeros for bytes beyond its end, as stb_image reads them.
uint64_t number(Bytes file, size_t at, size_t bytes) {
  uint64_t value = 0;
  for (size_t i = 0; i < bytes && at + i < file.size(); ++i)
    value |= uint64_t(file[at + i]) << (8 * i);
  return value;
}

[[noreturn]] void refuseShort() { throw std::runtime_error("it ends too early"); }

// Checks what stb_image does not: a BMP file has all its pixels, and its palette all their colours.
void checkBmp(Bytes file, const Picture& picture) {
  const uint64_t offset = number(file, 10, 4), header = number(file, 14, 4);
  const bool os2 = header == 12;
  const uint64_t depth = number(file, os2 ? 24 : 28, 2), bits = picture.width * depth,
                 row = (bits + 31) / 32 * 4;
  if (offset + row * (picture.height - 1) + (bits + 7) / 8 > file.size()) refuseShort();
  if (depth != 1 && depth != 4 && depth != 8) return;
  // stb_image takes so many colours from what is between header and pixels.
  const int64_t colors = os2 ? (int64_t(offset) - 38) / 3 : int64_t(offset - 14 - header) / 4;
  for (uint64_t y = 0; y < picture.height; ++y)
    for (uint64_t bit = 0; bit < bits; bit += depth) {
      const uint8_t byte = file[offset + y * row + bit / 8];
      if ((byte >> (8 - depth - bit % 8) & ((1 << depth) - 1)) >= colors)
        throw std::runtime_error("a pixel is beyond the colours that are read of its palette");
    }
}

// Checks what stb_image does not: a TGA file has all its pixels, and its map begins with colour 0.
void checkTga(Bytes file, const Picture& picture) {
  if (file[1] == 1 && number(file, 3, 2) != 0)
    throw std::runtime_error("its colour map does not begin with colour 0, which is not read");
  const uint64_t pixel = (file[16] + 7) / 8;
  uint64_t at = 18 + file[0] + number(file, 5, 2) * ((file[7] + 7) / 8);
  uint64_t left = picture.width * picture.height;
  const bool runs = file[2] & 8;
  while (runs && left > 0 && at < file.size()) {
    const uint64_t run = (file[at] & 127u) + 1;
    at += 1 + (file[at] & 128u ? 1 : run) * pixel;
    left -= std::min(left, run);
  }
  if (runs ? left > 0 || at > file.size() : at + left * pixel > file.size()) refuseShort();
}

// Mends the pixels of a TGA file: stb_image does not know rows from right to left. An alpha of 0
// everywhere means nothing if the file does not speak of alpha; but many programs write an alpha
// that is one without saying so.
void mendTga(Bytes file, const Picture& picture, uint8_t* pixels) {
  const uint64_t pixel = picture.components, row = picture.width * pixel;
  uint8_t* const end = pixels + row * picture.height;
  if (file[17] & 0x10)
    for (uint8_t* line = pixels; line < end; line += row)
      for (uint8_t *left = line, *right = line + row - pixel; left < right;
           left += pixel, right -= pixel)
        std::swap_ranges(left, left + pixel, right);
  if (pixel != 4 || file[17] & 15) return;
  uint8_t any = 0;
  for (const uint8_t* p = pixels; p < end; p += pixel) any |= p[3];
  for (uint8_t* p = pixels; any == 0 && p < end; p += pixel) p[3] = 255;
}

} // namespace

void decodeBitmap(std::span<const uint8_t> file, Answer& answer) {
  if (file.size() > size_t(std::numeric_limits<int>::max()))
    throw std::runtime_error("it is too large");
  const auto refuse = [] {
    const char* const why = stbi_failure_reason();
    throw std::runtime_error(why ? why : "it is damaged");
  };
  const int size = int(file.size());
  int width = 0, height = 0, components = 0;
  if (!stbi_info_from_memory(file.data(), size, &width, &height, &components)) refuse();
  // The height of a BMP file whose rows begin at the top is negative.
  const Picture picture{uint64_t(width), uint64_t(std::abs(int64_t(height))), uint64_t(components)};
  answer.contents({picture.width, picture.height, uint32_t(components), 1, 0});
  const bool bmp = file[0] == 'B' && file[1] == 'M';
  (bmp ? checkBmp : checkTga)(file, picture);
  const std::unique_ptr<uint8_t, decltype(&stbi_image_free)> pixels(
      stbi_load_from_memory(file.data(), size, &width, &height, nullptr, components),
      stbi_image_free);
  if (!pixels) refuse();
  if (!bmp) mendTga(file, picture, pixels.get());
  answer.add(pixels.get(), size_t(picture.width * picture.height * picture.components));
}
#else
void decodeBitmap(std::span<const uint8_t>, Answer&) {
  throw std::runtime_error("this build has no stb_image, which reads BMP and TGA");
}
#endif

} // namespace xvrml::decoding

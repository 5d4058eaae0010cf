// png.cpp: decodes PNG with libpng. Its errors return by longjmp, so functions that an error may
// leave have no objects with destructors.
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <cstring>

#include "image/decoders.h"

namespace xvrml {
namespace {

struct PngReader {
  std::span<const uint8_t> bytes;
  size_t position = 0;
  char message[200] = "";
  std::jmp_buf escape;
  png_structp png = nullptr;
  png_infop info = nullptr;
  int passes = 1; // 7 if the picture is interlaced
  Image image;

  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
};

[[noreturn]] void onError(png_structp png, png_const_charp text) {
  auto* reader = static_cast<PngReader*>(png_get_error_ptr(png));
  std::snprintf(reader->message, sizeof reader->message, "%s", text);
  std::longjmp(reader->escape, 1);
}

void onWarning(png_structp, png_const_charp) {} // a damaged text chunk is harmless

void readBytes(png_structp png, png_bytep to, size_t count) {
  auto* reader = static_cast<PngReader*>(png_get_io_ptr(png));
  if (count > reader->bytes.size() - reader->position) png_error(png, "the file ends early");
  std::memcpy(to, reader->bytes.data() + reader->position, count);
  reader->position += count;
}

// Reads everything before the pixels. Allocates nothing that grows with the picture.
bool readHeader(PngReader& reader) {
  if (setjmp(reader.escape)) return false;
  png_structp png = reader.png;
  png_set_read_fn(png, &reader, readBytes);
  png_set_user_limits(png, 0x7fffffff, 0x7fffffff); // checked by the caller
  png_set_chunk_malloc_max(png, 16 << 20);
  png_set_chunk_cache_max(png, 100);
  png_read_info(png, reader.info);
  return true;
}

// Sets the format of the decoded pixels. libpng allocates its rows here.
bool start(PngReader& reader) {
  if (setjmp(reader.escape)) return false;
  png_structp png = reader.png;
  if (png_get_bit_depth(png, reader.info) == 16) png_set_scale_16(png);
  png_set_expand(png); // palettes to RGB, fewer than 8 bits to 8, tRNS to alpha
  reader.passes = png_set_interlace_handling(png);
  png_read_update_info(png, reader.info);
  return true;
}

// Reads all rows, and stores them from the bottom up. Data after the pixels is ignored.
bool readRows(PngReader& reader, png_bytep pixels, size_t rowBytes, size_t height, int passes) {
  if (setjmp(reader.escape)) return false;
  for (int pass = 0; pass < passes; pass++)
    for (size_t y = height; y-- > 0;) png_read_row(reader.png, pixels + y * rowBytes, nullptr);
  return true;
}

// Returns the components of a decoded pixel: palettes become RGB, and a tRNS chunk becomes alpha.
uint64_t decodedComponents(const PngReader& reader) {
  const int type = png_get_color_type(reader.png, reader.info);
  const bool alpha =
      type & PNG_COLOR_MASK_ALPHA || png_get_valid(reader.png, reader.info, PNG_INFO_tRNS);
  return (type & PNG_COLOR_MASK_COLOR ? 3u : 1u) + (alpha ? 1u : 0u);
}

} // namespace

Image decodePng(std::span<const uint8_t> bytes, const ImageRoom& room) {
  PngReader reader;
  reader.bytes = bytes;
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, onError, onWarning);
  reader.info = reader.png ? png_create_info_struct(reader.png) : nullptr;
  if (!reader.info) throw std::bad_alloc();
  auto check = [&](bool fine) {
    if (!fine) throw std::runtime_error(std::string("damaged PNG picture: ") + reader.message);
  };
  check(readHeader(reader));
  uint64_t width = png_get_image_width(reader.png, reader.info),
           height = png_get_image_height(reader.png, reader.info);
  checkImageSize(width, height, decodedComponents(reader), 0, room, "PNG");
  // Deflate compresses at most 1032 to 1, which bounds the rows that the file can hold.
  checkFileSize(bytes.size(), png_get_rowbytes(reader.png, reader.info) * height / 1032, "PNG");
  check(start(reader));
  Image& image = reader.image;
  image.width = int32_t(width);
  image.height = int32_t(height);
  image.components = png_get_channels(reader.png, reader.info);
  size_t rowBytes = size_t(width) * size_t(image.components);
  if (png_get_rowbytes(reader.png, reader.info) != rowBytes)
    throw std::runtime_error("PNG picture of an unknown kind");
  image.pixels.resize(rowBytes * size_t(height));
  check(readRows(reader, image.pixels.data(), rowBytes, size_t(height), reader.passes));
  return std::move(image);
}

} // namespace xvrml

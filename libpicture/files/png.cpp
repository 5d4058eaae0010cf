// png.cpp: Encodes PNG with libpng in memory, 8 bits a component. [any thread]
#include <csetjmp>
#include <stdexcept>

#include <png.h>

#include "libpicture/files/formats.h"

namespace picture {

namespace {

void append(png_structp png, png_bytep bytes, size_t size) {
  // An exception must not cross libpng's C frames.
  try {
    static_cast<std::string*>(png_get_io_ptr(png))
        ->append(reinterpret_cast<const char*>(bytes), size);
  } catch (...) { png_error(png, "out of memory"); }
}

void nothing(png_structp) {}
void silent(png_structp, png_const_charp) {}

// Returns false on an error. Holds only C values across libpng's longjmp.
bool write(png_structp png, png_infop info, std::string* out, const uint8_t* bytes, int width,
           int height, int components, png_textp note) {
  constexpr int types[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                           PNG_COLOR_TYPE_RGB_ALPHA};
  if (setjmp(png_jmpbuf(png))) return false;
  png_set_write_fn(png, out, append, nothing);
  png_set_user_limits(png, 0x7fffffff, 0x7fffffff);
  png_set_IHDR(png, info, png_uint_32(width), png_uint_32(height), 8, types[components - 1],
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  if (note) png_set_text(png, info, note, 1);
  png_write_info(png, info);
  for (int y = 0; y < height; ++y)
    png_write_row(png, bytes + size_t(y) * size_t(width) * size_t(components));
  png_write_end(png, info);
  return true;
}

} // namespace

std::string pngOf(const std::vector<uint8_t>& bytes, int width, int height, int components,
                  std::string note) {
  std::string out;
  char keyword[] = "Comment";
  png_text text{};
  text.compression = PNG_TEXT_COMPRESSION_NONE;
  text.key = keyword;
  text.text = note.data();
  text.text_length = note.size();
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, silent);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  const bool done = info && write(png, info, &out, bytes.data(), width, height, components,
                                  note.empty() ? nullptr : &text);
  png_destroy_write_struct(&png, &info);
  if (!done) throw std::runtime_error("PNG: the picture cannot be encoded");
  return out;
}

std::string encodePng(const Picture& picture) {
  return picture.transparent
             ? pngOf(displayBytesAlpha(picture), picture.width, picture.height, 4, picture.note)
             : pngOf(displayBytes(picture), picture.width, picture.height, 3, picture.note);
}

} // namespace picture

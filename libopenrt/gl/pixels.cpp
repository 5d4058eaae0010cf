// pixels.cpp: Converts pixels of programs.
#include "gl/pixels.h"

#include <algorithm>

namespace rtgl {
namespace {

size_t sizeOf(GLenum type) {
  switch (type) {
  case GL_UNSIGNED_BYTE:
  case GL_BYTE: return 1;
  case GL_UNSIGNED_SHORT:
  case GL_SHORT: return 2;
  case GL_UNSIGNED_INT:
  case GL_INT:
  case GL_FLOAT: return 4;
  default: fail(GL_INVALID_ENUM, "no such type of pixels");
  }
}

unsigned char toByte(double unit) {
  return unit > 0 ? static_cast<unsigned char>(255 * std::min(unit, 1.0) + 0.5) : 0; // also for NaN
}

// Returns component i of the pixels at an address.
unsigned char component(const void* at, size_t i, GLenum type) {
  switch (type) {
  case GL_UNSIGNED_BYTE: return static_cast<const GLubyte*>(at)[i];
  case GL_BYTE: return toByte(static_cast<const GLbyte*>(at)[i] / 127.0);
  case GL_UNSIGNED_SHORT: return toByte(static_cast<const GLushort*>(at)[i] / 65535.0);
  case GL_SHORT: return toByte(static_cast<const GLshort*>(at)[i] / 32767.0);
  case GL_UNSIGNED_INT: return toByte(static_cast<const GLuint*>(at)[i] / 4294967295.0);
  case GL_INT: return toByte(static_cast<const GLint*>(at)[i] / 2147483647.0);
  default: return toByte(static_cast<double>(static_cast<const GLfloat*>(at)[i]));
  }
}

} // namespace

int componentsOf(GLenum format) {
  switch (format) {
  case GL_RED:
  case GL_GREEN:
  case GL_BLUE:
  case GL_ALPHA:
  case GL_LUMINANCE: return 1;
  case GL_LUMINANCE_ALPHA: return 2;
  case GL_RGB: return 3;
  case GL_RGBA: return 4;
  default:
    fail(GL_INVALID_ENUM,
         "pixels are GL_LUMINANCE, GL_LUMINANCE_ALPHA, GL_ALPHA, GL_RGB or GL_RGBA");
  }
}

size_t rowBytes(const PixelStore& store, int width, GLenum format, GLenum type) {
  const auto pixels = static_cast<size_t>(store.rowLength > 0 ? store.rowLength : width);
  const size_t bytes = pixels * static_cast<size_t>(componentsOf(format)) * sizeOf(type);
  const auto alignment = static_cast<size_t>(std::max(store.alignment, 1));
  return (bytes + alignment - 1) / alignment * alignment;
}

Picture pictureOf(const PixelStore& store, int width, int height, GLenum format, GLenum type,
                  const void* pixels) {
  Picture picture;
  picture.width = width;
  picture.height = height;
  const auto from = static_cast<size_t>(componentsOf(format));
  picture.components = format == GL_ALPHA ? 2 : static_cast<int>(from);
  const size_t count = static_cast<size_t>(width) * static_cast<size_t>(height);
  picture.texels.assign(count * static_cast<size_t>(picture.components), 0);
  if (!pixels) return picture;
  const size_t row = rowBytes(store, width, format, type);
  const auto* first = static_cast<const unsigned char*>(pixels) +
                      static_cast<size_t>(store.skipRows) * row +
                      static_cast<size_t>(store.skipPixels) * from * sizeOf(type);
  size_t out = 0;
  for (int y = 0; y < height; y++)
    for (size_t x = 0; x < static_cast<size_t>(width); x++) {
      const unsigned char* at = first + static_cast<size_t>(y) * row + x * from * sizeOf(type);
      if (format == GL_ALPHA) picture.texels[out++] = 255;
      for (size_t i = 0; i < from; i++) picture.texels[out++] = component(at, i, type);
    }
  return picture;
}

} // namespace rtgl

// pixels.h: reads and writes pixels in the memory of the program, as glPixelStore lays them out.
#pragma once

#include "gl/state.h"

namespace rtgl {

// Returns the number of components of a format of pixels; throws for others.
int componentsOf(GLenum format);
// Returns the bytes from one row to the next.
size_t rowBytes(const PixelStore& store, int width, GLenum format, GLenum type);
// Reads a picture with 8 bits per component. Formats with one component are grey; GL_ALPHA is
// white with alpha. pixels: NULL gives black.
Picture pictureOf(const PixelStore& store, int width, int height, GLenum format, GLenum type,
                  const void* pixels);

} // namespace rtgl

// image.h: pictures of 8 bits per component, as ImageTexture reads them.
#pragma once

#include <string>

#include "xvrml/limits.h"
#include "xvrml/types.h"

namespace xvrml {

// Reads a PNG, JPEG, WebP, BMP or TGA file, or the first frame of a GIF file. The format is
// recognised by the content. Another process decodes WebP, BMP and TGA, the program xvrml-decoder.
// Rows are stored from the bottom up, with the components of the file (1 grey, 2 grey and alpha, 3
// RGB, 4 RGB and alpha). Reads at most limits.imagePixels pixels. Throws std::runtime_error with a
// text that says what is wrong with the file. [any thread]
Image loadImage(const std::string& path, const Limits& limits = {});

} // namespace xvrml

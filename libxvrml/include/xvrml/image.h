// image.h: pictures of 8 bits a component, as ImageTexture reads them.
#pragma once

#include <string>

#include "xvrml/limits.h"
#include "xvrml/types.h"

namespace xvrml {

// Reads a PNG, JPEG or GIF file (its first frame), by content: rows from the bottom up, components
// as the file has them (1 grey, 2 grey and alpha, 3 colours, 4 colours and alpha). Throws
// std::runtime_error that says what is wrong with the file; at most limits.imagePixels pixels are
// read. [any thread]
Image loadImage(const std::string& path, const Limits& limits = {});

} // namespace xvrml

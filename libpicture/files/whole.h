// whole.h: Tells whether the file of a picture is complete, so that a sequence can be continued
// where pictures are absent or damaged. [any thread]
#pragma once

#include <string>

#include "libpicture/files/formats.h"

namespace picture {

// Returns whether a file is a whole picture of its format: PNG by the check sums of its parts, EXR
// by reading it, the others by their beginning, end and size.
bool isWholePicture(const std::string& path, const Format& format);

} // namespace picture

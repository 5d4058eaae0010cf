// exr_end.h: Finds where an OpenEXR file ends, by its table of blocks. Programs may put bytes of
// their own behind it. Pure functions. [any thread]
#pragma once

#include <cstdint>
#include <string_view>

namespace picture {

// Returns the number of bytes of the OpenEXR file that these bytes begin with. The pixels are not
// looked at. All bytes count as its own if it has tiles, several parts or deep pixels. Throws
// BrokenFile (byte_reader.h) if it is not complete.
uint64_t endOfExr(std::string_view bytes);

} // namespace picture

// read_note.h: Reads what the file of a picture says about it (Picture::note), without reading its
// pixels. [any thread]
#pragma once

#include <string>

namespace picture {

// The note of a picture that was saved before it had all of its samples.
inline constexpr const char* unfinishedNote = "unfinished: saved before it had all samples";

// Returns the comment of a PNG, JPEG, OpenEXR, PPM or Radiance file, as one line of ASCII; "" if it
// has none, has it behind its first 64 kB, or is another file.
std::string readNote(const std::string& path);

} // namespace picture

// sums_merge.h: Adds pictures that differ in their seeds alone, from files that hold their sums
// (sums.h). No world is read. [any thread]
#pragma once

#include <string>
#include <vector>

#include "libpicture/sums.h"

namespace picture {

struct MergedPicture {
  SumsFile sums;       // all of them, as `done`
  Picture picture;     // with all channels of the sums; facts.channels are those of files
  std::string warning; // the files are not to be shown in one way; "": they are
};

// Adds the pictures, at least one. The result is shown as the first one; an exposure that fits is
// chosen anew. Throws InputError if a file cannot be read, and RenderError with the code
// RT_SUMS_ERROR, whose text begins "cannot add FILE: ", if one does not belong to those before.
MergedPicture mergePictures(const std::vector<std::string>& paths);

} // namespace picture

// other_formats.h: the formats of 3D models, pictures and pages that people take for VRML97, told
// by how their bytes begin. The loader names them when it refuses a file. Pure functions, any
// thread.
#pragma once

#include <string_view>

namespace xvrml {

struct OtherFormat {
  std::string_view name;   // as its users call it: "an STL mesh"
  std::string_view remedy; // what to do, a clause that begins with a verb
};

// Returns the format that `bytes` (a whole file, or at least its first kilobytes) begin like, or
// null where none is known.
const OtherFormat* otherFormat(std::string_view bytes);

} // namespace xvrml

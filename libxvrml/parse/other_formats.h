// other_formats.h: formats of 3D models, pictures and pages that users mistake for VRML97,
// recognised by their first bytes. The loader names them when it refuses a file. Pure functions,
// any thread.
#pragma once

#include <string_view>

namespace xvrml {

struct OtherFormat {
  std::string_view name;   // as users call it: "an STL mesh"
  std::string_view remedy; // what to do, as a clause that begins with a verb
};

// Returns the format whose signature `bytes` (a whole file, or at least its first kilobytes) have;
// null if none is recognised.
const OtherFormat* otherFormat(std::string_view bytes);

} // namespace xvrml

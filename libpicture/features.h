// features.h: Lists what depends on libraries that a build or a machine need not have: whether each
// is there, which one it is, and how to get what is missing. vv --list-features and
// xvrml.features() show it, each with rows of its own. [one thread at a time]
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace picture {

struct Feature {
  std::string name, text; // "denoise"; what it is for, a phrase without a full stop
  bool available = false;
  // Says what provides it, with its version; "": nothing to say. If not available: why not, if
  // that is known.
  std::string detail;
  std::string file; // the library's; "": it is part of the program
  std::string how;  // how to get it; "" if it is available
};

// Returns the rows of denoising, films, script engines and their sandbox, and STEP models. A
// library for denoising is tried in a child process. scriptPath: folders that are searched first
// for script engines.
std::vector<Feature> listFeatures(std::string_view scriptPath = {});

} // namespace picture

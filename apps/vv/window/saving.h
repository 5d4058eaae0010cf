// saving.h: pictures of the window as files. [any thread]
#pragma once

#include <string>

#include "options/options.h"

namespace vv {

// Samples a pixel that the window refines its picture to.
int samplesInWindow(const Options& options);

// A name that no file has yet: world-1.png, world-2.png ... in the working folder.
std::string freeName(const std::string& world, const std::string& suffix);

// Returns what there is to tell: where it is, or why not.
std::string savePicture(const picture::Picture& picture, const std::string& path,
                        uint32_t channels);

} // namespace vv

// saving.h: Saves pictures of the window as files. [any thread]
#pragma once

#include <string>

#include "options/options.h"

namespace vv {

// Returns the samples per pixel up to which the window refines its picture.
int samplesInWindow(const Options& options);

// Returns an unused file name: world-1.png, world-2.png and so on in the working folder.
std::string freeName(const std::string& world, const std::string& suffix);

// Returns a message for the user: where the picture was saved, or why it was not.
std::string savePicture(const picture::Picture& picture, const std::string& path,
                        uint32_t channels);

} // namespace vv

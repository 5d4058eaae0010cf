// pictures.h: the pictures that the command line asks for: views, frames, turntables, files and
// films. [main thread]
#pragma once

#include "options/options.h"
#include "report/problems.h"

namespace vv {

// Returns an exit code. Throws Failure, picture::RenderError and what writing throws.
int makePictures(const Options& options, const std::string& commandLine, xvrml::Browser& browser,
                 Problems& problems);

// The channels that were asked for, without those that only the statistics need.
picture::Picture wantedPart(const picture::Picture& made, uint32_t channels);

// To a file or ("-") to standard output.
void writeText(const std::string& path, const std::string& text);

} // namespace vv

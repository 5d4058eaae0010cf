// pictures.h: Renders and writes the pictures that the command line asks for: views, frames,
// turntables, files and films. [main thread]
#pragma once

#include "options/options.h"
#include "report/problems.h"

namespace vv {

// Returns an exit code. Throws Failure, picture::RenderError and the errors of writing files.
// startSeconds: how long the world took to start, for the statistics.
int makePictures(const Options& options, const std::string& commandLine, xvrml::Browser& browser,
                 Problems& problems, double startSeconds);

// Returns the seconds between an interrupt and giving up a render that does not stop: a shader may
// hang, but a large picture takes some time to end.
int stuckSeconds(const picture::RenderSettings& render);

} // namespace vv

// hints.h: what to do about a picture that shows nothing. [main thread]
#pragma once

#include <string>

#include "libpicture/renderer.h"
#include "options/options.h"

namespace vv {

// Returns true if all pixels look the same on a screen: black, or one colour of background.
bool showsNothing(const picture::Picture& picture);

// Returns why a picture that shows nothing may be so, and the option that helps; empty if it may be
// meant. Makes a picture of one sample a pixel to see whether anything is in view. Not while a
// frame is in flight.
std::string hintFor(const Options& options, const picture::View& view,
                    const picture::RenderResult& result, picture::Renderer& renderer);

} // namespace vv

// hints.h: Suggests what to do about a picture that shows nothing. [main thread]
#pragma once

#include <string>

#include "libpicture/renderer.h"
#include "options/options.h"

namespace vv {

// Returns true if all pixels look the same on a screen: black, or one background colour.
bool showsNothing(const picture::Picture& picture);

// Returns the probable reason for a picture that shows nothing, and the option that helps; empty if
// the picture may be intended. Renders a picture with one sample per pixel to find out whether
// anything is in view. Do not call it while a frame is in flight.
std::string hintFor(const Options& options, const picture::View& view,
                    const picture::RenderResult& result, picture::Renderer& renderer);

} // namespace vv

// hints.h: Suggests what to do about a picture that shows nothing, or nothing but silhouettes.
// [main thread]
#pragma once

#include <string>

#include "libpicture/renderer.h"
#include "options/options.h"

namespace vv {

// Returns true if all pixels look the same on a screen: black, or one background colour.
bool showsNothing(const picture::Picture& picture);

// Returns true if the world has no light, and an option gives the background: the shapes may be
// silhouettes.
bool mayBeUnlit(const Options& options, const picture::RenderResult& result);

// Returns that most of the picture is brighter than white on a screen, and what helps; empty if it
// is not.
std::string tooBrightHint(const picture::Picture& picture);

// Returns the probable reason for a picture that shows nothing, or whose shapes are all black, and
// the option that helps; empty if the picture may be intended. Renders a picture with one sample
// per pixel to find out what is in view. Do not call it while a frame is in flight.
std::string hintFor(const Options& options, const picture::View& view,
                    const picture::RenderResult& result, picture::Renderer& renderer);

} // namespace vv

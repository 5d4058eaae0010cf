// preview_settings.h: Turns the settings of a frame into those of a preview. The renderers that
// make previews share it. [any thread]
#pragma once

#include <cstdint>

#include "libpicture/renderer.h"

namespace picture::live {

// Gives a frame samples of its own, anywhere in their pixels: from the same samples again and again
// nothing could be accumulated. number: counts the previews.
void drawFreshSamples(RenderSettings& settings, uint64_t number);

// Asks for the channels and settings that Reconstruction needs of a frame.
void askForGuides(RenderSettings& settings);

} // namespace picture::live

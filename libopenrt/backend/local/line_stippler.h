// line_stippler.h: lays the pattern of dashed lines along them, with lengths in pixels of the
// picture. Called on the application thread, between frames.
#pragma once

#include "backend/local/thin.h"
#include "scene/stipple.h"

namespace openrt {

// Returns the lines of a geometry as the camera sees them. `scale` converts render space to the top
// level's frame.
std::vector<StippledLine> stippledLines(const ThinGeometry& thin, const PixelFootprint& footprint,
                                        float scale);

} // namespace openrt
